#!/bin/sh
# Removes from a copy of the sources what there is to compare with (tests/without.sh baselines), or the particle sensors and what is
# theirs (tests/without.sh sensors). Builds library and tool from what is left and runs tests that would miss it;
# `make test-without-baselines` and `make test-without-sensors` call it.
set -eu
cd "$(dirname "$0")/.."
what=$1
copy=build/without-$what
started=$(date +%s)

rm -rf "$copy"
mkdir -p "$copy"
git ls-files -co --exclude-standard Makefile include src preprocess runtime sensors tool packaging models benchmarks tests |
    tar -cf - --ignore-failed-read -T - | tar -xf - -C "$copy"
cd "$copy"

# The lines elsewhere that are marked as theirs go, too.
remove_marked() {
    for file in "$@"; do
        [ "$(grep -c 'baselines: begin' "$file")" = "$(grep -c 'baselines: end' "$file")" ] && grep -q 'baselines: begin' "$file" ||
            { echo "$0: $file has nothing to remove" >&2; exit 1; }
        sed -i '/baselines: begin/,/baselines: end/d' "$file"
    done
}

case $what in
baselines)
    remove_marked runtime/detector/method_table.c preprocess/plan_draft.c preprocess/charges.c
    rm -r runtime/baselines preprocess/baselines
    names='bvh/test_bulk_motion core/test_progress culling/test_culling_traps culling/test_region_points detector/test_detector
        detector/test_oracle proofs/test_steps proofs/test_solver_calls solver/test_line_search solver/test_max_step
        solver/test_proximity'
    ;;
sensors)
    rm -r sensors include/cscd/sensors.h include/cscd/sensors.hpp benchmarks/sensors.c benchmarks/sensors tests/sensors \
        tests/support/sensors tests/mutants/sensors.txt tests/mutants/sensors
    ! grep -rn 'include [<"].*sensors' include src preprocess runtime tool models benchmarks tests --include='*.[ch]*' \
        --exclude-dir=install || # whose tests look at all that is installed
        { echo "$0: the lines above need what was removed" >&2; exit 1; }
    names='core/test_contexts detector/test_lifetimes detector/test_reentry mesh/test_loose_objects proofs/test_others'
    ;;
esac

# A compiler that remembers gives what make test has compiled. Others optimise a little, without symbols: the quickest to build and run.
case ${CC:-} in
*ccache*) flags='' ;;
*) flags='-O1 -g0' ;;
esac
tests=''
for name in $names; do tests="$tests build/release/tests/$name"; done
make -s -j"$(nproc)" tool library $tests CFLAGS="$flags"
# Recordings are compared by `make test`, and one comparison is with ICCD.
unset CSCD_DATA
BUILD=build/release tests/run.sh $tests
if [ "$what" = sensors ] && build/release/cscd --help | grep -q sense; then
    echo "$0: the tool still has the command sense" >&2
    exit 1
fi
echo "without $what: $(($(date +%s) - started)) s"
