#!/bin/sh
# Two builds of the tool replay recordings that are files, and must write the same bytes: same_bits.sh TOOL OTHER RECORD all|quick
# BUILD, whose tool and models make a file of every format.
# RECORD is models/record of this machine: it makes the recordings, because the two processors have mathematical functions that
# round differently. CSCD_DATA names a folder with more recordings (all of them, unless quick).
set -eu
cd "$(dirname "$0")/../.."

tool=$1
other=$2
record=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
same=0
different=0

# compare NAME ARGUMENT...: the contacts, events and the summary of a replay.
compare() {
    name=$1
    shift
    for side in one two; do
        program=$tool
        [ "$side" = one ] || program=$other
        "$program" replay "$@" --threads 2 --reproducible --quiet --json "$folder/$side.json" --contacts "$folder/$side.csv" \
            --events "$folder/$side.events" >"$folder/$side.out" || {
            echo "$name: $program ended with status $?"
            different=$((different + 1))
            return
        }
    done
    for output in json csv events out; do
        cmp "$folder/one.$output" "$folder/two.$output" || {
            different=$((different + 1))
            return
        }
    done
    same=$((same + 1))
    echo "$name: the same, $(($(wc -l <"$folder/one.csv") - 1)) contacts"
}

# ---- every format that is read

tests/fuzz/corpus.sh "$5" "$folder/corpus"
for file in "$folder"/corpus/*; do
    name=$(basename "$file")
    case $name in
    *.jsonl | *.json | *.pc2 | *.mdd) continue ;;
    esac
    for side in one two; do
        program=$tool
        [ "$side" = one ] || program=$other
        "$program" info "$file" --json "$folder/$side.json" >"$folder/$side.out" 2>&1 || echo "ended with $?" >>"$folder/$side.out"
    done
    if cmp "$folder/one.json" "$folder/two.json" && cmp "$folder/one.out" "$folder/two.out"; then
        same=$((same + 1))
    else
        echo "$name is not read alike"
        different=$((different + 1))
    fi
done
for frames in body.pc2 body.mdd; do compare "$frames" "$folder/corpus/body.obj" "$folder/corpus/$frames"; done

# ---- recordings

# The models are made here, by sines. The other machine must make the same plan, byte for byte.
scenes='pawn-drop'
[ "$4" = quick ] || scenes='pawn-drop dumbbell-stairs figure-balls'
# shellcheck disable=SC2086
"$record" $scenes "$folder" >"$folder/log" 2>&1 || {
    cat "$folder/log" >&2
    exit 1
}
for scene in $scenes; do
    model=$folder/$scene.obj
    frames=$folder/$scene.pc2
    "$tool" preprocess "$model" -o "$folder/$scene.plan.ply" >"$folder/log" 2>&1
    "$other" preprocess "$model" -o "$folder/other.plan.ply" >"$folder/log" 2>&1 || cat "$folder/log" >&2
    if cmp "$folder/$scene.plan.ply" "$folder/other.plan.ply"; then
        same=$((same + 1))
    else
        echo "$scene gets another plan"
        different=$((different + 1))
    fi
    compare "$scene by charge" "$model" "$frames" --method charge --plan "$folder/$scene.plan.ply"
    [ "$4" != quick ] || continue
    compare "$scene as one region" "$model" "$frames" --method single --volume kdop14
    compare "$scene by normal cones" "$model" "$frames" --method iccd
    compare "$scene by stars" "$model" "$frames" --method cones
    compare "$scene within a distance" "$model" "$frames" --method single --min-separation 0.001
done
if [ "$4" != quick ] && [ -n "${CSCD_DATA:-}" ]; then
    for model in "$CSCD_DATA"/sequences/*.obj; do
        compare "$(basename "$model" .obj)" "$model" "${model%.obj}.pc2" --method single
    done
    for pair in cloth_ball92:cloth_ball93 cloth_funnel227:cloth_funnel228; do
        compare "$pair" "$CSCD_DATA/frames/${pair%:*}.ply" "$CSCD_DATA/frames/${pair%:*}.ply" "$CSCD_DATA/frames/${pair#*:}.ply"
    done
fi
echo "$same files and recordings give the same bytes, $different do not"
[ "$different" = 0 ]
