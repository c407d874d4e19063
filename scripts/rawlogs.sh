#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the rawlogs of rawlogs/ again.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'TEXT'
usage: scripts/rawlogs.sh [--check] [--program FILE]

Makes all rawlogs of rawlogs/manifest.txt and their truth with terrain-sim, writes them to rawlogs/
and their sha256 into the manifest. With --check it makes them in a temporary folder, compares with the
manifest, and changes nothing. --program names a terrain-sim; without it, one is built.
TEXT
}

manifest="$project_folder/rawlogs/manifest.txt"

# make_all PROGRAM FOLDER: runs every command of the manifest; outputs go to FOLDER.
make_all() {
  local program="$1" folder="$2" line arguments
  while read -r line; do
    read -r -a arguments <<<"${line#\# make: }"
    arguments[0]="$project_folder/${arguments[0]}"
    (cd "$folder" && "$program" --quiet "${arguments[@]}")
  done < <(grep '^# make: ' "$manifest")
}

# sums_of FOLDER: sha256 of all files there, in the order of their names.
sums_of() {
  (cd "$1" && find . -type f ! -name manifest.txt ! -name README.md -printf '%P\0' |
    LC_ALL=C sort --zero-terminated | xargs --null sha256sum)
}

# temporary_folder NAME: makes a folder that goes when the script ends; the variable NAME has its path.
temporary_folder() {
  local -n path="$1"
  path="$(mktemp --directory)"
  # shellcheck disable=SC2064  # the folder of now
  trap "rm -rf '$path'" EXIT
}

check() {
  local program="$1" folder
  temporary_folder folder
  make_all "$program" "$folder"
  if ! diff <(grep -v '^#' "$manifest") <(sums_of "$folder"); then
    fail "the rawlogs (<) and what terrain-sim makes now (>) differ"
  fi
  diff <(grep -v '^#' "$manifest") <(sums_of "$project_folder/rawlogs") ||
    fail "rawlogs/manifest.txt (<) and the files beside it (>) differ"
  say "All rawlogs come out as they are"
}

remake() {
  local program="$1" folder="$project_folder/rawlogs" made commands sums
  temporary_folder made
  make_all "$program" "$made"
  find "$folder" -mindepth 1 ! -name manifest.txt ! -name README.md -delete
  cp -r "$made/." "$folder"
  commands="$(grep '^#' "$manifest")"
  sums="$(sums_of "$folder")"
  printf '%s\n' "$commands" "$sums" >"$manifest"
  du -sh "$folder"
}

main() {
  local program="" action=remake
  while [[ $# != 0 ]]; do
    case "$1" in
      --check) action=check ;;
      --program) program="${2:?--program needs a file}"; shift ;;
      -h | --help) usage; return ;;
      *) usage >&2; fail "unknown option $1" ;;
    esac
    shift
  done
  if [[ -z "$program" ]]; then
    install_packages packages.apt
    configure release
    build release terrain-sim
    program="$project_folder/build/release/bin/terrain-sim"
  fi
  program="$(realpath --canonicalize-existing "$program")"
  "$action" "$program"
}

main "$@"
