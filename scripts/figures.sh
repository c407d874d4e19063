#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the pictures of the documents.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

images="$project_folder/doc/images"

usage() {
  cat <<'TEXT'
usage: scripts/figures.sh [FOLDER]

Writes the pictures in doc/images: of the VLP-16 scan that Debian's mrpt-common brings along, of a
small made-up world, of two simulated ones in paper mode and field mode side by side, the plan of a
scene, and how many potholes are found over the distance. Builds terrain-rawlog, terrain-sim and
terrain-eval first, or uses those in FOLDER if it is given.
TEXT
}

sample_rawlog() {
  dpkg -L mrpt-common | grep '/test_velodyne_VLP16\.rawlog$' ||
    fail "mrpt-common has no test_velodyne_VLP16.rawlog"
}

# Flat ground of 5 m x 5 m with a point every 2 cm, and on it a ramp of 13.86 degrees, a box, a hole
# and an uneven shallow dent: one thing of each class.
made_up_world() {
  awk '
    function inside(x, y, x0, y0, size_x, size_y) {
      return x >= x0 && x < x0 + size_x && y >= y0 && y < y0 + size_y
    }
    function point(x, y, z) { line[n++] = sprintf("%.3f %.3f %.4f", x, y, z) }
    BEGIN {
      ramp = 13.86 / 180 * atan2(0, -1)
      for (i = -125; i < 125; ++i) for (j = -125; j < 125; ++j) {
        x = 0.02 * i + 0.01; y = 0.02 * j + 0.01
        if (inside(x, y, 0.9, 0.6, 1.2, 1.0)) point(x, y, (x - 0.9) * sin(ramp) / cos(ramp))
        else if (inside(x, y, 1.3, -1.1, 0.3, 0.3)) for (k = 1; k <= 15; ++k) point(x, y, 0.01 * k)
        else if (inside(x, y, -1.5, -1.4, 0.6, 0.6)) point(x, y, -0.09)
        else if (inside(x, y, -1.6, 0.9, 0.5, 0.5)) point(x, y, (i + j) % 2 ? -0.055 : -0.02)
        else point(x, y, 0)
      }
      printf "ply\nformat ascii 1.0\nelement vertex %d\n", n
      printf "property float x\nproperty float y\nproperty float z\nend_header\n"
      for (k = 0; k < n; ++k) print line[k]
    }'
}

# picture NAME INPUT OPTION...: describes INPUT and keeps the picture of its first scan as NAME.png.
picture() {
  local name="$1" input="$2"
  shift 2
  say "$name: $*"
  "$program" process "$input" "$@" --output-dir "$work/$name"
  cp "$work/$name/scan_000000.png" "$images/$name.png"
}

# classes_of NAME INPUT OPTION...: describes INPUT and cuts the classes of its first scan, with their
# legend, out of the picture: $work/NAME.png.
classes_of() {
  local name="$1" input="$2"
  shift 2
  say "$name: $*"
  "$program" process "$input" "$@" --output-dir "$work/$name"
  convert "$work/$name/scan_000000.png" -gravity NorthEast -crop 744x780+0+74 +repage "$work/$name.png"
}

# modes NAME FAMILY SEED: the first scan of a simulated world in paper mode, on the left, and in
# field mode, as NAME.png.
modes() {
  local name="$1" family="$2" seed="$3" map=(--set grid.length=36 --set grid.width=36)
  "$programs/terrain-sim" --family "$family" --family-seed "$seed" --sweeps 1 --no-truth \
    --output "$work/world.rawlog"
  local scan=("$work/world.rawlog" --poses "$work/world.tum")
  classes_of paper_mode "${scan[@]}" -c "$project_folder/params/paper_outdoor.ini" "${map[@]}"
  classes_of field_mode "${scan[@]}" -c "$project_folder/params/field.ini" "${map[@]}"
  convert "$work/paper_mode.png" "$work/field_mode.png" +append -strip -colors 256 \
    "PNG8:$images/$name.png"
}

# curve CSV METRIC: "number bin share count" for each bin of distance with at least ten potholes.
curve() {
  awk -F, -v metric="$2" '$1 == "pooled" && $2 == metric {
    if ($5 >= 10) print number + 0 "," $3 "," 100 * $4 "," $5
    ++number
  }' "$1" | sed 's/ m,/,/'
}

# detection NAME: shares of potholes that are found in a scan, by distance and by sensor, as NAME.png.
detection() {
  local name="$1" sensor
  for sensor in vlp16 hdl32e hdl64e; do
    say "$name: $sensor"
    "$programs/terrain-eval" worlds --families potholes --seeds 0:20 -j 2 --sensor "$sensor" \
      --sensor-z 0.81 -c "$project_folder/params/field.ini" --csv "$work/$sensor.csv" >/dev/null
    curve "$work/$sensor.csv" pothole_recall_due >"$work/$sensor.due"
    curve "$work/$sensor.csv" pothole_recall_right_size >"$work/$sensor.all"
  done
  gnuplot <<TEXT
set terminal pngcairo size 900,420
set output "$images/$name.png"
set datafile separator ","
set style data linespoints
set multiplot layout 1,2
set yrange [0:105]
set xrange [-0.5:8.5]
set grid
set key bottom left
set xtics rotate by -45
set xlabel "distance in m"
set ylabel "found in a single scan, %"
set title "all of 0.3 to 1 m width, 5 to 20 cm depth"
plot for [s in "vlp16 hdl32e hdl64e"] "$work/".s.".all" using 1:3:xtic(2) title s
set title "of these, those with 10 deep returns of 2 rings"
plot for [s in "vlp16 hdl32e hdl64e"] "$work/".s.".due" using 1:3:xtic(2) title s
unset multiplot
TEXT
}

main() {
  case "${1:-}" in -h | --help) usage; return ;; esac
  local programs="${1:-}"
  if [[ -z "$programs" ]]; then
    install_packages packages.apt
    configure release
    build release terrain-rawlog terrain-sim terrain-eval
    programs="$project_folder/build/release/bin"
  fi
  program="$programs/terrain-rawlog"
  work="$(mktemp -d)"
  trap 'rm -rf "$work"' EXIT
  mkdir -p "$images"
  local vlp16
  vlp16="$(sample_rawlog)"
  local outdoor="$project_folder/params/paper_outdoor.ini"
  local fine=(--set grid.length=24 --set grid.width=24 --set grid.cell_size=0.05)

  picture vlp16_60m "$vlp16" -c "$outdoor" --find-ground
  picture vlp16_24m "$vlp16" -c "$outdoor" --find-ground "${fine[@]}"
  made_up_world >"$work/made_up_world.ply"
  "$program" import "$work/made_up_world.ply" --output "$work/made_up_world.rawlog"
  picture made_up_world "$work/made_up_world.rawlog" -c "$project_folder/params/paper.ini"
  modes modes_hills_2 hills 2
  modes modes_mixed_4 mixed 4
  detection pothole_distance
  "$programs/terrain-sim" "$project_folder/params/scenes/drive.yaml" --preview "$images/drive_plan.png"
}

main "$@"
