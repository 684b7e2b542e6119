#!/bin/sh
# Puts what `make` built where a prefix has it, or removes exactly that again; the Makefile calls it and sets the
# variables that are checked here.
set -eu
cd "$(dirname "$0")/.."
: "${BUILD:?}" "${VERSION:?}" "${STATIC_LIBS:?}" "${POINTER_SIZE:?}"
: "${BASELINES:?}" "${SENSORS:?}" "${BINDIR:?}" "${LIBDIR:?}" "${INCLUDEDIR:?}" "${MANDIR:?}"
plain() { realpath -ms -- "$1"; } # plain PATH: absolute, and one of the ways to write it
DESTDIR=${DESTDIR:+$(plain "$DESTDIR")}
[ "$DESTDIR" != / ] || DESTDIR=''
major=${VERSION%%.*}
templates=packaging
made=$BUILD/installed-folders.$(id -u) # the folders that install made, a line each; by user, for root makes some

for folder in "$BINDIR" "$LIBDIR" "$INCLUDEDIR" "$MANDIR"; do
    case $folder in
    /*) ;;
    *)
        echo "install: $folder is not an absolute path" >&2
        exit 2
        ;;
    esac
done
BINDIR=$(plain "$BINDIR") LIBDIR=$(plain "$LIBDIR") INCLUDEDIR=$(plain "$INCLUDEDIR") MANDIR=$(plain "$MANDIR")
pc_folder=$LIBDIR/pkgconfig
cmake_folder=$LIBDIR/cmake/cscd

# The tool and the library; only the library.
what=all

# each ACTION: calls it with MODE SOURCE TARGET for every file; ACTION decides what becomes of it.
each_file() {
    [ "$what" = library ] || "$1" 755 "$BUILD/cscd" "$BINDIR/cscd"
    for header in include/cscd/*.h include/cscd/*.hpp; do
        case $SENSORS,$header in
        0,*/sensors.h*) continue ;;
        esac
        "$1" 644 "$header" "$INCLUDEDIR/cscd/${header##*/}"
    done
    "$1" 644 "$BUILD/libcscd.a" "$LIBDIR/libcscd.a"
    "$1" 644 "$BUILD/libcscd.so.$VERSION" "$LIBDIR/libcscd.so.$VERSION"
    "$1" link "libcscd.so.$VERSION" "$LIBDIR/libcscd.so.$major"
    "$1" link "libcscd.so.$major" "$LIBDIR/libcscd.so"
    if [ "$BASELINES" != 0 ]; then
        "$1" 644 "$BUILD/libcscd-baselines.so.$VERSION" "$LIBDIR/libcscd-baselines.so.$VERSION"
        "$1" link "libcscd-baselines.so.$VERSION" "$LIBDIR/libcscd-baselines.so.$major"
    fi
    "$1" template "$templates/cscd.pc.in" "$pc_folder/cscd.pc"
    "$1" template "$templates/cscdConfig.cmake.in" "$cmake_folder/cscdConfig.cmake"
    "$1" template "$templates/cscdConfigVersion.cmake.in" "$cmake_folder/cscdConfigVersion.cmake"
    for page in docs/man/*.[1-9]; do
        [ "$what" = library ] && [ "${page##*.}" != 3 ] && continue
        "$1" template "$page" "$MANDIR/man${page##*.}/${page##*/}"
    done
}

from() { realpath -ms --relative-to="$1" "$2"; } # from FOLDER TARGET: the way to TARGET

for_sed() { sed 's/[&\\|]/\\&/g'; }
way() { from "$1" "$2" | for_sed; }

# pkg-config takes words apart as a shell does, and where its own place has quotes in it, it cannot say where that is.
pc_way() {
    case $pc_folder in
    *[\"\'\\]*) printf '%s\n' "$1" ;;
    *) printf '${pcfiledir}/%s\n' "$(from "$pc_folder" "$1")" ;;
    esac | sed "s/[\"'\\\\ ]/\\\\&/g" | for_sed
}

fill_in() { # fill_in TEMPLATE: its text with this installation's values
    sed -e "s|@VERSION@|$VERSION|g" -e "s|@MAJOR@|$major|g" -e "s|@POINTER_SIZE@|$POINTER_SIZE|g" \
        -e "s|@STATIC_LIBS@|$STATIC_LIBS|g" -e "s|@STATIC_LIBS_LIST@|$(echo "$STATIC_LIBS" | tr -s ' ' ';')|g" \
        -e "s|@LIBDIR@|$(pc_way "$LIBDIR")|g" -e "s|@INCLUDEDIR@|$(pc_way "$INCLUDEDIR")|g" \
        -e "s|@LIB_FROM_CMAKE@|$(way "$cmake_folder" "$LIBDIR")|g" \
        -e "s|@INCLUDE_FROM_CMAKE@|$(way "$cmake_folder" "$INCLUDEDIR")|g" "$1"
}

# A folder of this name that somebody makes later is another one.
identity() { printf '%s %s\n' "$(stat -c '%d:%i:%W' -- "$1")" "$1"; }

make_folder() { # with those above it, and notes which are new
    [ ! -d "$1" ] || return 0
    make_folder "$(dirname "$1")"
    mkdir "$1"
    chmod 755 "$1"
    identity "$1" >>"$made"
}

put() {
    target=$DESTDIR$3
    make_folder "${target%/*}"
    case $1 in
    link) ln -sfn "$2" "$target" ;;
    template)
        fill_in "$2" >"$target"
        chmod 644 "$target"
        ;;
    *) install -m "$1" "$2" "$target" ;;
    esac
}

folder_before=''
remove() { # and the folder before, when it is the turn of another one
    folder=$DESTDIR${3%/*}
    [ "$folder" = "$folder_before" ] || leave_folder "$folder"
    rm -f "$DESTDIR$3"
}

leave_folder() {
    [ -z "$folder_before" ] || remove_folder "$folder_before"
    folder_before=$1
}

remove_folder() { # with those above it: only folders that install made, and only where nothing else has come into them
    [ -e "$made" ] || return 0
    [ ! -d "$1" ] || { grep -qxF -e "$(identity "$1")" "$made" && rmdir "$1" 2>/dev/null; } || return 0
    [ "$1" = / ] || remove_folder "$(dirname "$1")"
}

case ${1:-} in
install) each_file put ;;
install-library)
    what=library
    each_file put
    ;;
uninstall)
    each_file remove
    leave_folder ''
    # The library's own folders go even where another build folder made them.
    for folder in "$DESTDIR$INCLUDEDIR/cscd" "$DESTDIR$cmake_folder"; do
        [ ! -d "$folder" ] || rmdir "$folder" 2>/dev/null || echo "uninstall: $folder holds other files: left" >&2
    done
    ;;
*)
    echo "usage: $0 install|install-library|uninstall" >&2
    exit 2
    ;;
esac
