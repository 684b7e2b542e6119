#!/bin/sh
# Draws the pictures of README and docs/about/models.md; `make gallery` calls it. usage: gallery.sh MODELS IMAGES
set -eu
: "${BUILD:?BUILD must name the build folder}"
models=$1
images=$2
tool=$BUILD/cscd
mkdir -p "$images"

strip() { # strip NAME VIEW COLUMNS FRAMES [OPTIONS]: contacts on the body, with what it falls onto
    scenery=$models/$1-scenery
    moving=
    [ ! -e "$scenery.pc2" ] || moving="--scenery-frames $scenery.pc2"
    # shellcheck disable=SC2086
    "$tool" render "$models/$1.obj" "$models/$1.pc2" --up z --frames "$4" --columns "$3" --colour contacts --size 300x225 \
        --view "$2" --scenery "$scenery.obj" $moving ${5:-} -o "$images/$1.png"
}

for name in pawn dumbbell figure hand octopus torus; do
    "$tool" preprocess "$models/$name.obj" -o "$models/$name.plan.ply" --quiet
    for colour in charge region; do
        "$tool" render "$models/$name.obj" --up z --colour "$colour" --view 30,12 --size 640x480 -o "$images/$name-$colour.png"
    done
done
for motion in '' "$models/capsule-bend.pc2"; do
    plan=$models/capsule-bend.${motion:+motion.}plan.ply
    # shellcheck disable=SC2086
    "$tool" preprocess "$models/capsule-bend.obj" $motion -o "$plan" --quiet
    "$tool" render "$models/capsule-bend.obj" "$models/capsule-bend.pc2" --up y --frames 0:57:19 --columns 4 --colour region \
        --plan "$plan" --view 0,10 --size 300x225 -o "$images/capsule-bend-${motion:+motion-}region.png"
done
for name in torus genus2 coil slab chain; do
    "$tool" render "$models/$name.obj" --up z --wire --view 30,30 --size 360x300 -o "$images/$name.png"
done
strip pawn-drop 20,12 4 0:143:13
strip pawn-drop-free 20,12 4 0:140:20
strip dumbbell-stairs 25,14 4 0:143:13
strip dumbbell-stairs-free 25,14 4 0:140:20
strip figure-balls 25,14 4 12:144:12
strip figure-balls-free 25,14 4 12:138:18
strip cloth-drape 20,20 4 0:319:29
strip sleeve 20,12 4 0:239:21
strip bag 20,15 4 0:259:23 '--weld exact'
"$tool" render "$models/pawn-drop.obj" "$models/pawn-drop.pc2" --up z --frame 84 --colour contacts --view 0,10 --size 900x560 \
    --scenery "$models/pawn-drop-scenery.obj" -o "$images/pawn-contacts.png"
whole() { # whole NAME VIEW FRAMES [OPTIONS]: obstacles are part of the model
    # shellcheck disable=SC2086
    "$tool" render "$models/$1.obj" "$models/$1.pc2" --up z --frames "$3" --columns 4 --size 300x225 --view "$2" ${4:-} \
        -o "$images/$1.png"
}
whole rings 0,10 0:165:15
whole press 20,10 0:165:15
whole t-pair 25,15 0:110:10 '--colour contacts'
whole mixed 5,10 0:110:10 '--colour contacts'
"$tool" render "$models/mannequin.obj" "$models/mannequin.pc2" --frames 0:44:4 --columns 6 --size 180x300 --view 25,8 --up y \
    -o "$images/mannequin.png"
"$tool" render "$models/folds.obj" "$models/folds.pc2" --frames 0:50:50 --columns 2 --size 480x420 --view 30,20 --up z \
    -o "$images/folds.png"
strip tumble 25,25 4 0:143:13
# Cells, particles and where they have been.
"$tool" sense "$models/t-pair.obj" "$models/t-pair.pc2" --quiet --picture "$images/sense-t-pair.png" --frame 18 --view 20,15 \
    --size 640x480
