#!/bin/sh
# cscd-mpi on 1 to 8 ranks: the bytes and the exit code of one run, also when a shard is killed, and when mpirun is told to stop. CSCD_MPI
# names the program.
set -eu
cd "$(dirname "$0")"
folder=$(mktemp -d)
launcher=''
stop_all() {
    [ -z "$launcher" ] || kill -9 "$launcher" 2>/dev/null || true
    # shellcheck disable=SC2046
    [ ! -e "$folder/processes" ] || kill -9 $(cat "$folder/processes") 2>/dev/null || true
    rm -rf "$folder"
}
trap stop_all EXIT
. ./jobs.sh
make_jobs 60
run_whole
cd "$folder"
# A container's root, with fewer processors than ranks.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_btl_vader_single_copy_mechanism=none

run_ranks() { # run_ranks RANKS RESULTS WORD...: its exit code is in $code, what it printed in `log` and `errors`
    ranks=$1
    results=$2
    shift 2
    code=0
    mpirun -n "$ranks" "$CSCD_MPI" check --list jobs.jsonl --results "$results" --program "$CSCD" "$@" >log 2>errors || code=$?
}
fail() {
    echo "mpi: $*"
    cat log errors
    exit 1
}
expect_code() { [ "$code" = "$1" ] || fail "ended with $code, not $1"; }
expect_said() { grep -q "$1" log errors || fail "did not say: $1"; }
wrapper() { # wrapper NAME LINES: a program that does this before it runs cscd
    printf '#!/bin/sh\n%s\nexec "%s" "$@"\n' "$2" "$CSCD" >"$1"
    chmod +x "$1"
}

for ranks in 1 2 3 4 5 6 7 8; do
    run_ranks $ranks "ranks-$ranks"
    expect_code 1 # a job of the list has failed
    expect_merged "ranks-$ranks/all.jsonl"
    expect_said '60 jobs: .* 1 failed'
    [ "$(find "ranks-$ranks" -name "shard-*-of-$((8 * ranks)).jsonl" | grep -c .)" = $((8 * ranks)) ] || fail 'not 8 shards per rank'
done
run_ranks 3 seven --shards 7 --threads=2 --quiet
expect_code 1
expect_merged seven/all.jsonl
[ ! -s log ] || fail 'not quiet'
[ "$(find seven -name 'shard-*-of-7.jsonl' | grep -c .)" = 7 ] || fail 'not seven shards'
echo 'farm: MPI, 1 to 8 ranks'

# One rank is slow, and the others take what is left. Rank 0 answers them meanwhile.
# shellcheck disable=SC2016 # for the wrapper
wrapper slow 'echo "$OMPI_COMM_WORLD_RANK $*" >>taken; case "$SLOW_RANK $*" in "$OMPI_COMM_WORLD_RANK "*" --shard "*) sleep 3 ;; esac'
for SLOW_RANK in 0 1; do
    export SLOW_RANK
    run_ranks 3 slow-$SLOW_RANK --program "$folder/slow" --shards 12
    expect_code 1
    expect_merged slow-$SLOW_RANK/all.jsonl
    [ "$(grep -c ' --shard ' taken)" = 12 ] || fail 'not every shard was taken once'
    [ "$(grep -c "^$SLOW_RANK .* --shard " taken)" -le 2 ] || { cat taken; fail 'shards wait for a slow rank'; }
    rm taken
done
echo 'farm: MPI, a slow rank'

# Shard 5 is killed while it writes, and its rank goes on. Then on other ranks, which take the same shards.
# shellcheck disable=SC2016
wrapper dies 'case "$*" in *"--shard 5/16"*) '"\"$CSCD\""' "$@"; head -c 60 died/shard-5-of-16.jsonl >>died/shard-5-of-16.jsonl; kill -9 $$ ;; esac'
sed -i '/damaged/d' jobs.jsonl
run_whole
run_ranks 2 died --program "$folder/dies"
expect_code 1
expect_said 'shard 5 of 16, on rank [01], was ended by signal 9'
[ ! -e died/all.jsonl ] || fail 'it was merged'
run_ranks 3 died
expect_code 0
expect_merged died/all.jsonl
[ "$(find died -name 'shard-*' | grep -c .)" = 16 ] || fail 'other shards than before'
echo 'farm: MPI, a shard dies'

# Exit codes, and what cannot begin, which is said once.
run_ranks 2 rule --fail-on crossing
expect_code 3
sed 's/job 2"/job two"/' jobs.jsonl >edited.jsonl && mv edited.jsonl jobs.jsonl
# shellcheck disable=SC2016
wrapper counts 'echo "$*" >>started'
run_ranks 2 died --program "$folder/counts"
expect_code 4
expect_said 'these are results of another list'
[ "$(grep -c . started)" -le 4 ] || fail 'every shard was started, though none could begin'
! grep -q merge started || fail 'old results were merged'
run_ranks 2 nothing --no-such-option
expect_code 2
run_ranks 2 nothing --program "$folder/no-such-program"
expect_code 127
expect_said 'No such file'
run_ranks 2 nothing --shard 1/2
expect_code 2
run_ranks 2 clean.obj
expect_code 4
touch died/shard-1-of-3.jsonl
run_ranks 2 died
expect_code 1
expect_said 'different numbers of shards'
code=0
"$CSCD_MPI" check --list jobs.jsonl --results alone --program "$CSCD" >log 2>errors || code=$? # without mpirun
expect_code 0
echo 'farm: MPI, exit codes'

# mpirun is told to stop while a job waits for a pipe; what is done is kept, and nothing goes on running.
rm waits.obj
mkfifo waits.obj
# shellcheck disable=SC2016
wrapper traced 'echo $$ >>processes'
mpirun -n 2 "$CSCD_MPI" check --list jobs.jsonl --results stopped --shards 3 --program "$folder/traced" >log 2>errors &
launcher=$!
tries=100
until [ "$(cat stopped/shard-*.jsonl 2>/dev/null | grep -c .)" -ge 40 ]; do
    tries=$((tries - 1))
    [ $tries -gt 0 ] || fail 'it has not come so far'
    sleep 0.1
done
kill -TERM $launcher
code=0
wait $launcher || code=$?
launcher=''
[ $code != 0 ] || fail 'it ended with 0 though it was stopped'
[ ! -e stopped/all.jsonl ] || fail 'it was merged'
tries=100
# shellcheck disable=SC2013
for process in $(cat processes); do
    while kill -0 "$process" 2>/dev/null; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || fail 'a shard still runs'
        sleep 0.1
    done
done
rm processes
rm waits.obj
cp clean.obj waits.obj
run_whole
run_ranks 2 stopped
expect_code 0
expect_merged stopped/all.jsonl
echo 'farm: MPI, stopped'
