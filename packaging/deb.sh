#!/bin/sh
# Builds Debian's packages of the last commit: packaging/deb.sh FOLDER. The packages come into FOLDER, beside the tree from which
# they are built: what git archive gives, and packaging/debian filled in as its folder debian. Of one commit and one set of
# installed packages, they have the same bytes in any folder.
set -eu
folder=${1:?usage: packaging/deb.sh FOLDER}
cd "$(dirname "$0")/.."
fail() {
    echo "deb: $*" >&2
    exit 1
}
commit=$(git rev-parse --short=12 HEAD 2>/dev/null) || fail 'this builds a commit, and here is no git repository'
[ -z "$(git status --porcelain --untracked-files=no)" ] || echo 'deb: changes that are not committed are left out' >&2
version=$(git show HEAD:include/cscd/cscd.h | awk '/define CSCD_VERSION_/ {print $3}' | paste -sd .)
major=${version%%.*}
SOURCE_DATE_EPOCH=$(git show -s --format=%ct HEAD)
export SOURCE_DATE_EPOCH
date=$(LC_ALL=C date -u -d "@$SOURCE_DATE_EPOCH" '+%a, %d %b %Y %H:%M:%S +0000')

# Whoever gives the packages away says who they are, as Debian's own tools want it.
maintainer="${DEBFULLNAME:-the cscd authors} <${DEBEMAIL:-cscd@example.org}>"

tree=$folder/cscd-$version
rm -rf "$folder"
mkdir -p "$tree"
git archive HEAD | tar -xf - -C "$tree"
cp -r "$tree/packaging/debian" "$tree/debian"

# Functions belong to the version that brought them, which is the node of the version script that has them.
nodes=$(sed -n 's/^\(CSCD_@MAJOR@\.\([0-9]*\)\) {.*/ (symver)\1 @MAJOR@.\2.0/p' "$tree/packaging/cscd.map.in" | sed 's/$/\\/')
nodes=${nodes%\\}
for file in "$tree"/debian/libcscd.*; do mv "$file" "$tree/debian/libcscd$major.${file##*/libcscd.}"; done
for name in control rules changelog "libcscd$major.symbols"; do
    file=$tree/debian/$name
    sed -i -e "s|^@NODES@\$|$nodes|" "$file"
    sed -i -e "s|@MAJOR@|$major|g" -e "s|@VERSION@|$version|g" -e "s|@COMMIT@|$commit|g" -e "s|@DATE@|$date|g" \
        -e "s|@MAINTAINER@|$maintainer|g" "$file"
done

# What the caller's make or environment says of another build does not belong here.
unset MAKEFLAGS MAKELEVEL MAKEOVERRIDES MFLAGS CC CXX CFLAGS CPPFLAGS LDFLAGS CONFIG BASELINES EXPAT BUILD BUILD_ROOT
export DEB_BUILD_OPTIONS="${DEB_BUILD_OPTIONS:-parallel=$(nproc)}"
(cd "$tree" && dpkg-buildpackage -b -us -uc) >"$folder/build.log" 2>&1 || {
    tail -40 "$folder/build.log" >&2
    fail "dpkg-buildpackage failed; the end of $folder/build.log stands above"
}
ls "$folder"/*.deb
