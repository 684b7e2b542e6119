"""Looks for what the build needs before it starts: who lacks something reads its name, not a compiler's complaints."""
from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import tempfile
from typing import List, NamedTuple, Optional

from .project import Failure
from .target import Target


class Parts(NamedTuple):
    """The parts that the build can do without: libcscd-baselines.so, and the reader of GIFTI surfaces."""

    baselines: bool
    expat: bool


class Need(NamedTuple):
    """A library: its name, the header and the flag that prove that it is there, and its package in Debian."""

    what: str
    header: str
    flag: str
    package: str


LIBRARIES = [
    Need("libpng", "png.h", "-lpng", "libpng-dev"),
    Need("zlib", "zlib.h", "-lz", "zlib1g-dev"),
    Need("json-c", "json-c/json.h", "-ljson-c", "libjson-c-dev"),
]
# The build goes on without these.
EXPAT = Need("expat", "expat.h", "-lexpat", "libexpat1-dev")
BASELINES = [
    Need("LAPACKE", "lapacke.h", "-llapacke", "liblapacke-dev"),
    Need("OpenBLAS", "cblas.h", "-lopenblas", "libopenblas-dev"),
    Need("GSL", "gsl/gsl_poly.h", "-lgsl", "libgsl-dev"),
]


def compiler() -> List[str]:
    """The words that start the C compiler."""
    return shlex.split(os.environ.get("CC", "")) or ["gcc"]


def is_there(need: Need, target: Target = Target()) -> bool:
    """Whether a program compiles and links with a library."""
    program = f"#include <stddef.h>\n#include <stdio.h>\n#include <{need.header}>\nint main(void) {{ return 0; }}\n"
    flags = [shlex.split(os.environ.get(name, "")) for name in ("CFLAGS", "LDFLAGS")]
    words = [*compiler(), *flags[0], *target.flags(), "-x", "c", "-", *flags[1]]
    with tempfile.TemporaryDirectory() as folder:
        command = [*words, need.flag, "-o", os.path.join(folder, "program")]
        return subprocess.run(command, input=program.encode(), capture_output=True).returncode == 0


def check(baselines: Optional[bool], whole: bool = False, target: Target = Target()) -> Parts:
    """Fails with a sentence when something is missing, and returns what else can be built.

    `baselines` is what the caller asks for: True, False, or None for "where it can be built"; `whole` asks for everything
    else.
    """
    tools = [tool for tool in ("make", compiler()[0]) if shutil.which(tool) is None]
    if tools:
        fail(tools, ["build-essential"])
    wanted = LIBRARIES + (BASELINES if baselines else []) + ([EXPAT] if whole else [])
    missing = [need for need in wanted if not is_there(need, target)]
    if missing:
        fail([f"{need.what} ({need.header})" for need in missing], [need.package for need in missing])
    has_baselines = all(is_there(need, target) for need in BASELINES) if baselines is None else baselines
    parts = Parts(has_baselines, is_there(EXPAT, target))
    if not parts.expat:
        print("cscd: without expat (expat.h), so GIFTI surfaces are not read; Debian's package is libexpat1-dev",
              flush=True)
    if not parts.baselines and baselines is None:
        print("cscd: without LAPACKE, OpenBLAS and GSL, so Plan.charge has no dense solver; Debian's packages are "
              "liblapacke-dev, libopenblas-dev and libgsl-dev", flush=True)
    return parts


def fail(missing: List[str], packages: List[str]) -> None:
    """Says what is missing and what to install."""
    raise Failure(
        f"the build needs {' and '.join(missing)}, not found on this machine. Nothing has been built.\n"
        f"On Debian or Ubuntu, as root, type:\n"
        f"    apt-get update && apt-get install -y --no-install-recommends {' '.join(packages)}\n"
        f"Elsewhere, install the packages of these names with their headers."
    )
