#!/bin/sh
# Unpacks Debian's libraries of another architecture: sysroot.sh ARCHITECTURE FOLDER PACKAGE... What the packages depend on
# comes too. Nothing is installed, and apt's own lists are left alone: it is asked with state, caches and lists of its own beside
# the folder. A folder that has the same packages already is left as it is.
set -eu

architecture=$1
folder=$2
shift 2
state=$folder.apt
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
if [ "$(cat "$folder/packages" 2>/dev/null)" = "$*" ]; then exit 0; fi

echo "Unpacking Debian's libraries for $architecture"
mkdir -p "$state/lists/partial" "$state/archives/partial" "$state/sources"
state=$(cd "$state" && pwd)
: >"$state/status"
# Debian's own sources alone: others may not have this architecture.
for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [ ! -e "$file" ] || grep -E '^deb .*debian' "$file" | grep -v 'arch=' >"$state/sources/$(basename "$file")" || :
done
cp /etc/apt/sources.list.d/debian*.sources "$state/sources/" 2>/dev/null || :
cat >"$state/apt.conf" <<END
APT::Architecture "$architecture";
APT::Architectures { "$architecture"; };
APT::Install-Recommends "false";
APT::Sandbox::User "root";
Dir::State "$state";
Dir::State::status "$state/status";
Dir::State::extended_states "$state/extended_states";
Dir::Cache "$state";
Dir::Etc::sourcelist "/dev/null";
Dir::Etc::sourceparts "$state/sources";
END
export APT_CONFIG="$state/apt.conf"
apt-get update -q >"$state/log" 2>&1 && apt-get install -q -y --download-only "$@" >>"$state/log" 2>&1 || {
    tail -20 "$state/log" >&2
    echo "sysroot.sh: apt has not given the packages for $architecture; the whole log is $state/log" >&2
    exit 1
}
for archive in "$state"/archives/*.deb; do dpkg-deb -x "$archive" "$folder"; done
# Links that start at the root of the other system would end in this one.
find "$folder" -type l | while read -r link; do
    target=$(readlink "$link")
    case $target in
    /*) ln -sfn "$(realpath -ms --relative-to="$(dirname "$link")" "$folder$target")" "$link" ;;
    esac
done
# What update-alternatives does when packages are installed.
for library in "$folder"/usr/lib/*/openblas-pthread/lib*.so* "$folder"/usr/include/*/openblas-pthread/*.h "$folder"/usr/lib/*/blas/lib*.so* "$folder"/usr/lib/*/lapack/lib*.so*; do
    place=$(dirname "$(dirname "$library")")/$(basename "$library")
    [ ! -e "$library" ] || [ -e "$place" ] || ln -s "$(basename "$(dirname "$library")")/$(basename "$library")" "$place"
done
rm -rf "$state/archives"
echo "$*" >"$folder/packages"
