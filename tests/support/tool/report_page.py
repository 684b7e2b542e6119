"""Reads a page of --report."""
from pathlib import Path

from support.tool.reading import json_of

BEGIN, END = '<script type="application/json" id="cscd-report">', "</script>"


def read_page(path):
    """The block of JSON of a page."""
    text = Path(path).read_text(encoding="utf-8")
    assert text.count(BEGIN) == 1
    return json_of(text.split(BEGIN)[1].split(END)[0])
