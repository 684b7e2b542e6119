"""What README and the pages on Python show of a session is what Python prints."""
from __future__ import annotations

import doctest
import os
import re
import subprocess
from pathlib import Path
from typing import Iterator

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs" / "python").glob("*.md"))]
SESSION = re.compile(r"^```pycon\n(.*?)^```$", re.M | re.S)


@pytest.fixture(autouse=True)
def demo(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The root of the repository, where the recording of `make demo` is."""
    monkeypatch.chdir(ROOT)
    if not os.path.exists("build/demo/pawn-drop.pc2"):
        os.makedirs("build/demo", exist_ok=True)
        record = ["build/release/models/record", "pawn-drop", "build/demo"]
        subprocess.run(record, check=True, stdout=subprocess.DEVNULL)
    yield


@pytest.mark.parametrize("page", [page for page in PAGES if SESSION.search(page.read_text(encoding="utf-8"))],
                         ids=lambda page: page.name)
def test_sessions_print_what_they_show(page: Path) -> None:
    text = "\n".join(SESSION.findall(page.read_text(encoding="utf-8")))
    examples = doctest.DocTestParser().get_doctest(text, {}, page.name, str(page), 0)
    results = doctest.DocTestRunner(verbose=False).run(examples)
    assert results.failed == 0 and results.attempted > 0


def test_readme_has_a_session_of_five_lines() -> None:
    sessions = SESSION.findall((ROOT / "README.md").read_text(encoding="utf-8"))
    assert [len(session.splitlines()) for session in sessions] == [5]
