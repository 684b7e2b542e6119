#!/bin/sh
# What starts shards in the world, each by its own script: `make test-farm` calls it. CSCD names the tool,
# CSCD_MPI the launcher, PYTHONPATH the folder of the module.
set -eu
cd "$(dirname "$0")"
passed=0
failed=0
for script in shells.sh opencue.sh openjd.sh python.sh mpi.sh slurm.sh; do
    if ./$script; then passed=$((passed + 1)); else
        echo "farm: $script failed"
        failed=$((failed + 1))
    fi
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
