#!/bin/sh
# Removes runtime/baselines and preprocess/baselines, and the lines elsewhere that are marked as theirs, from a copy of the sources.
# Builds library and tool from what is left and runs the tests that use methods; `make test-without-baselines` calls it.
set -eu
cd "$(dirname "$0")/.."
copy=build/without-baselines
started=$(date +%s)

rm -rf "$copy"
mkdir -p "$copy"
git ls-files -co --exclude-standard Makefile include src preprocess runtime sensors tool packaging models benchmarks tests |
    tar -cf - --ignore-failed-read -T - | tar -xf - -C "$copy"
cd "$copy"
marked='runtime/detector/method_table.c preprocess/plan_draft.c preprocess/charges.c'
for file in $marked; do
    [ "$(grep -c 'baselines: begin' $file)" = "$(grep -c 'baselines: end' $file)" ] && grep -q 'baselines: begin' $file ||
        { echo "$0: $file has nothing to remove" >&2; exit 1; }
    sed -i '/baselines: begin/,/baselines: end/d' $file
done
rm -r runtime/baselines preprocess/baselines

# A compiler that remembers gives what make test has compiled. Others optimise a little, without symbols: the quickest to build and run.
case ${CC:-} in
*ccache*) flags='' ;;
*) flags='-O1 -g0' ;;
esac
tests=''
for name in bvh/test_bulk_motion core/test_progress culling/test_culling_traps \
    culling/test_region_points detector/test_detector detector/test_oracle proofs/test_steps proofs/test_solver_calls \
    solver/test_line_search solver/test_max_step solver/test_proximity; do
    tests="$tests build/release/tests/$name"
done
make -s -j"$(nproc)" tool library $tests CFLAGS="$flags"
# Recordings are compared by `make test`, and one comparison is with ICCD.
unset CSCD_DATA
BUILD=build/release tests/run.sh $tests
echo "without baselines: $(($(date +%s) - started)) s"
