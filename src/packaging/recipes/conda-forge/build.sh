#!/bin/sh
# conda-build runs it in the source tree.
set -eu
make -j"${CPU_COUNT:-1}" CHARGE=1 EXPAT=1 DYNAMIC=1 tool library
make CHARGE=1 EXPAT=1 DYNAMIC=1 PREFIX="$PREFIX" install
