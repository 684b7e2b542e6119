#!/bin/sh
# Instructions of replays by kernel and by room: x86-64 with AVX2 beside aarch64 with NEON and without, counted under qemu-user by one
# plugin. Counts do not depend on the machine. BUILD has this machine's tool and models; build/aarch64-linux-gnu/release the other tool
# (`make test-aarch64 ONLY=quick` builds it, too).
set -eu
cd "$(dirname "$0")/../.."
here=benchmarks/instructions
sysroot=build/sysroot/arm64
other=build/aarch64-linux-gnu/release/cscd
[ ! -e "$other.elf" ] || other=$other.elf
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
plugin=$folder/count_instructions.so
${CC:-cc} -shared -fPIC -O2 -o "$plugin" $here/count_instructions.c

"$BUILD/models/record" pawn-drop figure-balls pawn-drop-free "$folder" >/dev/null
"$BUILD/cscd" preprocess "$folder/pawn-drop.obj" -o "$folder/pawn-drop.plan.ply" >/dev/null

# count NAME LEVEL EMULATOR...: each replay, one after the other into one file of counts.
count() {
    name=$1
    level=$2
    shift 2
    for replay in "pawn-drop.obj pawn-drop.pc2 --plan pawn-drop.plan.ply --method charge" \
        "pawn-drop-free.obj pawn-drop-free.pc2 --method single --volume kdop14" "pawn-drop.obj pawn-drop.pc2 --method iccd" \
        "figure-balls.obj figure-balls.pc2 --method single --frames 60:100"; do
        # shellcheck disable=SC2086
        (cd "$folder" && "$@" replay $replay --simd "$level" --threads 1 --quiet)
        cat "$folder/counts" >>"$folder/$name"
    done
}

root=$(pwd)
count avx2 avx2 qemu-x86_64 -cpu max -plugin "$plugin,out=$folder/counts" "$root/$BUILD/cscd"
count neon neon qemu-aarch64 -L "$root/$sysroot" -plugin "$plugin,out=$folder/counts" "$root/$other"
count scalar scalar qemu-aarch64 -L "$root/$sysroot" -plugin "$plugin,out=$folder/counts" "$root/$other"
$here/count_table.py "avx2=$BUILD/cscd:$folder/avx2" "neon=$other:$folder/neon" "scalar=$other:$folder/scalar"
