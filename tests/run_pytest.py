#!/usr/bin/python3
"""Runs a file of pytest as a program of its room: the link build/release/tests/tool/test_tool_info runs tests/tool/test_tool_info.py.

A name of cases may follow, with * and ?. The totals at the end are those of cmocka, which tests/run.sh adds up. A test that is
skipped counts as failed: it has tested nothing.
"""
import fnmatch
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True

import pytest  # noqa: E402

TESTS = Path(__file__).resolve().parent


class Totals:
    """A plugin that chooses cases by their names, without `test_` and with or without parameters, and counts them."""

    def __init__(self, pattern):
        self.pattern, self.passed, self.failed = pattern.removeprefix("test_"), 0, []

    def pytest_collection_modifyitems(self, items):
        items[:] = [item for item in items if fnmatch.fnmatch(case_of(item.name), self.pattern)
                    or fnmatch.fnmatch(item.name, f"test_{self.pattern}")]

    def pytest_runtest_logreport(self, report):
        if report.failed or report.skipped:
            self.failed.append(case_of(report.nodeid.split("::")[-1]))
        elif report.when == "call":
            self.passed += 1

    def tell(self):
        print(f"[  PASSED  ] {self.passed} test(s).")
        if self.failed:
            print(f"[  FAILED  ] {len(self.failed)} test(s), listed below:")
            for case in self.failed:
                print(f"[  FAILED  ] {case}")


def case_of(name):
    """The name of a case in reports, whatever its parameters: test_parts_are_listed[many] is parts_are_listed."""
    return name.split("[")[0].replace("test_", "", 1)


def main():
    program = Path(sys.argv[0])
    file = TESTS / program.absolute().parent.name / f"{program.stem}.py"
    totals = Totals(sys.argv[1] if len(sys.argv) > 1 else "*")
    with tempfile.TemporaryDirectory() as folder:
        options = ["-q", "--no-header", "--tb=short", "-p", "no:cacheprovider", f"--basetemp={folder}/cases"]
        status = pytest.main([*options, str(file)], [totals])
    if totals.passed or totals.failed:
        totals.tell()
    return int(status) or len(totals.failed) > 0


if __name__ == "__main__":
    sys.exit(main())
