"""Runs the scenarios of this folder: reports are decoded by other code and used in a real browser, one test each."""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

RUNNER = Path(__file__).with_name("run.py")
SCENARIOS = subprocess.run([sys.executable, RUNNER, "--list"], check=True, capture_output=True, text=True).stdout.split()


@pytest.fixture(scope="module")
def logs():
    """One browser serves all scenarios, so they run before the tests, which report how each ended.

    Pages show the path of the folder, which is short, so that narrow windows have room for it.
    """
    build = os.path.dirname(os.environ["CSCD_TOOL"])
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, RUNNER, folder], cwd=RUNNER.parents[2], env={**os.environ, "BUILD": build}, check=False)
        yield Path(folder)


@pytest.mark.parametrize("name", SCENARIOS)
def test_scenario(logs, name):
    """One that ran has left a log, which is empty when nothing went wrong."""
    assert (logs / f"{name}.log").read_text(encoding="utf-8") == ""
