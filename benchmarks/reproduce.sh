#!/bin/sh
# The tables and figures of both theses, from our recordings, in build/reproduce: `make reproduce`, five minutes on two processors.
set -eu
cd "$(dirname "$0")/.."
build=$1
out=build/reproduce
mkdir -p "$out" build/models
begun=$(date +%s)

# Says what is made, and how long it took.
step() {
    since=$(date +%s)
    name=$1
    shift
    echo "== $name"
    "$@"
    echo "   $(($(date +%s) - since)) s"
}

tables() {
    "$build/benchmarks/thesis" >"$out/chapters-5-and-6.txt"
}

volumes() {
    "$build/benchmarks/volumes" --quick >"$out/volumes.txt"
}

sphere() {
    "$build/benchmarks/experiments" >"$out/sphere-and-stability.txt"
}

sensors() {
    "$build/benchmarks/sensors" >"$out/sensors.txt"
}

# A picture of each plan. With its frames a mesh is drawn without detector points, which the steps of a cut do not have.
draw_plan() {
    plan=$1
    name=$(basename "$plan" .plan.ply)
    mesh=${name%%-[367].*}
    mesh=${mesh%-6-*}
    by=region
    case $name in *density) by=density ;; esac
    if [ "$mesh" = torus ]; then set -- "$plan"; else set -- "build/models/$mesh.obj" "build/models/$mesh.pc2" --frame 0; fi
    ./cscd render "$@" --plan "$plan" --colour "$by" --size 480x480 --no-text --up z --view 30,5 -o "$out/$name.png" >/dev/null
}

# Figure 3.4 of three meshes as one picture, a row for each; docs/images/thesis-cuts.png is a copy of it.
join_steps() {
    for mesh in pawn-drop dumbbell-stairs figure-balls; do
        for picture in "$out/$mesh"-3.4[a-f]-*.png; do
            pngtopnm "$picture" | pamscale -xsize 240 -ysize 240 >"${picture%.png}.ppm"
        done
        pnmcat -leftright "$out/$mesh"-3.4[a-f]-*.ppm >"$out/$mesh.ppm"
    done
    pnmcat -topbottom "$out/pawn-drop.ppm" "$out/dumbbell-stairs.ppm" "$out/figure-balls.ppm" | pnmtopng >"$out/figure-3.4.png"
    rm "$out"/*.ppm
}

figures() {
    "$build/benchmarks/thesis_figures" "$out"
    for plan in "$out"/*.plan.ply; do draw_plan "$plan"; done
    for mesh in pawn-drop dumbbell-stairs figure-balls; do
        ./cscd render "build/models/$mesh.obj" "build/models/$mesh.pc2" --frame 0 --size 480x480 --no-text --up z --view 30,5 \
            -o "$out/$mesh-3.4a-model.png" >/dev/null
        ./cscd render "build/models/$mesh.obj" "build/models/$mesh.pc2" --frames 0:145:29 --columns 6 --up z \
            --colour contacts -o "$out/$mesh-5.5-frames.png" >/dev/null
    done
    join_steps
}

step 'figures 5.2 to 5.4 and 6.4, thresholds, rules (thesis)' tables
step 'k-DOPs (section 5.3)' volumes
step 'the sphere, the stability of K-means (section 6.1)' sphere
step 'figures 3.2, 3.4, 5.5, 6.1 to 6.3, 7.1' figures
[ ! -x "$build/benchmarks/sensors" ] || step 'the second thesis: particle sensors' sensors
cat "$out"/*.txt
echo "$(ls "$out"/*.png | wc -l) pictures and $(ls "$out"/*.txt | wc -l) tables are in $out; $(($(date +%s) - begun)) s"
