#!/bin/sh
# The farm script of the extension: exit codes, sentences, JSON, and that nothing is left behind. $1: the doll; $2: a folder to make.
set -eu
cd "$(dirname "$0")"
PYTHONPATH=$PYTHONPATH:$(realpath ../../blender)
export PYTHONPATH
doll=$1
folder=$2
mkdir "$folder"

run_farm() { # run_farm CODE WORDS FILE ARGUMENTS...: ends with this code, and says this
    code=$1 words=$2 file=$3
    shift 3
    status=0
    blender --background "$file" --python-use-system-env --python-exit-code 1 \
        --python-expr 'import cscd_blender.farm as farm; farm.main()' -- "$@" >"$folder/log" 2>&1 || status=$?
    [ "$status" = "$code" ] && grep -q -e "$words" "$folder/log" || {
        echo "farm: $*: expected $code and '$words', got $status:"
        cat "$folder/log"
        exit 1
    }
}

run_farm 3 '24 of 24 frames cross. 5 events' "$doll" --json "$folder/found.json"
run_farm 0 'Nothing crosses or touches in 24 frames' "$doll" --object Skirt --no-depths
run_farm 3 '^3 of 3 frames cross' "$doll" --frames 10:12
run_farm 3 '4 events.* As asked, 1 of 91 pairs of parts was not looked at.$' "$doll" --ignore Body/trunk,Body/forearm.L \
    --ignore Body/forearm.L,Body/trunk
run_farm 3 '3 events.* As asked, pairs of parts that meet in the first frame were not looked at.$' "$doll" --ignore-rest parts
run_farm 0 'touches in 24 frames. As asked, 1 of 1 pair of parts was not looked at.$' "$doll" --object Skirt --ignore Skirt,Skirt
run_farm 1 "there is no object 'Boots'" "$doll" --object Boots
run_farm 1 "there is no collection 'Boots'" "$doll" --collection Boots
run_farm 1 "there is no part 'Boots'" "$doll" --ignore Boots
run_farm 1 'there are no frames from 12 to 3' "$doll" --frames 12:3
run_farm 1 'expected two numbers' "$doll" --frames twelve
run_farm 1 'No such file or directory' "$doll" --json "$folder/nowhere/found.json"
run_farm 1 'unrecognized arguments' "$doll" --jason x
run_farm 0 'usage:' "$doll" --help

blender --background --factory-startup --python-exit-code 1 --python odd.py -- "$folder" >"$folder/log" 2>&1 || {
    cat "$folder/log"
    exit 1
}
run_farm 1 'there is nothing to check' "$folder/empty.blend"
run_farm 1 'Grid has other faces than in the first frame' "$folder/changing.blend"
run_farm 1 'Grid: vertex 3 is at (nan, ' "$folder/nan.blend"
run_farm 0 'touches in 5 frames. Grid has no surface in frames 2 to 3, and was not looked at there.$' "$folder/hidden.blend"
run_farm 1 'touches in 3 frames. No face has an area in frames 2 to 3, so nothing was looked at there.$' "$folder/alone.blend" --json "$folder/alone.json"

/usr/bin/python3 - "$folder" <<'END'
import json, os, sys
folder = sys.argv[1]
with open(os.path.join(folder, 'found.json')) as file:
    found = json.load(file)
assert [frame['frame'] for frame in found['frames']] == list(range(1, 25))
assert len(found['events']) == 5 and {'a', 'b', 'first', 'last', 'worst', 'kinds', 'pairs', 'depth', 'point'} <= set(found['events'][0])
assert all(sum(map(len, frame['faces'].values())) > 0 for frame in found['frames'] if frame['crossing'])
with open(os.path.join(folder, 'alone.json')) as file:
    assert [frame['collapsed'] for frame in json.load(file)['frames']] == [[], ['Grid'], ['Grid'], [], []]
assert sorted(os.listdir(folder)) == ['alone.blend', 'alone.json', 'changing.blend', 'empty.blend', 'found.json', 'hidden.blend', 'log',
                                      'nan.blend'], os.listdir(folder)
END
echo 'farm: 19 runs end as they should, with JSON and without'
