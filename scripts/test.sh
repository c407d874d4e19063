#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds everything and runs all tests.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'TEXT'
usage: scripts/test.sh [--sanitizers] [--paper]

Installs the missing Debian packages of packages.apt, then builds and tests: the core library alone,
with --sanitizers (or SANITIZERS=1) everything under the address and undefined-behaviour sanitizers
and what uses threads under the thread sanitizer, and at last everything optimised. Warnings are errors. Ends with CTest's summary.

With --paper the packages of packages-paper.apt are installed too, so that the estimators of PCL are
built and tested; without them that part is left out, and CMake says so.
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

# What runs in several threads, under the thread sanitizer; builds nothing else.
test_threads() {
  configure tsan -DMRPT_TERRAIN_WERROR=ON
  build tsan threads_test
  say "Testing build/tsan"
  ctest --test-dir "$project_folder/build/tsan" --output-on-failure --no-tests=error -R '^threads\.'
}

main() {
  local sanitizers="${SANITIZERS:-}"
  local lists=(packages.apt)
  while [[ $# != 0 ]]; do
    case "$1" in
      --sanitizers) sanitizers=1 ;;
      --paper) lists+=(packages-paper.apt) ;;
      -h | --help) usage; return ;;
      *) usage >&2; fail "unknown option $1" ;;
    esac
    shift
  done
  install_packages "${lists[@]}"
  test_preset core-only
  if [[ -n "$sanitizers" && "$sanitizers" != 0 ]]; then
    test_preset asan
    test_threads
  fi
  test_preset ci
}

main "$@"
