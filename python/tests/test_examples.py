"""The scripts of python/examples do what the pages in docs/python say: they print and draw what is shown there.

A page shows a command that runs a script of python/examples, then what it prints, behind "prints". The command is run as
it stands, but in a folder of its own, where the models that the page makes are built first.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import List, Optional

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
EXAMPLES = ROOT / "python" / "examples"
PAGES = sorted((ROOT / "docs" / "python").glob("*.md"))
COMMAND = re.compile(r"^    PYTHONPATH=build/python python3 python/examples/(\S+)(.*)$", re.M)
WITHOUT_SCRIPT = {"install.md", "bridges.md"}
# What scripts end with, if it is not 0.
STATUS = {"check-a-mesh.md": 1}


def make_models(page: str, folder: Path) -> None:
    """Makes the models of a page as it does itself, with programs that are built if they are missing."""
    folder.mkdir(parents=True)
    build = ROOT / os.environ.get("BUILD", "build/release")
    for name, words in (("folds", []), ("mannequin", ["frames"])):
        program = build / "models" / name
        if f"build/release/models/{name}" in page:
            if not program.exists():
                subprocess.run(["make", "-s", "-C", str(ROOT), str(program.relative_to(ROOT))], check=True)
            subprocess.run([str(program), str(folder), *words], check=True, stdout=subprocess.DEVNULL)


def without_torch(folder: Path) -> str:
    """A path for Python on which `import torch` fails, so that what is printed depends on numpy alone."""
    (folder / "torch.py").write_text('raise ImportError("left out")\n', encoding="utf-8")
    return os.pathsep.join([str(folder), str(ROOT / "build" / "python")])


def run_page(text: str, folder: Path, status: int) -> str:
    """Runs the command of a page in a folder; returns what it prints."""
    command = COMMAND.search(text)
    assert command is not None, "the page shows no command"
    make_models(text, folder / "build" / "models")
    (folder / "path").mkdir()
    done = subprocess.run([sys.executable, str(EXAMPLES / command[1]), *command[2].split()], cwd=folder, text=True,
                          env={**os.environ, "PYTHONPATH": without_torch(folder / "path")}, stdout=subprocess.PIPE)
    assert done.returncode == status
    return done.stdout


def shown(text: str) -> Optional[str]:
    """What a page says that its script prints."""
    found = re.search(r"\) prints\n\n((?:    .*\n)+)", text)
    return None if found is None else re.sub("(?m)^    ", "", found[1])


@pytest.mark.parametrize("page", [page for page in PAGES if page.name not in WITHOUT_SCRIPT], ids=lambda page: page.name)
def test_script_prints_and_draws_what_its_page_shows(page: Path, tmp_path: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert run_page(text, tmp_path, STATUS.get(page.name, 0)) == shown(text)
    drawn = sorted(tmp_path.glob("*.svg"))
    assert drawn
    for picture in drawn:
        assert f"(../images/{picture.name})" in text
        assert picture.read_text(encoding="utf-8") == (ROOT / "docs" / "images" / picture.name).read_text(encoding="utf-8")


def scripts() -> List[str]:
    """The files of python/examples that are run."""
    return sorted(path.name for path in EXAMPLES.glob("*.py") if path.name != "svg_picture.py")


def test_every_script_has_a_page() -> None:
    named = [found[1] for page in PAGES for found in COMMAND.finditer(page.read_text(encoding="utf-8"))]
    assert sorted(set(named)) == scripts()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_pages_link_to_what_there_is(page: Path) -> None:
    for target in re.findall(r"\]\((?!https?:)([^)#]+)", page.read_text(encoding="utf-8")):
        assert (page.parent / target).exists(), target
