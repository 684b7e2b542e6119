"""Reads a report without any code of the product: the blocks of the page, the arrays in them and the frames of the body."""
import base64
import json
import re
import struct
import zlib
from array import array
from itertools import accumulate

FORMATS = {"u8": "B", "u32": "I", "f32": "f", "f64": "d"}
BLOCK = re.compile(rb'<script type="application/([a-z-]+)" id="cscd-(report|array-[a-z0-9_-]+)">(.*?)</script>', re.DOTALL)


class Report:
    """The content of a page of the tool: `document` is its JSON, `arrays` are the numbers by name."""

    def __init__(self, path):
        with open(path, "rb") as file:
            self.page = file.read()
        blocks = BLOCK.findall(self.page)
        documents = [text for kind, name, text in blocks if name == b"report"]
        if len(documents) != 1:
            raise ValueError(f"{path}: {len(documents)} documents, not one")
        if b"<" in documents[0]:
            raise ValueError(f"{path}: the document has a < that is not escaped")
        self.document = json.loads(documents[0])
        self.scene = self.document["scene"]
        packed = {name.decode()[len("array-"):]: text for kind, name, text in blocks if name != b"report"}
        stated = (self.scene["arrays"] if self.scene else []) + self.table_arrays()
        if sorted(packed) != sorted(entry["name"] for entry in stated):
            raise ValueError(f"{path}: arrays {sorted(packed)} are not those that the document states")
        self.arrays = {entry["name"]: unpack(packed[entry["name"]], entry) for entry in stated}
        self.packed_sizes = {name: len(text) for name, text in packed.items()}
        for summary, name, table in list(self.tables()):
            summary[name] = self.rows(table)

    def tables(self):
        """Returns (summary, name, table) of every long array that the page holds as columns."""
        for entry in self.document["summaries"]:
            for name, value in entry["summary"].items():
                if isinstance(value, dict) and "columns" in value:
                    yield entry["summary"], name, value

    def table_arrays(self):
        return [column["array"] for _, _, table in self.tables() for column in table["columns"]]

    def rows(self, table):
        """Returns the rows of such an array as they were in the summary."""
        rows = [{} for _ in range(table["count"])]
        for column in table["columns"]:
            for row, value in zip(rows, self.arrays[column["array"]["name"]]):
                if "texts" in column:
                    value = column["texts"][value]
                elif value != value:
                    value = None
                for key in column["path"][:-1]:
                    row = row.setdefault(key, {})
                row[column["path"][-1]] = value
        return rows

    def summary(self):
        return self.document["summaries"][0]["summary"]

    def contacts(self):
        """Returns the contacts in order: (interval, "vf" or "ee", vertices, toi, point)."""
        a = self.arrays
        return [(a["contact_interval"][i], "ee" if a["contact_kind"][i] else "vf",
                 tuple(a["contact_vertices"][4 * i:4 * i + 4]), a["contact_toi"][i],
                 tuple(a["contact_point"][3 * i:3 * i + 3])) for i in range(len(a["contact_interval"]))]

    def orientations(self):
        """Returns (interval, orientation of each triangle: 0 S0, 1 S+, 2 S-) for every interval that has them."""
        scene, packed = self.scene, self.arrays["orientation"]
        size = (scene["triangles"] + 3) // 4
        kept = [frame for frame in scene["frames"] if frame < scene["last"]]
        if len(packed) != size * len(kept):
            raise ValueError(f"{len(packed)} bytes of orientations, not {size} for each of {len(kept)} intervals")
        now = bytes(size)
        for index, interval in enumerate(kept):
            change = packed[index * size:(index + 1) * size].tobytes()
            now = bytes(a ^ b for a, b in zip(now, change))
            yield interval, [now[t // 4] >> 2 * (t % 4) & 3 for t in range(scene["triangles"])]

    def frames(self, name="frames", vertices=None):
        """Returns the positions that the page shows in each kept frame: [x of all vertices, y of all, z of all]."""
        return [[shown_axis(origin[k], step, q[k]) for k in range(3)] for _, origin, step, q in self.records(name, vertices)]

    def records(self, name="frames", vertices=None):
        """Decodes the records one after the other: (1 where a grid begins, its origin, its step, values of each axis)."""
        return list(decoded(self.arrays[name].tobytes(), vertices or self.scene["vertices"]))

    def errors(self, given):
        """Returns the largest error of a coordinate of frames [(x, y, z)], and the largest by the longest side of its frame."""
        largest = relative = 0.0
        for shown, points in zip(self.frames(), given):
            axes = list(zip(*points))
            error = max(abs(a * self.scene["unit"] - b) for s, g in zip(shown, axes) for a, b in zip(s, g))
            side = max(max(axis) - min(axis) for axis in axes)
            largest = max(largest, error)
            relative = max(relative, (error / side if side > 0.0 else 1.0) if error > 0.0 else 0.0)
        return largest, relative


def unpack(text, entry):
    """Returns the numbers of a block."""
    data = zlib.decompress(base64.b64decode(text.strip(), validate=True))
    values = array(FORMATS[entry["type"]])
    values.frombytes(data)
    if len(values) != entry["count"]:
        raise ValueError(f"{entry['name']}: {len(values)} numbers, not {entry['count']}")
    return values


def wrap(value):
    """Returns the value as a signed number of 32 bits."""
    return (value + 0x80000000 & 0xFFFFFFFF) - 0x80000000


def read_body(data, at, count):
    """Returns the differences d from the prediction, per axis, and where the next record begins."""
    width = data[at]
    if not 1 <= width <= 4:
        raise ValueError(f"{width} bytes a value")
    at += 1
    planes = [data[at + p * 3 * count:at + (p + 1) * 3 * count] for p in range(width)]
    values = planes[0]
    for p in range(1, width):
        values = [low | high << 8 * p for low, high in zip(values, planes[p])]
    residuals = [value >> 1 ^ -(value & 1) for value in values]
    axes = [list(accumulate(residuals[k * count:(k + 1) * count])) for k in range(3)]
    return axes, at + width * 3 * count


def decoded(data, count):
    """Yields what Report.records returns."""
    at, q, origin, step = 0, None, None, None
    while at < len(data):
        key, at = data[at], at + 1
        if key == 1:
            *origin, step = struct.unpack_from("<4d", data, at)
            q, at = read_body(data, at + 32, count)
        else:
            shift = struct.unpack_from("<3i", data, at)
            d, at = read_body(data, at + 12, count)
            q = [[a + b + s for a, b in zip(old, new)] for old, new, s in zip(q, d, shift)]
        q = [[wrap(value) for value in axis] for axis in q]
        yield key, origin, step, q


def shown_axis(origin, step, q):
    """Returns positions along one axis as the page draws them: float32 relative to the middle of the body."""
    low, high = origin + step * min(q), origin + step * max(q)
    middle = 0.5 * (low + high)
    local = array("f", [origin + step * value - middle for value in q])
    return [value + middle for value in local]
