#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Repeats the experiments of Meng, Cao et al. 2018 and compares slope estimators.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'TEXT'
usage: scripts/paper.sh [--long] [OPTION...]

Installs the missing Debian packages of packages.apt and packages-paper.apt, builds terrain-paper and
runs it: 50 scans per scene and condition, tables on the screen, tables, figures and one HTML page in
out/paper. Takes some minutes. OPTION... is handed to terrain-paper (see its --help).

--long takes 2000 scans (LMEDS, which is slow, sees 200 of them), for intervals that tell the
estimators apart: about a quarter of an hour on two cores.
TEXT
}

main() {
  local options=(--output-dir "$project_folder/out/paper")
  case "${1:-}" in
    -h | --help) usage; return ;;
    --long) shift; options+=(--trials 2000 --lmeds-trials 200) ;;
  esac
  install_packages packages.apt packages-paper.apt
  configure release
  build release terrain-paper
  "$project_folder/build/release/bin/terrain-paper" "${options[@]}" "$@"
}

main "$@"
