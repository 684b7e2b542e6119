#!/bin/sh
# Draws the charts of docs/about/measurements.md from the JSON of benchmarks/methods or benchmarks/charge.
# usage: plot.sh methods|charge BENCH.json IMAGES
set -eu
kind=$1
json=$2
images=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$images"
[ -e "$json" ] || { echo "plot.sh: $json is missing; run make bench or make bench-charge first" >&2; exit 1; }

# stages.dat: a line per recording and method, an empty line between recordings; pairs.dat: pairs per triangle.
draw_methods() {
python3 - "$json" "$work" <<'PYTHON'
import json, sys
rows = json.load(open(sys.argv[1]))["rows"]
methods = ["none", "iccd", "cones", "single", "charge", "charge+"]
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
        out.write(f'set label "{scene}" at {7 * i + 2.5}, graph 0.97 center\n')
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
set yrange [0.02:20]
set xtics norotate
plot for [i=2:7] "$work/pairs.dat" using i:xtic(1) title columnheader(i)
GNUPLOT
echo "$images/bench-stages.png, $images/bench-pairs.png"
}

# A file of triangles and values per line of a chart. The figure's times are those of the charge alone, in seconds.
draw_charge() {
python3 - "$json" "$work" <<'PYTHON'
import json, sys
rows = json.load(open(sys.argv[1]))["rows"]
def write(name, chosen, value):
    points = sorted((r["triangles"], value(r)) for r in rows if chosen(r) and value(r) is not None)
    with open(f"{sys.argv[2]}/{name}.dat", "w") as out:
        out.writelines(f"{n} {v:.6g}\n" for n, v in points)
for solver in ["dense", "tree", "coarse"]:
    for body in ["sphere", "ellipsoid", "torus", "cube"]:
        of_body = lambda r: r["table"] == "errors" and r["body"] == body and r["solver"] == solver
        write(f"capacitance-{body}-{solver}", of_body, lambda r: r["capacitance_error"])
        write(f"density-{body}-{solver}", of_body, lambda r: r["density_rms"])
    for threads in [1, 2]:
        of_threads = lambda r: r["table"] == "times" and r["solver"] == solver and r["threads"] == threads
        write(f"seconds-{solver}-{threads}", of_threads, lambda r: r["charge_ms"] / 1e3)
        write(f"peak-{solver}-{threads}", of_threads, lambda r: r["peak_bytes"] / 2**20)
PYTHON

gnuplot <<GNUPLOT
set terminal pngcairo size 1200,520 font "sans,11" background "white"
set grid xtics ytics lt 1 lc rgb "#dddddd"
set border 3
set tics nomirror
set logscale xy
set xlabel "triangles"
set format x "10^{%T}"
set style data linespoints
set pointsize 0.9
array colours[4] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7"]
bodies = "sphere ellipsoid torus cube"
solvers = "dense tree coarse"
file(what, name, last) = "$work/" . what . "-" . name . "-" . last . ".dat"

set output "$images/bench-charge-errors.png"
set format y "10^{%T}"
set key inside bottom left reverse Left
set multiplot layout 1,2
set xrange [700:1.5e6]
set yrange [2e-6:2e-2]
set title "relative error of the capacitance"
plot for [i=1:4] file("capacitance", word(bodies, i), "tree") lc rgb colours[i] pt 7 lw 2 title word(bodies, i), \
     for [i=1:4] file("capacitance", word(bodies, i), "coarse") lc rgb colours[i] pt 6 dt 2 notitle, \
     for [i=1:4] file("capacitance", word(bodies, i), "dense") with points lc rgb colours[i] pt 4 ps 1.6 notitle, \
     2 / x with lines lc rgb "#888888" dt 3 title "second order", \
     keyentry with linespoints lc rgb "black" pt 7 lw 2 title "tree", \
     keyentry with linespoints lc rgb "black" pt 6 dt 2 title "coarse", \
     keyentry with points lc rgb "black" pt 4 ps 1.6 title "dense"
set yrange [1e-4:3e-1]
set title "relative error of the densities, root of the mean square"
plot for [i=1:3] file("density", word(bodies, i), "tree") lc rgb colours[i] pt 7 lw 2 title word(bodies, i), \
     for [i=1:3] file("density", word(bodies, i), "coarse") lc rgb colours[i] pt 6 dt 2 notitle, \
     for [i=1:3] file("density", word(bodies, i), "dense") with points lc rgb colours[i] pt 4 ps 1.6 notitle, \
     0.8 / sqrt(x) with lines lc rgb "#888888" dt 3 title "first order", \
     keyentry with linespoints lc rgb "black" pt 7 lw 2 title "tree", \
     keyentry with linespoints lc rgb "black" pt 6 dt 2 title "coarse", \
     keyentry with points lc rgb "black" pt 4 ps 1.6 title "dense"
unset multiplot

set output "$images/bench-charge-times.png"
set key inside bottom right reverse Left
set multiplot layout 1,2
set xrange [1500:1.5e6]
set yrange [1e-2:1e3]
set title "seconds for the charge"
plot for [i=1:3] file("seconds", word(solvers, i), "1") lc rgb colours[i] pt 7 lw 2 title word(solvers, i), \
     for [i=1:3] file("seconds", word(solvers, i), "2") lc rgb colours[i] pt 6 dt 2 notitle, \
     1e-5 * x with lines lc rgb "#888888" dt 3 title "0.01 ms a triangle", \
     keyentry with linespoints lc rgb "black" pt 7 lw 2 title "one thread", \
     keyentry with linespoints lc rgb "black" pt 6 dt 2 title "two threads"
set yrange [1:1e4]
set title "greatest memory of the process in MiB"
plot for [i=1:3] file("peak", word(solvers, i), "1") lc rgb colours[i] pt 7 lw 2 title word(solvers, i), \
     x / 1024 with lines lc rgb "#888888" dt 3 title "1 KiB a triangle"
unset multiplot
GNUPLOT
echo "$images/bench-charge-errors.png, $images/bench-charge-times.png"
}

case $kind in
methods) draw_methods ;;
charge) draw_charge ;;
*) echo "plot.sh: $kind is neither methods nor charge" >&2; exit 2 ;;
esac
