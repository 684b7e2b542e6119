"""What the scenarios of the report's page share: one browser, and recordings that are made once."""
import os
import tempfile
from pathlib import Path

import pytest
from material import Material
from page import Page
from pictures import Pictures

PICTURES = Path(__file__).parents[2] / "build/report-pictures"


class Context:
    """The objects that a scenario works with; the browser starts when it is first used."""

    def __init__(self, folder):
        self.material = Material(folder, os.path.dirname(os.environ["CSCD_TOOL"]))
        self._page = self._pictures = None

    @property
    def page(self):
        if self._page is None:
            self._page = Page()
        return self._page

    @property
    def pictures(self):
        if self._pictures is None:
            self._pictures = Pictures(self.page, PICTURES)
        return self._pictures

    def check_quiet(self):
        """Checks the open page: no complaint on the console, nothing fetched."""
        if self._page is not None and self._page.path is not None:
            self._page.check_quiet()

    def forget(self):
        """The next scenario has nothing to do with what this one has left."""
        if self._page is not None:
            self._page.forget()

    def close(self):
        if self._page is not None:
            self._page.close()


@pytest.fixture(scope="module")
def context():
    """Pages show the path of their folder, which is short, so that narrow windows have room for it."""
    with tempfile.TemporaryDirectory() as folder:
        shared = Context(folder)
        shared.material.begin()
        yield shared
        shared.close()


def scenarios_of(*modules):
    """Each scenario of some files is a case of a test, which has its name as a parameter."""
    cases = [pytest.param(scenario, id=scenario.__name__) for module in modules for scenario in module.SCENARIOS]
    return pytest.mark.parametrize("scenario", cases)


def play(scenario, context, capsys):
    """What a scenario prints is shown: the figures of docs are among it."""
    try:
        with capsys.disabled():
            scenario(context)
        context.check_quiet()
    finally:
        context.forget()
