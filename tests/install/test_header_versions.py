"""Callers and libraries of different versions.

A caller that was compiled with the headers of a later version, in which every struct that may grow has one more member, runs on
this library; and today's caller on a library of those headers. Nothing is written behind the caller's structs, and members that
only the caller knows are 0.
"""
import shutil

import pytest

from support.install.built_tree import BUILD, ROOT, shell


@pytest.fixture(scope="module")
def later(tmp_path_factory):
    """A folder with the later headers."""
    later = tmp_path_factory.mktemp("later")
    shell(f"tests/install/api_headers.py later '{later}/include'")
    return later


def fills_all(folder, include, library, flags=""):
    """Compiles the caller with the headers in `include`, and runs it on the library in `library`.

    Every struct that may grow must have been filled; a new one is added to tests/install/versions/caller.c.
    """
    shell(f"gcc -std=c11 -Wall -Wextra -Wno-missing-field-initializers -Werror {flags} -I'{include}' -I. -o '{folder}/caller' "
          f"tests/install/versions/caller.c -L'{library}' -lcscd -Wl,-rpath,'{library}'")
    filled = sorted(set(shell(f"'{folder}/caller'").splitlines()))
    assert filled == shell("tests/install/api_headers.py grows").splitlines()


def test_todays_caller_on_todays_library(tmp_path):
    fills_all(tmp_path, "include", BUILD)


def test_later_caller_on_todays_library(tmp_path, later):
    fills_all(tmp_path, later / "include", BUILD, "-DWITH_LATER")


def test_todays_caller_on_later_library(tmp_path, later):
    """A copy of the sources beside the later headers.

    What asserts that new members are looked after is left out, because nobody has; and so are vectors and what the caller does
    not use, which compiles quicker.
    """
    for name in ("src", "preprocess", "runtime", "sensors", "packaging", "Makefile"):
        (later / name).symlink_to(ROOT / name)
    compiler = "ccache gcc" if shutil.which("ccache") else "gcc"
    shell(f"make -s -j2 -C '{later}' library CC='{compiler}' CONFIG=debug BASELINES=0 OPTIMISE_debug='-O0 -DNDEBUG' "
          "LEVELS=scalar CORE_DEFINITIONS= WARNINGS=-w CFLAGS=\"'-D_Static_assert(holds,text)='\"")
    fills_all(tmp_path, "include", later / "build/debug")
