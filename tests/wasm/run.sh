#!/bin/sh
# Runs the library for WebAssembly under node: run.sh NATIVE FOLDER TEST.js... NATIVE is contacts.c of this machine, FOLDER has
# contacts.js and sizes.js, and each TEST is a test program of a room. Both machines must print the same bits, for two sheets, a plan and
# the recordings in the folder that CSCD_DATA names; and sizes that 32 bits cannot hold must be refused. Says what is left out, and why:
# left_out.txt. Ends non-zero when anything failed; its last line is `N passed, M failed`.
set -eu
cd "$(dirname "$0")/../.."
native=$1
folder=$2
shift 2
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

compare 'two sheets and a plan'
for model in "${CSCD_DATA:-/nowhere}"/sequences/*.obj; do
    [ ! -e "$model" ] || compare "$(basename "$model" .obj)" "$model" "${model%.obj}.pc2"
done

node $node_options "$folder/sizes.js" >"$scratch/sizes" || { echo "sizes ended with status $?"; failed=$((failed + 1)); }
cat "$scratch/sizes"
good=$(grep -c '^ok ' "$scratch/sizes" || :)
grep -q '^ok contacts afterwards' "$scratch/sizes" || { echo 'sizes ended early'; failed=$((failed + 1)); }
passed=$((passed + good))
failed=$((failed + $(grep -c '^failed ' "$scratch/sizes" || :)))

# ---- the tests of rooms, each program within LIMIT seconds

left_out=tests/wasm/left_out.txt

# total WORD LOG: the N of cmocka's line `[  WORD  ] N test(s)`.
total() {
    sed -n "s/^\[  $1  \] \(.*: \)\{0,1\}\([0-9][0-9]*\) test(s).*/\2/p" "$2" | tail -1
}

# check_left_out NAME LOG: sets known to the number of tests that must fail here and do. One that does not fail is left out in vain.
check_left_out() {
    known=0
    for test in $(sed -n "s|^tests/$1\.c \([^:]*\):.*|\1|p" "$left_out"); do
        if grep -q "^\[       OK \] $test\$" "$2"; then
            echo "$1: $test passes, so $left_out must not name it"
            failed=$((failed + 1))
        else
            known=$((known + 1))
        fi
    done
}

# add_up TEST: what its log says; a program that ended before its totals has failed.
add_up() {
    name=$(echo "${1%.js}" | sed 's:.*/\([^/]*/[^/]*\)$:\1:')
    log=$scratch/$(echo "$name" | tr / :)
    status=$(cat "$log.status")
    good=$(total PASSED "$log")
    bad=$(total FAILED "$log")
    if [ -z "$good$bad" ] || { [ "$status" != 0 ] && [ "${bad:-0}" = 0 ]; }; then
        echo "$name: ended with status $status"
        bad=1 known=0
    else
        check_left_out "$name" "$log"
        bad=$((${bad:-0} - known))
    fi
    echo "$name: ${good:-0} passed, $bad failed"
    [ "$bad" = 0 ] || grep -aE 'ERROR|error|FAILED|\.c:[0-9]' "$log" | head -20
    passed=$((passed + ${good:-0}))
    failed=$((failed + bad))
}

[ $# = 0 ] || printf '%s\n' "$@" | xargs -P "${JOBS:-$(nproc)}" -I PROGRAM sh -c '
    name=$(echo "${1%.js}" | sed "s:.*/\([^/]*/[^/]*\)$:\1:" | tr / :)
    # shellcheck disable=SC2086
    timeout "${LIMIT:-600}" node $3 "$1" >"$2/$name" 2>&1
    echo "$?" >"$2/$name.status"' sh PROGRAM "$scratch" "$node_options"
for program in "$@"; do add_up "$program"; done
echo "$# test programs ran under node $(node --version); left out of their rooms:"
sed -n 's/^tests\//  /p' "$left_out"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
