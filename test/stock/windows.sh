# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
# Programs with windows on a display of their own; source it after scripts/common.sh.

# need PROGRAM...: ends with `skip_code` (default 1) if one of them is not installed.
need() {
  local program
  for program in "$@"; do
    command -v "$program" >/dev/null && continue
    printf 'Left out: %s is not installed (packages.apt, "Tests")\n' "$program"
    exit "${skip_code:-1}"
  done
}

# wait_until SECONDS COMMAND...: runs the command until it succeeds.
wait_until() {
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    ((SECONDS < end)) || fail "this took too long: $*"
    sleep 0.2
  done
}

# start_display FOLDER: a display with a window manager, its files and those of its programs in
# FOLDER. Ends with the script.
start_display() {
  local folder="$1"
  need Xvfb openbox xdotool wmctrl xclip import
  export HOME="$folder/home" XDG_RUNTIME_DIR="$folder/run"
  # Mesa draws by itself; nobody asks for a session bus.
  export LIBGL_ALWAYS_SOFTWARE=1 GSETTINGS_BACKEND=memory NO_AT_BRIDGE=1
  unset WAYLAND_DISPLAY
  # RawLogViewer's settings: no tip of the day.
  mkdir -p "$HOME/.RawLogViewer" "$XDG_RUNTIME_DIR"
  chmod 700 "$XDG_RUNTIME_DIR"
  printf '[tips]\nshow = false\n' >"$HOME/.RawLogViewer/config.cfg"
  window_processes=()
  trap stop_display EXIT
  # It looks for a free number by itself.
  Xvfb -displayfd 9 -screen 0 1280x1024x24 -nolisten tcp 9>"$folder/display" \
    >"$folder/xvfb.log" 2>&1 &
  window_processes+=($!)
  wait_until 60 test -s "$folder/display"
  DISPLAY=":$(<"$folder/display")"
  export DISPLAY
  openbox >"$folder/openbox.log" 2>&1 &
  window_processes+=($!)
  wait_until 60 wmctrl -m
}

stop_display() {
  local k
  for ((k = ${#window_processes[@]} - 1; k >= 0; --k)); do
    kill "${window_processes[k]}" 2>/dev/null || true
    wait "${window_processes[k]}" 2>/dev/null || true
  done
}

# start_program LOG COMMAND...: in the background, as the process `program`.
start_program() {
  local log="$1"
  shift
  "$@" </dev/null >"$log" 2>&1 &
  program=$!
  window_processes+=("$program")
}

has_window() { wmctrl -l 2>/dev/null | cut -d' ' -f5- | grep -q -- "$1"; }
has_no_window() { ! has_window "$1"; }
# A zombie has ended: nobody has asked for its exit code yet.
has_ended() { ! grep -q '^State:[[:space:]]*[^Z[:space:]]' "/proc/$program/status"; }

# wait_for_window TITLE: fails at once if the program ends.
wait_for_window() {
  local end=$((SECONDS + 90))
  until has_window "$1"; do
    ! has_ended 2>/dev/null || fail "the program has ended, and no window \"$1\" came"
    ((SECONDS < end)) || fail "no window \"$1\" came; there are: $(wmctrl -l)"
    sleep 0.2
  done
}

# window_number TITLE: of the newest window whose title contains it.
window_number() { wmctrl -l | grep -- "$1" | tail -n 1 | cut -d' ' -f1; }

activate() { wmctrl -i -a "$(window_number "$1")"; sleep 0.3; }

# close_window TITLE: as its user would; killing it would hide a crash at the end.
close_window() {
  wmctrl -i -c "$(window_number "$1")"
  wait_until 60 has_no_window "$1"
}

# end_of_program: waits for the end of `program`, which has to be a good one.
end_of_program() {
  local code=0
  wait_until 60 has_ended
  wait "$program" || code=$?
  [[ "$code" == 0 ]] || fail "the program ended with exit code $code"
}

# colours_of TITLE: how many there are in a window.
colours_of() { import -window "$(window_number "$1")" -format '%k' info:-; }

# shows_more_colours_than N TITLE
shows_more_colours_than() { (($(colours_of "$2") > $1)); }

# --- RawLogViewer ---------------------------------------------------------------------------------

viewer_window='RawlogViewer - Part'
map_dialog='Creation of "raw map'
preview_window='Raw-map 3D preview'

# open_map_dialog: from the menu "Tools". Keys are lost while the rawlog is being shown, so they are
# pressed until the dialog comes.
open_map_dialog() {
  local tries k
  wait_for_window "$viewer_window"
  for ((tries = 0; tries < 20; ++tries)); do
    wait_until 60 has_no_window 'Constructing the tree'
    activate "$viewer_window"
    xdotool key alt+t
    sleep 0.5
    xdotool key m
    for ((k = 0; k < 20; ++k)); do
      ! has_window "$map_dialog" || return 0
      sleep 0.2
    done
    xdotool key Escape
  done
  fail "RawLogViewer does not open its raw-map dialog"
}

# into_map_text: puts the cursor into the text that describes the map, to the right.
into_map_text() {
  activate "$map_dialog"
  xdotool mousemove --window "$(window_number "$map_dialog")" 900 150 click 1
}

# press_in_map_dialog N: the N-th button before the text: 1 "Close", 2 "Preview map in 3D", 6 "Save
# map as text", 9 "Map from odometry"; before a map is there, 4 is "Map from odometry".
press_in_map_dialog() {
  local keys=(ctrl+shift+Tab)
  local k
  for ((k = 1; k < $1; ++k)); do keys+=(shift+Tab); done
  into_map_text
  xdotool key "${keys[@]}" space
}

# The path of the robot is drawn at the end, in red.
shows_path() {
  import -window "$(window_number "$map_dialog")" -crop 1280x700+0+370 -depth 8 \
    -format '%c' histogram:info:- | grep -qi '#FF0000'
}

# generate_map INI: pastes the text of the file (typing would lose the line ends).
generate_map() {
  xclip -selection clipboard -i "$1" >/dev/null 2>&1
  into_map_text
  xdotool key ctrl+a ctrl+v
  press_in_map_dialog 4
  wait_until 90 shows_path
  wait_until 60 has_no_window 'Creating raw map'
}

preview_map() {
  press_in_map_dialog 2
  wait_for_window "$preview_window"
}

# save_map PREFIX LAST_FILE: and waits for the last of the files.
save_map() {
  press_in_map_dialog 6
  wait_for_window 'Save as text file'
  activate 'Save as text file'
  xdotool key ctrl+a
  xdotool type --delay 20 "$1"
  xdotool key Return
  wait_until 60 test -s "$2"
}

# close_viewer: the dialog first, as nothing else is listened to as long as it is open.
close_viewer() {
  press_in_map_dialog 1
  wait_until 60 has_no_window "$map_dialog"
  close_window "$preview_window"
  close_window "$viewer_window"
  end_of_program
}
