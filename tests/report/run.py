#!/usr/bin/python3
"""Runs the scenarios of the report's page in one browser. OUT/NAME.log has the faults of each, or is empty.

usage: BUILD=build/release run.py --list | OUT [NAME...]

NAME: a scenario, or a part of the names of some. The pictures are in build/report-pictures.
"""
import os
import sys
import time
import traceback

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True

import answer_scenarios  # noqa: E402
import changes_scenarios  # noqa: E402
import charts_scenarios  # noqa: E402
import controls_scenarios  # noqa: E402
import data_scenarios  # noqa: E402
import extremes_scenarios  # noqa: E402
import frames_scenarios  # noqa: E402
import jobs_scenarios  # noqa: E402
import layout_scenarios  # noqa: E402
import tables_scenarios  # noqa: E402
import view_scenarios  # noqa: E402
from material import Material  # noqa: E402
from page import Page  # noqa: E402
from pictures import Pictures  # noqa: E402

MODULES = (data_scenarios, answer_scenarios, changes_scenarios, controls_scenarios, frames_scenarios, view_scenarios,
           charts_scenarios, tables_scenarios, layout_scenarios, extremes_scenarios, jobs_scenarios)
SCENARIOS = {scenario.__name__: scenario for module in MODULES for scenario in module.SCENARIOS}


class Context:
    """The objects that a scenario works with; the browser starts when it is first used."""

    def __init__(self, folder, build):
        self.material = Material(folder, build)
        self.picture_folder = os.path.join("build", "report-pictures")
        self._page = self._pictures = None

    @property
    def page(self):
        if self._page is None:
            self._page = Page()
        return self._page

    @property
    def pictures(self):
        if self._pictures is None:
            self._pictures = Pictures(self.page, self.picture_folder)
        return self._pictures

    def check_quiet(self):
        """Checks the open page: no complaint on the console, nothing fetched."""
        if self._page is not None and self._page.path is not None:
            self._page.check_quiet()
            self._page.forget()

    def close(self):
        if self._page is not None:
            self._page.close()


def told(error):
    """Returns the fault and where in this program it was found. Browsers' errors end in addresses that say nothing."""
    where = [f"  {frame.name}, {os.path.basename(frame.filename)}:{frame.lineno}: {frame.line}\n"
             for frame in traceback.extract_tb(error.__traceback__)[1:]]
    return f"{type(error).__name__}: {str(error).split('Stacktrace:')[0].strip()}\n" + "".join(where)


def run(scenario, context, log_path):
    """Runs a scenario and writes its log as a whole, at the end. Returns whether nothing went wrong."""
    start = time.monotonic()
    text = ""
    for step in (lambda: scenario(context), context.check_quiet):
        try:
            step()
        except Exception:  # the next scenario runs in any case
            text += told(sys.exc_info()[1])
    with open(log_path, "w", encoding="utf-8") as file:
        file.write(text)
    print(f"{'FAILED' if text else 'passed'} {scenario.__name__} ({time.monotonic() - start:.1f} s)", flush=True)
    if text:
        print(text, flush=True)
    return text == ""


def main():
    if sys.argv[1:] == ["--list"]:
        print("\n".join(SCENARIOS))
        return 0
    if len(sys.argv) < 2:
        print(__doc__)
        return 2
    folder, wanted = sys.argv[1], sys.argv[2:]
    context = Context(folder, os.environ.get("BUILD", "build/release"))
    context.material.begin()
    try:
        good = [run(scenario, context, os.path.join(folder, name + ".log")) for name, scenario in SCENARIOS.items()
                if not wanted or any(part in name for part in wanted)]
    finally:
        context.close()
    print(f"{sum(good)} of {len(good)} scenarios passed")
    return 0 if all(good) and good else 1


if __name__ == "__main__":
    sys.exit(main())
