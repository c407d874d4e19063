#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures the description of a scan on one core and prints its cost as a multiple of the reference
# loop of bench/reference_loop.h.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'TEXT'
usage: scripts/bench.sh [REPETITIONS]

Builds the benchmarks, runs each REPETITIONS times (default 15, interleaved) on one core, and prints
medians and ratios. Uses a KITTI scan if there is one (see bench/scan_files.h).
TEXT
}

main() {
  case "${1:-}" in -h | --help) usage; return ;; esac
  local repetitions="${1:-15}"
  install_packages packages.apt
  configure release
  build release core_bench
  local report="$project_folder/build/release/core_bench.json"
  say "Measuring on core 1 of $(nproc)"
  taskset -c "$(($(nproc) > 1 ? 1 : 0))" "$project_folder/build/release/bin/core_bench" \
    --benchmark_repetitions="$repetitions" --benchmark_enable_random_interleaving=true \
    --benchmark_min_time=0.1 --benchmark_report_aggregates_only=true \
    --benchmark_out="$report" --benchmark_out_format=json >/dev/null 2>&1
  awk -F'[:,]' '
    /"run_name"/ { gsub(/[ "]/, "", $2); name = $2 }
    /"aggregate_name"/ { gsub(/[ "]/, "", $2); kind = $2 }
    /"cpu_time"/ && kind == "median" { time[name] = $2 + 0; order[++n] = name }
    /_us"/ && kind == "median" { gsub(/[ "]/, "", $1); stage[$1] = $2 + 0; names[++m] = $1 }
    /"allocations"/ && kind == "median" { allocations[name] = $2 + 0 }
    /"scan"/ { gsub(/^ *"|"$/, "", $2); scan = $2 }
    END {
      printf "scan: %s\n%-28s %9s %8s %12s\n", scan, "benchmark", "us", "ratio", "allocations"
      for (k = 1; k <= n; ++k)
        printf "%-28s %9.0f %8.2f %12s\n", order[k], time[order[k]],
          time[order[k]] / time["reference"], allocations[order[k]]
      print "stages of description_by_stage, us:"
      for (k = 1; k <= m; ++k) printf "  %-26s %9.0f\n", names[k], stage[names[k]]
    }' "$report"
}

main "$@"
