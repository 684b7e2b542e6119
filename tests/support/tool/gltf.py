"""Writes small glTF files."""
import json
import struct

SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
FLOAT, UNSIGNED_SHORT = 5126, 5123


def write_glb(path, arrays, **document):
    """Writes a binary file.

    arrays: the accessors, each a type, such as "VEC3", its numbers, and UNSIGNED_SHORT where they are no floats. document: all
    other members.
    """
    data, accessors, views = b"", [], []
    for kind, values, component in (array if len(array) == 3 else (*array, FLOAT) for array in arrays):
        packed = struct.pack(f"<{len(values)}{'f' if component == FLOAT else 'H'}", *values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
        accessors.append({"bufferView": len(accessors), "componentType": component, "type": kind,
                          "count": len(values) // SIZES[kind]})
        data += packed + bytes(-len(packed) % 4)
    document.update(asset={"version": "2.0"}, buffers=[{"byteLength": len(data)}], bufferViews=views, accessors=accessors)
    text = json.dumps(document).encode("utf-8")
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
        for kind, chunk in ((b"JSON", text), (b"BIN\0", data)):
            file.write(struct.pack("<I4s", len(chunk), kind) + chunk)
