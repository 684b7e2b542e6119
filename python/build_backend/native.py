"""Builds the package folder, with its native library, by the Makefile.

The build is one in the tree: it takes over the objects that lie in build/ and leaves its own there for the next one,
while the package folder that becomes a wheel is a new one each time, so that nothing of an older version gets into it.
A tree that cannot be written to is copied first.
"""
from __future__ import annotations

import fcntl
import os
import shlex
import shutil
import subprocess
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import Dict, Iterator, List, Optional

from . import requirements, sdist
from .project import Failure
from .target import Target

# Variables that make would take from the environment although they mean another build, or that another make has left there.
NOT_FOR_MAKE = {"BUILD", "BUILD_ROOT", "GNUMAKEFLAGS", "MAKEFLAGS", "MAKELEVEL", "MAKEOVERRIDES", "MFLAGS", "ONLY"}


def baselines_setting(settings: Optional[Dict[str, object]]) -> Optional[bool]:
    """The value of `--config-settings baselines=`: True, False, or None if it is not given."""
    for key in settings or {}:
        if key != "baselines":
            raise Failure(f"the only --config-settings is baselines=0 or baselines=1, and not {key}")
    value = str((settings or {}).get("baselines", ""))
    if value not in ("", "0", "1"):
        raise Failure(f"--config-settings baselines={value} is neither baselines=0 nor baselines=1")
    return None if value == "" else value == "1"


@contextmanager
def built_package(root: Path, baselines: Optional[bool], target: Target = Target()) -> Iterator[Path]:
    """Builds the package of the tree `root` into a folder `cscd` that is there until the block ends.

    `baselines` says whether libcscd-baselines.so is part of it; None means where its libraries are installed.
    """
    parts = requirements.check(baselines, target=target)
    with writable_tree(root) as tree, alone(tree) as lock:
        for rest in (tree / "build").glob("package.*"):
            shutil.rmtree(rest)  # of a build that was killed: no other one holds the lock
        with tempfile.TemporaryDirectory(dir=tree / "build", prefix="package.") as folder:
            package = Path(folder, "cscd")
            # Relative, because make takes no names with spaces in them.
            settings = [f"PYTHON_PACKAGE={package.relative_to(tree)}", f"LDFLAGS={stripped()}", *target.settings]
            run_make(tree, commit_of(root), parts, lock, *settings)
            check_package(package, parts.baselines, target.library)
            yield package


def build_in_place(root: Path, baselines: Optional[bool]) -> None:
    """Builds the package of the tree `root` as `make python` does, in build/python."""
    parts = requirements.check(baselines)
    with alone(root) as lock:
        run_make(root, commit_of(root), parts, lock)


@contextmanager
def alone(tree: Path) -> Iterator[int]:
    """Waits until no other build of ours runs in a tree, and keeps others waiting; gives the lock's file descriptor."""
    (tree / "build").mkdir(exist_ok=True)
    with open(tree / "build" / "python.lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield lock.fileno()


def stripped() -> str:
    """The caller's flags for the linker, and the one that leaves out what only a debugger reads."""
    return f"{os.environ.get('LDFLAGS', '')} -s".strip()


@contextmanager
def writable_tree(root: Path) -> Iterator[Path]:
    """The tree itself, or a copy of its sources where it cannot be written to."""
    inside = ("", "release", "release/objects", "python.lock")
    places = [root, *(root / "build" / name for name in inside)]
    if all(os.access(place, os.W_OK) for place in places if place.exists()):
        yield root
        return
    with tempfile.TemporaryDirectory(prefix="cscd-build-") as folder:
        for name in sdist.source_files(root):
            target = Path(folder, name)
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(root / name, target)
        yield Path(folder)


def commit_of(root: Path) -> str:
    """The commit that results of the tool name: of this tree, and not of a tree of somebody else's that it lies in."""
    if not sdist.tracked_files(root):
        return "unknown"
    words = ["git", "-C", str(root), "rev-parse", "--short=12", "HEAD"]
    return subprocess.run(words, capture_output=True, text=True).stdout.strip() or "unknown"


def run_make(tree: Path, commit: str, parts: requirements.Parts, lock: int, *settings: str) -> None:
    """Runs make for the package; what it prints goes to the caller's standard output."""
    command = ["make", f"-j{len(os.sched_getaffinity(0))}", "--no-print-directory", "python"]
    command += ["CONFIG=release", "WERROR=0", f"BASELINES={int(parts.baselines)}", f"EXPAT={int(parts.expat)}"]
    command += [f"COMMIT={commit}", *settings]
    # make holds the lock, too: if this process is killed, the next build waits for the end of its make.
    status = subprocess.run(command, cwd=tree, env=environment(), pass_fds=[lock]).returncode
    if status != 0:
        said = " ".join(shlex.quote(word) for word in command)
        raise Failure(f"make ended with status {status}; what it said stands above. "
                      f"The command, in the source tree:\n    {said}")


def environment() -> Dict[str, str]:
    """The caller's environment without what would make this another build."""
    return {name: value for name, value in os.environ.items() if name not in NOT_FOR_MAKE}


def check_package(package: Path, with_baselines: bool, library: str) -> None:
    """Fails unless what the package cannot do without is there."""
    needed: List[str] = ["__init__.py", "__main__.py", "py.typed", library]
    if with_baselines:
        needed.append("libcscd-baselines.so.*")
    missing = [name for name in needed if not list(package.glob(name))]
    if missing:
        raise Failure(f"make has left out {' and '.join(missing)}")
