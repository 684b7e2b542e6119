"""Runs tests of the package with an interpreter of another platform, on the package that it finds; ends as tests/run.sh does.

Those of archives, of pages and of the machine's own OpenBLAS are about this machine.
"""
from __future__ import annotations

import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
FILES = ("results", "misuse_arrays", "misuse_calls", "moment_oracle", "motion_oracle", "lifetimes", "processes", "threads", "replay", "charge_solvers")
# What is left out, and why.
LEFT_OUT = {
    "test_memory_of_many": "counts the memory of the process, in which an emulator keeps what it has translated",
    "test_fork_with_threads": "qemu-user falls over its own locks when a process with threads forks",
    "from_several_threads": "gives a thread a minute, in which an emulator gets nowhere",
    "test_detectors_side_by_side": "as above",
    "test_objects_that_go_during_a_call": "as above",
    "control_c": "sends signals after milliseconds, in which an emulator gets nowhere",
    "test_replay_equals_the_tool": "replays a figure ten times, for a minute each; once is below",
    "test_replay_from_its_own_callback": "as above",
}
ALL_THE_SAME = "test_replay_equals_the_tool[mannequin.glb-all]"


def main() -> int:
    report = ROOT / "build" / "python-elsewhere.xml"
    tests = [f"python/tests/test_{name}.py" for name in FILES]
    chosen = " and ".join(f"not {name}" for name in LEFT_OUT)
    totals = [0, 0]
    for words in (["-k", chosen, *tests], [f"python/tests/test_replay.py::{ALL_THE_SAME}"]):
        status = pytest.main(["-q", "--tb=short", "--durations=10", f"--junitxml={report}", *words])
        suite = ElementTree.parse(report).getroot().find("testsuite")
        bad = sum(int(suite.attrib[kind]) for kind in ("errors", "failures", "skipped"))
        totals[0] += int(suite.attrib["tests"]) - bad
        totals[1] += max(bad, int(status != 0))
    for name, reason in LEFT_OUT.items():
        print(f"left out: {name}: {reason}")
    print(f"{totals[0]} passed, {totals[1]} failed")
    return int(totals[1] > 0)


if __name__ == "__main__":
    sys.exit(main())
