#!/bin/sh
# Makes every shape at its default size and every recording; `make models` calls it. usage: make.sh FOLDER
set -eu
: "${BUILD:?BUILD must name the build folder}"
folder=$1
mkdir -p "$folder"
for name in $("$BUILD/models/shape" --help | awk '$2 ~ /^[0-9]+$/ && $3 ~ /^[0-9]+$/ {print $1}'); do
    "$BUILD/models/shape" "$name" "$folder/$name.obj"
done
"$BUILD/models/record" all "$folder"
"$BUILD/models/cloth" all "$folder"
"$BUILD/models/ipc" all "$folder"
"$BUILD/models/objects" all "$folder"
"$BUILD/models/mannequin" "$folder" cache skin
"$BUILD/models/folds" "$folder"
"$BUILD/models/capsule_bend" "$folder/capsule-bend.obj" "$folder/capsule-bend.pc2"
