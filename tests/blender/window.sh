#!/bin/sh
# The extension in a window of Blender on a display of its own: checks the doll, stops a check with Esc, goes to an event, colours
# faces, and writes the picture of the panel to $1, if that is given. BUILD and PYTHON_PACKAGE are those of run.sh.
set -eu
picture=${1:+$(realpath "$1")}
cd "$(dirname "$0")"
case ${PYTHON_PACKAGE:?PYTHON_PACKAGE must name the folder of the package} in
/*) PYTHONPATH=$PYTHON_PACKAGE ;;
*) PYTHONPATH=$(realpath "../../$PYTHON_PACKAGE") ;;
esac
export PYTHONPATH PYTHONDONTWRITEBYTECODE=1 LIBGL_ALWAYS_SOFTWARE=1

folder=$(mktemp -d)
for number in 90 91 92 93 94 95 96 97 98 99; do
    [ -e /tmp/.X$number-lock ] || break
done
Xvfb :$number -screen 0 1500x950x24 >/dev/null 2>&1 &
server=$!
export DISPLAY=:$number
trap 'kill $viewer $server 2>/dev/null; rm -rf "$folder"' EXIT
viewer=$server

wait_for() { # wait_for WORDS SECONDS: until the state has the words
    tries=$(($2 * 5))
    until grep -q "$1" "$folder/state.json" 2>/dev/null; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || {
            echo "window: waited $2 s for $1: $(cat "$folder/state.json" 2>/dev/null)"
            exit 1
        }
        sleep 0.2
    done
}
click() { xdotool mousemove "$1" "$2" sleep 0.3 click 1 sleep 0.5; }

blender --background --factory-startup --python doll.py -- "$folder/doll.blend" >"$folder/log" 2>&1
blender --factory-startup -p 0 0 1500 950 "$folder/doll.blend" --python-use-system-env --python window.py -- "$folder/state.json" \
    >"$folder/log" 2>&1 &
viewer=$!
wait_for '"running": false' 60
sleep 2
# A window that is still being drawn loses clicks.
for try in 1 2 3 4 5 6; do
    click 1226 242 # our tab; Blender 3.4 cannot choose one by script
    click 1120 222 # Check
    sleep 1
    ! grep -q '"running": true' "$folder/state.json" || break
    sleep 3
done
wait_for '"running": true.*"view": "CAMERA"' 20
wait_for '"frame": [3-9]' 60
xdotool key Escape
wait_for '"running": false, "events": 0, "frame": 1,' 20
click 1120 222
wait_for '"running": false, "events": 5, "frame": 1,' 240
sleep 3        # until the list is drawn
click 1070 406 # the second event,
wait_for '"frame": 16' 20
click 1070 385 # and the first
wait_for '"frame": 12, "view": "PERSP", "selected": \["Body"\]' 20
click 1113 593 # Colours
sleep 2
touch "$folder/page-wanted"
tries=600
until [ -s "$folder/page.html" ]; do
    tries=$((tries - 1))
    [ $tries -gt 0 ] || { echo 'window: waited 120 s for the page'; tail -5 "$folder/log"; exit 1; }
    sleep 0.2
done
wait_for '"frame": 12,' 5
[ -z "$picture" ] || import -window root -crop 1240x880+0+0 +repage -resize 1000x -colors 200 "PNG8:$picture"
echo 'window: a check by a click, Esc, going to events and a page work'
