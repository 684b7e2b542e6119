"""Runs everything that tests the Python package, and ends as tests/run.sh does: with the line `N passed, M failed`.

`make test-python` calls it, after it has built the package in build/python. The interpreter that runs it is the one
that is tested. With the word `bridges` it runs the tests of python/bridges alone, which need other packages.
"""
from __future__ import annotations

import ast
import os
import subprocess
import sys
import threading
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Callable, List, Tuple

ROOT = Path(__file__).resolve().parent.parent.parent
PACKAGE = ROOT / "build" / "python" / "cscd"
# The oldest language that the sources keep to.
OLDEST = (3, 9)

# Tests that mostly wait for pip, make and the disk.
ARCHIVES = [f"python/tests/test_{name}.py" for name in ("back_end", "installation", "wheel")]

Totals = Tuple[int, int]


class Log:
    """What a step says, kept until it is shown."""

    def __init__(self) -> None:
        self.text = ""

    def say(self, text: str) -> None:
        """Adds a line."""
        self.text += f"{text}\n"

    def python(self, *words: str) -> int:
        """Runs the interpreter in the root of the repository, with build/python on its path; returns its status."""
        environment = {**os.environ, "PYTHONPATH": str(PACKAGE.parent), "PYTHONDONTWRITEBYTECODE": "1"}
        ended = subprocess.run([sys.executable, *words], cwd=ROOT, env=environment, text=True, errors="replace",
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.text += ended.stdout
        return ended.returncode

    def pytest(self, name: str, *words: str) -> Totals:
        """Runs pytest and counts. A test that is skipped counts as failed: it has tested nothing."""
        report = ROOT / "build" / f"python-{name}.xml"
        report.unlink(missing_ok=True)
        status = self.python("-m", "pytest", "-q", "--tb=short", "--durations=5", f"--junitxml={report}", *words)
        suite = ElementTree.parse(report).getroot().find("testsuite") if report.exists() else None
        if suite is None:
            self.say(f"pytest ended with status {status} and counted nothing")
            return 0, 1
        total = int(suite.attrib["tests"])
        bad = sum(int(suite.attrib[kind]) for kind in ("errors", "failures", "skipped"))
        return total - bad, max(bad, int(status != 0))


def archives(log: Log) -> Totals:
    """The wheel and the archive of the sources."""
    return log.pytest("archives", *ARCHIVES)


def written_tests(log: Log) -> Totals:
    """The other tests of this folder."""
    return log.pytest("tests", "python/tests", *(f"--ignore={path}" for path in ARCHIVES))


def bridges(log: Log) -> Totals:
    """The blocks of docs/python/bridges.md, with the packages that they lead to."""
    return log.pytest("bridges", "python/bridges")


def docstring_examples(log: Log) -> Totals:
    """The examples in the package's docstrings print what they show."""
    return log.pytest("docstrings", "--doctest-modules", str(PACKAGE))


def checked_types(log: Log) -> Totals:
    """mypy finds no fault in the package and in what builds it."""
    failed = [folder for folder in ("cscd", "build_backend") if log.python("-m", "mypy", f"python/{folder}") != 0]
    return 2 - len(failed), len(failed)


def sources() -> List[Path]:
    """The Python files that users run."""
    folders = [ROOT / "python" / name for name in ("cscd", "build_backend", "examples")] + [ROOT / "blender"]
    return sorted(path for folder in folders for path in folder.rglob("*.py"))


def oldest_language(log: Log) -> Totals:
    """Each source is one for the oldest Python, as far as its grammar shows."""
    failed = 0
    for path in sources():
        try:
            ast.parse(path.read_text(encoding="utf-8"), str(path), feature_version=OLDEST)
        except SyntaxError as error:
            log.say(f"{path.relative_to(ROOT)}:{error.lineno}: not Python {OLDEST[0]}.{OLDEST[1]}: {error.msg}")
            failed += 1
    return len(sources()) - failed, failed


Step = Callable[[Log], Totals]
# Two at a time: archives beside all others, one after the other.
LANES: List[List[Step]] = [[oldest_language, checked_types, docstring_examples, written_tests], [archives]]


def run_steps(steps: List[Step], totals: List[Totals]) -> None:
    """Runs steps, shows each as soon as it has ended, and adds its totals to a list."""
    for step in steps:
        log = Log()
        good, bad = 0, 1
        try:
            good, bad = step(log)
        finally:
            totals.append((good, bad))
            title = (step.__doc__ or "").splitlines()[0]
            print(f"== {title}\n{log.text}{good} passed and {bad} failed\n", end="", flush=True)


def main() -> int:
    """Runs all steps, and adds up."""
    totals: List[Totals] = []
    chosen: List[List[Step]] = [[bridges]] if sys.argv[1:] == ["bridges"] else LANES
    lanes = [threading.Thread(target=run_steps, args=(steps, totals)) for steps in chosen]
    for lane in lanes:
        lane.start()
    for lane in lanes:
        lane.join()
    passed, failed = (sum(counts) for counts in zip(*totals))
    failed += sum(map(len, chosen)) - len(totals)  # steps behind one that has fallen over
    print(f"{passed} passed, {failed} failed")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
