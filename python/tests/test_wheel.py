"""The wheel that is given away: what is in it, what it needs, and that it is whole, or not there at all."""
from __future__ import annotations

import base64
import hashlib
import os
import shutil
import signal
import subprocess
import sys
import time
import zipfile
from pathlib import Path
from typing import Dict

import pytest

import package_rig as rig
from build_backend import native

VERSION = rig.Project.read(rig.ROOT).version
NAME = f"cscd-{VERSION}-py3-none-linux_x86_64.whl"


@pytest.fixture(scope="session")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A source tree whose path has a space and an umlaut in it."""
    return rig.source_tree(tmp_path_factory.mktemp("a fresh clöne"))


@pytest.fixture(scope="session")
def wheel(tree: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of that tree."""
    folder = tmp_path_factory.mktemp("wheel")
    assert rig.make_archive("wheel", tree, folder).endswith(f"{folder / NAME}\n")
    return folder / NAME


def contents(wheel: Path) -> Dict[str, bytes]:
    with zipfile.ZipFile(wheel) as archive:
        assert archive.testzip() is None
        return {name: archive.read(name) for name in archive.namelist()}


def test_record_names_every_file(wheel: Path) -> None:
    files = contents(wheel)
    record = f"cscd-{VERSION}.dist-info/RECORD"
    lines = {}
    for line in files[record].decode().splitlines():
        path, digest, size = line.rsplit(",", 2)
        lines[path] = (digest, size)
    assert lines.keys() == files.keys()
    assert lines.pop(record) == ("", "")
    for path, (digest, size) in lines.items():
        expected = base64.urlsafe_b64encode(hashlib.sha256(files[path]).digest()).rstrip(b"=").decode()
        assert (digest, size) == (f"sha256={expected}", str(len(files[path]))), path


def test_package_is_the_folder_of_sources_and_the_library(wheel: Path) -> None:
    packed = {Path(name).name for name in contents(wheel) if name.startswith("cscd/")}
    written = {path.name for path in (rig.ROOT / "python" / "cscd").iterdir() if path.is_file()}
    assert packed == written | {"libcscd-python.so"}


def test_metadata_says_what_pyproject_says(wheel: Path) -> None:
    files = contents(wheel)
    metadata = files[f"cscd-{VERSION}.dist-info/METADATA"].decode()
    for line in ("Name: cscd", f"Version: {VERSION}", "Requires-Python: >=3.9", "Requires-Dist: numpy", "License: MIT"):
        assert f"\n{line}\n" in metadata.split("\n\n")[0] + "\n"
    assert metadata.count("Requires-Dist:") == 1
    assert b"\nTag: py3-none-linux_x86_64\n" in files[f"cscd-{VERSION}.dist-info/WHEEL"]
    assert files[f"cscd-{VERSION}.dist-info/entry_points.txt"] == b"[console_scripts]\ncscd = cscd.__main__:main\n"
    licences = {Path(name).name for name in files if "/licenses/" in name}
    assert licences == {"LICENSE", "expat.txt", "json-c.txt", "libpng.txt", "zlib.txt"}


