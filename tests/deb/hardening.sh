#!/bin/sh
# Every program and library of the packages in a folder is hardened: tests/deb/hardening.sh FOLDER. It is independent of its place,
# binds all symbols before it runs, and has them read-only then; its stack is guarded and not executable; and the C library's checked
# functions are called where there are some. tests/deb/contents.sh has unpacked the packages.
set -eu
folder=$1
failed=0
count=0
complain() {
    echo "$*"
    failed=1
}
for file in $(find "$folder/unpacked" -type f \( -path '*/bin/*' -o -name '*.so' -o -name '*.so.*' \)); do
    count=$((count + 1))
    name=${file#"$folder/unpacked/"}
    headers=$(readelf -hlW "$file")
    dynamic=$(readelf -dW "$file")
    symbols=$(nm -D --undefined-only "$file")
    echo "$headers" | grep -q 'Type: *DYN' || complain "$name: not independent of its place"
    case $name in
    */bin/*) echo "$dynamic" | grep -q 'FLAGS_1.*PIE' || complain "$name: no PIE" ;;
    esac
    echo "$headers" | grep -q GNU_RELRO || complain "$name: no RELRO"
    echo "$dynamic" | grep -qE 'BIND_NOW|FLAGS_1.*NOW' || complain "$name: binds symbols late"
    echo "$headers" | grep -qE 'GNU_STACK.* RW ' || complain "$name: executable stack"
    echo "$symbols" | grep -q __stack_chk_fail || complain "$name: no guard of the stack"
    echo "$symbols" | grep -qE '__[a-z]+_chk@' || complain "$name: calls no checked function"
done
[ "$count" = 4 ] || complain "$count programs and libraries; expected are the tool and three libraries"
exit "$failed"
