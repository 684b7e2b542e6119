#!/bin/sh
# Builds what Debian has no package of for another system, from its source packages: libraries.sh HOST FOLDER LIBRARY... puts archives
# and headers into FOLDER, by the cross compiler of HOST. Fetches only what is missing, with lists of apt's own in the folder, so that
# the machine's sources stay as they are. Needs cmake and dpkg-source.
set -eu
cd "$(dirname "$0")/.."
host=$1 folder=$2
shift 2
root=$(pwd)/$folder
# The compilers are not CC, which is the compiler of this machine; and who calls may be a make that was given it.
unset CC CXX CFLAGS CXXFLAGS CPPFLAGS LDFLAGS MAKEFLAGS MAKEOVERRIDES MFLAGS
prefix=/usr/$host
case $host in
x86_64-w64-mingw32)
    set_up="-DCMAKE_SYSTEM_NAME=Windows -DCMAKE_SYSTEM_PROCESSOR=x86_64 -DCMAKE_C_COMPILER=$host-gcc-posix
        -DCMAKE_CXX_COMPILER=$host-g++-posix -DCMAKE_RC_COMPILER=$host-windres"
    ;;
wasm32-emscripten)
    # cmocka.h defines uintptr_t where this macro does not tell it that there is one.
    set_up='-DCMAKE_TOOLCHAIN_FILE=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake -DCMAKE_C_FLAGS=-D_UINTPTR_T'
    prefix=$(em-config CACHE)/sysroot
    ;;
*)
    set_up="-DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=${host%%-*} -DCMAKE_C_COMPILER=$host-gcc
        -DCMAKE_CXX_COMPILER=$host-g++"
    ;;
esac
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
    echo "libraries.sh: cannot $2 $1; the end of $folder/logs/$1.$2 stands above" >&2
    exit 1
}

# build PACKAGE ARCHIVE FOLDER OPTION...: installs it into the root, unless its archive is there.
build() {
    package=$1 archive=$2 part=$3
    shift 3
    [ ! -e "$root/lib/$archive" ] || return 0
    echo "  $package for $host"
    fetch "$package"
    {
        # shellcheck disable=SC2086
        cmake -S "$root/sources/$package/$part" -B "$root/sources/$package.build" -Wno-dev $set_up \
            -DCMAKE_FIND_ROOT_PATH="$root;$prefix" -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER \
            -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY -DCMAKE_BUILD_TYPE=Release \
            -DCMAKE_INSTALL_PREFIX="$root" -DCMAKE_INSTALL_LIBDIR=lib -DBUILD_SHARED_LIBS=OFF "$@" &&
            cmake --build "$root/sources/$package.build" -j"$(nproc)" &&
            cmake --install "$root/sources/$package.build"
    } >"$root/logs/$package.build" 2>&1 || fail "$package" build
    [ -e "$root/lib/$archive" ] || fail "$package" build
    # Programs shall need nothing but what is linked into them.
    rm -f "$root/lib"/*.so*
}

# Its CMake files want a file that Debian's sources leave out.
configure_zlib() {
    [ ! -e "$root/lib/libz.a" ] || return 0
    echo "  zlib for $host"
    fetch zlib
    (cd "$root/sources/zlib" && CHOST=$host ./configure --static --prefix="$root" && make -j"$(nproc)" libz.a && make install) \
        >"$root/logs/zlib.build" 2>&1 || fail zlib build
}

for library in "$@"; do
    case $library in
    zlib) configure_zlib ;;
    libpng)
        build libpng1.6 libpng16.a . -DPNG_SHARED=OFF -DPNG_STATIC=ON -DPNG_TESTS=OFF -DPNG_EXECUTABLES=OFF \
            -DPNG_HARDWARE_OPTIMIZATIONS=OFF
        ;;
    json-c)
        build json-c libjson-c.a . -DBUILD_STATIC_LIBS=ON -DBUILD_TESTING=OFF -DBUILD_APPS=OFF -DDISABLE_WERROR=ON \
            -DENABLE_THREADING=OFF
        ;;
    expat)
        # The compiler is told XML_DTD without a value by this version's CMake files, and its sources compare it with 1.
        [ -e "$root/lib/libexpat.a" ] || {
            fetch expat
            sed -i 's/^#cmakedefine XML_DTD.*/#define XML_DTD 1/' "$root/sources/expat/expat/expat_config.h.cmake"
        }
        build expat libexpat.a expat -DEXPAT_SHARED_LIBS=OFF -DEXPAT_BUILD_TOOLS=OFF -DEXPAT_BUILD_EXAMPLES=OFF \
            -DEXPAT_BUILD_TESTS=OFF -DEXPAT_BUILD_DOCS=OFF
        ;;
    cmocka) build cmocka libcmocka-static.a . -DWITH_STATIC_LIB=ON -DWITH_EXAMPLES=OFF -DUNIT_TESTING=OFF ;;
    *)
        echo "libraries.sh: $library is not known here" >&2
        exit 2
        ;;
    esac
done
