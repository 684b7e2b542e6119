#!/bin/sh
# Builds the libraries that the tool and the tests need on Windows (libpng, json-c, expat, cmocka) from Debian's source packages, as
# archives in build/windows/libraries; zlib is Debian's libz-mingw-w64-dev. Fetches only what is missing, with lists of apt's own in
# the build folder, so that the machine's sources stay as they are. Needs cmake and the compiler of `make windows`.
set -eu
cd "$(dirname "$0")/../../.."
compiler=x86_64-w64-mingw32-gcc-posix # not CC, which is the compiler of this machine
root=$(pwd)/${1:-build/windows/libraries}
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
mkdir -p "$root/apt/parts" "$root/apt/lists/partial" "$root/apt/cache" "$root/sources" "$root/logs"

tell_apt() {
    apt-get -qq -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$root/apt/parts" -o Dir::State::lists="$root/apt/lists" \
        -o Dir::Cache="$root/apt/cache" -o APT::Sandbox::User=root "$@"
}

# The mirror is the one of the machine's own sources.
read_lists() {
    [ ! -e "$root/apt/read" ] || return 0
    mirror=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/*.sources /etc/apt/sources.list.d/*.list 2>/dev/null |
        grep -oE 'https?://[^ ]*/debian/?( |$)' | head -1 | tr -d ' ')
    printf 'Types: deb-src\nURIs: %s\nSuites: %s\nComponents: main\nSigned-By: /usr/share/keyrings/debian-archive-keyring.gpg\n' \
        "${mirror:-http://deb.debian.org/debian}" "$suite" >"$root/apt/parts/debian.sources"
    tell_apt update
    touch "$root/apt/read"
}

# fetch PACKAGE: its patched sources become sources/PACKAGE.
fetch() {
    [ ! -d "$root/sources/$1" ] || return 0
    read_lists
    rm -rf "$root/sources/$1.part"
    mkdir "$root/sources/$1.part"
    (cd "$root/sources/$1.part" && tell_apt source "$1" >"$root/logs/$1.fetch" 2>&1) || fail "$1" fetch
    mv "$root/sources/$1.part"/*/ "$root/sources/$1"
    rm -rf "$root/sources/$1.part"
}

fail() {
    tail -30 "$root/logs/$1.$2" >&2
    echo "libraries.sh: cannot $2 $1; the end of build/windows/libraries/logs/$1.$2 stands above" >&2
    exit 1
}

# build PACKAGE ARCHIVE FOLDER OPTION...: installs it into the root, unless its archive is there.
build() {
    package=$1 archive=$2 folder=$3
    shift 3
    [ ! -e "$root/lib/$archive" ] || return 0
    echo "  $package for Windows"
    fetch "$package"
    {
        cmake -S "$root/sources/$package/$folder" -B "$root/sources/$package.build" -Wno-dev -DCMAKE_SYSTEM_NAME=Windows \
            -DCMAKE_SYSTEM_PROCESSOR=x86_64 -DCMAKE_C_COMPILER="$compiler" -DCMAKE_CXX_COMPILER="${compiler%gcc*}g++${compiler##*gcc}" \
            -DCMAKE_RC_COMPILER="${compiler%gcc*}windres" \
            -DCMAKE_FIND_ROOT_PATH="$root;/usr/x86_64-w64-mingw32" -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER \
            -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY -DCMAKE_BUILD_TYPE=Release \
            -DCMAKE_INSTALL_PREFIX="$root" -DCMAKE_INSTALL_LIBDIR=lib -DBUILD_SHARED_LIBS=OFF "$@" &&
            cmake --build "$root/sources/$package.build" -j"$(nproc)" &&
            cmake --install "$root/sources/$package.build"
    } >"$root/logs/$package.build" 2>&1 || fail "$package" build
    [ -e "$root/lib/$archive" ] || fail "$package" build
}

build libpng1.6 libpng16.a . -DPNG_SHARED=OFF -DPNG_STATIC=ON -DPNG_TESTS=OFF -DPNG_EXECUTABLES=OFF -DPNG_HARDWARE_OPTIMIZATIONS=OFF
build json-c libjson-c.a . -DBUILD_STATIC_LIBS=ON -DBUILD_TESTING=OFF -DBUILD_APPS=OFF -DDISABLE_WERROR=ON -DENABLE_THREADING=OFF
# The compiler is told XML_DTD without a value by this version's CMake files, and its sources compare it with 1.
[ -e "$root/lib/libexpat.a" ] || {
    fetch expat
    sed -i 's/^#cmakedefine XML_DTD.*/#define XML_DTD 1/' "$root/sources/expat/expat/expat_config.h.cmake"
}
build expat libexpat.a expat -DEXPAT_SHARED_LIBS=OFF -DEXPAT_BUILD_TOOLS=OFF -DEXPAT_BUILD_EXAMPLES=OFF -DEXPAT_BUILD_TESTS=OFF \
    -DEXPAT_BUILD_DOCS=OFF
build cmocka libcmocka-static.a . -DWITH_STATIC_LIB=ON -DWITH_EXAMPLES=OFF -DUNIT_TESTING=OFF
