#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures the insertion of scans into an octree against OctoMap's own, on one core.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'TEXT'
usage: scripts/bench-octree.sh [--check] [ROUNDS]

Builds the benchmark and inserts the 40 scans of kitti_raw_0001, and a VLP-16 scan, with different
resolutions and ranges. This library and OctoMap take turns ROUNDS times (default 3), each in a
process of its own on one core. Prints medians of milliseconds of processor time, and ratios.
A round takes about twelve minutes, nearly all of it OctoMap's.

--check  compares the trees after every scan instead, of both KITTI sequences
TEXT
}

readonly settings=('0.2 -1 0' '0.2 -1 1' '0.1 20 0' '0.1 20 1' '0.1 -1 0' '0.1 -1 1')
vlp16="$(dpkg -L mrpt-common 2>/dev/null | grep '/test_velodyne_VLP16\.rawlog$' || true)"

# insert WHO SCANS COUNT RESOLUTION MAX_RANGE DISCRETIZE
insert() {
  taskset -c "$(($(nproc) > 1 ? 1 : 0))" "$project_folder/build/release/bin/octree_insertion" "$@" \
    2>/dev/null
}

# measure ROUNDS SCANS COUNT RESOLUTION MAX_RANGE DISCRETIZE
measure() {
  local rounds="$1" round who
  shift
  for ((round = 0; round < rounds; ++round)); do
    for who in octomap own; do
      insert "$who" "$@" | sed "s/^/$who /"
    done
  done | awk -v title="$(printf '%-22s %5s m %5s m  discretize %s' "$(basename "$1")" "$3" "$4" "$5")" '
    function median(name, scan, n, k, values) {
      n = count[name, scan]
      for (k = 1; k <= n; ++k) values[k] = time[name, scan, k]
      for (k = 2; k <= n; ++k)
        for (j = k; j > 1 && values[j - 1] > values[j]; --j) {
          t = values[j]; values[j] = values[j - 1]; values[j - 1] = t
        }
      return (values[int((n + 1) / 2)] + values[int(n / 2) + 1]) / 2
    }
    { time[$1, $2, ++count[$1, $2]] = $3; if ($2 > last) last = $2 }
    END {
      print title
      for (scan = 1; scan <= last; ++scan) {
        a = median("octomap", scan); b = median("own", scan); sum_a += a; sum_b += b
        if (scan == 1 || scan == 10 || scan == 40)
          printf "  scan %2d  %8.1f ms  %8.1f ms  %5.1f\n", scan, a, b, a / b
      }
      printf "  mean     %8.1f ms  %8.1f ms  %5.1f\n", sum_a / last, sum_b / last, sum_a / sum_b
    }'
}

check_all() {
  local setting sequence
  for setting in "${settings[@]}"; do
    for sequence in kitti_raw_0001 kitti_00; do
      # shellcheck disable=SC2086 # three words
      insert check "$sequence" 40 $setting >/dev/null || fail "$sequence, $setting: trees differ"
      say "$sequence, $setting: equal after every scan"
    done
  done
}

main() {
  case "${1:-}" in -h | --help) usage; return ;; esac
  install_packages packages.apt
  configure release
  build release octree_insertion
  if [[ "${1:-}" == --check ]]; then
    check_all
    return
  fi
  local rounds="${1:-3}" setting
  echo 'scans, resolution, range; OctoMap, this library, ratio'
  for setting in "${settings[@]}"; do
    # shellcheck disable=SC2086 # three words
    measure "$rounds" kitti_raw_0001 40 $setting
  done
  [[ -z "$vlp16" ]] || measure "$((10 * rounds))" "$vlp16" 1 0.1 -1 0
}

main "$@"
