#!/bin/sh
# Reads the files that fuzzing has kept, and large ones, damages files of every format at random, compares random scenes with exact
# answers, and judges untangled ones: run.sh SECONDS SEED, a hexadecimal number, so that a commit's hash will do. BUILD has the fuzzers, built with sanitizers; MAKERS the tool and models that make the files. Each kind
# takes SECONDS. What fails is repeated by the same seed. Its last line is `N passed, M failed`.
set -u
cd "$(dirname "$0")/../.." || exit 1
seconds=$1
seed=$2
corpus=$(mktemp -d) || exit 1
trap 'rm -rf "$corpus"' EXIT
tests/fuzz/corpus.sh "$MAKERS" "$corpus" || exit 1
passed=0
failed=0

# try NAME COMMAND...
try() {
    name=$1
    shift
    printf '\n%s\n' "$name"
    if "$@"; then
        passed=$((passed + 1))
    else
        echo "$name: failed with seed $seed"
        failed=$((failed + 1))
    fi
}

readers=$BUILD/tests/fuzz/fuzz_readers
tests/fuzz/kept.sh unpack "$corpus/kept" || exit 1
try 'kept files' "$readers" --replay "$corpus"/kept/*
tests/fuzz/large.py "$corpus/large" || exit 1
try 'large files' "$readers" --replay "$corpus"/large/*
try 'mesh files' "$readers" "$seconds" "$seed" "$corpus"/*.obj "$corpus"/*.off "$corpus"/*.stl "$corpus"/big.ply "$corpus"/little.ply \
    "$corpus"/text.ply
try 'GIFTI' "$readers" "$seconds" "$seed" "$corpus"/*.gii
try 'glTF' "$readers" "$seconds" "$seed" "$corpus"/*.glb "$corpus"/*.gltf
try 'point caches' "$readers" "$seconds" "$seed" "$corpus"/*.pc2 "$corpus"/*.mdd
try 'plans' "$readers" "$seconds" "$seed" "$corpus"/*.plan.ply
try 'summaries' "$readers" "$seconds" "$seed" "$corpus"/*.summary.json
try 'lists of jobs and their results' "$readers" "$seconds" "$seed" "$corpus"/*.jobs.jsonl "$corpus"/*.results.jsonl
number=$(printf '%d' "0x$(echo "$seed" | cut -c 1-7)")
try 'elementary tests' "$BUILD/tests/fuzz/fuzz_elementary" "$seconds" 0 "$number" both
try 'surfaces' "$BUILD/tests/fuzz/fuzz_surfaces" "$((seconds * 20))" "$number"
try 'tangles' "$BUILD/tests/fuzz/fuzz_untangle" "$seconds" 0 "$number"
printf '\n%s passed, %s failed\n' "$passed" "$failed"
[ "$failed" = 0 ]
