"""Flags of the caller that would change what is computed are refused with a sentence, by make and by the sources.

So are those for a 32-bit system; others are harmless.
"""
import platform

import pytest

from support.install.built_tree import CC, shell


def make_object(variables, code):
    """What make says and would run for one object of the library."""
    folder = "build/no-such-build"
    return shell(f"make -n BUILD_ROOT={folder} {folder}/release/objects/src/core/sort.o {variables}", code=code)


@pytest.mark.parametrize("variables", [
    "CFLAGS='-g -Ofast'", "CFLAGS=-ffast-math", "CPPFLAGS=-ffinite-math-only", "CC='clang -funsafe-math-optimizations'",
])
def test_make_refuses_other_arithmetic(variables):
    assert "IEEE arithmetic: leave out -" in make_object(variables, 2)


@pytest.mark.parametrize("flags, code", [
    ("-Ofast", 1), ("-ffast-math", 1), ("-ffinite-math-only", 1), ("-Ofast -fno-fast-math", 0),
    ("-Os -fno-math-errno -fno-trapping-math", 0),
])
def test_sources_refuse_other_arithmetic(flags, code):
    """Who compiles the sources in another way reads the sentence, too."""
    said = shell(f"echo '#include \"src/core/floating.h\"' | {CC} {flags} -I. -fsyntax-only -x c -", code=code)
    assert ("IEEE arithmetic" in said) == (code != 0)


@pytest.mark.parametrize("flags", ["-m32", "-mx32"] if platform.machine() == "x86_64" else ["-D__SIZEOF_POINTER__=4"])
def test_sources_refuse_32_bits(flags):
    """The sentence comes first, also where the headers of such a system are missing."""
    assert "cscd runs on 64-bit systems" in shell(f"{CC} {flags} -Iinclude -I. -fsyntax-only src/core/system.c", code=1)


def test_sources_take_64_bits():
    shell(f"{CC} -D_GNU_SOURCE -Iinclude -I. -fsyntax-only src/core/system.c")


def test_flags_that_are_left_out():
    """Flags of the caller are passed on, but for those that the library is built without."""
    said = make_object("V=1 CPPFLAGS=-D_FORTIFY_SOURCE=2 CFLAGS='-Os -flto=auto -ffp-contract=fast -g3'", 0)
    assert " -D_FORTIFY_SOURCE=2 -Os -g3 " in said and " -ffp-contract=off " in said
    assert "-flto" not in said and "-ffp-contract=fast" not in said
