#!/bin/sh
# The names of the packages in a folder, and what they need: tests/deb/names.sh FOLDER.
set -eu
cd "$(dirname "$0")/../.."
folder=$1
major=$(awk '/define CSCD_VERSION_MAJOR/ {print $3}' include/cscd/cscd.h)
failed=0
complain() {
    echo "$*"
    failed=1
}
expected="cscd cscd-doc libcscd-dev libcscd$major python3-cscd"
found=$(for package in "$folder"/*.deb; do dpkg-deb -f "$package" Package; done | grep -v -e -dbgsym | LC_ALL=C sort | xargs)
[ "$found" = "$expected" ] || complain "packages: $found; expected: $expected"

field() { dpkg-deb -f "$folder/$1"_*.deb "$2"; } # field PACKAGE FIELD
# needs PACKAGE FIELD WORD...: the field has each of these.
needs() {
    package=$1 field=$2 text=$(field "$1" "$2")
    shift 2
    for word; do
        case $text in *"$word"*) ;; *) complain "$package: $field lacks $word: $text" ;; esac
    done
}
needs "libcscd$major" Depends 'libc6 (>='
needs "libcscd$major" Suggests libgsl liblapacke libopenblas0
needs libcscd-dev Depends "libcscd$major (= "
needs cscd Depends "libcscd$major (>=" libpng16 zlib1g libjson-c5 libexpat1
needs python3-cscd Depends "libcscd$major (>=" python3-numpy
needs "libcscd$major" Multi-Arch same
needs libcscd-dev Multi-Arch same

# Linear algebra and GSL, which is under another licence, are suggested, and never installed without being asked for.
for package in $expected; do
    asked=$(field "$package" Depends)$(field "$package" Recommends)
    case $asked in *lapack* | *blas*) complain "$package asks for linear algebra" ;; esac
    case $asked in *gsl*) complain "$package asks for GSL" ;; esac
done

# A program's dependency comes from the symbols that it uses, of which each has the version that brought it.
dpkg-deb -I "$folder/libcscd${major}"_*.deb symbols >"$folder/symbols.txt"
exported=$(nm -D --defined-only "$folder"/cscd-*/build/release-dynamic/libcscd.so | awk '{print $NF}' | sed 's/@@/@/' | LC_ALL=C sort)
listed=$(sed -n "s/^ \(.*@CSCD_[0-9.]*\) .*/\1/p" "$folder/symbols.txt" | LC_ALL=C sort)
[ -n "$listed" ] || complain 'no symbol is listed'
[ "$listed" = "$(echo "$exported" | sed "s/^\(CSCD_[0-9.]*\)\(@.*\)\{0,1\}$/\1@\1/")" ] || complain 'symbols that are exported and those that are listed differ'
exit "$failed"
