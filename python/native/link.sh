#!/bin/sh
# Links the native library of the Python module: python/native/link.sh OUTPUT OBJECT... The compiler with its flags is in LINK, the
# libraries for files and pictures, as the tool links them, in FILE_LIBS, and all others in OTHER_LIBS; OBJCOPY is that of the compiler.
#
# The libraries for files and pictures go into it as archives, hidden, so that it runs on machines without them, and neither uses nor
# disturbs other versions of them in the same process. Debian's archives are compiled for programs: hidden, they fit into a shared
# library as well, but for the variable stderr of the C library, which libpng reads directly. A copy of libpng reads
# cscdpy_standard_error in its place (recordings.c). Where an archive is missing or does not fit, the library needs the shared ones,
# as a distribution wants it: DYNAMIC=1.
set -eu
output=$1
shift
part=$output.part
copy=$output.libpng.a
trap 'rm -f "$part" "$copy"' EXIT

archives=''
rest=''
[ "${DYNAMIC:-0}" != 1 ] || FILE_ARCHIVES=''
for flag in ${FILE_ARCHIVES-$FILE_LIBS}; do
    case $flag in
    -l*) archive=$($LINK -print-file-name="lib${flag#-l}.a") ;;
    *) archive='' ;;
    esac
    case $flag:$archive in
    -lm:* | -pthread:*) rest="$rest $flag" ;;
    -lpng*:/*)
        "${OBJCOPY:-objcopy}" --redefine-sym stderr=cscdpy_standard_error "$archive" "$copy"
        archives="$archives $copy"
        ;;
    -l*:/*) archives="$archives $archive" ;;
    -l*) archives='' && break ;;
    *) rest="$rest $flag" ;;
    esac
done

# shellcheck disable=SC2086
if [ -z "$archives" ] || ! $LINK -Wl,--exclude-libs,ALL -Wl,-z,text -o "$part" "$@" $archives $rest $OTHER_LIBS 2>"$part.log"; then
    $LINK -o "$part" "$@" $FILE_LIBS $OTHER_LIBS
fi
rm -f "$part.log"
mv "$part" "$output"
