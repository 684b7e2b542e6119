"""What the tests of the archives share: source trees to build from, and virtual environments to install into."""
from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Dict, List

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "python"))

from build_backend import native, sdist  # noqa: E402
from build_backend.project import Project  # noqa: E402

# Without an index pip has nothing to ask; a request would fail, because nothing listens there.
OFFLINE = {"PIP_NO_INDEX": "1", "PIP_CONFIG_FILE": os.devnull, "https_proxy": "http://127.0.0.1:9"}


def bare_environment(**more: str) -> Dict[str, str]:
    """The environment of a user: nothing of this build, no index for pip."""
    environment = {key: value for key, value in native.environment().items() if not key.startswith(("PYTHON", "PIP"))}
    return {**environment, **OFFLINE, "PYTHONDONTWRITEBYTECODE": "1", **more}


def run(*words: str, cwd: Path, status: int = 0, **more: str) -> str:
    """Runs a program that must end with `status`, and returns what it printed."""
    ended = subprocess.run(words, cwd=cwd, env=bare_environment(**more), text=True,
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert ended.returncode == status, f"{' '.join(words)} ended with {ended.returncode}:\n{ended.stdout}"
    return ended.stdout


def source_tree(folder: Path) -> Path:
    """A copy of the sources, as a fresh clone has them, with the objects of the tree that is tested.

    The objects save the seconds of compiling, as a compiler cache would: they are of the same sources, and younger.
    """
    for name in sdist.source_files(ROOT):
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, target)
    copy_objects(folder)
    return folder


def copy_objects(tree: Path) -> None:
    """Puts the objects of the tree that is tested into another one."""
    shutil.copytree(ROOT / "build" / "release" / "objects", tree / "build" / "release" / "objects",
                    ignore=shutil.ignore_patterns("tests", "benchmarks", "models"), copy_function=shutil.copy)


def make_archive(kind: str, tree: Path, folder: Path, status: int = 0, **more: str) -> str:
    """Lets the back end of a tree make a `wheel` or an `sdist` in a folder, and returns what it printed."""
    words = (sys.executable, "-m", "build_backend", kind, str(folder))
    return run(*words, cwd=tree, status=status, PYTHONPATH=str(tree / "python"), **more)


def virtual_environment(folder: Path) -> Path:
    """Makes a virtual environment that sees the packages of the system, numpy above all, and returns its bin folder."""
    run(sys.executable, "-m", "venv", "--system-site-packages", str(folder), cwd=ROOT)
    return folder / "bin"


def tools_without(folder: Path, *missing: str) -> str:
    """A PATH on which all programs of the system stand but these."""
    folder.mkdir()
    for place in reversed(os.environ["PATH"].split(os.pathsep)):
        for program in Path(place).glob("*"):
            if program.name not in missing:
                link = folder / program.name
                link.unlink(missing_ok=True)
                link.symlink_to(program)
    return str(folder)


def left_behind(tree: Path) -> List[str]:
    """What a build that has ended must not leave in build/."""
    return [path.name for path in (tree / "build").glob("package.*")]
