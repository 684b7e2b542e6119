#!/bin/sh
# Tests the wheels of all platforms: tests/wheels/run.sh FOLDER, where they are; `make test-wheels` calls it. Its last line is
# `N passed, M failed`.
#
# Their contents by contents.py. Of aarch64: the tests of the package, by Debian's Python of that architecture with its numpy, under
# qemu-user. Of Windows: the DLL under wine, loaded as Python does, which must give the bits of the wheel of this machine; Windows'
# Python is not run.
set -u
cd "$(dirname "$0")/../.." || exit 1
wheels=$(cd "${1:?usage: tests/wheels/run.sh FOLDER}" && pwd) || exit 1
version=$(sed -n 's/^#define CSCD_VERSION_[A-Z]* \([0-9]*\)$/\1/p' include/cscd/cscd.h | paste -sd .)
folder=$(mktemp -d) || exit 1
WINE=${WINE:-$(command -v wine64 || echo /usr/lib/wine/wine64)}
SERVER=${WINESERVER:-$(command -v wineserver64 || echo /usr/lib/wine/wineserver64)}
trap '"$SERVER" -k 2>/dev/null; rm -rf "$folder"' EXIT
case ${CC:-} in ccache*) cache='ccache ' ;; *) cache='' ;; esac
unset MAKEFLAGS
passed=0
failed=0
# count LOG: adds the totals of its last line.
count() {
    totals=$(tail -1 "$1" | sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p')
    set -- ${totals:-0 1}
    passed=$((passed + $1))
    failed=$((failed + $2))
}
# check NAME COMMAND...: one test, whose output is shown when it fails.
check() {
    name=$1
    shift
    if "$@" >"$folder/log" 2>&1; then
        passed=$((passed + 1))
    else
        cat "$folder/log"
        echo "failed: $name"
        failed=$((failed + 1))
    fi
}
wheel_of() { echo "$wheels/cscd-$version-py3-none-$1.whl"; }
for tag in linux_x86_64 linux_aarch64 win_amd64; do
    mkdir "$folder/$tag"
    check "the wheel $tag unpacks" python3 -m zipfile -e "$(wheel_of $tag)" "$folder/$tag"
done

# ---- what is in them

tests/wheels/contents.py "$(wheel_of linux_x86_64)" "$(wheel_of linux_aarch64)" "$(wheel_of win_amd64)" >"$folder/contents" 2>&1
cat "$folder/contents"
count "$folder/contents"

# ---- aarch64, by its own Python

sysroot=$PWD/build/sysroot/arm64-python
packaging/sysroot.sh arm64 "$sysroot" libc6-dev libstdc++-12-dev libpng-dev zlib1g-dev libjson-c-dev libexpat1-dev \
    libgsl-dev liblapacke-dev libopenblas-dev libcmocka-dev libflint-dev libflint-arb-dev libgmp-dev python3 python3-numpy \
    python3-pytest || exit 1
build=build/aarch64-linux-gnu/release
emulate() { # emulate PROGRAM: a script that starts the emulator takes its place
    [ "$(head -c 4 "$1" | tail -c 3)" = ELF ] || return 0
    mv "$1" "$1.elf"
    printf '#!/bin/sh\nexec qemu-aarch64 -L "%s" -0 "$0" "%s.elf" "$@"\n' "$sysroot" "$1" >"$1"
    chmod +x "$1"
}
python=$sysroot/usr/bin/python3.11
emulate "$python"
make -j"$(nproc)" --no-print-directory HOST=aarch64-linux-gnu SYSROOT="$sysroot" CC="${cache}aarch64-linux-gnu-gcc --sysroot=$sysroot" \
    CXX="aarch64-linux-gnu-g++ --sysroot=$sysroot" python-oracle $build/models/mannequin >"$folder/log" 2>&1 || {
    tail -20 "$folder/log"
    exit 1
}
emulate "$PWD/$build/models/mannequin"
PYTHONPATH=$folder/linux_aarch64 PYTHONDONTWRITEBYTECODE=1 BUILD=$build "$python" tests/wheels/python_tests.py >"$folder/python"
cat "$folder/python"
count "$folder/python"

# ---- the DLL

/usr/bin/python3 -c 'import runpy
print(*runpy.run_path("python/cscd/_prototypes.py")["PROTOTYPES"], *runpy.run_path("python/cscd/_api.py")["FUNCTIONS"], sep="\n")' >"$folder/names"
check 'the caller compiles' ${cache}gcc -Iinclude -o "$folder/call_library" tests/wheels/call_library.c -ldl
check 'the caller compiles for Windows' ${cache}x86_64-w64-mingw32-gcc-posix -D__USE_MINGW_ANSI_STDIO=1 -Iinclude \
    -o "$folder/call_library.exe" tests/wheels/call_library.c
WINEPREFIX=$folder/wine
WINEDEBUG=-all
WINEDLLOVERRIDES='winemenubuilder.exe,mscoree,mshtml='
export WINEPREFIX WINEDEBUG WINEDLLOVERRIDES
mkdir "$WINEPREFIX"
"$SERVER" -p
"$WINE" wineboot -i >/dev/null 2>&1 || "$WINE" cmd /c exit >/dev/null 2>&1
# both NAME ARGUMENT...: the same output, byte for byte, and the same exit code.
both() {
    name=$1
    shift
    "$folder/call_library" "$folder/linux_x86_64/cscd/libcscd-python.so" "$folder/names" "$@" >"$folder/here" 2>"$folder/errors"
    expected=$?
    timeout 300 "$WINE" "$folder/call_library.exe" "$folder/win_amd64/cscd/libcscd-python.dll" "$folder/names" "$@" \
        >"$folder/there" 2>>"$folder/errors"
    status=$?
    check "$name: exit code $status, and here $expected: $(cat "$folder/errors")" test "$status" = "$expected"
    check "$name: the same bytes" cmp "$folder/here" "$folder/there"
}
both 'contacts of two sheets'
check 'there are contacts' grep -qE '^[1-9][0-9]{2,} contacts' "$folder/here"
both 'the tool says its version' --version
both 'the tool refuses' check --no-such-option
cp tests/builds/*.obj "$folder"
both 'the tool checks' check "$folder/crossing.obj"
both 'the tool checks in JSON' check --json - "$folder/apart.obj"

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
