#!/bin/sh
# Builds for another processor and runs test programs there under qemu-user, with Debian's libraries of that architecture:
# emulated.sh arm64|s390x all|rooms|quick|build|TEST..., where a TEST is room/test_name, and rooms are those of the readers and of the
# detector. `make test-aarch64` and `make test-s390x` call it. emulated.sh riscv64 all|quick|build runs no test programs: Debian has
# no libraries for that processor, so those of the tool are built from Debian's sources (`make test-riscv64`).
#
# Programs become scripts that start the emulator on them, so that tests start the tool and the models as they do elsewhere. Then
# the tool of this machine and the emulated one replay the same recordings and must write the same bytes. CSCD_DATA names a folder
# with more recordings. What does not run is listed with its reason in left_out.txt.
set -eu
cd "$(dirname "$0")/../.."

architecture=$1
shift
choices=''
case $architecture in
arm64) host=aarch64-linux-gnu emulator=qemu-aarch64 ;;
s390x) host=s390x-linux-gnu emulator=qemu-s390x ;;
riscv64) host=riscv64-linux-gnu emulator=qemu-riscv64 choices='BASELINES=0 EXPAT=1' ;;
*)
    echo "emulated.sh: $architecture is none of arm64, s390x and riscv64" >&2
    exit 2
    ;;
esac
unset MAKEFLAGS
case ${CC:-} in ccache*) cache='ccache ' ;; *) cache='' ;; esac
build=build/$host/release
if [ "$architecture" = riscv64 ]; then
    libraries=build/$host/libraries
    packaging/libraries.sh $host $libraries zlib libpng json-c expat
    sysroot=/usr/$host found=''
    choices="$choices CPPFLAGS=-I$libraries/include LDFLAGS=-L$libraries/lib"
else
    sysroot=$PWD/build/sysroot/$architecture found=" --sysroot=$PWD/build/sysroot/$architecture"
    packaging/sysroot.sh "$architecture" "$sysroot" libc6-dev libstdc++-12-dev libpng-dev zlib1g-dev libjson-c-dev libexpat1-dev \
        libgsl-dev liblapacke-dev libopenblas-dev libcmocka-dev libflint-dev libflint-arb-dev libgmp-dev
fi

# cross TARGET...: makes them for the other processor.
cross() {
    # shellcheck disable=SC2086
    make -j"$(nproc)" --no-print-directory HOST=$host SYSROOT="$sysroot" WERROR="${WERROR:-0}" $choices \
        CC="$cache$host-gcc$found" CXX="$host-g++$found" "$@"
}

# Makes programs into scripts that start the emulator; a program that is linked again is made into one again.
wrap() {
    for program in "$@"; do
        [ -f "$program" ] && [ "$(head -c 4 "$program" | tail -c 3)" = ELF ] || continue
        mv "$program" "$program.elf"
        printf '#!/bin/sh\nexec %s -L "%s" -0 "$0" "%s" "$@"\n' $emulator "$sysroot" "$PWD/$program.elf" >"$program"
        chmod +x "$program"
    done
}

# left_out ARCHITECTURE ROOM/TEST: its reason, empty when it runs.
left_out() {
    awk -v architecture="$1" -v name="$2" '$1 == name && ($2 == "*" || $2 == architecture) {
        $1 = $2 = ""; sub(/^ +/, ""); print; exit }' tests/cross/left_out.txt
}

if [ "$1" = build ]; then
    cross tool
    exit 0
fi

# ---- which tests

case $architecture:$1 in
riscv64:*) names='' ;;
*:all) names=$(ls tests/*/test_*.c tests/*/test_*.cpp tests/*/test_*.py | sed 's:^tests/::; s:\.[a-z]*$::') ;;
*:quick) names='core/test_simd ccd/test_describe_kernel ccd/test_proximity_kernel detector/test_invariance' ;;
*:rooms) names=$(ls tests/io/test_*.c tests/core/test_*.c tests/mesh/test_*.c tests/detector/test_*.c tests/proofs/test_*.c | sed 's:^tests/::; s:\.c$::') ;;
*) names=$* ;;
esac
programs=''
skipped=0
for name in $names; do
    reason=$(left_out "$architecture" "$name")
    if [ -n "$reason" ]; then
        echo "left out: $name: $reason"
        skipped=$((skipped + 1))
    else
        programs="$programs $build/tests/$name"
    fi
done

# ---- run

make --no-print-directory tool build/release/models/record build/release/models/shape build/release/models/mannequin
if [ "$1" = all ] && [ "$architecture" != riscv64 ]; then
    cross programs
else
    cross tool
fi
# shellcheck disable=SC2086
[ -z "$programs" ] || cross $programs
# shellcheck disable=SC2046,SC2086
wrap $build/cscd $(find $build/models $build/benchmarks -maxdepth 1 -type f -perm -u+x ! -name '*.*' 2>/dev/null) $programs
status=0
# shellcheck disable=SC2086
[ -z "$programs" ] || CSCD_EMULATED=1 CSCD_DATA='' BUILD=$build tests/run.sh $programs || status=1
[ "$skipped" = 0 ] || echo "$skipped programs left out, with reasons above"
tests/cross/same_bits.sh build/release/cscd $build/cscd build/release/models/record "$1" build/release || status=1
exit $status
