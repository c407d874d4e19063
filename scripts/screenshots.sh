#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the pictures of MRPT's programs in doc/mrpt-programs.md.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/../test/stock/windows.sh"

images="$project_folder/doc/images"
inis="$project_folder/params/mrpt"

usage() {
  cat <<'TEXT'
usage: scripts/screenshots.sh [FOLDER]

Starts MRPT's programs with the plug-in on a display of their own and takes the pictures in
doc/images/mrpt_*.png. Builds the plug-in, stock_inputs and terrain-sim first, or uses the build folder FOLDER.
TEXT
}

# picture NAME TITLE [CROP]: of a window, with few colours so that the file stays small.
picture() {
  import -window "$(window_number "$2")" ${3:+-crop "$3"} +repage -colors 64 \
    "PNG8:$images/mrpt_$1.png"
  say "mrpt_$1.png: $(stat --format=%s "$images/mrpt_$1.png") bytes"
}

# place TITLE WIDTH HEIGHT: at the upper left corner of the screen.
place() {
  wmctrl -i -r "$(window_number "$1")" -b remove,maximized_vert,maximized_horz
  wmctrl -i -r "$(window_number "$1")" -e "0,0,0,$2,$3"
  sleep 2
}

# farther TITLE TURNS: turns the mouse wheel over a window.
farther() {
  xdotool mousemove --window "$(window_number "$1")" 500 300 \
    click --repeat "$2" --delay 300 5
  sleep 2
}

# show_scene NAME FILE: in SceneViewer3D.
show_scene() {
  start_program "$work/$1.log" SceneViewer3D "$2"
  wait_for_window SceneViewer3D
  place SceneViewer3D 900 640
  farther SceneViewer3D 8
  wait_until 60 shows_more_colours_than 300 SceneViewer3D
  picture "$1" SceneViewer3D
  close_window SceneViewer3D
  end_of_program
}

picture_slam() {
  LD_PRELOAD="$library" icp-slam "$inis/icp-slam.ini" "$work/sparse.rawlog" </dev/null >slam.log 2>&1
  show_scene icp-slam "log_icp_slam/_finalmaps_.txt_mrpt_terrain__CTerrainMap_01.3Dscene"
}

picture_observations2map() {
  sed 's/^colouring = height/colouring = class/' "$inis/observations2map.ini" >classes.ini
  LD_PRELOAD="$library" observations2map classes.ini log_icp_slam/_finalmap_.simplemap out \
    </dev/null >map.log 2>&1
  show_scene observations2map out_mrpt_terrain__CTerrainMap_00.3Dscene
}

picture_rbpf() {
  "$folder/bin/stock_inputs" sparse.rawlog .
  LD_PRELOAD="$library" rbpf-slam "$inis/rbpf-slam.ini" pairs.rawlog </dev/null >rbpf.log 2>&1
  show_scene rbpf-slam log_rbpf_slam/3D/buildingmap_00007.3Dscene
}

picture_viewer() {
  start_program viewer.log RawLogViewer -l "$library" "$work/drive.rawlog"
  open_map_dialog
  generate_map "$inis/rawlogviewer.ini"
  place "$map_dialog" 1000 760
  picture rawlogviewer_dialog "$map_dialog"
  preview_map
  place "$preview_window" 800 560
  activate "$preview_window"
  farther "$preview_window" 4
  wait_until 60 shows_more_colours_than 20 "$preview_window"
  picture rawlogviewer_preview "$preview_window"
  close_viewer
}

main() {
  case "${1:-}" in -h | --help) usage; return ;; esac
  local folder="${1:-}"
  if [[ -z "$folder" ]]; then
    install_packages packages.apt
    configure release
    build release mrpt_terrain_map stock_inputs terrain-sim
    folder="$project_folder/build/release"
  fi
  folder="$(realpath "$folder")"
  need icp-slam observations2map rbpf-slam RawLogViewer SceneViewer3D
  library="$folder/lib/libmrpt_terrain_map.so"
  work="$(mktemp -d)"
  cd "$work"
  local drive=("$project_folder/params/scenes/drive.yaml" --packets --no-truth)
  "$folder/bin/terrain-sim" "${drive[@]}" --every 0.5 -o drive.rawlog
  # The matching of icp-slam wants few rings on the ground and long steps.
  "$folder/bin/terrain-sim" "${drive[@]}" --sensor vlp16 --every 2.5 -o sparse.rawlog
  start_display "$work"
  picture_slam
  picture_observations2map
  picture_rbpf
  picture_viewer
  cd "$project_folder"
  stop_display
  rm -rf "$work"
}

main "$@"
