"""Small glTF files, put together from their arrays and the members of their JSON."""
import base64
import json
import struct
from pathlib import Path

SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
BYTE, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
FORMATS = {BYTE: "b", UNSIGNED_BYTE: "B", SHORT: "h", UNSIGNED_SHORT: "H", UNSIGNED_INT: "I", FLOAT: "f"}


class Gltf:
    """Data, their views and accessors. arrays: what `add` takes, each."""

    def __init__(self, *arrays):
        self.data, self.views, self.accessors = b"", [], []
        for array in arrays:
            self.add(*array)

    def view(self, values, component=FLOAT):
        """Adds data; returns the number of their view."""
        packed = struct.pack(f"<{len(values)}{FORMATS[component]}", *values)
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
