#!/bin/sh
# The command file for OpenCue: frames that run its lines by a shell, as cuecmd does, give what one run gives. A shard that dies fails its
# frame, and one that found something does not.
set -eu
cd "$(dirname "$0")"
script=$(realpath ../../docs/scripts/opencue-commands.sh)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
. ./jobs.sh
make_jobs 60
cd "$folder"
sed -i "s|$folder/||" jobs.jsonl # names that count from here, though frames run elsewhere
run_whole

# As cuecmd's execute_commands.py does it: the lines of a frame one after the other, and none behind one that has failed.
run_frames() { # run_frames COMMANDS CHUNK: prints the exit code of each frame
    frame=0
    lines=$(grep -c . "$1")
    while [ $((frame * $2)) -lt "$lines" ]; do
        tail -n +$((frame * $2 + 1)) "$1" | head -n "$2" >"$folder/frame"
        code=0
        while [ $code = 0 ] && IFS= read -r line; do
            (cd / && sh -c "$line" <"$folder/nothing" 2>"$folder/errors") || code=$?
        done <"$folder/frame"
        echo $code
        frame=$((frame + 1))
    done
}
: >"$folder/nothing"
expect_frames() { # expect_frames COUNT: so many frames have ended, all of them with 0
    [ "$(sort -u <"$folder/codes")" = 0 ] && [ "$(grep -c . "$folder/codes")" = "$1" ] && return
    echo 'opencue: the frames ended with'
    cat "$folder/codes" "$folder/errors"
    exit 1
}

# A folder that needs quotes, from where the farm does not run; a job of the list fails.
results="an 'odd' \$folder"
"$script" jobs.jsonl "$results" 5 >night.txt
run_frames night.txt 1 >codes
expect_frames 5
"$CSCD" merge "$results"/shard-*.jsonl -o all.jsonl --quiet 2>/dev/null || [ $? = 1 ]
expect_merged all.jsonl

# Three lines a frame: the shards behind one that found something run as well.
"$script" jobs.jsonl chunks 7 --fail-on crossing >night.txt
run_frames night.txt 3 >codes
expect_frames 3
"$CSCD" check --list jobs.jsonl --results found.jsonl --fail-on crossing --threads 1 --quiet 2>/dev/null || [ $? = 1 ]
"$CSCD" merge found.jsonl -o expected.jsonl --quiet 2>/dev/null || [ $? = 1 ]
grep -q '"found":true' expected.jsonl
"$CSCD" merge chunks/shard-*.jsonl -o all.jsonl --quiet 2>/dev/null || [ $? = 1 ]
expect_merged all.jsonl
echo 'farm: command file of OpenCue'

# Shard 2 is killed while it writes, and its frame is run again.
run_whole
printf '#!/bin/sh\ncase "$*" in *"--shard 2/3"*) %s "$@"; head -c 60 %s >>%s; kill -9 $$ ;; *) exec %s "$@" ;; esac\n' \
    "$CSCD" "$folder/died/shard-2.jsonl" "$folder/died/shard-2.jsonl" "$CSCD" >dies
chmod +x dies
CSCD="$folder/dies" "$script" jobs.jsonl died 3 >night.txt
run_frames night.txt 1 >codes
[ "$(tr '\n' ' ' <codes)" = '0 137 0 ' ] || { echo 'opencue: the frame of the dead shard has not failed'; exit 1; }
"$script" jobs.jsonl died 3 | sed -n 2p >night.txt
run_frames night.txt 1 >codes
expect_frames 1
"$CSCD" merge died/shard-*.jsonl -o all.jsonl --quiet 2>/dev/null || [ $? = 1 ]
expect_merged all.jsonl
echo 'farm: command file of OpenCue, a shard dies'

# The list is edited: no shard may begin in the old results, so that all frames fail, though there are lines to merge.
grep -v damaged jobs.jsonl >edited.jsonl
"$script" edited.jsonl edited 3 >night.txt
run_frames night.txt 1 >codes
expect_frames 3
sed -i 's/job 2"/job two"/' edited.jsonl
run_frames night.txt 1 >codes
[ "$(tr '\n' ' ' <codes)" = '4 4 4 ' ] || { echo 'opencue: an edited list was taken'; exit 1; }
echo 'farm: command file of OpenCue, an edited list'
