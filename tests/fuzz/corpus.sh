#!/bin/sh
# Makes a small file of every format that we read, by our own writers: corpus.sh BUILD FOLDER. BUILD has the tool and models.
set -eu
build=$(cd "$1" && pwd)
scripts=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$2"
cd "$2"

"$build/models/shape" sphere --triangles 40 body.obj >/dev/null
"$build/models/mannequin" . skin >/dev/null
"$scripts/corpus.py" body.obj .
"$build/cscd" preprocess body.obj --method kmeans:3 -o body.plan.ply >/dev/null
"$build/cscd" replay body.obj body.pc2 --json body.summary.json --quiet >/dev/null
printf '%s\n' '{"model": "body.obj", "frames": "body.pc2"}' \
    '{"model": "body.off", "size": 40, "options": {"max-faces": 3}}' >body.jobs.jsonl
"$build/cscd" check --list body.jobs.jsonl --results body.results.jsonl --reproducible --quiet >/dev/null
