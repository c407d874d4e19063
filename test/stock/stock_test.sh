#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Starts one of MRPT's programs with the plug-in; CMakeLists.txt beside it has the calls.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/../../scripts/common.sh"
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/windows.sh"

rawlog="$project_folder/rawlogs/tunnel.rawlog"  # four turns of a VLP-16 as packets, with odometry
inis="$project_folder/params/mrpt"
skip_code=77

usage() {
  cat <<'TEXT'
usage: stock_test.sh PROGRAM LIBRARY INPUTS FOLDER

Starts PROGRAM with the plug-in LIBRARY. INPUTS is the program stock_inputs; FOLDER is emptied, and
what the programs write goes there.
TEXT
}

# run LOG COMMAND...: must end by itself with exit code 0. Nothing can be typed: many of MRPT's
# programs wait for a key after a mistake.
run() {
  local log="$1"
  shift
  local code=0
  "$@" </dev/null >"$log" 2>&1 || code=$?
  [[ "$code" == 0 ]] && return
  tail -n 40 "$log"
  fail "exit code $code of: $*"
}

# contains FILE TEXT
contains() {
  grep -a -q -- "$2" "$1" || { tail -n 40 "$1"; fail "no \"$2\" in $1"; }
}
lacks() {
  ! grep -a -q -- "$2" "$1" || { tail -n 40 "$1"; fail "\"$2\" in $1"; }
}

# check_map PREFIX: the files of a terrain map that holds something.
check_map() {
  local ending
  for ending in .3Dscene .ot .bt _classes.png _cost.png _clusters.csv _cost.pgm _cost.yaml; do
    [[ -s "$1$ending" ]] || fail "$1$ending was not written"
  done
  contains "$1_clusters.csv" ',obstacle,'
}

# make_map: with icp-slam, once, into the folder `slam`; `map` is the prefix of its terrain map.
make_map() {
  need icp-slam
  run icp-slam.log env LD_PRELOAD="$library" icp-slam "$inis/icp-slam.ini" "$rawlog"
  map="$PWD/log_icp_slam/_finalmaps_.txt_mrpt_terrain__CTerrainMap_01"
}

# The sections of the terrain map are the same in all files, but for the program's prefix.
check_inis() {
  local ini section
  local sections='/^\[.*_terrainMap_/,/^$/p'
  for ini in "$@"; do
    section="$(sed -n "$sections" "$inis/$ini.ini" | sed -e 's/^\[MappingApplication_/[map_/' \
      -e '/^fusion /d' -e '/^$/d')"
    [[ "$section" == "$(sed -n "$sections" "$inis/terrain_map.ini" | sed '/^$/d')" ]] ||
      fail "params/mrpt/$ini.ini and terrain_map.ini differ"
  done
}

# --- Without a window -----------------------------------------------------------------------------

# A rawlog with a terrain map in it can be read to its end with the plug-in, and only with it.
test_rawlog-edit() {
  need rawlog-edit
  run inputs.log "$inputs" "$rawlog" "$PWD"
  run with.log rawlog-edit -p "$library" -i with_map.rawlog --info
  contains with.log 'All sensor labels  *: lidar, odometry'
  lacks with.log xception
  rawlog-edit -i with_map.rawlog --info </dev/null >without.log 2>&1 || true
  contains without.log CTerrainMap
  lacks without.log 'All sensor labels  *: lidar'
}

is_mapped() { grep -q "$library" "/proc/$program/maps"; }
records() { compgen -G 'grabbed_*.rawlog'; }

# It records nothing, as there is no sensor, but must load the plug-in and end well at a key.
test_rawlog-grabber() {
  need rawlog-grabber
  mkfifo keys
  rawlog-grabber -p "$library" "$inis/rawlog-grabber.ini" <keys >grabber.log 2>&1 &
  program=$!
  exec 8>keys
  wait_until 60 is_mapped
  wait_until 60 records
  echo >&8
  end_of_program
  lacks grabber.log 'thread signal'
}

test_observations2map() {
  need observations2map
  check_inis observations2map
  make_map
  local simplemap=log_icp_slam/_finalmap_.simplemap
  run observations2map.log env LD_PRELOAD="$library" \
    observations2map "$inis/observations2map.ini" "$simplemap" out
  check_map out_mrpt_terrain__CTerrainMap_00
  # A mistake in the file is named, and nothing is written.
  sed 's/^cell_size/cel_size/' "$inis/observations2map.ini" >wrong.ini
  ! env LD_PRELOAD="$library" observations2map wrong.ini "$simplemap" wrong \
    </dev/null >wrong.log 2>&1 || fail "a wrong key was accepted"
  contains wrong.log cel_size
  ! compgen -G 'wrong_*' >/dev/null || fail "files were written in spite of a wrong key"
}

test_icp-slam() {
  check_inis icp-slam
  make_map
  check_map "$map"
  # Four turns along a straight way of 6.2 m.
  [[ "$(grep -a -c 'Fit:' icp-slam.log)" == 3 ]] || fail "three scans were to be matched"
  awk 'END { exit !($2 > 5.9 && $2 < 6.4 && $3 > -0.2 && $3 < 0.2) }' \
    log_icp_slam/log_estimated_path.txt || fail "the path ends in a wrong place"
}

test_rbpf-slam() {
  need rbpf-slam
  check_inis rbpf-slam
  run inputs.log "$inputs" "$rawlog" "$PWD"
  run rbpf-slam.log env LD_PRELOAD="$library" rbpf-slam "$inis/rbpf-slam.ini" pairs.rawlog
  lacks rbpf-slam.log xception
  check_map "$(compgen -G 'log_rbpf_slam/finalMap*CTerrainMap_00.3Dscene' | sed 's/\.3Dscene$//')"
}

# --- With a window --------------------------------------------------------------------------------

test_SceneViewer3D() {
  need SceneViewer3D
  make_map
  start_display "$PWD"
  start_program viewer.log SceneViewer3D "$map.3Dscene"
  wait_for_window 'SceneViewer3D.*CTerrainMap_01.3Dscene'
  # Toolbar and background have some; a drawn map has many more.
  wait_until 60 shows_more_colours_than 300 SceneViewer3D
  close_window SceneViewer3D
  end_of_program
  lacks viewer.log xception
}

# Only what octovis says about the file is looked at: Debian's octovis 1.9.7 draws nothing with Mesa's
# software drawing, and sooner or later crashes there, with or without a file.
test_octovis() {
  need octovis
  make_map
  start_display "$PWD"
  start_program octovis.log octovis "$map.bt" 16
  wait_until 60 grep -q 'Reading binary octree type OcTree' octovis.log
  lacks octovis.log 'ERROR'
}

test_RawLogViewer() {
  need RawLogViewer
  check_inis rawlogviewer
  local prefix="$PWD/viewer_mrpt_terrain__CTerrainMap_01"
  start_display "$PWD"
  start_program viewer.log RawLogViewer -l "$library" "$rawlog"
  open_map_dialog
  generate_map "$inis/rawlogviewer.ini"
  preview_map
  wait_until 60 shows_more_colours_than 20 "$preview_window"
  save_map "$PWD/viewer" "${prefix}_cost.png"
  check_map "$prefix"
  close_viewer
}

main() {
  if [[ $# != 4 ]]; then
    usage >&2
    exit 2
  fi
  local name="$1"
  library="$(realpath "$2")"
  inputs="$(realpath "$3")"
  rm -rf "$4"
  mkdir -p "$4"
  cd "$4"
  declare -F "test_$name" >/dev/null || fail "no test of $name"
  "test_$name"
  say "$name: passed in $SECONDS s"
}

main "$@"
