"""Runs everything that tests the Python package, and ends as tests/run.sh does: with the line `N passed, M failed`.

`make test-python` calls it, after it has built the package in build/python. The interpreter that runs it is the one
that is tested.
"""
from __future__ import annotations

import ast
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Callable, List, Tuple

ROOT = Path(__file__).resolve().parent.parent.parent
PACKAGE = ROOT / "build" / "python" / "cscd"
REPORT = ROOT / "build" / "python-tests.xml"
# The oldest language that the sources keep to.
OLDEST = (3, 9)

Totals = Tuple[int, int]


def python(*words: str) -> int:
    """Runs the interpreter in the root of the repository, as a user of build/python would, and returns its status."""
    environment = {**os.environ, "PYTHONPATH": str(PACKAGE.parent), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run([sys.executable, *words], cwd=ROOT, env=environment).returncode


def pytest(*words: str) -> Totals:
    """Runs pytest and counts. A test that is skipped counts as failed: it has tested nothing."""
    REPORT.unlink(missing_ok=True)
    status = python("-m", "pytest", "-q", "--tb=short", "--durations=5", f"--junitxml={REPORT}", *words)
    if not REPORT.exists():
        print(f"pytest ended with status {status} and counted nothing")
        return 0, 1
    suite = ElementTree.parse(REPORT).getroot().find("testsuite")
    counts = {} if suite is None else suite.attrib
    total, bad = int(counts["tests"]), sum(int(counts[kind]) for kind in ("errors", "failures", "skipped"))
    return total - bad, max(bad, int(status != 0))


def written_tests() -> Totals:
    """The tests of this folder."""
    return pytest("python/tests")


def docstring_examples() -> Totals:
    """The examples in the package's docstrings print what they show."""
    return pytest("--doctest-modules", str(PACKAGE))


def checked_types() -> Totals:
    """mypy finds no fault in the package, in what builds it, and in what calls it."""
    failed = [folder for folder in ("cscd", "build_backend") if python("-m", "mypy", f"python/{folder}") != 0]
    return 2 - len(failed), len(failed)


def sources() -> List[Path]:
    """The Python files that users run."""
    folders = [ROOT / "python" / name for name in ("cscd", "build_backend", "examples")] + [ROOT / "blender"]
    return sorted(path for folder in folders for path in folder.rglob("*.py"))


def oldest_language() -> Totals:
    """Each source is one for the oldest Python, as far as its grammar shows."""
    failed = 0
    for path in sources():
        try:
            ast.parse(path.read_text(encoding="utf-8"), str(path), feature_version=OLDEST)
        except SyntaxError as error:
            print(f"{path.relative_to(ROOT)}:{error.lineno}: not Python {OLDEST[0]}.{OLDEST[1]}: {error.msg}")
            failed += 1
    return len(sources()) - failed, failed


STEPS: List[Callable[[], Totals]] = [oldest_language, checked_types, docstring_examples, written_tests]


def main() -> int:
    """Runs all steps, and adds up."""
    passed = failed = 0
    for step in STEPS:
        print(f"== {(step.__doc__ or '').splitlines()[0]}", flush=True)
        good, bad = step()
        print(f"{good} passed and {bad} failed", flush=True)
        passed, failed = passed + good, failed + bad
    print(f"{passed} passed, {failed} failed")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
