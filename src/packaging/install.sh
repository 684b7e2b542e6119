#!/bin/sh
# Puts what `make` built where a prefix has it, or removes exactly that again; the Makefile calls it and sets the
# variables that are checked here.
set -eu
cd "$(dirname "$0")/../.."
: "${BUILD:?}" "${VERSION:?}" "${STATIC_LIBS:?}" "${POINTER_SIZE:?}"
: "${CHARGE:?}" "${BINDIR:?}" "${LIBDIR:?}" "${INCLUDEDIR:?}" "${MANDIR:?}"
DESTDIR=${DESTDIR:-}
major=${VERSION%%.*}
pc_folder=$LIBDIR/pkgconfig
cmake_folder=$LIBDIR/cmake/cscd
templates=src/packaging
made=$BUILD/installed-folders.$(id -u) # the folders that install made, one a line; by user, for root makes some

for folder in "$BINDIR" "$LIBDIR" "$INCLUDEDIR" "$MANDIR"; do
    case $folder in
    /*) ;;
    *)
        echo "install: $folder is not an absolute path" >&2
        exit 2
        ;;
    esac
done

# The tool and the library; only the library.
what=all

# each ACTION: calls it with MODE SOURCE TARGET for every file; ACTION decides what becomes of it.
each_file() {
    [ "$what" = library ] || "$1" 755 "$BUILD/cscd" "$BINDIR/cscd"
    for header in include/cscd/*.h include/cscd/*.hpp; do
        "$1" 644 "$header" "$INCLUDEDIR/cscd/${header##*/}"
    done
    "$1" 644 "$BUILD/libcscd.a" "$LIBDIR/libcscd.a"
    "$1" 644 "$BUILD/libcscd.so.$VERSION" "$LIBDIR/libcscd.so.$VERSION"
    "$1" link "libcscd.so.$VERSION" "$LIBDIR/libcscd.so.$major"
    "$1" link "libcscd.so.$major" "$LIBDIR/libcscd.so"
    if [ "$CHARGE" != 0 ]; then
        "$1" 644 "$BUILD/libcscd-charge.so.$VERSION" "$LIBDIR/libcscd-charge.so.$VERSION"
        "$1" link "libcscd-charge.so.$VERSION" "$LIBDIR/libcscd-charge.so.$major"
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

fill_in() { # fill_in TEMPLATE: its text with this installation's values
    sed -e "s|@VERSION@|$VERSION|g" -e "s|@MAJOR@|$major|g" -e "s|@POINTER_SIZE@|$POINTER_SIZE|g" \
        -e "s|@STATIC_LIBS@|$STATIC_LIBS|g" -e "s|@STATIC_LIBS_LIST@|$(echo "$STATIC_LIBS" | tr -s ' ' ';')|g" \
        -e "s|@LIB_FROM_PC@|$(from "$pc_folder" "$LIBDIR")|g" \
        -e "s|@INCLUDE_FROM_PC@|$(from "$pc_folder" "$INCLUDEDIR")|g" \
        -e "s|@LIB_FROM_CMAKE@|$(from "$cmake_folder" "$LIBDIR")|g" \
        -e "s|@INCLUDE_FROM_CMAKE@|$(from "$cmake_folder" "$INCLUDEDIR")|g" "$1"
}

make_folder() { # with those above it, and notes which are new
    [ ! -d "$1" ] || return 0
    make_folder "$(dirname "$1")"
    mkdir "$1"
    chmod 755 "$1"
    echo "$1" >>"$made"
}

put() {
    target=$DESTDIR$3
    make_folder "$(dirname "$target")"
    case $1 in
    link) ln -sfn "$2" "$target" ;;
    template)
        fill_in "$2" >"$target"
        chmod 644 "$target"
        ;;
    *) install -m "$1" "$2" "$target" ;;
    esac
}

remove() { rm -f "$DESTDIR$3"; }

# Only folders that install made, and only where nothing else has come into them. Deeper ones come first.
remove_folders() {
    [ -e "$made" ] || return 0
    sort -ru "$made" >"$made.old"
    : >"$made"
    while IFS= read -r folder; do
        [ ! -d "$folder" ] || rmdir "$folder" 2>/dev/null || echo "$folder" >>"$made"
    done <"$made.old"
    rm -f "$made.old"
}

case ${1:-} in
install) each_file put ;;
install-library)
    what=library
    each_file put
    ;;
uninstall)
    each_file remove
    remove_folders
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
