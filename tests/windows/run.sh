#!/bin/sh
# Runs the test programs that are its arguments, built for Windows, under wine, and adds up their totals; `make test-windows` calls it. Files of
# pytest run here, and the tool that they start runs under wine.
# BUILD is the build folder, ANSWERS the file that a Linux run wrote, NATIVE the build folder of Linux, ARCHIVE what is given away, LIMIT the
# seconds that one program may take. Says how many programs ran, and of each that did not, why: tests/windows/left_out.txt. Ends
# non-zero when anything failed; its last line is `N passed, M failed`.
set -u
cd "$(dirname "$0")/../.." || exit 1
: "${BUILD:?BUILD must name the build folder}"
BUILD=$(cd "$BUILD" && pwd) || exit 1
WINE=${WINE:-$(command -v wine64 || echo /usr/lib/wine/wine64)}
LIMIT=${LIMIT:-120}
SERVER=${WINESERVER:-$(command -v wineserver64 || echo /usr/lib/wine/wineserver64)}
[ -x "$WINE" ] || { echo 'run.sh: there is no wine64 (Debian: wine64)' >&2; exit 1; }
logs=$(mktemp -d) || exit 1

# A prefix of its own, without the windows and menus that a new one asks for; it is short, as sockets want it.
WINEPREFIX=$BUILD/wine
WINEDEBUG=-all
WINEDLLOVERRIDES='winemenubuilder.exe,mscoree,mshtml='
CSCD_TOOL=$BUILD/cscd.exe
CSCD_MODELS=$BUILD/models
TMPDIR=$logs/files
CSCD_ANSWERS=${ANSWERS:-}
export WINE LIMIT WINEPREFIX WINEDEBUG WINEDLLOVERRIDES CSCD_TOOL CSCD_MODELS TMPDIR CSCD_ANSWERS
mkdir -p "$TMPDIR" "$WINEPREFIX"
trap '"$SERVER" -k 2>/dev/null; rm -rf "$logs"' EXIT
"$SERVER" -p
"$WINE" wineboot -i >/dev/null 2>&1 || "$WINE" cmd /c exit >/dev/null 2>&1

passed=0 failed=0 ran=0 known_sum=0 failures='' late=''
total() { # total WORD LOG: the N of cmocka's line `[  WORD  ] N test(s)`
    tr -d '\r' <"$2" | sed -n "s/^\[  $1  \] \(.*: \)\{0,1\}\([0-9][0-9]*\) test(s).*/\2/p" | tail -1
}
add_up() {
    name=$(echo "$1" | sed 's:.*/\([^/]*/[^/]*\)$:\1:')
    log=$logs/$(echo "$1" | tr / :)
    status=$(cat "$log.status")
    good=$(total PASSED "$log")
    bad=$(total FAILED "$log")
    known=0 surprises=0
    [ -z "$good$bad" ] || count_known "$name" "$log"
    if [ -z "$good$bad" ] || { [ "$status" != 0 ] && [ "${bad:-0}" = 0 ]; }; then
        if [ "$status" = 124 ] || [ "$status" = 137 ]; then
            echo "$name: ran out of time, which is $LIMIT seconds"
            late="$late $name"
        else
            echo "$name: ended with status $status"
        fi
        bad=1
    fi
    passed=$((passed + ${good:-0} - surprises))
    bad=$((${bad:-0} - known + surprises))
    failed=$((failed + bad))
    ran=$((ran + 1))
    [ "$bad" = 0 ] || { failures="$failures $name"; grep -aE 'ERROR|error|FAILED|\.c:[0-9]|exit code|std(out|err):|Unhandled|rip:' "$log" | head -20; }
}

# count_known NAME LOG: of the tests that are known to fail, how many did, and how many surprise by passing.
count_known() {
    listed=$(tr -d "\r" <"$2" | sed "1,/listed below:/d")
    for test in $(sed -n "s|^tests/$1\.[a-z]* \([^:]*\): .*|\1|p" tests/windows/left_out.txt); do
        times=$(echo "$listed" | grep -c "^\[  FAILED  \] $test\$") # once for each of its parameters
        if [ "$times" -gt 0 ]; then
            known=$((known + times))
        else
            surprises=$((surprises + 1))
            echo "$1: $test is known to fail, and did not: take it out of tests/windows/left_out.txt"
        fi
    done
    known_sum=$((known_sum + known))
}

# run_script NAME SENTENCE ARGUMENTS...: a script of this folder that is a test of its own; the sentence is said when it passes.
run_script() {
    script=tests/windows/$1 shown=$2
    shift 2
    if "$script" "$@"; then
        passed=$((passed + 1))
        echo "$shown"
    else
        failed=$((failed + 1))
        failures="$failures ${script#tests/}"
    fi
}

printf '%s\n' "$@" | xargs -P "${JOBS:-$(nproc)}" -I PROGRAM sh -c '
    log=$2/$(echo "$1" | tr / :)
    began=$(date +%s)
    case $(readlink "$1") in
    *.py) CSCD_RUNNER=$WINE timeout -k 5 "$LIMIT" "$1" >"$log" 2>&1 ;;
    *) timeout -k 5 "$LIMIT" "$WINE" "$1" >"$log" 2>&1 ;;
    esac
    echo "$?" >"$log.status"
    printf "%8d  %s\n" "$(($(date +%s) - began))" "${1#*/tests/}" >>"$2/seconds"' sh PROGRAM "$logs"
for program in "$@"; do add_up "$program"; done

if [ -n "${NATIVE:-}" ]; then
    run_script plans.sh 'plans have the bytes that they have on Linux' "$NATIVE" "$logs/plans"
fi
if [ -n "${ARCHIVE:-}" ]; then
    run_script archive.sh 'the archive runs from another folder' "$ARCHIVE" "$logs/archive"
fi

echo 'slowest, in seconds:'
sort -rn "$logs/seconds" | head -10
left=$(grep -c '^tests/[^: ]*:' tests/windows/left_out.txt)
echo "$ran programs ran under $("$WINE" --version), with $known_sum tests that are known to fail:"
sed -n 's/^tests\/\([^: ]* [^:]*:\)/  \1/p' tests/windows/left_out.txt
echo "$left programs did not run:"
sed -n 's/^tests\/\([^: ]*:\)/  \1/p' tests/windows/left_out.txt
[ -z "$late" ] || echo "ran out of time:$late"
[ -z "$failures" ] || echo "failed:$failures"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
