"""Reads a page of --report."""
import base64
import re
import struct
import zlib
from pathlib import Path

from support.tool.reading import json_of

BEGIN, END = '<script type="application/json" id="cscd-report">', "</script>"


def read_page(path):
    """The block of JSON of a page."""
    text = Path(path).read_text(encoding="utf-8")
    assert text.count(BEGIN) == 1
    return json_of(text.split(BEGIN)[1].split(END)[0])


def read_array(path, name):
    """The bytes of an array of a page; None if it has none of that name."""
    found = re.findall(f'id="cscd-array-{name}">([^<]*)<', Path(path).read_text(encoding="utf-8"))
    assert len(found) <= 1
    return zlib.decompress(base64.b64decode(found[0], validate=True)) if found else None


def read_doubles(path, name):
    """The numbers of an array."""
    return [number for (number,) in struct.iter_unpack("<d", read_array(path, name))]


def read_texts(path, name):
    """The texts of an array, each of which ends with a 0."""
    data = read_array(path, name).decode("utf-8")
    assert data.endswith("\0")
    return data.split("\0")[:-1]
