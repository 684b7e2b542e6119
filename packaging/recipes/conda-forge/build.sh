#!/bin/sh
# conda-build runs it in the source tree. Without libcscd-baselines.so, which is linked with GSL and so under the GPL, as a whole.
set -eu
make -j"${CPU_COUNT:-1}" BASELINES=0 EXPAT=1 DYNAMIC=1 tool library
make BASELINES=0 EXPAT=1 DYNAMIC=1 PREFIX="$PREFIX" install
