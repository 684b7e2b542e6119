"""The library opens libcscd-baselines.so, beside itself or where the system looks, for charge by a dense matrix.

So does a program with the static library inside, and the tool, beside itself or in its prefix. Without it, or with a wrong one,
that call fails with a sentence and everything else works, also where OpenBLAS would hang.
"""
import os
import shutil

import pytest

from support.install.built_tree import BASELINE_LIBRARY, BUILD, CC, MAJOR, needed_by, shell

COMPILE = f"{CC} -std=c99 -Wall -Wextra -Werror -Iinclude tests/install/charge_client.c"


@pytest.fixture(scope="module")
def clients(tmp_path_factory):
    """A client of the shared library, which is alone in the folder lib, and one with the static library inside."""
    folder = tmp_path_factory.mktemp("baselines")
    (folder / "lib").mkdir()
    library = shutil.copy(BUILD / f"libcscd.so.{MAJOR}", folder / "lib")
    # This way to its own libraries does not count when a library opens another one.
    shell(f"{COMPILE} '{library}' -Wl,--enable-new-dtags,-rpath,'{folder}/lib' -o '{folder}/opens'")
    shell(f"{COMPILE} '{BUILD}/libcscd.a' -lm -ldl -pthread -o '{folder}/linked'")
    return folder


@pytest.fixture
def linked(clients):
    """What the static library prints with that library beside the program."""
    shutil.copy(BUILD / BASELINE_LIBRARY, clients)
    printed = shell(f"'{clients}/linked'")
    (clients / BASELINE_LIBRARY).unlink()
    assert "solved: charge 0x1." in printed
    return printed


@pytest.fixture
def lib(clients):
    """The folder of the library, in which nothing else is left."""
    yield clients / "lib"
    for path in (clients / "lib").iterdir():
        if path.is_dir():
            shutil.rmtree(path)
        elif path.name != f"libcscd.so.{MAJOR}":
            path.unlink()


def opened(clients, folders=""):
    return shell(f"'{clients}/opens'", LD_LIBRARY_PATH=str(folders))


@pytest.mark.parametrize("place", [".", "cscd"])
def test_is_looked_for_beside_the_library(clients, lib, linked, place):
    """Or as distributions lay it out; the library has its own name there, and is loaded by a link."""
    (lib / place).mkdir(exist_ok=True)
    shutil.copy(BUILD / BASELINE_LIBRARY, lib / place)
    assert opened(clients) == linked


def test_is_looked_for_where_the_system_looks(clients, lib, linked, tmp_path):
    shutil.copy(BUILD / BASELINE_LIBRARY, tmp_path)
    assert opened(clients, tmp_path) == linked


def refuses(clients, linked, words, client="opens"):
    """Dense solutions fail with a sentence that has these words; all else is as it was."""
    printed = shell(f"'{clients}/{client}'", LD_LIBRARY_PATH="")
    assert printed.startswith("solved: the system refused") and words in printed and BASELINE_LIBRARY in printed
    assert printed.split("from parts")[1] == linked.split("from parts")[1]


@pytest.mark.parametrize("client", ["opens", "linked"])
def test_is_missing(clients, lib, linked, client):
    refuses(clients, linked, "a build with BASELINES=1, which is the default, makes it", client)


def test_libraries_need_the_c_library_alone(clients):
    for binary in (BUILD / "libcscd.so", clients / "linked"):
        assert set(needed_by(binary)) <= {"libc", "libm"}


def test_is_damaged(clients, lib, linked):
    (lib / BASELINE_LIBRARY).write_text("text\n")
    refuses(clients, linked, "/lib/libcscd-baselines.so")


@pytest.mark.parametrize("source", [
    'const void *cscd_baseline_dense(unsigned i) {return i == 1000 ? "" : 0;}', "int unrelated;",
])
def test_is_of_another_version(clients, lib, linked, source):
    """Another interface, or a library that is none."""
    shell(f"echo '{source}' | {CC} -xc -shared -fPIC - -o '{lib}/{BASELINE_LIBRARY}'")
    refuses(clients, linked, "are of different versions")


def test_is_opened_when_it_is_needed(clients, lib):
    """A program that makes no plan by charge loads no linear algebra."""
    shutil.copy(BUILD / BASELINE_LIBRARY, lib)
    needed = shell(f"ldd '{clients}/opens'", LD_LIBRARY_PATH=str(lib))
    assert "lapack" not in needed and "openblas" not in needed


def test_takes_no_blas_of_others():
    """GSL, which a program may have loaded, has its own cblas_sgemm, which would be found first."""
    assert "cblas_" not in shell(f"nm -D --undefined-only '{BUILD}/{BASELINE_LIBRARY}'")


@pytest.mark.parametrize("mebibytes, threads, sentence", [
    (50, 1, "takes 60 MiB of address space"), (320, 3, "takes 340 MiB of address space"),
    (150, 1, "128 MiB of address space for buffers"),
])
def test_a_host_needs_little_memory(clients, lib, mebibytes, threads, sentence):
    """A plan fails with a sentence where OpenBLAS would hang as it is loaded, which each of its threads makes likelier.

    Or where it would hang as it computes.
    """
    shutil.copy(BUILD / BASELINE_LIBRARY, lib)
    printed = shell(f"ulimit -v {mebibytes * 1024}; timeout 20 '{clients}/opens'", OPENBLAS_NUM_THREADS=str(threads))
    assert sentence in printed and "from parts" in printed


# ---- the tool


def lay_out_prefix(folder, libraries):
    """Writes a model, and a prefix with the tool alone."""
    for name in ("bin", libraries):
        (folder / "prefix" / name).mkdir(parents=True, exist_ok=True)
    shutil.copy(BUILD / "cscd", folder / "prefix/bin")
    (folder / "model.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")


@pytest.mark.parametrize("libraries", ["bin", "lib", "lib64", "of the machine"])
def test_the_tool_looks_in_its_prefix(tmp_path, libraries):
    """By its path, by its name alone, by a link from another folder, and under another name than its own."""
    if libraries == "of the machine":  # lib/ where the system has no such folders
        libraries = f"lib/{shell(f'{CC} -print-multiarch').strip()}"
    lay_out_prefix(tmp_path, libraries)

    def make_plan(call, code=0):
        line = f"{call} preprocess ../../model.obj -o ../../plan.ply --charge dense"
        return shell(line, code=code, cwd=tmp_path / "prefix/bin", PATH=f".:{os.environ['PATH']}")

    assert BASELINE_LIBRARY in make_plan("cscd", 1)
    shutil.copy(BUILD / BASELINE_LIBRARY, tmp_path / "prefix" / libraries)
    (tmp_path / "link").symlink_to("prefix/bin/cscd")
    for call in ("./cscd", "cscd", "../../link", "bash -c 'exec -a other ./cscd \"$@\"' -"):
        assert "\nwritten: " in "\n" + make_plan(call), call


@pytest.mark.parametrize("mebibytes", [60, 100, 140])
def test_the_tool_needs_little_memory(tmp_path, mebibytes):
    """OpenBLAS hangs in so little memory when it is loaded, and when a thread computes in it."""
    lay_out_prefix(tmp_path, "lib")
    shutil.copy(BUILD / BASELINE_LIBRARY, tmp_path / "prefix/lib")
    limited = f"ulimit -v {mebibytes * 1024}; timeout 20 prefix/bin/cscd"
    shell(f"{limited} info model.obj", cwd=tmp_path)
    assert "MiB of address space" in shell(f"{limited} preprocess model.obj -o plan.ply --charge dense", code=1, cwd=tmp_path)
