#!/bin/sh
# Draws the charts of docs/measurements.md from the JSON of benchmarks/methods. usage: plot.sh BENCH.json IMAGES
set -eu
json=$1
images=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$images"
[ -e "$json" ] || { echo "plot.sh: $json is missing; run make bench first" >&2; exit 1; }

# stages.dat: a line per recording and method, an empty line between recordings; pairs.dat: pairs per triangle.
python3 - "$json" "$work" <<'PYTHON'
import json, sys
rows = json.load(open(sys.argv[1]))["rows"]
methods = ["none", "iccd", "single", "charge", "charge+"]
stages = ["bvh_ms", "orient_ms", "cnc_ms", "traverse_ms", "contact_ms", "proof_ms"]
own = ["pawn-drop", "pawn-drop-free", "dumbbell-stairs", "dumbbell-stairs-free", "figure-balls", "figure-balls-free"]
scenes = [s for s in own if any(r["scene"] == s for r in rows)]
find = {(r["scene"], r["method"]): r for r in rows}
with open(sys.argv[2] + "/stages.dat", "w") as out:
    out.write("method " + " ".join(["update", "orientation", "contour", "traversal", "contact", "proof"]) + "\n")
    for scene in scenes:
        for method in methods:
            row = find[scene, method]
            nanos = [1e6 * row[s] / row["triangles"] for s in stages]
            out.write(f'"{method}" ' + " ".join(f"{n:.2f}" for n in nanos) + "\n")
        out.write('"" 0 0 0 0 0 0\n')
with open(sys.argv[2] + "/pairs.dat", "w") as out:
    out.write("scene " + " ".join(f'"{m}"' for m in methods) + "\n")
    for scene in scenes:
        values = [find[scene, m]["pcp"] / find[scene, m]["triangles"] for m in methods]
        out.write(f'"{scene}" ' + " ".join(f"{v:.3f}" for v in values) + "\n")
with open(sys.argv[2] + "/labels.gp", "w") as out:
    for i, scene in enumerate(scenes):
        out.write(f'set label "{scene}" at {6 * i + 2}, graph 0.97 center\n')
PYTHON

gnuplot <<GNUPLOT
set terminal pngcairo size 1200,520 font "sans,11" background "white"
set style data histograms
set style fill solid 1.0 border rgb "white"
set grid ytics lc rgb "#dddddd"
set border 3
set tics nomirror

set output "$images/bench-stages.png"
set style histogram rowstacked
set boxwidth 0.85
set ylabel "ns per triangle and interval"
set xtics rotate by -45
set yrange [0:*]
set offset 0,0,graph 0.1,0
set key outside right top
load "$work/labels.gp"
set linetype 1 lc rgb "#0072b2"
set linetype 2 lc rgb "#e69f00"
set linetype 3 lc rgb "#cc79a7"
set linetype 4 lc rgb "#56b4e9"
set linetype 5 lc rgb "#d55e00"
set linetype 6 lc rgb "#009e73"
plot for [i=2:7] "$work/stages.dat" using i:xtic(1) title columnheader(i)

unset label
unset offset
set output "$images/bench-pairs.png"
set style histogram clustered gap 1
set boxwidth 0.9
set ylabel "potentially colliding pairs per triangle"
set logscale y
set yrange [0.05:20]
set xtics norotate
plot for [i=2:6] "$work/pairs.dat" using i:xtic(1) title columnheader(i)
GNUPLOT
echo "$images/bench-stages.png, $images/bench-pairs.png"
