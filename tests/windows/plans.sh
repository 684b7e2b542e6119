#!/bin/sh
# Compares the plans that the tool makes under wine with those of Linux, byte for byte: plans.sh NATIVE FOLDER. NATIVE is the build folder of
# this machine, which writes the meshes too, since those come from sines; FOLDER gets the files. WINE is wine64, CSCD_TOOL the tool for
# Windows. Ends non-zero when a plan differs.
set -eu
native=$1
place=$2
mkdir -p "$place"
cd "$place"

fail() {
    echo "plans.sh: $1" >&2
    exit 1
}

# compare NAME OPTION...: a plan of the shape, here and there.
compare() {
    name=$1
    shift
    "$native/cscd" preprocess "$name.obj" --quiet -o native.ply "$@" || fail "$name $*: this machine's tool ended with $?"
    "$WINE" "$CSCD_TOOL" preprocess "$name.obj" --quiet -o windows.ply "$@" || fail "$name $*: cscd.exe ended with $?"
    cmp native.ply windows.ply || fail "$name $*: another plan than on Linux"
}

for shape in pawn dumbbell figure; do
    "$native/models/shape" "$shape" "$shape.obj" >shape.txt || fail "there is no shape $shape"
    compare "$shape"
done
compare pawn --charge coarse
compare pawn --threads 1
compare figure --method kmeans:5

# A replay makes the same plan on its way; and the dense solver is not there.
cp dumbbell.obj later.obj
"$WINE" "$CSCD_TOOL" replay dumbbell.obj dumbbell.obj later.obj --method charge >replay.txt || fail "replay ended with $?"
grep -q '^plan: charge, ' replay.txt || fail "replay makes no plan by charge: $(cat replay.txt)"
if "$WINE" "$CSCD_TOOL" preprocess pawn.obj -o dense.ply --charge dense >dense.txt 2>&1; then fail 'there is a dense solver'; fi
grep -q 'not built for Windows' dense.txt || fail "a dense solution is refused by: $(cat dense.txt)"
