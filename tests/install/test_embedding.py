"""Projects that build the library by CMake's add_subdirectory, static and shared, and that find what such a build installed.

The host takes warnings for errors that are no faults of ours, and is careless of rounding. Objects are compiled without
optimisation, which is quicker.
"""
import re
import shutil

import pytest

from support.install.built_tree import ROOT, VERSION, needed_by, shell


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("embedding")


HOST_FLAGS = "-O0 -Wall -Wextra -Wpedantic -Wconversion -Werror -ffast-math"


def build(project, *options):
    """Configures and builds the project, and runs its program. A compiler cache spares most of the second build."""
    launcher = shutil.which("ccache") or ""
    shell(f"cmake -S tests/install/embedding -B '{project}' -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS='{HOST_FLAGS}' "
          f"-DCMAKE_C_COMPILER_LAUNCHER='{launcher}' {' '.join(options)} && cmake --build '{project}' -j2")
    assert shell(f"'{project}/client'") == f"cscd {VERSION}\nvf 4 0 at t = 0.667\n"


@pytest.fixture(scope="module")
def static(folder):
    build(folder / "static", f"-DCSCD_SOURCES='{ROOT}'", "-DCSCD_INSTALL=ON")
    return folder / "static"


def test_a_static_library(static):
    """Only public names leave it, and the flags of the project do not reach it."""
    names = shell(f"nm -g --defined-only '{static}/cscd/libcscd.a'").splitlines()
    assert [line for line in names if re.search(" [A-Z] ", line) and " T cscd_" not in line] == []


def test_a_shared_library(folder):
    """It needs the C library alone; what needs more is in libcscd-baselines.so, beside it."""
    build(folder / "shared", f"-DCSCD_SOURCES='{ROOT}'", "-DBUILD_SHARED_LIBS=ON")
    assert needed_by(folder / "shared/cscd/libcscd.so") == ["libc", "libm"]


def test_an_installed_library(static, folder):
    shell(f"cmake --install '{static}' --prefix '{folder}/prefix'")
    build(folder / "installed", f"-DCMAKE_PREFIX_PATH='{folder}/prefix'")
