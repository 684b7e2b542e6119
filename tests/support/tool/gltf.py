"""Writes small glTF files."""
import json
import struct

SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def write_glb(path, arrays, **document):
    """Writes a binary file. arrays: the accessors, each a type, such as "VEC3", and its floats; document: all other members."""
    data, accessors, views = b"", [], []
    for kind, values in arrays:
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": 4 * len(values)})
        accessors.append({"bufferView": len(accessors), "componentType": 5126, "type": kind, "count": len(values) // SIZES[kind]})
        data += struct.pack(f"<{len(values)}f", *values)
    document.update(asset={"version": "2.0"}, buffers=[{"byteLength": len(data)}], bufferViews=views, accessors=accessors)
    text = json.dumps(document).encode("utf-8")
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
        for kind, chunk in ((b"JSON", text), (b"BIN\0", data)):
            file.write(struct.pack("<I4s", len(chunk), kind) + chunk)
