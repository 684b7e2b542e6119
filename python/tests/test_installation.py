"""What users type: pip, in a new virtual environment that sees the system's numpy, without an index to ask.

The package that is installed runs in an empty folder, away from the sources.
"""
from __future__ import annotations

import json
import sys
import tarfile
from pathlib import Path
from typing import Dict, List, NamedTuple

import pytest

import package_rig as rig

CUBE = """
import cscd, json, numpy, os, sys
V = numpy.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [.5, .5, -1], [.5, .5, 1], [3, 3, 0]], float)
F = numpy.array([[0, 1, 2], [3, 4, 5]])
found = cscd.self_intersections(V, F)
closed = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
mesh = cscd.Mesh([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
assert cscd.Plan.charge(mesh, closed).region_count == 1
try:
    charge = str(cscd.Plan.charge(mesh, closed, solver="dense").region_count > 0)
except cscd.Error as error:
    charge = str(error)
maps = open("/proc/self/maps").read()
print(json.dumps({"file": cscd.__file__, "version": cscd.__version__, "pairs": found.pairs.tolist(), "charge": charge,
                  "numpy": numpy.__file__, "foreign": [name for name in ("libpng", "libjson-c") if name in maps],
                  "written": os.listdir(".")}))
"""


class Clone(NamedTuple):
    """A clone in which README's command has been run: its folder, what its module answered, what lay in build/ then."""

    tree: Path
    said: Dict[str, object]
    left: List[str]


@pytest.fixture(scope="module")
def clone(tmp_path_factory: pytest.TempPathFactory) -> Clone:
    """The clone, whose virtual environment the other tests use again, since making one takes longest of all."""
    tree = rig.source_tree(tmp_path_factory.mktemp("a clone with späces"))
    lines = (rig.ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    commands = [line.strip() for line in lines if "-m venv" in line and line.startswith("    ")]
    assert commands == ["python3 -m venv --system-site-packages v && v/bin/pip install ."]
    rig.run("sh", "-euc", commands[0].replace("python3 ", f"{sys.executable} "), cwd=tree)
    said = answers(tree / "v" / "bin", tmp_path_factory.mktemp("empty"))
    return Clone(tree, said, sorted(path.name for path in (tree / "build").iterdir()))


@pytest.fixture
def binaries(clone: Clone) -> Path:
    """The bin folder of an environment with nothing of ours in it."""
    folder = clone.tree / "v" / "bin"
    rig.run(str(folder / "pip"), "uninstall", "-y", "-q", "cscd", cwd=clone.tree)
    assert not list((clone.tree / "v").rglob("*cscd*"))
    return folder


@pytest.fixture
def empty(tmp_path: Path) -> Path:
    """An empty folder to run in."""
    folder = tmp_path / "empty"
    folder.mkdir()
    return folder


def answers(binaries: Path, empty: Path) -> Dict[str, object]:
    """What the installed package answers to CUBE. On a new processor it warns of the kernels that OpenBLAS has chosen."""
    read = json.loads(rig.run(str(binaries / "python"), "-W", "ignore::RuntimeWarning", "-c", CUBE, cwd=empty))
    assert isinstance(read, dict)
    assert str(read["file"]).startswith(str(binaries.parent))
    assert not str(read["numpy"]).startswith(str(binaries.parent))
    assert read["version"] == rig.Project.read(rig.ROOT).version and read["pairs"] == [[0, 1]] and read["written"] == []
    return read


def test_sources_are_installed_as_readme_says(clone: Clone) -> None:
    assert clone.said["charge"] == "True"
    # pip has built in the tree, and left nothing there but objects.
    assert clone.left == ["python.lock", "release"]


def test_wheel_is_installed_without_an_index(binaries: Path, tmp_path: Path, empty: Path) -> None:
    made = rig.make_archive("wheel", rig.ROOT, tmp_path).splitlines()[-1]
    rig.run(str(binaries / "pip"), "install", "--no-index", made, cwd=empty)
    read = answers(binaries, empty)
    assert "libcscd-baselines.so.2" in str(read["charge"]) and "install it from its sources" in str(read["charge"])
    assert read["foreign"] == []
    # The tool, by both of its names.
    version = f"cscd {read['version']} ("
    assert rig.run(str(binaries / "cscd"), "--version", cwd=empty).startswith(version)
    assert rig.run(str(binaries / "python"), "-m", "cscd", "--version", cwd=empty).startswith(version)
    (empty / "crossing.off").write_text("OFF\n6 2 0\n0 0 0\n2 0 0\n0 2 0\n.5 .5 -1\n.5 .5 1\n3 3 0\n3 0 1 2\n3 3 4 5\n")
    said = rig.run(str(binaries / "cscd"), "check", "--fail-on", "crossing", "crossing.off", cwd=empty, status=3)
    assert "1 pair" in said


def test_archive_of_sources_is_installed(binaries: Path, tmp_path: Path, empty: Path) -> None:
    made = Path(rig.make_archive("sdist", rig.ROOT, tmp_path).splitlines()[-1])
    with tarfile.open(made) as archive:
        archive.extractall(tmp_path)
    tree = tmp_path / made.name[: -len(".tar.gz")]
    rig.copy_objects(tree)
    said = rig.run(str(binaries / "pip"), "install", "-v", "--config-settings", "baselines=0", ".", cwd=tree)
    assert "BASELINES" not in said and "Successfully installed cscd" in said
    assert "libcscd-baselines.so.2" in str(answers(binaries, empty)["charge"])


def test_what_is_missing_stands_in_what_pip_prints(binaries: Path, clone: Clone, tmp_path: Path, empty: Path) -> None:
    path = rig.tools_without(tmp_path / "tools", "make")
    said = rig.run(str(binaries / "pip"), "install", str(clone.tree), cwd=empty, status=1, PATH=path)
    assert "cscd: the build needs make, not found on this machine" in said and "Traceback" not in said
    assert "ERROR: Could not build wheels for cscd" in said


def test_editable_installation_sees_what_make_builds(binaries: Path, clone: Clone, tmp_path: Path, empty: Path) -> None:
    rig.run(str(binaries / "pip"), "install", "--editable", str(clone.tree), cwd=empty)
    words = (str(binaries / "python"), "-c", "import cscd; print(cscd.__file__)")
    assert rig.run(*words, cwd=empty) == f"{clone.tree / 'build' / 'python' / 'cscd' / '__init__.py'}\n"
