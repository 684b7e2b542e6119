#!/bin/sh
# Merges the shards of slurm-shard.sh once all of them have ended. A shard that found something ends with 3, which Slurm takes for a
# failure, so that this waits by afterany. Its own exit code is that of the night.
#SBATCH --job-name=cscd-merge
exec "${CSCD:-cscd}" merge "$1"/shard-*.jsonl -o "$1/all.jsonl"
