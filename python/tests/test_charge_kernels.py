"""Plans by charge say with which kernels OpenBLAS has made them, and warn of old ones.

A library that is loaded before Python plays an OpenBLAS that does not know the processor.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np

import cscd

V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float64)
F = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])

PROGRAM = f"""
import warnings
import numpy, cscd
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    plan = cscd.Plan.charge(cscd.Mesh({F.tolist()}, 4), numpy.array({V.tolist()}), solver="dense")
print(plan.charge_kernels, plan.better_kernels, len(caught), caught[0].category.__name__ if caught else "")
print(caught[0].message if caught else "")
"""


def charge_behind(core: str, folder: Path) -> "list[str]":
    """The two lines that the program prints behind an OpenBLAS that says it has these kernels."""
    library = folder / "openblas.so"
    subprocess.run([*os.environ.get("CC", "cc").split(), "-xc", "-shared", "-fPIC", "-", "-o", str(library)], check=True,
                   text=True, input=f'char *openblas_get_corename(void) {{return "{core}";}}')
    ended = subprocess.run([sys.executable, "-c", PROGRAM], check=True, text=True, stdout=subprocess.PIPE,
                           env={**os.environ, "LD_PRELOAD": str(library)})
    return ended.stdout.splitlines()


def has_avx2() -> bool:
    """Whether this processor deserves better than the kernels of 2004."""
    info = Path("/proc/cpuinfo")
    return info.exists() and " avx2" in info.read_text() and " fma" in info.read_text()


def test_old_kernels_are_warned_of(tmp_path: Path) -> None:
    said, warning = charge_behind("Prescott", tmp_path)
    if has_avx2():
        assert said in ("Prescott SkylakeX 1 RuntimeWarning", "Prescott Haswell 1 RuntimeWarning")
        assert "OpenBLAS ran its kernels for Prescott" in warning and f"OPENBLAS_CORETYPE={said.split()[1]}" in warning
    else:
        assert said.strip() == "Prescott None 0"


def test_other_kernels_are_only_named(tmp_path: Path) -> None:
    assert charge_behind("a core to come", tmp_path) == ["a core to come None 0 ", ""]


def test_other_plans_have_none() -> None:
    mesh = cscd.Mesh(F, 4)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        charge = cscd.Plan.charge(mesh, V, solver="dense")
    for plan in (cscd.Plan.kmeans(mesh, V, 1), pickle.loads(pickle.dumps(charge))):
        assert plan.charge_kernels is None and plan.better_kernels is None
