#!/bin/sh
# What is in the packages of a folder: tests/deb/contents.sh FOLDER. Each file that a user looks for is where Debian has it, none is in
# two packages, none has a script of another project or the path of the folder where it was built.
set -eu
cd "$(dirname "$0")/../.."
folder=$1
version=$(awk '/define CSCD_VERSION_/ {print $3}' include/cscd/cscd.h | paste -sd .)
major=${version%%.*}
triplet=$(dpkg-architecture -qDEB_HOST_MULTIARCH)
failed=0
complain() {
    echo "$*"
    failed=1
}
place=$folder/unpacked
rm -rf "$place"
for package in "$folder"/*.deb; do
    name=$(dpkg-deb -f "$package" Package)
    case $name in *-dbgsym) continue ;; esac
    mkdir -p "$place/$name"
    dpkg-deb -x "$package" "$place/$name"
done

has() { # has PACKAGE FILE...
    package=$1
    shift
    for file; do [ -e "$place/$package/usr/$file" ] || [ -L "$place/$package/usr/$file" ] || complain "$package lacks $file"; done
}
has "libcscd$major" "lib/$triplet/libcscd.so.$major" "lib/$triplet/libcscd.so.$version" "lib/$triplet/cscd/libcscd-baselines.so.$major"
has libcscd-dev "lib/$triplet/libcscd.so" "lib/$triplet/libcscd.a" "lib/$triplet/pkgconfig/cscd.pc" \
    "lib/$triplet/cmake/cscd/cscdConfig.cmake" include/cscd/cscd.hpp share/man/man3/cscd.3.gz
has cscd bin/cscd share/man/man1/cscd.1.gz
has python3-cscd lib/python3/dist-packages/cscd/libcscd-python.so "lib/python3/dist-packages/cscd-$version.dist-info/METADATA"
has cscd-doc share/doc/cscd-doc/html/index.html share/doc/cscd-doc/README.md share/doc/cscd-doc/docs/artist/guide.md \
    share/doc/cscd-doc/docs/images/doll.png share/doc-base
for header in include/cscd/*.h include/cscd/*.hpp; do has libcscd-dev "$header"; done
for module in python/cscd/*.py; do has python3-cscd "lib/python3/dist-packages/cscd/${module##*/}"; done
for package in "$place"/*; do
    has "${package##*/}" "share/doc/${package##*/}/copyright" "share/doc/${package##*/}/changelog.gz"
done

twice=$(cd "$place" && for package in *; do (cd "$package" && find . ! -type d); done | LC_ALL=C sort | uniq -d)
[ -z "$twice" ] || complain "in two packages: $twice"
scripts=$(find "$place/cscd-doc" -name '*.js')
[ -z "$scripts" ] || complain "scripts: $scripts"
! grep -rl '<script' "$place"/cscd-doc/usr/share/doc/cscd-doc/html >"$folder/scripts.txt" || complain "pages with scripts: $(cat "$folder/scripts.txt")"
! grep -rlF "$folder" "$place" >"$folder/paths.txt" || complain "files that name the folder of the build: $(cat "$folder/paths.txt")"

# A relative link of the manual's pages leads to a page or a picture of the package. The sources are not in it.
documents=$place/cscd-doc/usr/share/doc/cscd-doc
find "$documents" -name '*.md' | while read -r page; do
    grep -oE '\]\([^)#: ]+[#)]' "$page" | sed -e 's/^](//' -e 's/.$//' | grep '[./]' | while read -r link; do
        case $link in *include/* | *CONTRIBUTING* | *LICENSE | *CHANGELOG* | *licences* | *src/* | *tool/* | *tests/* | *models/* | *benchmarks/*) continue ;; esac
        [ -e "${page%/*}/$link" ] || echo "${page#"$documents"/}: $link"
    done
done >"$folder/links.txt"
[ ! -s "$folder/links.txt" ] || complain "links that lead nowhere: $(cat "$folder/links.txt")"
exit "$failed"
