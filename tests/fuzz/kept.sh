#!/bin/sh
# The small files that fuzzing has kept, in an archive for each format: tests/fuzz/corpus/FORMAT.tgz.
#
#     kept.sh unpack FOLDER          writes FOLDER/FORMAT/FILE for all of them
#     kept.sh pack FOLDER FORMAT     makes the archive of a format anew from FOLDER/FORMAT; the same files give the same bytes
set -eu
corpus=$(dirname "$0")/corpus
case $1 in
unpack)
    mkdir -p "$2"
    for archive in "$corpus"/*.tgz; do tar -xzf "$archive" -C "$2"; done
    ;;
pack)
    tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX -C "$2" -cf - "$3" | gzip -n9 >"$corpus/$3.tgz"
    ;;
*)
    sed -n '2,6s/^# \{0,1\}//p' "$0" >&2
    exit 2
    ;;
esac
