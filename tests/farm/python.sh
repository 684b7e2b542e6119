#!/bin/sh
# The Python programs of docs/artist/engines.md, as they stand there, on meshes of which some cross, some are buried, and one cannot be read: their
# rows are what the tool says of the same files. Ray's is only compiled. PYTHONPATH names the module.
set -eu
cd "$(dirname "$0")"
page=$(realpath ../../docs/artist/engines.md)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
. ./jobs.sh
make_jobs 60
cd "$folder"
corners() { printf 'v %s 0 0\nv %s 1 0\nv 0 %s 0\nv %s 0 1\n' "$1" "$2" "$2" "$1"; }
{
    corners 0 1
    corners 0.1 0.9
    printf 'f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n'
} >buried.obj
mkdir meshes
for i in $(seq 10 69); do
    case $i in 13) model=damaged ;; *3 | *6) model=crossing ;; *8) model=buried ;; *) model=clean ;; esac
    cp $model.obj meshes/mesh-"$i".obj
done
# shellcheck disable=SC2046,SC2183 # two words for each mesh
printf '{"name": "%s", "model": "%s"}\n' $(for mesh in meshes/*.obj; do echo "${mesh#*/} $mesh"; done) >jobs.jsonl
"$CSCD" check --list jobs.jsonl --results tool.jsonl --quiet 2>/dev/null || [ $? = 1 ]

block() { # block NAME: of the page
    awk -v name="$1" '$0 == "```python " name {inside = 1; next} /^```/ {inside = 0} inside' "$page"
}
cat >compare.py <<'P'

if __name__ == "__main__":
    import json

    with open("tool.jsonl", encoding="utf-8") as lines:
        told = [json.loads(line) for line in lines]
    told = [(row["name"], row["crossing_pairs"], row["depth"], row["error"]) for row in sorted(told, key=lambda row: row["job"])]
    assert rows == told, [pair for pair in zip(rows, told) if pair[0] != pair[1]]
    assert len(told) == 60
    assert sum(row[1] is None for row in told) == 1 and sum((row[2] or 0) > 0 for row in told) == 6, told
P
for engine in futures dask; do
    { block check; block $engine; cat compare.py; } >run_$engine.py
    grep -q '^    rows\|^        rows' run_$engine.py
    /usr/bin/python3 run_$engine.py
    echo "farm: $engine"
done
block ray >run_ray.py
grep -q 'import ray' run_ray.py
/usr/bin/python3 -m py_compile run_ray.py
grep -q "^with $(/usr/bin/python3 -c 'import dask; print(".".join(dask.__version__.split(".")[:2]))')):$" "$page"
