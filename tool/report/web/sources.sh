#!/bin/sh
# The hash of the page's sources, as build.mjs records it in the template.
set -eu
cd "$(dirname "$0")"
find . -name node_modules -prune -o -type f -print | LC_ALL=C sort | while read -r file; do sha256sum "$file"; done | sha256sum | cut -d ' ' -f 1
