#!/bin/sh
# The demo: a soft pawn falls and bows; where does it hit itself? Checks the answer three ways, draws it.
set -eu
build=${BUILD:-build/release}
out=build/demo
name=$out/pawn-drop
mkdir -p "$out"
tool=./cscd
[ "$build" = build/release ] || tool=$build/cscd
fail() {
    echo "demo: FAILED: $*" >&2
    exit 1
}
show() { # show PROGRAM ARGUMENTS...: the command, then what it says
    printf '\n$ %s\n' "$*"
    "$@"
}

show "$build/models/record" pawn-drop "$out"
show "$tool" preprocess "$name.obj"
show "$tool" replay "$name.obj" "$name.pc2" --contacts "$out/contacts.csv" --json "$out/summary.json" \
    --up z --report "$out/report.html" --scenery "$name-scenery.obj" >"$out/table.txt"
cat "$out/table.txt"

# The plain method without regions gives the same contacts, and brute force over all pairs of features the same
# for the first interval that has any.
"$tool" replay "$name.obj" "$name.pc2" --method none --no-check --quiet --contacts "$out/none.csv"
cmp "$out/contacts.csv" "$out/none.csv" || fail 'method none gives another list (none.csv)'
first=$(sed -n '2s/,.*//p' "$out/contacts.csv")
[ -n "$first" ] || fail 'no contact found'
"$tool" replay "$name.obj" "$name.pc2" --frames "$first:$((first + 1))" --method brute --no-check --quiet \
    --contacts "$out/brute.csv"
grep -E "^(frame|$first)," "$out/contacts.csv" | cmp - "$out/brute.csv" ||
    fail "brute force over interval $first gives another list (brute.csv)"

# CSV, JSON and table agree.
rows=$(($(wc -l <"$out/contacts.csv") - 1))
table=$(sed -n 's/^contacts: \([0-9]*\) VF and \([0-9]*\) EE.*/\1 \2/p' "$out/table.txt" | awk '{print $1 + $2}')
[ "$rows" = "$table" ] || fail "$rows rows in the CSV, $table in the table"
python3 - "$out/summary.json" "$rows" "$first" >"$out/most.txt" <<'PYTHON' || fail 'the JSON summary disagrees with the CSV'
import json, sys
intervals = json.load(open(sys.argv[1]))["intervals"]
assert sum(i["vf"] + i["ee"] for i in intervals) == int(sys.argv[2]), "contacts"
assert next(i["frame"] for i in intervals if i["earliest_toi"] is not None) == int(sys.argv[3]), "first contact"
print(max(intervals, key=lambda i: i["vf"] + i["ee"])["frame"])
PYTHON
most=$(cat "$out/most.txt")

"$tool" render "$name.obj" --up z --colour charge --view 30,12 -o "$out/charge.png"
"$tool" render "$name.obj" --up z --colour region --view 30,12 -o "$out/regions.png"
"$tool" render "$name.obj" "$name.pc2" --up z --frames 0:143:13 --columns 4 --colour contacts --view 20,12 \
    --scenery "$name-scenery.obj" -o "$out/strip.png"
"$tool" render "$name.obj" "$name.pc2" --up z --frame "$most" --colour contacts --view 0,10 --scenery "$name-scenery.obj" \
    -o "$out/contacts.png"

echo
echo "demo: first contact in interval $first; method none and brute force agree, CSV, JSON and table too"
echo "      $out/report.html shows all of it: open it in a browser"
echo "      $out/contacts.csv, summary.json; strip.png, contacts.png (interval $most, which has most), charge.png, regions.png"
