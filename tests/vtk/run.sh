#!/bin/sh
# Reads what the tool writes for ParaView with VTK, and compares it with its other outputs. BUILD is the build folder. Ends non-zero
# when they differ.
set -eu
cd "$(dirname "$0")"
: "${BUILD:?BUILD must name the build folder}"
case $BUILD in /*) ;; *) BUILD=../../$BUILD ;; esac

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 compare.py "$BUILD/cscd" "$folder"
