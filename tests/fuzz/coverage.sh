#!/bin/sh
# Lets libFuzzer make files of each format, guided by the paths that they take through its reader: coverage.sh SECONDS TARGET FOLDER
# [FORMAT...], SECONDS for each. It begins with the files that are kept (kept.sh), and with the words of tests/fuzz/words.
# What it finds is left in FOLDER/FORMAT: files that end the program, take too long or too much memory are called crash-*, timeout-* and
# oom-*. KEEP=1 keeps the files that reach new code, as few and as small as do.
set -u
cd "$(dirname "$0")/../.." || exit 1
seconds=$1
target=$2
found=$3
shift 3
kept=$(mktemp -d) || exit 1
trap 'rm -rf "$kept"' EXIT
tests/fuzz/kept.sh unpack "$kept" || exit 1
# shellcheck disable=SC2046
[ $# -gt 0 ] || set -- $(ls "$kept")
for format; do
    [ -f "tests/fuzz/words/$format" ] || { echo "coverage.sh: no format is called $format; there are" tests/fuzz/words/* | sed 's: tests/fuzz/words/: :g' >&2; exit 2; }
done
# A reader may take five seconds of processor time, which readings.c looks at; here the clock counts, on a machine that does other work.
options='-rss_limit_mb=2048 -timeout=60 -max_len=4096 -print_final_stats=1 -verbosity=0'
export ASAN_OPTIONS="${ASAN_OPTIONS:-allocator_may_return_null=1}"
[ -d /dev/shm ] && export TMPDIR="${TMPDIR:-/dev/shm}"
failed=''
for format; do
    export READER="$format"
    mkdir -p "$found/$format" "$kept/$format"
    printf '\n%s: %s seconds\n' "$format" "$seconds"
    # shellcheck disable=SC2086
    "$target" $options -dict="tests/fuzz/words/$format" -artifact_prefix="$found/$format/" -max_total_time="$seconds" \
        "$found/$format" "$kept/$format" || failed="$failed $format"
    [ "${KEEP:-0}" = 1 ] || continue
    # Of the files that are kept already and the small ones that were found, those that together reach the same code.
    candidates=$(mktemp -d) smaller=$(mktemp -d) || exit 1
    find "$found/$format" "$kept/$format" -type f -size -700c ! -name '*-*' -exec cp {} "$candidates" ';'
    cp "$kept/$format"/* "$candidates"
    # shellcheck disable=SC2086
    if "$target" $options -set_cover_merge=1 -use_counters=0 "$smaller" "$candidates"; then
        rm -f "$kept/$format"/*
        for file in "$smaller"/*; do cp "$file" "$kept/$format/$(sha1sum <"$file" | cut -c 1-12)"; done
        tests/fuzz/kept.sh pack "$kept" "$format"
    fi
    rm -rf "$candidates" "$smaller"
done
[ -z "$failed" ] || { echo "files that fail:$failed; they are in $found" >&2; exit 1; }
