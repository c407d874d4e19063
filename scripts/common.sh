# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
# Shared by the scripts of this folder; source it, do not run it.
set -euo pipefail
project_folder="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

say() { printf '==> %s\n' "$*"; }
fail() {
  printf 'Error: %s\n' "$*" >&2
  exit 1
}

# listed_packages FILE...: names of the packages in these lists, one a line.
listed_packages() {
  (cd "$project_folder" && sed -e 's/#.*//' -e 's/[[:space:]]*$//' -e '/^$/d' "$@")
}

is_installed() {
  [[ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]
}

missing_packages() {
  local package
  while read -r package; do
    is_installed "$package" || printf '%s\n' "$package"
  done < <(listed_packages "$@")
}

as_root() {
  if [[ "$(id -u)" == 0 ]]; then
    env DEBIAN_FRONTEND=noninteractive "$@"
  elif command -v sudo >/dev/null; then
    sudo env DEBIAN_FRONTEND=noninteractive "$@"
  else
    fail "these packages have to be installed by root, and there is no sudo. As root:
  $*"
  fi
}

# install_packages FILE...: installs what is missing of these lists; asks nothing of the network if
# nothing is.
install_packages() {
  if [[ -n "${MRPT_TERRAIN_SKIP_PACKAGES:-}" ]]; then
    say "MRPT_TERRAIN_SKIP_PACKAGES is set: not looking at packages"
    return
  fi
  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    fail "this system has no apt-get. The project is built on Debian 12; elsewhere install the
counterparts of the packages in $project_folder/packages.apt by hand (MRPT 2.5 or later), set
MRPT_TERRAIN_SKIP_PACKAGES=1 and run this script again."
  fi
  local missing
  mapfile -t missing < <(missing_packages "$@")
  if [[ ${#missing[@]} == 0 ]]; then
    say "All packages of $* are installed"
    return
  fi
  say "Installing ${missing[*]}"
  as_root apt-get update -q
  as_root apt-get install -q -y --no-install-recommends "${missing[@]}"
}

# configure PRESET [OPTION...]: configures build/PRESET, through ccache where there is one.
configure() {
  local preset="$1"
  shift
  local options=("$@")
  if command -v ccache >/dev/null; then
    options+=("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
  fi
  say "Configuring build/$preset"
  cmake -S "$project_folder" --preset "$preset" "${options[@]}"
}

# build PRESET [TARGET...]: builds build/PRESET, everything if no target is named.
build() {
  local preset="$1"
  shift
  say "Building build/$preset${*:+: $*}"
  cmake --build "$project_folder/build/$preset" ${1:+--target "$@"}
}
