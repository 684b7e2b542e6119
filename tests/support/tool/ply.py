"""Reads the binary PLY files that the tool writes: plans, and frames of --ply."""
import struct
from pathlib import Path
from typing import NamedTuple

FORMATS = {"double": "d", "float": "f", "int": "i", "uint": "I", "uchar": "B"}
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
        form = "<" + "".join("B3I" if words[0] == "list" else FORMATS[words[0]] for words in properties)
        keys = [key for words in properties for key in (CORNERS if words[0] == "list" else words[1:])]
        rows = data[at : at + count * struct.calcsize(form)]
        elements[element] = [dict(zip(keys, values)) for values in struct.iter_unpack(form, rows)]
        assert len(elements[element]) == count
        at += len(rows)
    assert at == len(data)
    return Ply([line[8:] for line in lines if line.startswith("comment ")], elements)
