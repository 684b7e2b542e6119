#!/bin/sh
# A job array of Slurm, with a merge job behind it: a controller and three node daemons of our own, on free ports, in a temporary folder. A
# node is killed while its task runs and half a line is written; Slurm queues the task again, and the merged result is unchanged.
set -eu
cd "$(dirname "$0")"
scripts=$(realpath ../../docs/scripts)
folder=$(mktemp -d)
chmod 755 "$folder"
. ./jobs.sh
export CSCD

stop_all() {
    for file in "$folder"/*.pid; do
        [ ! -e "$file" ] || kill -9 "$(cat "$file")" 2>/dev/null || true
    done
    pkill -9 -f "slurmstepd.*$folder" 2>/dev/null || true
    pkill -9 -f "$folder/jobs.jsonl" 2>/dev/null || true
    rm -rf "$folder"
}
trap stop_all EXIT
trap 'exit 1' INT TERM HUP

# ---- the daemons

free_ports() { # COUNT neighbouring ports
    python3 - "$1" <<'P'
import random, socket, sys
count = int(sys.argv[1])
while True:
    first = random.randrange(20000, 60000)
    taken = []
    try:
        for port in range(first, first + count):
            taken.append(socket.socket())
            taken[-1].bind(('127.0.0.1', port))
    except OSError:
        continue
    finally:
        for one in taken: one.close()
    print(first)
    break
P
}
port=$(free_ports 4)
head -c 1024 /dev/urandom >"$folder/munge.key"
chmod 400 "$folder/munge.key"
munged --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" --pid-file="$folder/munged.pid" \
    --log-file="$folder/munged.log" --seed-file="$folder/munged.seed"
mkdir "$folder/state"
cat >"$folder/slurm.conf" <<C
ClusterName=cscd
SlurmctldHost=$(hostname)(127.0.0.1)
SlurmctldPort=$port
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool-%n
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd-%n.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd-%n.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/linear
MpiDefault=none
MailProg=/bin/true
ReturnToService=1
SlurmdTimeout=10
SlurmdParameters=config_overrides
SchedulerParameters=batch_sched_delay=1,sched_interval=2
NodeName=n[1-3] NodeHostname=$(hostname) NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + 3))] CPUs=1
PartitionName=all Nodes=n[1-3] Default=YES MaxTime=INFINITE State=UP
C
export SLURM_CONF="$folder/slurm.conf"
slurmctld
for node in n1 n2 n3; do slurmd -N $node; done

await() { # await SECONDS COMMAND...
    tries=$(($1 * 2))
    shift
    until "$@"; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || {
            echo "slurm: waited in vain for: $*"
            sinfo -N -l || true
            squeue -l || true
            tail -5 "$folder"/*.log
            exit 1
        }
        sleep 0.5
    done
}
all_idle() { [ "$(sinfo -h -N -o %T | grep -c '^idle$')" = 3 ]; }
await 60 all_idle
echo 'slurm: three nodes are up'

# ---- a night

make_jobs 30
run_whole
expected_code() { [ "$(scontrol -o show job "$merge" | grep -o 'ExitCode=[0-9]*')" = ExitCode=1 ]; }
submit() { # submit RESULTS
    mkdir -p "$1"
    array=$(sbatch --parsable --array=1-3 --output="$1/%a.log" "$scripts/slurm-shard.sh" "$folder/jobs.jsonl" "$1")
    merge=$(sbatch --parsable --dependency=afterany:"$array" --output="$1/merge.log" "$scripts/slurm-merge.sh" "$1")
}
submit "$folder/first"
await 120 test -s "$folder/first/all.jsonl"
expect_merged "$folder/first/all.jsonl"
await 30 expected_code # a job of the list has failed
echo 'slurm: an array of three shards and its merge'

# The list is edited, so that no shard begins in the old results, and these are not merged.
mv "$folder/jobs.jsonl" "$folder/kept.jsonl"
sed 's/job 2"/job two"/' "$folder/kept.jsonl" >"$folder/jobs.jsonl"
rm "$folder/first/all.jsonl"
submit "$folder/first"
await 120 grep -q 'not all jobs of this shard have run' "$folder/first/merge.log"
await 30 expected_code
[ ! -e "$folder/first/all.jsonl" ] || { echo 'slurm: old results were merged'; exit 1; }
mv "$folder/kept.jsonl" "$folder/jobs.jsonl"
echo 'slurm: an edited list'

# ---- a node dies

# The task of the second shard waits for a model, which is a pipe; what comes before is written.
rm "$folder/waits.obj"
mkfifo "$folder/waits.obj"
submit "$folder/second"
task_node() { squeue -h -r -o '%i %N %T' | sed -n "s/^${array}_2 \(n[1-3]\) RUNNING$/\1/p"; }
task_waits() { [ -n "$(task_node)" ] && [ -s "$folder/second/shard-2.jsonl" ]; }
await 60 task_waits
sleep 2
node=$(task_node)
daemon=$(cat "$folder/slurmd-$node.pid")
job=$(squeue -h -r -o '%i %A' | sed -n "s/^${array}_2 //p")
pkill -9 -f "$folder/second/shard-2.jsonl" || true
kill -9 "$daemon"
pkill -9 -f "slurmstepd: \[$job\." || true # it would tell the controller that the task has ended
rm -f "$folder/slurmd-$node.pid"
head -c 60 "$folder/second/shard-2.jsonl" >>"$folder/second/shard-2.jsonl"
rm "$folder/waits.obj"
cp "$folder/clean.obj" "$folder/waits.obj"
echo "slurm: node $node is dead"
await 400 test -s "$folder/second/all.jsonl"
expect_merged "$folder/second/all.jsonl"
scontrol -o show job "$job" | grep -q ' Restarts=1 ' || { echo 'slurm: the task was not queued again'; exit 1; }
echo 'slurm: the task was queued again, and the merged result is unchanged'
