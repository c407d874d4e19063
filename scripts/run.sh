#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds terrain-rawlog and describes the terrain in a rawlog.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'TEXT'
usage: scripts/run.sh [RAWLOG] [OPTION...]

Installs the missing Debian packages of packages.apt, builds terrain-rawlog, and describes the
terrain in RAWLOG, or without RAWLOG in a scan of a VLP-16 that Debian's mrpt-common brings along.
Results and pictures go to out/NAME beside this project's README. Every OPTION is handed to
`terrain-rawlog process`; without any, it uses `-c params/paper_outdoor.ini --find-ground`.
TEXT
}

sample_rawlog() {
  local file
  file="$(dpkg -L mrpt-common 2>/dev/null | grep '/test_velodyne_VLP16\.rawlog$' || true)"
  [[ -n "$file" ]] || fail "mrpt-common has no test_velodyne_VLP16.rawlog; name a rawlog:
  scripts/run.sh RAWLOG"
  printf '%s\n' "$file"
}

# The folder that the options of terrain-rawlog name, or nothing.
chosen_output_folder() {
  while [[ $# -gt 0 ]]; do
    case "$1" in
      -o | --output-dir) printf '%s\n' "${2:-}" && return ;;
      --output-dir=*) printf '%s\n' "${1#*=}" && return ;;
      -o?*) printf '%s\n' "${1#-o}" && return ;;
    esac
    shift
  done
}

main() {
  if [[ "${1:-}" == -h || "${1:-}" == --help ]]; then
    usage
    return
  fi
  local rawlog=""
  if [[ $# -gt 0 && "$1" != -* ]]; then
    rawlog="$1"
    shift
    # Before a build of minutes, not after it.
    [[ -e "$rawlog" ]] || fail "$rawlog: no such file"
  fi
  install_packages packages.apt
  [[ -n "$rawlog" ]] || rawlog="$(sample_rawlog)"

  configure release
  build release terrain-rawlog

  local options=("$@")
  if [[ $# == 0 ]]; then
    options=(-c "$project_folder/params/paper_outdoor.ini" --find-ground)
  fi
  local output
  output="$(chosen_output_folder "$@")"
  if [[ -z "$output" ]]; then
    local name
    name="$(basename "$rawlog")"
    output="$project_folder/out/${name%.*}"
    options+=(--output-dir "$output")
  fi
  mkdir -p "$(dirname "$output")"
  say "terrain-rawlog process $rawlog ${options[*]}"
  "$project_folder/build/release/bin/terrain-rawlog" process "$rawlog" "${options[@]}"

  say "Results are in $output; pictures:"
  find "$output" -name '*.png' | sort
}

main "$@"
