#!/bin/sh
# Runs the library for WebAssembly under node: run.sh NATIVE FOLDER. NATIVE is contacts.c of this machine, FOLDER has contacts.js and
# sizes.js. Both machines must print the same bits, for two sheets and for the recordings in the folder that CSCD_DATA names; and
# sizes that 32 bits cannot hold must be refused. Ends non-zero when anything failed; its last line is `N passed, M failed`.
set -eu
cd "$(dirname "$0")/../.."
native=$1
folder=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
passed=0
failed=0

# A node that has fetch hides from emscripten's loader that it is no browser. Older ones do not know the option.
node_options=''
! node --no-experimental-fetch -e '' 2>/dev/null || node_options=--no-experimental-fetch

# compare NAME ARGUMENT...
compare() {
    name=$1
    shift
    if "$native" "$@" >"$scratch/native" && node $node_options "$folder/contacts.js" "$@" >"$scratch/wasm" &&
        [ -s "$scratch/wasm" ] && cmp "$scratch/native" "$scratch/wasm"; then
        echo "$name: the same, $(awk '{sum += $3} END {print sum}' "$scratch/wasm") contacts"
        passed=$((passed + 1))
    else
        echo "$name: not the same"
        failed=$((failed + 1))
    fi
}

compare 'two sheets'
for model in "${CSCD_DATA:-/nowhere}"/sequences/*.obj; do
    [ ! -e "$model" ] || compare "$(basename "$model" .obj)" "$model" "${model%.obj}.pc2"
done

node $node_options "$folder/sizes.js" >"$scratch/sizes" || { echo "sizes ended with status $?"; failed=$((failed + 1)); }
cat "$scratch/sizes"
good=$(grep -c '^ok ' "$scratch/sizes" || :)
grep -q '^ok contacts afterwards' "$scratch/sizes" || { echo 'sizes ended early'; failed=$((failed + 1)); }
passed=$((passed + good))
failed=$((failed + $(grep -c '^failed ' "$scratch/sizes" || :)))
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