def test_library_needs_the_c_library_alone(wheel: Path, tmp_path: Path) -> None:
    library = tmp_path / "libcscd-python.so"
    library.write_bytes(contents(wheel)["cscd/libcscd-python.so"])
    dynamic = rig.run("readelf", "-d", str(library), cwd=tmp_path)
    needed = {line.split("[")[1].rstrip("]") for line in dynamic.splitlines() if "(NEEDED)" in line}
    assert needed <= {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2"}
    assert "RPATH" not in dynamic and "RUNPATH" not in dynamic and "TEXTREL" not in dynamic
    assert ".debug" not in rig.run("readelf", "-S", str(library), cwd=tmp_path)
    # Nothing of what has gone into it can get in the way of other versions in the process.
    exported = rig.run("nm", "-D", "--defined-only", str(library), cwd=tmp_path)
    names = [line.split()[-1] for line in exported.splitlines()]
    assert names and [name for name in names if not name.startswith(("cscd_", "cscdpy_"))] == []


def test_wheel_that_needs_more_is_not_given_away(tree: Path, tmp_path: Path) -> None:
    compiler = tmp_path / "compiler-without-archives"
    compiler.write_text('#!/bin/sh\ncase "$*" in *-print-file-name=lib*.a) echo lib.a ;; *) exec gcc "$@" ;; esac\n')
    compiler.chmod(0o755)
    said = rig.make_archive("wheel", tree, tmp_path / "out", status=1, CC=str(compiler))
    assert "the wheel would need libpng16.so.16 and libz.so.1 and libjson-c.so.5 and libexpat.so.1 wherever" in said
    assert not (tmp_path / "out").exists()


def test_another_folder_gives_the_same_bytes(wheel: Path, tmp_path: Path) -> None:
    other = rig.source_tree(tmp_path / "b")
    # What is compiled there knows the folder in what it tells debuggers.
    shutil.rmtree(other / "build" / "release" / "objects" / "python")
    rig.make_archive("wheel", other, tmp_path / "out")
    assert (tmp_path / "out" / NAME).read_bytes() == wheel.read_bytes()
    rig.make_archive("wheel", other, tmp_path / "dated", SOURCE_DATE_EPOCH="1700000000")
    dated = tmp_path / "dated" / NAME
    assert contents(dated) == contents(wheel) and dated.read_bytes() != wheel.read_bytes()


def test_two_builds_at_once_wait_for_each_other(tree: Path, wheel: Path, tmp_path: Path) -> None:
    words = [sys.executable, "-m", "build_backend", "wheel"]
    environment = rig.bare_environment(PYTHONPATH=str(tree / "python"))
    with native.alone(tree):
        builds = [
            subprocess.Popen([*words, str(tmp_path / name)], cwd=tree, env=environment, stdout=subprocess.DEVNULL)
            for name in "ab"
        ]
        time.sleep(3)  # a build that did not wait would have begun by now
        assert rig.left_behind(tree) == [] and [build.poll() for build in builds] == [None, None]
    assert [build.wait() for build in builds] == [0, 0]
    for name in "ab":
        assert (tmp_path / name / NAME).read_bytes() == wheel.read_bytes()
    assert rig.left_behind(tree) == []


def hear_interrupts() -> None:
    """What a shell starts in the background ignores SIGINT, and so would all that it starts."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def test_interrupted_build_leaves_nothing(tree: Path, wheel: Path, tmp_path: Path) -> None:
    compiler = tmp_path / "slow-compiler"
    compiler.write_text('#!/bin/sh\n'
                        'case "$*" in *libcscd-python*) touch "$0.reached"; exec sleep 60 ;; esac\n'
                        'exec gcc "$@"\n')
    compiler.chmod(0o755)
    reached = tmp_path / "slow-compiler.reached"
    out = tmp_path / "out"
    for number in (signal.SIGINT, signal.SIGTERM):
        build = subprocess.Popen([sys.executable, "-m", "build_backend", "wheel", str(out)], cwd=tree,
                                 env=rig.bare_environment(PYTHONPATH=str(tree / "python"), CC=str(compiler)),
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
                                 preexec_fn=hear_interrupts)
        while not reached.exists():
            assert build.poll() is None, "the build ended before it was interrupted"
            time.sleep(0.02)
        os.killpg(build.pid, number)
        assert build.wait(timeout=20) != 0
        reached.unlink()
        assert not out.exists() or list(out.iterdir()) == []
        # What a killed build leaves in the tree, the next one removes.
        assert number == signal.SIGTERM or rig.left_behind(tree) == []
    rig.make_archive("wheel", tree, out)
    assert rig.left_behind(tree) == []
    assert (out / NAME).read_bytes() == wheel.read_bytes()
