#!/bin/sh
# Runs the test programs that are its arguments and adds up their totals; `make test` calls it.
# BUILD is the build folder. CSCD_DATA names a folder with recordings to compare with (tests/io/check_recordings.py);
# when it is not set, nothing is compared. Ends non-zero when anything failed; its last line is `N passed, M failed`,
# and before it stand the SLOWEST programs (20) that took most processor time.
set -u
cd "$(dirname "$0")/.." || exit 1
: "${BUILD:?BUILD must name the build folder}"
BUILD=$(cd "$BUILD" && pwd) || exit 1
CSCD_TOOL=$BUILD/cscd
CSCD_MODELS=$BUILD/models
CSCD_QUERIES=$BUILD/benchmarks/queries
CSCD_METHODS=$BUILD/benchmarks/methods
CSCD_VOLUMES=$BUILD/benchmarks/volumes
export CSCD_TOOL CSCD_MODELS CSCD_QUERIES CSCD_METHODS CSCD_VOLUMES

[ $# -gt 0 ] || { echo 'run.sh: no test program is named, so nothing is tested (does ONLY name one?)' >&2; exit 1; }

logs=$(mktemp -d) || exit 1
trap 'rm -rf "$logs"' EXIT
passed=0
failed=0
failures=''

# A program is called by its room and its name, and its log alike. There are hundreds, so the shell does what it can itself.
name_of() { # name_of PROGRAM: sets name and log
    folder=${1%/*}
    name=${folder##*/}/${1##*/}
    log=$logs/${folder##*/}:${1##*/}
}

# add_up PROGRAM: shows what it printed, and counts the N of cmocka's last lines `[  PASSED  ] N test(s)` and `[  FAILED  ] N test(s)`.
add_up() {
    name_of "$1"
    cat "$log"
    read -r status <"$log.status"
    totals=$(awk '/^\[  (PASSED|FAILED)  \] (.*: )?[0-9]+ test\(s\)/ {
            sub(/ test\(s\).*/, "")
            total[$2] = $NF
        }
        END {print total["PASSED"] "/" total["FAILED"]}' "$log")
    good=${totals%/*} bad=${totals#*/}
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
}

# As many at a time as there are processors; shown in order, each as soon as it and those before it have ended.
{
    printf '%s\n' "$@" | xargs -P "${JOBS:-$(nproc)}" -I PROGRAM sh -c '
    case $1 in /*) program=$1 ;; *) program=./$1 ;; esac
    folder=${1%/*}
    log=$2/${folder##*/}:${1##*/}
    read -r started _ </proc/uptime
    "$program" >"$log" 2>&1
    echo "$?" >"$log.part"
    read -r ended _ </proc/uptime
    { echo "${folder##*/}/${1##*/} $started $ended" && times; } >"$log.seconds"
    mv "$log.part" "$log.status"' sh PROGRAM "$logs"
    : >"$logs/.all"
} &
for program in "$@"; do
    name_of "$program"
    while [ ! -e "$log.status" ] && [ ! -e "$logs/.all" ]; do sleep 0.1; done
    [ -e "$log.status" ] || { echo unknown >"$log.status" && : >>"$log"; }
    add_up "$program"
done
wait

configuration=$(basename "$BUILD")
if [ -z "${CSCD_DATA:-}" ]; then
    echo 'recordings to compare with: CSCD_DATA is not set, nothing to compare'
elif [ "$configuration" = sanitize ] || [ "$configuration" = tsan ]; then
    echo 'recordings to compare with: left to the other configurations, too slow in this one'
elif ! python3 tests/io/check_recordings.py "$CSCD_DATA"; then
    failed=$((failed + 1))
    failures="$failures check_recordings.py"
fi

# Behind a program and its two moments, the second line of `times` is of it and all that it started: user and system, as `0m1.23s 0m0.05s`.
echo 'slowest, in seconds of processor time, and seconds that passed:'
cat "$logs"/*.seconds 2>/dev/null | awk -F '[ms ]+' 'NR % 3 == 1 {split($0, moments, " ")}
    NR % 3 == 0 {printf "%8.1f %8.1f  %s\n", 60 * ($1 + $3) + $2 + $4, moments[3] - moments[2], moments[1]}' |
    sort -rn | head -"${SLOWEST:-20}"

[ -z "$failures" ] || echo "failed:$failures"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
