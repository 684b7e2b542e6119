#!/bin/sh
# Moves soft bodies of Bullet with cscd behind it, and judges every frame. BUILD is the build folder; arguments are those of the program.
# PAGE=--write draws the pictures of docs/solver/in-your-engine.md instead. Ends non-zero where something touches, or freezes.
set -eu
: "${BUILD:?BUILD must name the build folder}"
program=$BUILD/tests/engine/soft_bodies
if [ "${PAGE:-}" != --write ]; then
    "$program" "$@"
    exit
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for driver in none make_safe; do
    "$program" --scene sleeve --driver "$driver" --record "$folder"
    "$BUILD/cscd" render "$folder/sleeve-$driver.obj" "$folder/sleeve-$driver.pc2" --up z --frames 90:240:75 --columns 3 \
        --size 180x240 --view 20,12 -o "docs/images/engine-$(echo "$driver" | tr _ -).png"
done
