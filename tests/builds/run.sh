#!/bin/sh
# Builds and installs in the ways that users ask for, each in a copy of the sources: `make test-builds` calls it, as root, since one
# build runs as the user nobody. In each the tool answers a check of a small mesh, and a caller is compiled against the installed
# library and runs. FOLDER takes the copies.
set -eu
folder=${1:?usage: tests/builds/run.sh FOLDER}
cd "$(dirname "$0")/../.."
[ "$(id -u)" = 0 ] || {
    echo 'test-builds: one build runs as nobody; run this as root' >&2
    exit 1
}
unset MAKEFLAGS MAKELEVEL MAKEOVERRIDES MFLAGS CC CFLAGS CPPFLAGS LDFLAGS
sources=$(pwd)
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
passed=0
failed=0

copy_sources() { # copy_sources FOLDER
    rm -rf "$1"
    mkdir -p "$1"
    (cd "$sources" && git ls-files -co --exclude-standard | tar -cf - --ignore-failed-read -T - 2>/dev/null) | tar -xf - -C "$1"
}

# Headers of what a build does without: to include one is an error.
forbid() { # forbid FOLDER HEADER...
    place=$1
    shift
    for header; do
        mkdir -p "$place/$(dirname "$header")"
        echo "#error this build does without $header" >"$place/$header"
    done
}

# answers TREE: the tool that is installed in TREE/stage finds what crosses, and nothing where nothing does.
expected=$(cat tests/builds/crossing.txt)
answers() {
    found=$(LD_LIBRARY_PATH="$1/stage/lib" "$1/stage/bin/cscd" check "$1/tests/builds/crossing.obj" | head -1)
    [ "$found" = "$expected" ] || { echo "the tool says: $found" && return 1; }
    found=$(LD_LIBRARY_PATH="$1/stage/lib" "$1/stage/bin/cscd" check "$1/tests/builds/apart.obj" | head -1)
    case $found in 'Clean: '*) ;; *) echo "the tool says: $found" && return 1 ;; esac
}

# calls TREE COMPILER...: a caller of what is installed runs, with the shared library and with the static one.
calls() {
    tree=$1
    shift
    for form in '' --static; do
        rm -f "$tree/client"
        (
            export PKG_CONFIG_PATH="$tree/stage/lib/pkgconfig"
            flags=$(pkg-config --cflags --libs $form cscd)
            [ -z "$form" ] || flags=$(echo "$flags" | sed 's/-lcscd/-l:libcscd.a/')
            # The flags are quoted as a shell reads them: folders may have blanks.
            eval "$* -std=c99 \"\$tree/tests/install/charge_client.c\" $flags -o \"\$tree/client\"" &&
                LD_LIBRARY_PATH=$tree/stage/lib "$tree/client"
        ) >"$tree/printed.txt" || return 1
        grep -q "^from parts: charge 0x1p+0\$" "$tree/printed.txt" && grep -q '^by a tree: charge 0x1' "$tree/printed.txt" || return 1
        case $(head -1 "$tree/printed.txt") in
        'solved: charge 0x1.'*) [ "$baselines" = 1 ] ;;
        *) [ "$baselines" = 0 ] ;;
        esac || { cat "$tree/printed.txt" && return 1; }
    done
}

# Neither tool nor library need what is for libcscd-baselines alone, nor the libraries that are named in $without.
needs_not() {
    needed=$(for file in "$1"/stage/bin/cscd "$1"/stage/lib/libcscd.so; do readelf -d "$file"; done | grep NEEDED)
    case $needed in *'[libc.so'*) ;; *) echo 'what the build needs is unknown' && return 1 ;; esac
    for library in gsl gslcblas lapacke openblas $without; do
        case $needed in *"[lib$library."*) echo "the build needs $library" && return 1 ;; esac
    done
}

build_tree() { # build_tree TREE VARIABLE...: builds and installs, by the user that $user names
    tree=$1
    shift
    as_user=''
    if [ "$user" != root ]; then
        chown -R "$user" "$tree"
        as_user="setpriv --reuid=$user --regid=nogroup --clear-groups env HOME=/nonexistent"
    fi
    (cd "$tree" && $as_user make -s "$jobs" tool library "$@" && $as_user make -s install PREFIX="$tree/stage" "$@")
}

# try NAME VARIABLE...: by the settings $user, $jobs, $compiler, $without and $baselines, which are the usual ones after it.
try() {
    name=$1
    shift
    tree=$folder/$name
    copy_sources "$tree"
    started=$(date +%s)
    if { build_tree "$tree" "$@" && answers "$tree" && calls "$tree" $compiler && needs_not "$tree" && extra "$tree"; } >"$folder/log" 2>&1; then
        echo "passed: $name ($(($(date +%s) - started)) s)"
        passed=$((passed + 1))
        rm -rf "$tree"
    else
        tail -20 "$folder/log"
        echo "failed: $name"
        failed=$((failed + 1))
    fi
    usual
}
usual() {
    user=root jobs=-j$(nproc) compiler=gcc without='' baselines=1
    extra() { :; }
}
usual

jobs=-j8
try 'a folder with blanks, and -j8'
# A folder that others may enter, unlike perhaps the checkout's.
kept=$folder
folder=$(mktemp -d)
trap 'rm -rf "$kept/traps" "$folder"' EXIT
chmod 755 "$folder"
user=nobody
try 'as nobody'
folder=$kept
try 'optimised for size' CFLAGS=-Os
compiler=clang
try clang CC=clang
compiler='gcc -flto -O2'
extra() {
    ! readelf -SW "$1/stage/lib/libcscd.a" | grep -q gnu.lto
}
try 'link-time optimisation' CFLAGS='-flto -O2' LDFLAGS=-flto

traps=$folder/traps
rm -rf "$traps"
forbid "$traps/baselines" lapacke.h cblas.h gsl/gsl_poly.h
forbid "$traps/expat" expat.h
cp -r "$traps/baselines" "$traps/all"
cp -r "$traps/expat/." "$traps/all"
baselines=0
try 'without libcscd-baselines' BASELINES=0 CPPFLAGS="-I'$traps/baselines'"
without=expat
try 'without expat' EXPAT=0 CPPFLAGS="-I'$traps/expat'"
without=expat baselines=0
try 'without both' BASELINES=0 EXPAT=0 CPPFLAGS="-I'$traps/all'"
try 'for distributions' DYNAMIC=1

# Other arithmetic is refused with a sentence, before anything is compiled.
tree=$folder/other-arithmetic
copy_sources "$tree"
if (cd "$tree" && make -s tool CFLAGS=-Ofast) >"$folder/log" 2>&1; then refused=no; else refused=yes; fi
if [ "$refused" = yes ] && grep -q 'IEEE arithmetic: leave out -Ofast; -O3 is the default' "$folder/log" && [ ! -e "$tree/build" ]; then
    echo 'passed: -Ofast is refused'
    passed=$((passed + 1))
    rm -rf "$tree"
else
    cat "$folder/log"
    echo 'failed: -Ofast is refused'
    failed=$((failed + 1))
fi
rm -f "$folder/log"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
