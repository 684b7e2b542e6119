#!/bin/sh
# The demo: generates a bending capsule, finds its self-collisions, checks the answer three ways, draws it.
set -eu
build=${BUILD:-build/release}
out=build/demo
mkdir -p "$out"
tool=./cscd
[ "$build" = build/release ] || tool=$build/cscd
fail() {
    echo "demo: FAILED: $*" >&2
    exit 1
}

"$build/models/capsule_bend" "$out/capsule.obj" "$out/capsule.pc2" >"$out/capsule.txt"
cat "$out/capsule.txt"
expected=$(sed -n 's/^first contact expected in interval //p' "$out/capsule.txt")

echo
"$tool" replay "$out/capsule.obj" "$out/capsule.pc2" \
    --contacts "$out/contacts.csv" --json "$out/summary.json" >"$out/table.txt"
cat "$out/table.txt"

# The first contact comes where the generator's formula says.
first=$(sed -n '2s/,.*//p' "$out/contacts.csv")
[ "$first" = "$expected" ] || fail "the first contact is in interval '$first', expected $expected"

# Brute force over all pairs of features gives the same list for that interval.
"$tool" replay "$out/capsule.obj" "$out/capsule.pc2" --frames "$first:$((first + 1))" --method brute --no-check \
    --quiet --contacts "$out/brute.csv"
grep -E "^(frame|$first)," "$out/contacts.csv" | cmp - "$out/brute.csv" ||
    fail "brute force over interval $first gives another list (brute.csv)"

# CSV, JSON and table agree.
rows=$(($(wc -l <"$out/contacts.csv") - 1))
table=$(sed -n 's/^contacts: \([0-9]*\) VF and \([0-9]*\) EE.*/\1 \2/p' "$out/table.txt" | awk '{print $1 + $2}')
[ "$rows" = "$table" ] || fail "$rows rows in the CSV, $table in the table"
python3 - "$out/summary.json" "$rows" "$first" <<'PYTHON' || fail 'the JSON summary disagrees with the CSV'
import json, sys
summary = json.load(open(sys.argv[1]))
intervals = summary["intervals"]
assert [i["frame"] for i in intervals] == list(range(59)), "59 intervals, in order"
assert len(summary["frames"]) == 60, "60 frames"
assert sum(i["vf"] + i["ee"] for i in intervals) == int(sys.argv[2]), "contacts"
assert next(i["frame"] for i in intervals if i["earliest_toi"] is not None) == int(sys.argv[3]), "first contact"
PYTHON

"$tool" render "$out/capsule.obj" "$out/capsule.pc2" --frame "$first" --colour contacts --view 20,40 \
    -o "$out/contacts.png"
"$tool" render "$out/capsule.obj" "$out/capsule.pc2" --frame "$first" --colour contacts --view 20,40 --zoom --wire \
    -o "$out/close-up.png"

echo
echo "demo: first contact in interval $first as expected, brute force agrees, CSV, JSON and table agree"
echo "      $out/contacts.csv, $out/summary.json, $out/contacts.png, $out/close-up.png"
