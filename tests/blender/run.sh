#!/bin/sh
# Builds rigs in Blender, exports them as glTF, and compares their frames as the tool reads them with the vertices that Blender
# evaluates; selects there what the tool has found in a scene of its own, compares the extension with the tool, checks meshes whose
# polygons a fan would fill wrongly, and runs the steps of docs/artist/from-your-program.md. BUILD is the build folder, PYTHON_PACKAGE the
# folder of the Python package, PAGE the option --write of page.py, or nothing. Ends non-zero when something differs.
set -eu
cd "$(dirname "$0")"
: "${BUILD:?BUILD must name the build folder}"
case $BUILD in /*) ;; *) BUILD=../../$BUILD ;; esac
export PYTHONDONTWRITEBYTECODE=1

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
run_blender() { # run_blender SCRIPT ARGUMENTS...
    script=$1
    shift
    blender --background --factory-startup --python-exit-code 1 --python "$script" -- "$@" >"$folder/log" 2>&1 || {
        tail -20 "$folder/log"
        exit 1
    }
}

run_blender rigs.py "$folder"
python3 compare.py "$BUILD/tests/blender/print_frames" "$folder"

run_blender selection.py "$(realpath "$BUILD/cscd")" "$folder"
grep '^selection:' "$folder/log"

run_blender families.py "$(realpath "$BUILD/cscd")" "$folder"
grep '^families:' "$folder/log"

# The extension, on the Python package of these sources.
PYTHONPATH=$(case ${PYTHON_PACKAGE:?PYTHON_PACKAGE must name the folder of the package} in /*) echo "$PYTHON_PACKAGE" ;; *) realpath "../../$PYTHON_PACKAGE" ;; esac)
export PYTHONPATH
check_extension() { # check_extension [FILE.blend]
    blender --background "$@" --factory-startup --python-use-system-env --python-exit-code 1 --python extension.py -- \
        "$(realpath "$BUILD/cscd")" "$folder/frames" >"$folder/log" 2>&1 || {
        tail -20 "$folder/log"
        exit 1
    }
    grep '^extension:' "$folder/log"
    rm -r "$folder/frames"
}
check_extension

mkdir "$folder/page"
run_blender clamp.py "$folder/page"
run_blender doll.py "$folder/page/doll.blend"
check_extension "$folder/page/doll.blend"
blender --background "$folder/page/doll.blend" --factory-startup --python-use-system-env --python-exit-code 1 \
    --python marks.py >"$folder/log" 2>&1 || {
    tail -20 "$folder/log"
    exit 1
}
grep '^marks:' "$folder/log"
mkdir "$folder/changes"
blender --background --factory-startup --python-use-system-env --python-exit-code 1 --python changes.py -- "$folder/changes" \
    >"$folder/log" 2>&1 || {
    tail -20 "$folder/log"
    exit 1
}
grep '^changes:' "$folder/log"
blender --background --factory-startup --python-use-system-env --python-exit-code 1 --python untangle.py >"$folder/log" 2>&1 || {
    tail -20 "$folder/log"
    exit 1
}
grep '^untangle:' "$folder/log"
./farm.sh "$folder/page/doll.blend" "$folder/farm"
mkdir "$folder/scripts"
env -u PYTHONPATH BLENDER_USER_SCRIPTS="$folder/scripts" blender --background "$folder/page/doll.blend" --factory-startup \
    --python-use-system-env --python-exit-code 1 --python install.py -- "$(realpath ../../build/blender/cscd_blender-*.zip)" \
    >"$folder/log" 2>&1 || {
    tail -20 "$folder/log"
    exit 1
}
grep '^install:' "$folder/log"
BUILD=$BUILD PYTHON_PACKAGE=$PYTHONPATH ./window.sh ${PAGE:+../../docs/images/blender-panel.png}
python3 page.py "$BUILD/cscd" "$folder/page/doll.blend" "$folder/page" ${PAGE:-}
