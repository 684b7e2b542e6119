"""The page docs/python/figure.md shows what its script prints and draws."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs" / "python" / "figure.md"


def test_figure_is_that_of_the_page(tmp_path: Path) -> None:
    build = ROOT / os.environ.get("BUILD", "build/release")
    program = build / "models" / "folds"
    if not program.exists():
        subprocess.run(["make", "-s", "-C", str(ROOT), str(program.relative_to(ROOT))], check=True)
    subprocess.run([str(program), str(tmp_path)], check=True, stdout=subprocess.DEVNULL)
    plot = tmp_path / "folds-share.svg"
    done = subprocess.run([sys.executable, str(ROOT / "python" / "examples" / "figure.py"), str(tmp_path / "folds.obj"),
                           str(tmp_path / "folds.pc2"), str(plot)], check=True, text=True, stdout=subprocess.PIPE)
    page = PAGE.read_text(encoding="utf-8")
    shown = re.search(r"\) prints\n\n((?:    .*\n)+)", page)
    assert shown is not None
    assert done.stdout == re.sub("(?m)^    ", "", shown[1])
    assert plot.read_text(encoding="utf-8") == (ROOT / "docs" / "images" / "folds-share.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize("page", sorted(PAGE.parent.glob("*.md")), ids=lambda page: page.name)
def test_pages_link_to_what_there_is(page: Path) -> None:
    for target in re.findall(r"\]\((?!https?:)([^)#]+)", page.read_text(encoding="utf-8")):
        assert (page.parent / target).exists(), target
