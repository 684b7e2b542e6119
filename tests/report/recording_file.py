"""Reads and writes the files of a recording with Python alone: OBJ, PC2, and the CSV of contacts."""
import csv
import struct
from array import array
from itertools import chain


def read_obj(path):
    """Returns positions [(x, y, z)] and triangles [(a, b, c)], counted from 0."""
    positions, triangles = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if words[:1] == ["v"]:
                positions.append(tuple(float(word) for word in words[1:4]))
            elif words[:1] == ["f"]:
                triangles.append(tuple(int(word.split("/")[0]) - 1 for word in words[1:4]))
    return positions, triangles


def write_obj(path, positions, triangles, names=None):
    """names: {the first triangle of a part: its name}."""
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in positions)
        for number, (a, b, c) in enumerate(triangles):
            if names is not None and number in names:
                file.write(f"o {names[number]}\n")
            file.write(f"f {a + 1} {b + 1} {c + 1}\n")


def read_pc2(path):
    """Returns every frame as [x of all vertices, y of all, z of all]."""
    with open(path, "rb") as file:
        signature, version, count, start, rate, samples = struct.unpack("<12siiffi", file.read(32))
        if signature != b"POINTCACHE2\0" or version != 1:
            raise ValueError(f"{path}: not a PC2 file")
        for _ in range(samples):
            values = array("f")
            values.fromfile(file, 3 * count)
            yield [list(values[k::3]) for k in range(3)]


def write_pc2(path, frames):
    """Writes frames, each an array('f') of x y z, x y z, ...; `frames` may be a generator."""
    with open(path, "wb") as file:
        file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(frames[0]) // 3, 0.0, 1.0, len(frames)))
        for frame in frames:
            frame.tofile(file)


def flat(positions):
    """Returns [(x, y, z)] as an array('f') of x y z, x y z, ..."""
    return array("f", chain.from_iterable(positions))


def read_contacts(path):
    """Returns the rows of the CSV: (interval, kind, vertices, toi, point). A VF row has the vertex before the face."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    contacts = []
    for row in rows:
        names = ("a0", "b0", "b1", "b2") if row["kind"] == "vf" else ("a0", "a1", "b0", "b1")
        contacts.append((int(row["frame"]), row["kind"], tuple(int(row[name]) for name in names), float(row["toi"]),
                         tuple(float(row[axis]) for axis in "xyz")))
    return contacts


def heat(triangles, contacts):
    """Returns how many contacts each triangle takes part in: as the face, or as a triangle around the vertex or an edge."""
    around = {}
    for t, corners in enumerate(triangles):
        for corner in corners:
            around.setdefault(corner, set()).add(t)
    counts = [0] * len(triangles)
    for _, kind, (a, b, c, d), _, _ in contacts:
        if kind == "vf":
            taking_part = around[a] | (around[b] & around[c] & around[d])
        else:
            taking_part = (around[a] & around[b]) | (around[c] & around[d])
        for t in taking_part:
            counts[t] += 1
    return counts
