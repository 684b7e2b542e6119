"""make install, programs that use the installed files (pkg-config, CMake, moved trees), and make uninstall."""
import os
import re
import shutil
from pathlib import Path

import pytest

from support.install.built_tree import (
    BUILD, CC, MAJOR, MINOR, ROOT, VERSION, files_in, make, needed_by, shell, symbols_of,
)

# What both clients must print, whichever library they use.
PRINTED = f"cscd {VERSION}\nvf 4 0 at t = 0.667\n"
STRICT = "-std=c99 -Wall -Wextra -Wpedantic -Werror"


@pytest.fixture(scope="module")
def stage(tmp_path_factory):
    """DESTDIR."""
    stage = tmp_path_factory.mktemp("install") / "stage"
    make("install", stage, "PREFIX=/opt/cscd")
    return stage


@pytest.fixture
def prefix(stage):
    return stage / "opt/cscd"


def pkg_config(prefix, options):
    return shell(f"pkg-config {options} cscd", PKG_CONFIG_PATH=f"{prefix}/lib/pkgconfig")


def test_files_are_where_they_belong(prefix):
    headers = [f"include/cscd/{path.name}" for path in (ROOT / "include/cscd").iterdir() if path.suffix in (".h", ".hpp")]
    libraries = [f"lib/{name}.so.{version}" for name in ("libcscd", "libcscd-baselines") for version in (MAJOR, VERSION)]
    assert files_in(prefix) == sorted([
        "bin/cscd", *headers, "lib/cmake/cscd/cscdConfig.cmake", "lib/cmake/cscd/cscdConfigVersion.cmake", *libraries,
        "lib/libcscd.a", "lib/libcscd.so", "lib/pkgconfig/cscd.pc", "share/man/man1/cscd.1", "share/man/man3/cscd.3"])
    assert (prefix / "bin/cscd").read_bytes() == (BUILD / "cscd").read_bytes()
    for folder in ("lib/pkgconfig", "lib/cmake", "share"):
        for name in files_in(prefix / folder):
            assert not re.search("@[A-Z_]*@", (prefix / folder / name).read_text()), name


def test_the_tool_answers(prefix):
    """What Debian's packages and the builds in other ways are asked, too."""
    said = shell(f"'{prefix}/bin/cscd' check tests/builds/crossing.obj", LD_LIBRARY_PATH=f"{prefix}/lib")
    assert said.split("\n")[0] + "\n" == (ROOT / "tests/builds/crossing.txt").read_text()


def test_the_library_alone(prefix, tmp_path):
    """Without the tool and its page; and nothing of it asks a package manager."""
    make("install-library", tmp_path / "library", "PREFIX=/opt/cscd")
    assert set(files_in(prefix)) - set(files_in(tmp_path / "library/opt/cscd")) == {"bin/cscd", "share/man/man1/cscd.1"}
    assert set(files_in(tmp_path / "library/opt/cscd")) < set(files_in(prefix))
    make("uninstall", tmp_path / "library", "PREFIX=/opt/cscd")
    assert not (tmp_path / "library").exists()
    assert "packages" not in shell("make -n library install-library")


def test_plain_make_installs_no_package(tmp_path):
    """On a machine without any library, where a compiler finds no header: make says what to type, and types nothing."""
    bare = tmp_path / "bare"
    bare.mkdir()
    for name, line in (("cc", "exit 1"), ("apt-get", f"touch '{tmp_path}/asked'"), ("sudo", f"touch '{tmp_path}/asked'")):
        (bare / name).write_text(f"#!/bin/sh\n{line}\n")
        (bare / name).chmod(0o755)
    said = shell(f"make -s all BUILD_ROOT='{tmp_path}/none'", code=2, PATH=f"{bare}:{os.environ['PATH']}")
    assert "apt-get install -y" in said and "libopenblas-dev" in said and "libcmocka-dev" not in said
    assert not (tmp_path / "asked").exists() and not (tmp_path / "none").exists()


def test_the_shared_library_exports_the_api(prefix):
    library = prefix / "lib/libcscd.so"
    assert re.search(rf"\(SONAME\).*\[libcscd\.so\.{MAJOR}\]", shell(f"readelf -d '{library}'"))
    exported = shell(f"nm -D --defined-only '{library}'")
    assert sorted(re.findall(rf" T (.*)@@CSCD_{MAJOR}\.\d+$", exported, re.MULTILINE)) == symbols_of()
    assert [line for line in exported.splitlines() if not re.search(" T cscd_| A CSCD_", line)] == []


def run_client(prefix, folder, flags):
    """Compiles tests/install/client.c, and runs it."""
    shell(f"{CC} {STRICT} tests/install/client.c {flags} -o '{folder}/client'")
    return shell(f"'{folder}/client'", LD_LIBRARY_PATH=f"{prefix}/lib")


