#!/bin/sh
# Shards that xargs and GNU parallel start give what one run gives.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
. "$(dirname "$0")/jobs.sh"
make_jobs 60
run_whole
export CSCD folder

seq 5 | xargs -P 3 -I {} "$CSCD" check --list "$folder/jobs.jsonl" --shard {}/5 --threads 1 --results "$folder/shard-{}.jsonl" --quiet \
    2>/dev/null || true # a job of the list fails
"$CSCD" merge "$folder"/shard-*.jsonl -o "$folder/all.jsonl" --quiet 2>/dev/null || [ $? = 1 ]
expect_merged "$folder/all.jsonl"
echo 'farm: xargs'

# A log of GNU parallel, by which it runs again what was stopped.
rm "$folder"/shard-*.jsonl "$folder/all.jsonl"
run_parallel() {
    seq 5 | parallel --jobs 3 --joblog "$folder/log" "$@" \
        "$CSCD" check --list "$folder/jobs.jsonl" --shard {}/5 --threads 1 --results "$folder/shard-{}.jsonl" --resume --quiet \
        2>/dev/null || true
}
run_parallel
head -c -30 "$folder/shard-2.jsonl" >"$folder/torn" && cp "$folder/torn" "$folder/shard-2.jsonl"
sed -i '/shard 2/d' "$folder/log"
run_parallel --resume
"$CSCD" merge "$folder"/shard-*.jsonl -o "$folder/all.jsonl" --quiet 2>/dev/null || [ $? = 1 ]
expect_merged "$folder/all.jsonl"
echo 'farm: GNU parallel'

# The list is edited: no shard may begin in the old results. The log of parallel says so by 4, and xargs stops by 255.
sed -i 's/job 2"/job two"/' "$folder/jobs.jsonl"
run_parallel
[ "$(awk 'NR > 1 && $7 != 4' "$folder/log")" = '' ] || { echo 'parallel: an edited list was taken'; exit 1; }
code=0
# shellcheck disable=SC2016
seq 5 | xargs -I {} sh -c '"$CSCD" check --list "$folder/jobs.jsonl" --shard {}/5 --results "$folder/shard-{}.jsonl" --resume --quiet
    [ $? != 4 ] || exit 255' 2>/dev/null || code=$?
[ $code = 124 ] || { echo "xargs: an edited list was taken: $code"; exit 1; }
echo 'farm: xargs and GNU parallel, an edited list'

# One recording of 100 frames, in which a triangle sinks through another and comes back, in shards.
awk -v folder="$folder" 'BEGIN {
    for (i = 0; i < 100; i++) {
        z = i % 20 < 10 ? 5 - i % 20 : i % 20 - 15
        printf "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 %g\nv 1 1 %g\nv 2 1 %g\nf 1 2 3\nf 4 5 6\n", z - .5, z + .5, z + .3 \
            >sprintf("%s/sinks_%03d.obj", folder, i)
    }
}'
cd "$folder"
"$CSCD" replay sinks_000.obj 'sinks_%03d.obj' --quiet --contacts one.csv --events one-events.csv
[ "$(grep -c . one.csv)" -gt 20 ]
seq 3 | parallel --jobs 2 "$CSCD" replay sinks_000.obj "'sinks_%03d.obj'" --shard {}/3 --results sinks-{}.shard --resume --quiet
"$CSCD" merge sinks-*.shard --quiet --contacts all.csv --events all-events.csv
cmp one.csv all.csv
cmp one-events.csv all-events.csv
echo 'farm: GNU parallel, one recording'
