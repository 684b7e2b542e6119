#!/bin/sh
# Runs the test programs that are its arguments and adds up their totals; `make test` calls it.
# BUILD is the build folder. Ends non-zero when anything failed; its last line is `N passed, M failed`.
set -u
cd "$(dirname "$0")/.." || exit 1
: "${BUILD:?BUILD must name the build folder}"
BUILD=$(cd "$BUILD" && pwd) || exit 1
CSCD_TOOL=$BUILD/cscd
CSCD_MODELS=$BUILD/models
CSCD_QUERIES=$BUILD/benchmarks/queries
CSCD_METHODS=$BUILD/benchmarks/methods
export CSCD_TOOL CSCD_MODELS CSCD_QUERIES CSCD_METHODS

log=$(mktemp) || exit 1
trap 'rm -f "$log"' EXIT
passed=0
failed=0
failures=''

# total WORD: the N of cmocka's line `[  WORD  ] N test(s)`, empty when there is none.
total() {
    sed -n "s/^\[  $1  \] \(.*: \)\{0,1\}\([0-9][0-9]*\) test(s).*/\2/p" "$log" | tail -1
}

for program in "$@"; do
    name=$(basename "$program")
    case $program in
    /*) ;;
    *) program=./$program ;;
    esac
    "$program" >"$log" 2>&1
    status=$?
    cat "$log"
    good=$(total PASSED)
    bad=$(total FAILED)
    if [ -z "$good$bad" ]; then
        echo "$name: ended with status $status and printed no totals"
        bad=1
    elif [ "$status" != 0 ] && [ "${bad:-0}" = 0 ]; then
        echo "$name: ended with status $status"
        bad=1
    fi
    passed=$((passed + ${good:-0}))
    failed=$((failed + ${bad:-0}))
    [ "${bad:-0}" = 0 ] || failures="$failures $name"
done

configuration=$(basename "$BUILD")
if [ "$configuration" = sanitize ] || [ "$configuration" = tsan ]; then
    echo 'data to develop against: compared by the other configurations, too slow in this one'
elif [ -d ../shared/data ] && [ -f tests/check_shared.py ]; then
    echo 'data to develop against: found, comparing'
    if ! python3 tests/check_shared.py ../shared/data; then
        failed=$((failed + 1))
        failures="$failures check_shared.py"
    fi
else
    echo 'data to develop against: absent, nothing to compare'
fi

[ -z "$failures" ] || echo "failed:$failures"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