def test_a_c_program_by_pkg_config(prefix, tmp_path):
    assert pkg_config(prefix, "--modversion") == f"{VERSION}\n"
    assert run_client(prefix, tmp_path, pkg_config(prefix, "--cflags --libs").strip()) == PRINTED
    assert re.search(rf"NEEDED.*libcscd\.so\.{MAJOR}\]", shell(f"readelf -d '{tmp_path}/client'"))
    flags = pkg_config(prefix, "--cflags --libs --static").strip().replace("-lcscd", "-l:libcscd.a")
    assert run_client(prefix, tmp_path, flags) == PRINTED
    assert "libcscd" not in needed_by(tmp_path / "client")


def test_the_example_of_the_manual(prefix, tmp_path):
    """The page cscd(3) ends with a program, between .nf and .fi; it is compiled as C99."""
    page = (prefix / "share/man/man3/cscd.3").read_text()
    program = re.search(r"^#include.*?^}$", page.split(".SH EXAMPLES")[1], re.DOTALL | re.MULTILINE).group()
    (tmp_path / "example.c").write_text(program.replace("\\e", "\\").replace("\\-", "-").replace("\\(aq", "'") + "\n")
    flags = pkg_config(prefix, "--cflags --libs").strip()
    shell(f"{CC} {STRICT} '{tmp_path}/example.c' {flags} -o '{tmp_path}/example'")
    assert "vf 4 0 at t = 0.66" in shell(f"'{tmp_path}/example'", LD_LIBRARY_PATH=f"{prefix}/lib")


def test_a_cpp_program_by_cmake(prefix, tmp_path):
    """A tree that was moved refers nowhere to its old place."""
    def build(place):
        project = tmp_path / "project"
        shell(f"cmake -S tests/install -B '{project}' -Dcscd_DIR='{place}/lib/cmake/cscd'")
        shell(f"cmake --build '{project}' --clean-first")
        for program, shared in (("with-cscd", True), ("with-cscd-static", False)):
            assert shell(f"'{project}/{program}'") == PRINTED and ("libcscd" in needed_by(project / program)) == shared

    build(prefix)
    moved = tmp_path / "moved"
    shutil.move(prefix, moved)
    build(moved)
    flags = pkg_config(moved, "--cflags --libs")
    assert str(moved) in flags and str(prefix) not in flags
    shutil.move(moved, prefix)


@pytest.mark.parametrize("version, answer", [
    (f"{MAJOR - 1}.9", " "), (f"{MAJOR}", "TRUE "), (VERSION, "TRUE TRUE"), (f"{MAJOR}.{MINOR + 1}", " "), (f"{MAJOR + 1}", " "),
])
def test_cmake_takes_the_same_major_version(prefix, tmp_path, version, answer):
    """Whether find_package accepts the installed version, and whether it is exactly that one."""
    (tmp_path / "version.cmake").write_text(
        f'set(PACKAGE_FIND_VERSION {version})\nset(PACKAGE_FIND_VERSION_MAJOR {version.split(".")[0]})\n'
        f'include("{prefix}/lib/cmake/cscd/cscdConfigVersion.cmake")\n'
        'message("${PACKAGE_VERSION_COMPATIBLE} ${PACKAGE_VERSION_EXACT}")\n')
    assert shell(f"cmake -P '{tmp_path}/version.cmake'") == f"{answer}\n"


def test_uninstall_leaves_nothing(tmp_path):
    make("install", tmp_path / "stage", "PREFIX=/opt/cscd")
    make("uninstall", tmp_path / "stage", "PREFIX=/opt/cscd")
    assert not (tmp_path / "stage").exists()


def test_uninstall_leaves_what_others_made(tmp_path):
    """Folders may have any names. Files and empty folders that were there before stay."""
    place = tmp_path / "with space"
    variables = ("PREFIX=/usr", "LIBDIR=/usr/lib/a-machine", "INCLUDEDIR=/elsewhere/include", "BINDIR=/usr/games",
                 "MANDIR=/usr/man")
    (place / "usr/lib/a-machine/pkgconfig").mkdir(parents=True)
    (place / "usr/man/man1").mkdir(parents=True)
    (place / "usr/man/man1/other.1").touch()
    before = sorted(place.rglob("*"))
    make("install", place, *variables)
    folder = shell("pkg-config --variable=includedir cscd", PKG_CONFIG_PATH=f"{place}/usr/lib/a-machine/pkgconfig")
    assert (Path(folder.strip().replace("\\", "")) / "cscd/cscd.h").exists()
    make("uninstall", place, *variables)
    assert sorted(place.rglob("*")) == before
