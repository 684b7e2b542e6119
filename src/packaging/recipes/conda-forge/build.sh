#!/bin/sh
# conda-build runs it in the source tree. Without GSL, which is under the GPL; the results are the same.
set -eu
make -j"${CPU_COUNT:-1}" GSL=0 CHARGE=1 EXPAT=1 DYNAMIC=1 tool library
make GSL=0 CHARGE=1 EXPAT=1 DYNAMIC=1 PREFIX="$PREFIX" install
