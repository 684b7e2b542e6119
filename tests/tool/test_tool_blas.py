"""The tool sees to it that OpenBLAS starts on one thread, with kernels for the processor.

A library that is loaded before it plays an OpenBLAS that does not know the processor: it names old kernels unless the
variable says otherwise.
"""
import os
import platform
import shlex
import subprocess
from pathlib import Path

import pytest

from support.tool.running import SLOW_MACHINE, run

SOURCE = r"""
#include <stdio.h>
#include <stdlib.h>
char *openblas_get_corename(void) {
    char *told = getenv("OPENBLAS_CORETYPE"), *threads = getenv("OPENBLAS_NUM_THREADS");
    fprintf(stderr, "asked with %s, %s threads\n", told != NULL ? told : "nothing", threads);
    return told != NULL ? told : (char *)"Prescott";
}
"""
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


def has_better_kernels():
    """Whether this processor has instructions that the old kernels leave alone."""
    if platform.machine() != "x86_64" or SLOW_MACHINE:
        return False
    return {"avx2", "fma"} <= set(Path("/proc/cpuinfo").read_text(encoding="utf-8").split())


def preprocess(method, solver, **variables):
    """Runs it beside that library, which sanitizers do not bear; returns what was asked, in turn, and the other errors."""
    Path("model.obj").write_text(TETRAHEDRON)
    compiler = shlex.split(os.environ.get("CC", "cc"))
    subprocess.run([*compiler, "-xc", "-shared", "-fPIC", "-", "-o", "old_openblas.so"], input=SOURCE, text=True, check=True)
    environment = {name: value for name, value in os.environ.items() if not name.startswith("OPENBLAS_")}
    if not SLOW_MACHINE:
        environment["LD_PRELOAD"] = os.path.abspath("old_openblas.so")
    line = f"preprocess model.obj -o plan.ply --method {method} --charge {solver}"
    answer = run(line, env={**environment, **variables})
    assert "written: " in answer.out
    lines = answer.error.splitlines()
    asked = [line[len("asked with ") :] for line in lines if line.startswith("asked with ")]
    return asked, [line for line in lines if not line.startswith("asked with ")]


if has_better_kernels():
    @pytest.mark.parametrize("method", ["charge", "auto"])
    def test_chooses_kernels(method):
        """Another process finds out; this one asks with better kernels from the first time on, and warns of nothing."""
        asked, others = preprocess(method, "dense")
        assert asked[0] == "nothing, 1 threads" and asked[-1] in ("SkylakeX, 1 threads", "Haswell, 1 threads") and others == []

    def test_a_choice_of_the_user_stays():
        asked, others = preprocess("charge", "dense", OPENBLAS_CORETYPE="Prescott", OPENBLAS_NUM_THREADS="2")
        assert set(asked) == {"Prescott, 2 threads"}
        assert any("warning: OpenBLAS runs its kernels for Prescott" in line for line in others)


def test_others_need_none():
    """Other ways to solve for the charge ask nobody, and warn of nothing."""
    assert preprocess("auto", "tree") == ([], [])
