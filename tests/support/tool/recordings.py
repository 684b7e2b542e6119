"""Recordings that tests of the tool replay: meshes with frames, and the files that hold them.

Every position is exact in float32, so that all formats hold the same numbers.
"""
import struct
from math import cos, pi, sin, sqrt
from pathlib import Path


def _as_float32(points):
    """The points, rounded."""
    return list(struct.iter_unpack("<3f", struct.pack(f"<{3 * len(points)}f", *(x for point in points for x in point))))


class Recording:
    """Triangles, by the numbers of their vertices, and frames, each a list of points."""

    def __init__(self, triangles, frames):
        self.triangles = [tuple(triangle) for triangle in triangles]
        self.frames = [_as_float32(points) for points in frames]

    def write_mesh(self, path, frame=0, records=None):
        """Writes a frame as .obj or .ply. records: the lines before each triangle of an OBJ file, such as "o Wall"."""
        points = self.frames[frame]
        if str(path).endswith(".ply"):
            lines = ["ply", "format ascii 1.0", f"element vertex {len(points)}", *(f"property double {axis}" for axis in "xyz"),
                     f"element face {len(self.triangles)}", "property list uchar int vertex_indices", "end_header"]
            lines += [" ".join(map(repr, point)) for point in points] + ["3 %d %d %d" % triangle for triangle in self.triangles]
        else:
            lines = [f"v {' '.join(map(repr, point))}" for point in points]
            for i, (a, b, c) in enumerate(self.triangles):
                lines += ([records[i]] if records else []) + [f"f {a + 1} {b + 1} {c + 1}"]
        Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")

    def write_cache(self, path, frame_count=None):
        """Writes all frames as a point cache, .pc2 or .mdd; frame_count: so many, forwards, backwards, forwards, ..."""
        count, frame_count = len(self.frames[0]), frame_count or len(self.frames)
        order, header = "<", struct.pack("<12siiffi", b"POINTCACHE2\0", 1, count, 0.0, 1.0, frame_count)
        if str(path).endswith(".mdd"):
            order, header = ">", struct.pack(f">ii{frame_count}f", frame_count, count, *(k / 24.0 for k in range(frame_count)))
        frames = [struct.pack(f"{order}{3 * count}f", *(x for point in frame for x in point)) for frame in self.frames]
        there_and_back = frames + frames[-2:0:-1]
        with open(path, "wb") as file:
            file.write(header)
            for k in range(frame_count):
                file.write(there_and_back[k % len(there_and_back)])

    def write_sequence(self, pattern, first=0):
        """Writes frame k as the file whose name the pattern, such as f_%04d.obj, gives for first + k."""
        for frame in range(len(self.frames)):
            self.write_mesh(pattern % (first + frame), frame)

    def part(self, vertices, triangles):
        """What a range of vertices and a range of triangles are alone."""
        return Recording([[corner - vertices.start for corner in self.triangles[t]] for t in triangles],
                         [[frame[v] for v in vertices] for frame in self.frames])


def _tetrahedron(a, b, c, d):
    """The outward triangles of a tetrahedron; from outside a, b, c are counter-clockwise."""
    return [(a, b, c), (b, a, d), (c, b, d), (a, c, d)]


def tetrahedra(frame_count):
    """The tetrahedron 4 5 6 7 flies with its tip 4 at (3.5 - k, 1, 1) in frame k through the tetrahedron 0 1 2 3.

    Face 0 1 2 of that (triangle 0) lies in x = 0, and its opposite face passes through x = -2 there. So the tip touches triangle
    0 at (0, 1, 1) half way through interval 3, frames 4 and later have an intersection, nothing happens in interval 4, and the
    tip leaves at (-2, 1, 1) half way through interval 5.
    """
    wall = [(0, 0, 0), (0, 4, 0), (0, 0, 4), (-4, 0, 0)]
    dart = [(0, 1, 1), (4, 1.5, 1), (4, 0.5, 1.5), (4, 0.5, 0.5)]
    return Recording(_tetrahedron(0, 1, 2, 3) + _tetrahedron(5, 6, 7, 4),
                     [wall + [(3.5 - k + x, y, z) for x, y, z in dart] for k in range(frame_count)])


def _grid(columns, rows, closed):
    """A grid of quads, each two triangles. closed: its ends are joined both ways."""
    across, along = (columns, rows) if closed else (columns + 1, rows + 1)
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a, b = j * across + i, j * across + (i + 1) % across
            c, d = (j + 1) % along * across + (i + 1) % across, (j + 1) % along * across + i
            triangles += [(a, b, c), (a, c, d)]
    return triangles


def fold(columns, rows, frame_count):
    """An open strip of quads (columns: 8 or more), slightly wavy.

    Its right half folds over by 200 degrees, so that it passes through the left half in the last third of the frames.
    """
    def place(s, w, angle):
        radius, turned = 2.0 / angle, angle * min(1.0, max(0.0, (s + 1.0) / 2.0))
        before, after = min(0.0, s + 1.0), max(0.0, s - 1.0)
        wave = 0.05 * sin(1.7 * s + 2.3 * w) + 0.03 * cos(3.1 * w - 0.9 * s)
        return (before + radius * sin(turned) + after * cos(turned) - wave * sin(turned), w + 0.04 * after,
                radius * (1.0 - cos(turned)) + after * sin(turned) + wave * cos(turned))

    angles = [0.1 + (200.0 / 180.0 * pi - 0.1) * k / max(1, frame_count - 1) for k in range(frame_count)]
    places = [(10.0 * i / columns - 5.0, 4.0 * j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    return Recording(_grid(columns, rows, False), [[place(s, w, angle) for s, w in places] for angle in angles])


# The corners of each side of a cube, by bits x, y, z, counter-clockwise from outside.
CUBE_SIDES = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))


