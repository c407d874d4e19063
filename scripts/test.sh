#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds everything and runs all tests.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'TEXT'
usage: scripts/test.sh [--sanitizers]

Installs the missing Debian packages of packages.apt, then builds and tests: the core library alone,
with --sanitizers (or SANITIZERS=1) everything under the address and undefined-behaviour sanitizers,
and at last everything optimised. Warnings are errors. Ends with CTest's summary.
TEXT
}

# test_preset PRESET: configures, builds and tests build/PRESET.
test_preset() {
  local preset="$1"
  configure "$preset" -DMRPT_TERRAIN_WERROR=ON
  build "$preset"
  say "Testing build/$preset"
  ctest --test-dir "$project_folder/build/$preset" --output-on-failure --no-tests=error \
    --parallel "$(nproc)"
}

main() {
  local sanitizers="${SANITIZERS:-}"
  case "${1:-}" in
    "") ;;
    --sanitizers) sanitizers=1 ;;
    -h | --help) usage; return ;;
    *) usage >&2; fail "unknown option $1" ;;
  esac
  install_packages
  test_preset core-only
  [[ -z "$sanitizers" || "$sanitizers" == 0 ]] || test_preset asan
  test_preset ci
}

main "$@"
