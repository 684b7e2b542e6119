#!/bin/sh
# The Open Job Description template of docs/scripts, expanded and run by openjd.py: it gives what one run gives. A shard that dies keeps the
# merge back, one that found something does not, and the job that is sent again goes on where it was.
set -eu
cd "$(dirname "$0")"
scripts=$(realpath ../../docs/scripts)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
. ./jobs.sh
make_jobs 60
engine=$(realpath openjd.py)
cd "$folder"
sed -i "s|$folder/||" jobs.jsonl # names that count from here, though tasks run elsewhere
run_whole

run_template() { # run_template RESULTS NAME=VALUE...: its exit code is in $code, what it printed in $folder/log
    results=$1
    shift
    code=0
    python3 "$engine" "$scripts/cscd.openjd.json" List=jobs.jsonl Folder=. Results="$results" "$@" >"$folder/log" 2>"$folder/errors" || code=$?
}
expect_tasks() { # expect_tasks CODE LINE...: how the engine ended, and `COUNT TASK: CODE` for its tasks
    [ "$code" = "$1" ] || { echo "openjd: ended with $code, not $1"; cat "$folder/log" "$folder/errors"; exit 1; }
    shift
    printf '%s\n' "$@" >"$folder/tasks"
    grep -v ' jobs: ' "$folder/log" | sort | uniq -c | sed 's/^ *//' | diff "$folder/tasks" -
}

# A job of the list has failed, so that the shard with it ends with 1, and so does the merge; all others are taken as they are.
run_template "an 'odd' \$folder" Cscd="$CSCD" Shards=5
expect_tasks 1 '1 Merge: 1' '5 Shards: 0'
expect_merged "$folder/an 'odd' \$folder/all.jsonl"
run_template many Cscd="$CSCD" Shards=80 Options='--threads 1'
expect_tasks 1 '1 Merge: 1' '80 Shards: 0'
expect_merged "$folder/many/all.jsonl"

# Without that job, and with a rule, it is 3.
cp "$folder/jobs.jsonl" "$folder/all_jobs.jsonl"
sed -i '/damaged/d' "$folder/jobs.jsonl"
run_template rule Cscd="$CSCD" Shards=4 Options='--fail-on crossing --threads 1'
expect_tasks 1 '1 Merge: 3' '4 Shards: 0'
run_template clean Cscd="$CSCD" Shards=4
expect_tasks 0 '1 Merge: 0' '4 Shards: 0'
mv "$folder/all_jobs.jsonl" "$folder/jobs.jsonl"
echo 'farm: Open Job Description'

# Shard 2 is killed while it writes.
printf '#!/bin/sh\ncase "$*" in *"--shard 2/3"*) %s "$@"; head -c 60 %s >>%s; kill -9 $$ ;; *) exec %s "$@" ;; esac\n' \
    "$CSCD" "$folder/died/shard-2.jsonl" "$folder/died/shard-2.jsonl" "$CSCD" >"$folder/dies"
chmod +x "$folder/dies"
run_template died Cscd="$folder/dies" Shards=3
expect_tasks 1 '1 Merge: left out' '2 Shards: 0' '1 Shards: 137'
if [ -e "$folder/died/all.jsonl" ]; then echo 'openjd: it was merged'; exit 1; fi
run_template died Cscd="$CSCD" Shards=3
expect_tasks 1 '1 Merge: 1' '3 Shards: 0'
expect_merged "$folder/died/all.jsonl"
echo 'farm: Open Job Description, a shard dies'

# The list is edited: no shard may begin in the old results, and there is no merge.
sed 's/job 2"/job two"/' jobs.jsonl | grep -v damaged >edited.jsonl
run_template clean Cscd="$CSCD" Shards=4 List=edited.jsonl
expect_tasks 1 '1 Merge: left out' '4 Shards: 4'
echo 'farm: Open Job Description, an edited list'

# The engine does refuse what the schema does not know.
for fault in 's/"PATH"/"FOLDER"/' 's/Param.Shards}}",/Param.Parts}}",/' 's/"dependsOn": "Shards"/"dependsOn": "Merge"/' 's/1-{{/1 to {{/' \
    's/"onRun"/"run"/' 's/2023-09/2023-10/' 's/"1-{{Param.Shards/"1-{{Task.Param.Shard/' 's/mkdir/\\nmkdir/'; do
    sed "$fault" "$scripts/cscd.openjd.json" >"$folder/wrong.json"
    cmp -s "$folder/wrong.json" "$scripts/cscd.openjd.json" && { echo "openjd: $fault changes nothing"; exit 1; }
    code=0
    python3 "$engine" "$folder/wrong.json" List=jobs.jsonl Folder=. Results="$folder/wrong" Cscd="$CSCD" >"$folder/log" || code=$?
    if [ "$code" != 2 ] || [ -e "$folder/wrong" ]; then echo "openjd: $fault was taken"; cat "$folder/log"; exit 1; fi
done
