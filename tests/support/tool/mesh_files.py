"""Writes mesh files for tests: boxes as text of OBJ, whose vertices count from the end; GIFTI, glTF, and a soft bar in PLY."""
import base64
import gzip
import json
import struct
import zlib
from math import cos, pi, sin
from pathlib import Path

# The corners of each side, by bits x, y, z, counter-clockwise from outside.
SIDES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def corners_of(low, high):
    """The eight corners."""
    return [tuple((low, high)[corner >> axis & 1][axis] for axis in range(3)) for corner in range(8)]


def box(low, high, name="", inverted=False, cut=None):
    """A box of six quads. inverted: inside out. cut: its sides are two triangles, along the one diagonal (0) or the other (1)."""
    lines = [f"o {name}"] * bool(name) + ["v {!r} {!r} {!r}".format(*corner) for corner in corners_of(low, high)]
    for side in SIDES:
        a, b, c, d = (corner - 8 for corner in (reversed(side) if inverted else side))
        if cut == 1:
            a, b, c, d = b, c, d, a
        lines += [f"f {a} {b} {c} {d}"] if cut is None else [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    return "\n".join(lines) + "\n"


def cube(low, size, name="", **options):
    """A cube from a corner with equal coordinates, or from any."""
    low = (low, low, low) if isinstance(low, (int, float)) else low
    return box(low, tuple(x + size for x in low), name, **options)


# ---- GIFTI files of a square, in every way that the format has

SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
HALVES = [(0, 1, 2), (0, 2, 3)]
ASCII, BASE64, ZIPPED = "ASCII", "Base64Binary", "GZipBase64Binary"


HEADER = """<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE GIFTI SYSTEM "http://www.nitrc.org/frs/download.php/115/gifti.dtd">
<GIFTI Version="1.0" NumberOfDataArrays="4">
 <MetaData><MD><Name><![CDATA[Who]]></Name><Value><![CDATA[a<b]]></Value></MD></MetaData>
 <LabelTable/>
 <DataArray Intent="NIFTI_INTENT_LABEL" DataType="NIFTI_TYPE_INT32" ArrayIndexingOrder="RowMajorOrder" Dimensionality="1" \
Dim0="4" Encoding="ASCII" Endian="LittleEndian"><Data>1 2 3 4</Data></DataArray>
"""
ARRAY = """ <DataArray Intent="NIFTI_INTENT_{}" DataType="NIFTI_TYPE_{}" ArrayIndexingOrder="{}MajorOrder" Dimensionality="2" \
Dim0="{}" Dim1="3"
  Encoding="{}" Endian="{}Endian" ExternalFileName="" ExternalFileOffset="">
  <MetaData/>
  <Data>{}</Data>
 </DataArray>
"""
GIFTI_FORMATS = {"INT32": "i", "FLOAT32": "f", "FLOAT64": "d"}


def square_gifti(encoding=ASCII, kind="FLOAT32", big_endian=False, column_major=False, gzip_header=False):
    """A file. The points stand from line 7 on, with their numbers in line 10; labels, and points behind, are no part of it."""
    def array(intent, own_kind, rows):
        numbers = [number for row in (zip(*rows) if column_major else rows) for number in row]
        data = struct.pack(f"{'>' if big_endian else '<'}{len(numbers)}{GIFTI_FORMATS[own_kind]}", *numbers)
        if encoding == ZIPPED:
            data = gzip.compress(data) if gzip_header else zlib.compress(data)
        text = " ".join(map(repr, numbers)) if encoding == ASCII else base64.b64encode(data).decode()
        return ARRAY.format(intent, own_kind, "Column" if column_major else "Row", len(rows), encoding,
                            "Big" if big_endian else "Little", text)

    return (HEADER + array("POINTSET", kind, SQUARE) + array("TRIANGLE", "INT32", HALVES)
            + array("POINTSET", kind, [(9, 9, 9)]) + "</GIFTI>\n")


# ---- small glTF files, put together from their arrays and the members of their JSON

SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
COMPONENT_FORMATS = {BYTE: "b", UNSIGNED_BYTE: "B", SHORT: "h", UNSIGNED_SHORT: "H", UNSIGNED_INT: "I", FLOAT: "f"}


class Gltf:
    """Data, their views and accessors. arrays: what `add` takes, each."""

    def __init__(self, *arrays):
        self.data, self.views, self.accessors = b"", [], []
        for array in arrays:
            self.add(*array)

    def view(self, values, component=FLOAT):
        """Adds data; returns the number of their view."""
        packed = struct.pack(f"<{len(values)}{COMPONENT_FORMATS[component]}", *values)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        self.data += packed + bytes(-len(packed) % 4)
        return len(self.views) - 1

    def add(self, kind, values, component=FLOAT, **members):
        """Adds an accessor, of a type such as "VEC3", with data of its own; returns its number."""
        self.accessors.append({"bufferView": self.view(values, component), "componentType": component, "type": kind,
                               "count": len(values) // SIZES[kind], **members})
        return len(self.accessors) - 1

    def text(self, uri=None, **members):
        """The JSON, without blanks. uri: of the buffer, which is in the file else; members: all but the data."""
        buffer = {"byteLength": len(self.data), **({"uri": uri} if uri else {})}
        document = {"asset": {"version": "2.0"}, "buffers": [buffer], "bufferViews": self.views, "accessors": self.accessors}
        return json.dumps({**document, **members}, separators=(",", ":"))

    def embedded(self, **members):
        """The JSON with the data in it."""
        return self.text("data:application/octet-stream;base64," + base64.b64encode(self.data).decode(), **members)

    def glb(self, **members):
        """The bytes of a binary file."""
        return glb_of(self.text(**members), self.data)


def glb_of(text, data):
    """A binary file of a JSON and data."""
    text = text.encode("utf-8")
    text += b" " * (-len(text) % 4)
    chunks = b"".join(struct.pack("<I4s", len(chunk), kind) + chunk for kind, chunk in ((b"JSON", text), (b"BIN\0", data)))
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def write_glb(path, arrays, **document):
    """Writes a binary file."""
    Path(path).write_bytes(Gltf(*arrays).glb(**document))


# ---- a bar that is soft at one place: between rings 26 and 28 of 40

RINGS, AROUND = 40, 12


def write_soft_bar(path, soft=3.0, bad=None, split=False):
    """Writes it as PLY, with the stiffness of its faces: 3, and `soft` at that place. bad: a face, and its own stiffness.

    split: each face has vertices of its own.
    """
    faces = []
    for side in range((RINGS - 1) * AROUND):
        ring, i = divmod(side, AROUND)
        a, b = ring * AROUND + i, ring * AROUND + (i + 1) % AROUND
        faces.append(((a, b, b + AROUND, a + AROUND), soft if 26 <= ring < 28 else 3.0))
    faces.append((range(AROUND - 1, -1, -1), 3.0))
    faces.append((range((RINGS - 1) * AROUND, RINGS * AROUND), 3.0))
    if bad:
        faces[bad[0]] = (faces[bad[0]][0], bad[1])
    vertices = list(range(RINGS * AROUND))
    if split:
        vertices = [v for corners, _ in faces for v in corners]
        places = iter(range(len(vertices)))
        faces = [([next(places) for _ in corners], stiffness) for corners, stiffness in faces]
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", *(f"property float {axis}" for axis in "xyz"),
             f"element face {len(faces)}", "property list uchar int vertex_indices", "property float stiffness", "end_header"]
    for v in vertices:
        angle = pi / 6.0 * (v % AROUND)
        lines.append(f"{cos(angle):.9g} {sin(angle):.9g} {0.25 * (v // AROUND):.9g}")
    lines += [f"{len(corners)} {' '.join(map(str, corners))} {stiffness:g}" for corners, stiffness in faces]
    Path(path).write_text("\n".join(lines) + "\n")
