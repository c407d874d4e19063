#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Drives a long way through a simulated road into one terrain map, and judges time and memory.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'TEXT'
usage: scripts/soak.sh [METRES]

Builds the tests of the map and drives METRES (default 2000) along a simulated road, a scan of 32
beams per metre, into a rolling map with its OctoMap, then a quarter as far into a growing one.
Prints milliseconds of processor time per scan, resident memory, nodes of the OctoMap and area of the
fused grid, a line per tenth of the way. Fails if
  - a scan of the last tenth takes more than 1.2 times as long as one of the first (medians),
  - the memory of the second half is more than 1.1 times that at 15 % of the way,
  - nodes or cells grow with the way,
  - a growing map takes more memory per square metre in the second half than in the first.
TEXT
}

main() {
  case "${1:-}" in -h | --help) usage; return ;; esac
  install_packages packages.apt
  configure release
  build release map_test
  TERRAIN_SOAK_METRES="${1:-2000}" "$project_folder/build/release/bin/map_test" \
    --gtest_filter='Soak.*'
}

main "$@"
