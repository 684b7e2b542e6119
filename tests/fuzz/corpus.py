#!/usr/bin/env python3
"""Writes the mesh of an OBJ file in the formats that we read and do not write: corpus.py BODY.obj FOLDER, which has mannequin.glb."""
import base64
import json
import os
import struct
import sys
import zlib


def read_obj(path):
    with open(path, encoding="ascii") as file:
        rows = [line.split() for line in file]
    points = [tuple(map(float, row[1:4])) for row in rows if row[:1] == ["v"]]
    faces = [tuple(int(corner.split("/")[0]) - 1 for corner in row[1:]) for row in rows if row[:1] == ["f"]]
    return points, faces


def as_off(points, faces):
    rows = ["OFF", f"{len(points)} {len(faces)} 0"]
    rows += [" ".join(f"{x:.9g}" for x in point) for point in points]
    rows += [" ".join(map(str, (len(face),) + face)) for face in faces]
    return "\n".join(rows).encode() + b"\n"


def as_stl(points, faces):
    rows = ["solid body"]
    for face in faces:
        rows += ["facet normal 0 0 0", "outer loop"]
        rows += ["vertex " + " ".join(f"{x:.9g}" for x in points[corner]) for corner in face]
        rows += ["endloop", "endfacet"]
    return "\n".join(rows + ["endsolid body"]).encode() + b"\n"


def as_binary_stl(points, faces):
    rows = [bytes(80), struct.pack("<I", len(faces))]
    rows += [struct.pack("<12fH", 0, 0, 0, *(x for corner in face for x in points[corner]), 0) for face in faces]
    return b"".join(rows)


def as_ply(points, faces, encoding):
    head = (f"ply\nformat {encoding} 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty double z\n"
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n").encode()
    if encoding == "ascii":
        rows = [" ".join(f"{x:.9g}" for x in point) for point in points]
        rows += [" ".join(map(str, (len(face),) + face)) for face in faces]
        return head + "\n".join(rows).encode() + b"\n"
    order = "<" if encoding == "binary_little_endian" else ">"
    rows = [struct.pack(order + "ffd", *point) for point in points]
    rows += [struct.pack(order + "B3i", len(face), *face) for face in faces]
    return head + b"".join(rows)


def gifti_array(intent, kind, rows, encoding, order):
    letter, name = {"f": ("f", "NIFTI_TYPE_FLOAT32"), "i": ("i", "NIFTI_TYPE_INT32")}[kind]
    values = [x for row in rows for x in row]
    raw = struct.pack(f"{order}{len(values)}{letter}", *values)
    data = {"ASCII": " ".join(f"{x:.9g}" if kind == "f" else str(x) for x in values),
            "Base64Binary": base64.b64encode(raw).decode(),
            "GZipBase64Binary": base64.b64encode(zlib.compress(raw)).decode()}[encoding]
    endian = "LittleEndian" if order == "<" else "BigEndian"
    return (f'<DataArray Intent="{intent}" DataType="{name}" ArrayIndexingOrder="RowMajorOrder" Dimensionality="2" '
            f'Dim0="{len(rows)}" Dim1="3" Encoding="{encoding}" Endian="{endian}"><Data>{data}</Data></DataArray>\n')


def as_gifti(points, faces, encoding, order):
    return ('<?xml version="1.0" encoding="UTF-8"?>\n<GIFTI Version="1.0" NumberOfDataArrays="2">\n'
            + gifti_array("NIFTI_INTENT_POINTSET", "f", points, encoding, order)
            + gifti_array("NIFTI_INTENT_TRIANGLE", "i", faces, encoding, order) + "</GIFTI>\n").encode()


def as_polygons():
    """Faces of more corners, parts and numbers that count from the end, as artists' files have them."""
    rows = ["o body", "v 0 0 0", "v 1 0 0", "v 1 1 0", "v 0.5 0.2 0", "v 0 1 0", "vt 0 0", "g left", "f 1/1 2/1 3/1 4/1 5/1",
            "o other", "v 0 0 1", "v 1 0 1", "v 0 1 1", "usemtl red", "f -3 -2 -1"]
    return "\n".join(rows).encode() + b"\n"


def as_gltf(path):
    """The same as a .glb file, in text."""
    with open(path, "rb") as file:
        data = file.read()
    size = struct.unpack_from("<I", data, 12)[0]
    document, binary = json.loads(data[20:20 + size]), data[28 + size:]
    document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    return json.dumps(document).encode()


def as_pc2(frames):
    head = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(frames[0]), 0.0, 1.0, len(frames))
    return head + b"".join(struct.pack("<3f", *point) for frame in frames for point in frame)


def as_mdd(frames):
    head = struct.pack(">ii", len(frames), len(frames[0])) + struct.pack(f">{len(frames)}f", *range(len(frames)))
    return head + b"".join(struct.pack(">3f", *point) for frame in frames for point in frame)


def main(model, folder):
    points, faces = read_obj(model)
    files = {"polygons.obj": as_polygons(), "mannequin.gltf": as_gltf(os.path.join(folder, "mannequin.glb")),
             "body.off": as_off(points, faces), "text.stl": as_stl(points, faces), "body.stl": as_binary_stl(points, faces),
             "text.surf.gii": as_gifti(points, faces, "ASCII", "<"),
             "base64.surf.gii": as_gifti(points, faces, "Base64Binary", ">"),
             "gzip.surf.gii": as_gifti(points, faces, "GZipBase64Binary", "<")}
    frames = [[(x, y, z * (1.0 - 0.4 * i)) for x, y, z in points] for i in range(5)]
    files["body.pc2"], files["body.mdd"] = as_pc2(frames), as_mdd(frames)
    for name, encoding in (("text.ply", "ascii"), ("little.ply", "binary_little_endian"), ("big.ply", "binary_big_endian")):
        files[name] = as_ply(points, faces, encoding)
    for name, data in files.items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(data)


if __name__ == "__main__":
    main(*sys.argv[1:])
