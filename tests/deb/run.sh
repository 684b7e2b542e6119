#!/bin/sh
# Builds Debian's packages twice, looks at them, installs them, tests what is installed, and purges it: `make test-deb` calls it, as
# root. FOLDER takes everything that is built. It does not start where something of cscd is installed, which it would replace.
set -eu
folder=${1:?usage: tests/deb/run.sh FOLDER}
cd "$(dirname "$0")/../.."
refuse() {
    echo "test-deb: $*" >&2
    exit 1
}
[ "$(id -u)" = 0 ] || refuse 'this installs packages; run it as root'
# Those that dpkg knows, but for what is purged or was never there.
packages_of_ours() {
    dpkg-query -W -f '${db:Status-Status} ${Package}\n' | awk '$1 != "not-installed" && $2 ~ /^((lib|python3-)?cscd[0-9]*(-[a-z]+)?|autopkgtest-satdep)$/ {print $2}'
}
installed=$(packages_of_ours)
[ -z "$installed" ] || refuse "these packages are installed, and it would replace and purge them: $installed"
for file in /usr/include/cscd /usr/local/include/cscd /usr/bin/cscd /usr/local/bin/cscd /usr/lib/libcscd* /usr/lib/*/libcscd* \
    /usr/local/lib/libcscd* /usr/lib/python3/dist-packages/cscd; do
    [ ! -e "$file" ] || refuse "cscd is installed already: $file"
done

passed=0
failed=0
# check NAME COMMAND...: the command's output is shown when it fails.
check() {
    name=$1
    shift
    if "$@" >"$folder/check.log" 2>&1; then
        echo "passed: $name"
        passed=$((passed + 1))
    else
        cat "$folder/check.log"
        echo "failed: $name"
        failed=$((failed + 1))
    fi
}

# What a failure or a signal leaves installed goes.
newly=''
purge() {
    [ -n "$newly" ] || return 0
    # shellcheck disable=SC2086
    ask_apt purge $newly || return 1
    newly=''
}
ask_apt() { DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 "$@"; }
trap 'purge >/dev/null 2>&1 || echo "test-deb: could not purge$newly" >&2' EXIT
trap 'exit 129' HUP
trap 'exit 130' INT
trap 'exit 143' TERM

rm -rf "$folder"
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
one=$folder/one another=$folder/another/one/of/these

# The second build has another folder, time zone, language, mask of new files, and number of processes.
build_again() { (umask 027 && TZ=Pacific/Apia LC_ALL=C.UTF-8 DEB_BUILD_OPTIONS=parallel=3 packaging/deb.sh "$another"); }
check 'the packages are built' packaging/deb.sh "$one"
[ "$failed" = 0 ] || {
    echo "$passed passed, $failed failed"
    exit 1
}
check 'they are built again elsewhere' build_again

same_bytes() {
    for package in "$one"/*.deb; do
        cmp "$package" "$another/${package##*/}" || return 1
    done
    [ "$(ls "$one"/*.deb | wc -l)" = "$(ls "$another"/*.deb | wc -l)" ]
}
check 'both builds have the same bytes' same_bytes

check 'lintian has no errors and no warnings' lintian --allow-root --fail-on error,warning --tag-display-limit 0 "$one"/*.changes

for script in names contents hardening; do check "tests/deb/$script.sh" "tests/deb/$script.sh" "$one"; done

# ---- what is installed

packages=$(ls "$one"/*.deb | grep -v -e -dbgsym_)
# Those that were there before and are replaced have their old version in brackets; they stay.
# shellcheck disable=SC2086
newly=$(apt-get -s -o APT::Install-Recommends=true install $packages | awk '$1 == "Inst" && $3 !~ /^\[/ {printf " %s", $2}')
# shellcheck disable=SC2086
check 'apt installs the packages' ask_apt -o APT::Install-Recommends=true install $packages

tree=$(ls -d "$one"/cscd-*/)
installed_tests() { autopkgtest -B -o "$folder/autopkgtest" "$tree" -- null; }
check 'autopkgtest' installed_tests
sed -n '/^[a-z-]* *\(PASS\|FAIL\|SKIP\)/s/^/    /p' "$folder/autopkgtest/summary" || true

check 'apt purges the packages' purge
nothing_left() {
    for package in $packages; do
        for file in $(dpkg-deb -c "$package" | awk '{print $6}' | grep cscd | sed 's/^\.//'); do
            [ ! -e "$file" ] || {
                echo "$file is left"
                return 1
            }
        done
    done
    packages_of_ours
    [ -z "$(packages_of_ours)" ]
}
check 'nothing is left' nothing_left
rm -f "$folder/check.log"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
