#!/bin/sh
# A shard of a list as a task of a Slurm job array:
#
#     array=$(sbatch --parsable --array=1-16 slurm-shard.sh JOBS.jsonl RESULTS)
#     sbatch --dependency=afterany:$array slurm-merge.sh RESULTS
#
# RESULTS is a folder that all nodes see. A task that Slurm starts again, as when its node has died, goes on where it was.
#SBATCH --job-name=cscd
#SBATCH --requeue
#SBATCH --open-mode=append
file="$2/shard-$SLURM_ARRAY_TASK_ID.jsonl"
code=0
"${CSCD:-cscd}" check --list "$1" --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --results "$file" --resume --quiet || code=$?
# A shard that could not begin, as with results of another list, ends with 4. The merge must know.
rm -f "$file.refused"
[ $code != 4 ] || : >"$file.refused"
exit $code
