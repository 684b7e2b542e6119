"""Reads what the tool exports: PLY of plans and frames, .vtp of ParaView, pictures, and pages of --report."""
import base64
import re
import struct
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path
from typing import NamedTuple

from support.tool.reading import json_of

PLY_FORMATS = {"double": "d", "float": "f", "int": "i", "uint": "I", "uchar": "B"}
CORNERS = ("size", "a", "b", "c")


class Ply(NamedTuple):
    """A file. elements: by their names, rows that are dicts of their properties; comments: the lines of the header."""

    comments: list
    elements: dict

    @property
    def points(self):
        """The positions of the vertices."""
        return [(row["x"], row["y"], row["z"]) for row in self.elements["vertex"]]

    @property
    def triangles(self):
        """The numbers of their corners."""
        assert all(row["size"] == 3 for row in self.elements["face"])
        return [(row["a"], row["b"], row["c"]) for row in self.elements["face"]]

    def faces(self, name):
        """A property of all faces."""
        return [row[name] for row in self.elements["face"]]

    def named(self, word):
        """What comments call something, such as `comment part 0 Body`, by its number."""
        found = [line.split(" ", 2) for line in self.comments if line.startswith(f"{word} ")]
        return {int(number): name for _, number, name in found}


def read_ply(path):
    """Reads a file, whose faces are triangles."""
    header, data = Path(path).read_bytes().split(b"end_header\n", 1)
    lines, elements, at = header.decode("utf-8").splitlines(), {}, 0
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"]
    names = {}
    for words in map(str.split, lines):
        if words[0] == "element":
            names[words[1]] = (int(words[2]), [])
        elif words[0] == "property":
            names[list(names)[-1]][1].append(words[1:])
    for element, (count, properties) in names.items():
        form = "<" + "".join("B3I" if words[0] == "list" else PLY_FORMATS[words[0]] for words in properties)
        keys = [key for words in properties for key in (CORNERS if words[0] == "list" else words[1:])]
        rows = data[at : at + count * struct.calcsize(form)]
        elements[element] = [dict(zip(keys, values)) for values in struct.iter_unpack(form, rows)]
        assert len(elements[element]) == count
        at += len(rows)
    assert at == len(data)
    return Ply([line[8:] for line in lines if line.startswith("comment ")], elements)


# ---- files of ParaView: binary data behind the XML

VTP_FORMATS = {"Int32": "i", "UInt32": "I", "Int64": "q", "Float64": "d", "UInt8": "B", "String": "s"}


class Vtp:
    """A file. arrays: by the name of their section, such as CellData, and their own, as (type, values)."""

    def __init__(self, path):
        text, self._data = Path(path).read_bytes().split(b'<AppendedData encoding="raw">\n_', 1)
        root = ElementTree.fromstring(text + b"</VTKFile>")
        assert (root.get("byte_order"), root.get("header_type")) == ("LittleEndian", "UInt64")
        piece = root.find("PolyData/Piece")
        self.counts = {key.replace("NumberOf", ""): int(value) for key, value in piece.items()}
        sections = [root.find("PolyData/FieldData"), *piece]
        self.arrays = {section.tag: {array.get("Name"): self._read(array) for array in section} for section in sections}

    def _read(self, array):
        kind, offset = array.get("type"), int(array.get("offset"))
        (size,) = struct.unpack_from("<Q", self._data, offset)
        data = self._data[offset + 8 : offset + 8 + size]
        assert len(data) == size and array.get("format") == "appended"
        if kind == "String":
            assert data.endswith(b"\0")
            return kind, data.decode("utf-8").split("\0")[:-1]
        return kind, [value for (value,) in struct.iter_unpack("<" + VTP_FORMATS[kind], data)]

    def values(self, section, name, kind):
        """The values of an array, which must have this type."""
        found, values = self.arrays[section][name]
        assert found == kind
        return values


# ---- PNG files of eight bits and four channels


class Picture:
    """Rows of pixels, each 4 bytes: red, green, blue, opacity."""

    def __init__(self, rows):
        self.rows, self.width, self.height = rows, len(rows[0]) // 4, len(rows)

    def pixels(self):
        """All pixels, as (red, green, blue)."""
        return [tuple(row[at : at + 3]) for row in self.rows for at in range(0, len(row), 4)]

    def count(self, colour):
        """The number of pixels of exactly this colour."""
        return self.pixels().count(colour)

    def tile(self, index, columns, width, height):
        """One tile of a strip."""
        top, left = index // columns * height, index % columns * width
        return Picture([row[4 * left : 4 * (left + width)] for row in self.rows[top : top + height]])

    def __eq__(self, other):
        return self.rows == other.rows


def _nearest(left, above, corner):
    """The predictor of Paeth."""
    distances = [abs(above - corner), abs(left - corner), abs(left + above - 2 * corner)]
    return (left, above, corner)[distances.index(min(distances))]


def _unfiltered(kind, line, above):
    """A line without its filter: each byte was predicted by the one of the pixel at the left, the one above, or both."""
    row = bytearray(line)
    for at, byte in enumerate(line if kind != 0 else b""):
        left, corner = (row[at - 4], above[at - 4]) if at >= 4 else (0, 0)
        predicted = (0, left, above[at], (left + above[at]) // 2)[kind] if kind < 4 else _nearest(left, above[at], corner)
        row[at] = (byte + predicted) & 255
    return bytes(row)


def read_png(path):
    """Reads a picture; every part of the file must have its checksum."""
    data, at, packed, header = Path(path).read_bytes(), 8, b"", b""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size : at + 12 + size])[0] == zlib.crc32(kind + body), kind
        header = body if kind == b"IHDR" else header
        packed += body if kind == b"IDAT" else b""
        at += 12 + size
    width, height, *form = struct.unpack(">IIBBBBB", header)
    assert form == [8, 6, 0, 0, 0] and kind == b"IEND"
    lines, rows = zlib.decompress(packed), [bytes(4 * width)]
    assert len(lines) == height * (4 * width + 1)
    for begin in range(0, len(lines), 4 * width + 1):
        rows.append(_unfiltered(lines[begin], lines[begin + 1 : begin + 4 * width + 1], rows[-1]))
    return Picture(rows[1:])


def png_size(path):
    """Width and height alone."""
    return struct.unpack(">II", Path(path).read_bytes()[16:24])


# ---- pages of --report

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
