#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Lists the potholes that field mode reports in a rawlog, with a picture of each, to be looked at.
# shellcheck source-path=SCRIPTDIR
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

usage() {
  cat <<'TEXT'
usage: scripts/potholes.sh RAWLOG OUTPUT_FOLDER [PROGRAMS]

Describes all scans of RAWLOG in field mode and writes OUTPUT_FOLDER/potholes.csv, a line per pothole
(scan, place, size and depth in metres, points), a picture of each, scan_NNNNNN_K.png, and all
pictures on one sheet, sheet.png. A picture has the points within 3 m from above, coloured by height,
those of the pothole in black, and a cut of 0.8 m width along the line from the robot.
Builds terrain-rawlog first, or uses that in the folder PROGRAMS.
TEXT
}

# potholes_of CLUSTERS.CSV: "scan cluster x y length width depth points" of each pothole.
potholes_of() {
  awk -F, 'NR > 1 && $4 == "pothole" {
    a = $9 - $7; b = $10 - $8
    length_m = (a > b) ? a : b; width_m = (a > b) ? b : a
    printf("%d %d %.2f %.2f %.2f %.2f %.3f %d\n", $1, $3, $5, $6, length_m, width_m, $13, $12)
  }' "$1"
}

# draw PLY PNG CLUSTER X Y TITLE
draw() {
  local ply="$1" skip
  skip="$(grep --only-matching --byte-offset --text --max-count=1 'end_header' "$ply" | head -n 1)"
  skip="$((${skip%%:*} + 11))"
  gnuplot <<TEXT
set terminal pngcairo size 900,460
set output "$2"
points = 'binary skip=$skip endian=little format="%float%float%float%uchar%uchar%int%3uchar"'
file = "$ply"
x0 = $4; y0 = $5; range = sqrt(x0 * x0 + y0 * y0)
along(x, y) = (x * x0 + y * y0) / range - range
across(x, y) = (y * x0 - x * y0) / range
near(x, y) = abs(x - x0) < 3 && abs(y - y0) < 3
cut(x, y) = abs(across(x, y)) < 0.4 && abs(along(x, y)) < 3
stats file @points using (near(\$1, \$2) && \$4 == 1 ? \$3 : NaN) name "Z" nooutput
set multiplot layout 1,2 title "$6"
set palette defined (0 "#0000c0", 1 "#30a030", 2 "#e0a000", 3 "#d00000")
set cbrange [Z_median - 0.2:Z_median + 0.2]
set cblabel "z in m"
set size ratio -1
set xrange [y0 + 3:y0 - 3]
set yrange [x0 - 3:x0 + 3]
set xlabel "y in m"
set ylabel "x in m"
set key off
plot file @points using (near(\$1, \$2) ? \$2 : NaN):1:3 with points pt 7 ps 0.3 lc palette, \
     file @points using (\$6 == $3 && near(\$1, \$2) ? \$2 : NaN):1 with points pt 6 ps 0.6 lc "black"
set size noratio
set xrange [-3:3]
set yrange [Z_median - 0.4:Z_median + 0.6]
set xlabel "from the middle, away from the robot, in m"
set ylabel "z in m"
plot file @points using (cut(\$1, \$2) ? along(\$1, \$2) : NaN):3 with points pt 7 ps 0.3 lc "#3070c0", \
     file @points using (\$6 == $3 && cut(\$1, \$2) ? along(\$1, \$2) : NaN):3 with points pt 6 ps 0.6 lc "black"
unset multiplot
TEXT
}

main() {
  case "${1:-}" in -h | --help | "") usage; return ;; esac
  local rawlog="$1" output="$2" programs="${3:-}"
  if [[ -z "$programs" ]]; then
    install_packages packages.apt
    configure release
    build release terrain-rawlog
    programs="$project_folder/build/release/bin"
  fi
  mkdir -p "$output"
  "$programs/terrain-rawlog" process "$rawlog" -c "$project_folder/params/field.ini" --every 1 \
    --quiet --output-dir "$output/described"
  echo "scan,x,y,length,width,depth,points" >"$output/potholes.csv"
  local scan cluster x y length width depth points name count=0
  while read -r scan cluster x y length width depth points; do
    echo "$scan,$x,$y,$length,$width,$depth,$points" >>"$output/potholes.csv"
    name="$(printf 'scan_%06d' "$scan")"
    draw "$output/described/$name.ply" "$output/${name}_$cluster.png" "$cluster" "$x" "$y" \
      "scan $scan: $length m x $width m, $depth m deep"
    count=$((count + 1))
  done < <(potholes_of "$output/described/clusters.csv")
  if ((count > 0)); then
    montage "$output"/scan_*.png -tile 3x -geometry 600x307+2+2 "$output/sheet.png"
  fi
  say "$count potholes in $output/potholes.csv"
}

main "$@"
