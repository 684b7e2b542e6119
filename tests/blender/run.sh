#!/bin/sh
# Builds rigs in Blender, exports them as glTF, and compares their frames as the tool reads them with the vertices that Blender
# evaluates; then selects there what the tool has found in a scene of its own. BUILD is the build folder. Ends non-zero when they differ.
set -eu
cd "$(dirname "$0")"
: "${BUILD:?BUILD must name the build folder}"
case $BUILD in /*) ;; *) BUILD=../../$BUILD ;; esac

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
if ! blender --background --factory-startup --python-exit-code 1 --python rigs.py -- "$folder" >"$folder/log" 2>&1; then
    tail -20 "$folder/log"
    exit 1
fi
PYTHONDONTWRITEBYTECODE=1 python3 compare.py "$BUILD/tests/blender/print_frames" "$folder"
if ! PYTHONDONTWRITEBYTECODE=1 blender --background --factory-startup --python-exit-code 1 --python selection.py -- \
    "$(realpath "$BUILD/cscd")" "$folder" >"$folder/log" 2>&1; then
    tail -20 "$folder/log"
    exit 1
fi
grep '^selection:' "$folder/log"