def _turned_corner(corner):
    p = [1.0 if corner >> axis & 1 else -1.0 for axis in range(3)]
    for k, angle in enumerate((0.71, 0.43, 0.29)):
        i, j = (k + 1) % 3, (k + 2) % 3
        p[i], p[j] = cos(angle) * p[i] - sin(angle) * p[j], sin(angle) * p[i] + cos(angle) * p[j]
    return p


def cube(split):
    """A turned cube flies in three frames into the tip of a tetrahedron, and on.

    Clean, it has 8 vertices beside the 4 of the tetrahedron. Split, it has 24: each side has its own four vertices, as exporters
    write them. The triangles come in the same order.
    """
    corners = [corner for side in CUBE_SIDES for corner in side] if split else range(8)
    sides = [tuple(range(4 * side, 4 * side + 4)) for side in range(6)] if split else CUBE_SIDES
    triangles = [triangle for a, b, c, d in sides for triangle in ((a, b, c), (a, c, d))]
    count = len(corners)
    tetrahedron = [(1.1, -3, -2), (0.8, 3, -2), (1, 0.3, 3), (-2, 0.5, 0.2)]
    points = [_turned_corner(corner) for corner in corners]
    return Recording(triangles + _tetrahedron(count, count + 1, count + 2, count + 3),
                     [[(x - 4.0 + 2.1 * k, y + 0.1, z - 0.2) for x, y, z in points] + tetrahedron for k in range(3)])


def ball(x, rings=10, segments=14):
    """The points of a ball of radius 1, and its triangles."""
    places = [(pi * i / rings, 2.0 * pi * j / segments) for i in range(1, rings) for j in range(segments)]
    points = [(x, 0.1, 1.05), *((x + sin(a) * cos(b), 0.1 + sin(a) * sin(b), 0.05 + cos(a)) for a, b in places), (x, 0.1, -0.95)]
    last, triangles = len(points) - 1, []
    for j in range(segments):
        after = (j + 1) % segments
        triangles += [(0, 1 + j, 1 + after), (last, last - segments + after, last - segments + j)]
        for row in range(1, 1 + segments * (rings - 2), segments):
            triangles += [(row + j, row + segments + j, row + segments + after), (row + j, row + segments + after, row + after)]
    return points, triangles


def balls(*distances):
    """Two balls in frames in which their middles are so far apart."""
    points, triangles = ball(0.0)
    both = triangles + [tuple(corner + len(points) for corner in triangle) for triangle in triangles]
    return Recording(both, [points + ball(distance)[0] for distance in distances])


def bow_tie():
    """Two closed tetrahedra that share one vertex, 0. One frame."""
    turns = [2.0 * pi * (v % 3) / 3.0 for v in range(1, 7)]
    points = [(2.0 if i < 3 else -2.0, cos(turn), sin(turn)) for i, turn in enumerate(turns)]
    return Recording(_tetrahedron(1, 2, 3, 0) + _tetrahedron(6, 5, 4, 0), [[(0, 0, 0), *points]])


def torus(rings, segments):
    """A closed torus of rings by segments quads. One frame."""
    places = [(2.0 * pi * (v % segments) / segments, 2.0 * pi * (v // segments) / rings) for v in range(rings * segments)]
    points = [((3.0 + cos(u)) * cos(w), (3.0 + cos(u)) * sin(w), -sin(u)) for u, w in places]
    return Recording(_grid(segments, rings, True), [points])


def spindle(rings, segments, frame_count):
    """A closed spindle of rings by segments quads and two tips, twelve units long, which bends from 30 degrees to 400.

    Its tips, the last two vertices, touch shortly before the last frame.
    """
    first, end = rings * segments, (rings - 1) * segments
    triangles = []
    for i in range(segments):
        following = (i + 1) % segments
        triangles += [(first, following, i), (first + 1, end + i, end + following)]
        for j in range(rings - 1):
            a, b = j * segments + i, j * segments + following
            triangles += [(a, b, a + segments), (b, b + segments, a + segments)]

    def place(s, w, angle):
        radius, thick = 12.0 / angle, sqrt(max(0.0, 1.0 - s * s / 36.0))
        from_centre = radius + thick * cos(w)
        return (from_centre * sin(s / radius), from_centre * cos(s / radius) - radius,
                thick * sin(w) + 0.03 * s + 0.01 * sin(3.0 * s))

    places = [(12.0 * (v // segments + 1) / (rings + 1.0) - 6.0, 2.0 * pi * (v % segments + 0.3 * (v // segments)) / segments)
              for v in range(rings * segments)] + [(-6.0, 0.0), (6.0, 0.0)]
    angles = [(30.0 + 370.0 * k / (frame_count - 1.0)) / 180.0 * pi for k in range(frame_count)]
    return Recording(triangles, [[place(s, w, angle) for s, w in places] for angle in angles])
