#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Asks in how many simulated worlds the likelihood of a scan is greatest near its true pose.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'TEXT'
usage: scripts/likelihood.sh [SEEDS [FIRST]]

Builds the tests of the map. In SEEDS worlds (default 5, those of the seeds from FIRST on, default 0)
of each family in params/families, a robot maps the first 4 m of its path, and a scan from farther on
is compared with the map at poses up to
0.5 m and 10 degrees from the true one. Prints where the likelihood was greatest, and how often that
was within 0.1 m and 1 degree of the truth. Fails if that is less than 95 % of the worlds whose
surfaces fix a pose in maps of several scans, or less than 85 % in maps of one; libs/map/README.md
says which worlds those are.
TEXT
}

main() {
  case "${1:-}" in -h | --help) usage; return ;; esac
  install_packages packages.apt
  configure release
  build release map_test
  TERRAIN_LIKELIHOOD_SEEDS="${1:-5}" TERRAIN_LIKELIHOOD_FIRST="${2:-0}" \
    "$project_folder/build/release/bin/map_test" \
    --gtest_filter='LikelihoodWorlds.*'
}

main "$@"
