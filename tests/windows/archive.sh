#!/bin/sh
# Tests the archive that is its first argument, under wine, in the folder that is its second: unpacks it where the path has a blank and
# an umlaut, and runs the program from another folder; links a program with the library. Ends non-zero when something is wrong.
# WINE is wine64, CSCD_TOOL the tool as it was built, CC the compiler.
set -eu
archive=$(realpath "$1")
place=$2
mkdir -p "$place/Körper und Flächen" "$place/elsewhere"
python3 -m zipfile -e "$archive" "$place/Körper und Flächen"
cd "$place/elsewhere"
top=$(echo ../K*/cscd-*-windows-x86_64)

fail() {
    echo "archive.sh: $1" >&2
    exit 1
}

# Two tetrahedra, one with its tip in the other.
cat >pair.obj <<'EOF'
v 0 0 0
v 3 0 0
v 0 3 0
v 0 0 3
v 0.5 0.5 0.5
v 5 1 1
v 5 2 1
v 5 1 2
f 1 3 2
f 1 2 4
f 2 3 4
f 1 4 3
f 5 7 6
f 5 6 8
f 6 7 8
f 5 8 7
EOF

"$WINE" "$top/cscd.exe" check pair.obj --json own.json >own.txt || fail "cscd.exe ended with $?"
"$WINE" "$CSCD_TOOL" check pair.obj --json built.json >built.txt || fail "the tool as it was built ended with $?"
grep -q 'cross' own.txt || fail 'cscd.exe finds nothing'
cmp own.json built.json && cmp own.txt built.txt || fail 'cscd.exe says something else than the tool as it was built'

cat >version.c <<'EOF'
#include <cscd/cscd.h>
#include <stdio.h>

int main(void) {
    puts(cscd_version_string());
    return 0;
}
EOF
${CC:-x86_64-w64-mingw32-gcc-posix} -I"$top/include" version.c -L"$top/lib" -lcscd -o version.exe
cp "$top"/lib/libcscd-*.dll .
"$WINE" version.exe >version.txt || fail "a program with the library ended with $?"
version=$(tr -d '\r' <version.txt)
case $archive in
*"/cscd-$version-windows-x86_64.zip") ;;
*) fail "the library calls itself '$version'" ;;
esac

# What Windows itself has; who runs the archive has nothing else.
for file in "$top/cscd.exe" "$top"/lib/*.dll; do
    others=$(x86_64-w64-mingw32-objdump -p "$file" | sed -n 's/.*DLL Name: //p' |
        grep -viE '^(kernel32|msvcrt|advapi32|bcrypt|ntdll|ucrtbase|api-ms-win-crt-.*)\.dll$' || true)
    [ -z "$others" ] || fail "$file needs $others"
done
