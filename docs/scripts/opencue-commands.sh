#!/bin/sh
# Prints a command for each shard of a list, a line each, as cuecmd of OpenCue takes them:
#
#     opencue-commands.sh JOBS.jsonl RESULTS SHARDS [OPTION...] >night.txt
#     cuecmd night.txt
#     cscd merge RESULTS/shard-*.jsonl -o night.jsonl     # when all frames are done
#
# Run it in the folder from which the names of files in the list count. All hosts see that folder, and RESULTS. A frame that runs again goes on where it was. Options are those of all jobs, such as
# --fail-on crossing. A shard ends with 3 if it found something, and with 1 if a job has failed; it is done then, and so is its frame.
set -eu
[ $# -ge 3 ] || {
    echo "usage: $0 JOBS.jsonl RESULTS SHARDS [OPTION...]" >&2
    exit 2
}
quote() { printf "'%s' " "$(printf %s "$1" | sed "s/'/'\\\\''/g")"; }
list=$(realpath "$1")
mkdir -p "$2"
results=$(realpath "$2")
shards=$3
shift 3
options=$(for option; do quote "$option"; done)
program=$(quote "${CSCD:-cscd}")
shard=1
while [ "$shard" -le "$shards" ]; do
    file=$(quote "$results/shard-$shard.jsonl")
    # shellcheck disable=SC2016
    printf 'cd %s&& %scheck --list %s--shard %d/%d --threads 1 --results %s--resume --quiet %s; code=$?; ' \
        "$(quote "$PWD")" "$program" "$(quote "$list")" "$shard" "$shards" "$file" "$options"
    # shellcheck disable=SC2016
    printf '[ $code = 1 ] || [ $code = 3 ] || exit $code\n'
    shard=$((shard + 1))
done
