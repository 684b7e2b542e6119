#!/bin/sh
# Merges the shards of slurm-shard.sh once all of them have ended. A shard that found something ends with 3, which Slurm takes for a
# failure, so that this waits by afterany. Its own exit code is that of the night.
#SBATCH --job-name=cscd-merge
for mark in "$1"/*.refused; do
    [ ! -e "$mark" ] || {
        echo "${mark%.refused}: not all jobs of this shard have run, as its log says; nothing is merged" >&2
        exit 1
    }
done
exec "${CSCD:-cscd}" merge "$1"/shard-*.jsonl -o "$1/all.jsonl"
