#!/usr/bin/env python3
"""The cost of very large inputs to the tool: prints a table for docs/about/measurements.md. Linux.

Usage: python3 benchmarks/extremes.py [CSCD [ROW...]]

Each row makes its files, runs one command on them, and prints how long that took and the most memory that it held. Rows are named by the
first words in ROWS; without names all of them are run, which takes some minutes, 3 GB of memory and 1 GB of disk. A size can be given
as NAME=COUNT.
"""
import array
import math
import os
import sys
import tempfile
import time

CSCD = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "cscd")


# ---- files ----

def write_mesh(path, vertices, triangles):
    """Writes a binary PLY of flat lists: three numbers a vertex, three a triangle."""
    faces = array.array("I", [0]) * (len(triangles) // 3 * 4)
    faces[0::4] = array.array("I", [3]) * (len(triangles) // 3)
    for k in range(3):
        faces[k + 1::4] = triangles[k::3]
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {len(vertices) // 3}\nproperty float x\nproperty float y\nproperty float z\n"
              f"element face {len(triangles) // 3}\nproperty list uint uint vertex_indices\nend_header\n")
    with open(path, "wb") as out:
        out.write(header.encode("ascii"))
        vertices.tofile(out)
        faces.tofile(out)


def write_frames(path, frame_count, vertex_count, frame):
    """Writes a PC2; frame(k) returns the flat list of one frame."""
    with open(path, "wb") as out:
        out.write(b"POINTCACHE2\0")
        array.array("i", [1, vertex_count]).tofile(out)
        array.array("f", [0.0, 1.0]).tofile(out)
        array.array("i", [frame_count]).tofile(out)
        for k in range(frame_count):
            frame(k).tofile(out)


def raised(vertices, begin, height):
    """Returns the vertices, those from number `begin` on higher by `height`."""
    moved = array.array("f", vertices)
    heights = moved[3 * begin + 2::3]
    moved[3 * begin + 2::3] = array.array("f", [z + height for z in heights])
    return moved


# ---- scenes: each returns the mesh and how to make its frames ----

def comb(count, place):
    """Needles next to each other whose broad ends a spine joins; place(along, across) returns a vertex."""
    vertices, triangles = array.array("f"), array.array("I")
    for i in range(count):
        for along, across in ((-1.0, i), (count, i + 0.25), (count, i - 0.25), (count + 1.0, i)):
            vertices.extend(place(along, across))
        n = 4 * i
        triangles.extend((n, n + 2, n + 1, n + 1, n + 2, n + 3))
        if i + 1 < count:
            triangles.extend((n + 1, n + 3, n + 7, n + 1, n + 7, n + 6))
    return vertices, triangles


def combs(contacts):
    """Two combs across each other, one of which falls through the other: every two needles have four contacts of edges."""
    count = math.isqrt(contacts // 4)
    vertices, triangles = comb(count, lambda along, across: (along, across, 0.0))
    upper, more = comb(count, lambda along, across: (across + 0.125, along, 1.0))
    triangles.extend(array.array("I", [v + 4 * count for v in more]))
    vertices.extend(upper)
    return vertices, triangles, 2, lambda k: raised(vertices, 4 * count, -2.0 * k)


def torus(triangles, frames=3):
    """A torus that turns and breathes in waves."""
    segments = max(3, math.isqrt(triangles // 4))
    rings = max(3, triangles // (2 * segments))
    faces = array.array("I")
    for i in range(rings):
        a, b = i * segments, (i + 1) % rings * segments
        for k in range(segments):
            n = (k + 1) % segments
            faces.extend((a + k, b + k, b + n, a + k, b + n, a + n))
    around = [(math.cos(2.0 * math.pi * k / segments), math.sin(2.0 * math.pi * k / segments)) for k in range(segments)]

    def frame(number):
        vertices = array.array("f")
        for i in range(rings):
            a = 2.0 * math.pi * (i / rings + number / 1000.0)
            r, c, s = 0.3 + 0.02 * math.sin(5.0 * a + 0.1 * number), math.cos(a), math.sin(a)
            for x, y in around:
                vertices.extend(((1.0 + r * x) * c, (1.0 + r * x) * s, r * y))
        return vertices
    return frame(0), faces, frames, frame


def recording(frames):
    """A torus of 5,000 triangles for this number of frames."""
    return torus(5000, frames)


def components(count):
    """So many tetrahedra in a cube, which all move down, the upper half by more than the distance of two layers."""
    side = math.ceil(count ** (1 / 3))
    vertices, triangles = array.array("f"), array.array("I")
    for i in range(count):
        x, y, z = i % side, i // side % side, i // side // side
        vertices.extend((x, y, z, x + 0.5, y, z, x, y + 0.5, z, x, y, z + 0.5))
        n = 4 * i
        triangles.extend((n, n + 2, n + 1, n, n + 1, n + 3, n + 1, n + 2, n + 3, n + 2, n, n + 3))
    upper = 4 * (side // 2 * side * side)
    return vertices, triangles, 3, lambda k: raised(vertices, upper, -0.35 * k)


def intervals(count):
    """A small pyramid above a large triangle, which it goes through and leaves again, for this number of intervals."""
    vertices = array.array("f", (-9, -9, 0, 9, -9, 0, 0, 9, 0, -1, -1, 1, 1, -1, 1, 0, 1, 1, 0, 0, 0.5))
    triangles = array.array("I", (0, 1, 2, 3, 5, 4, 3, 4, 6, 4, 5, 6, 5, 3, 6))
    return vertices, triangles, count + 1, lambda k: raised(vertices, 3, 0.6 * math.sin(0.1 * k) - 0.3)


# ---- rows ----

# Each: its scene, its size, the command and its options; M and F stand for the mesh and its frames.
ROWS = (
    ("combs", 10_000_000, ("replay", "M", "F", "--method", "none")),
    ("torus", 4_000_000, ("info", "M")),
    ("torus", 4_000_000, ("check", "M")),
    ("torus", 4_000_000, ("replay", "M", "F", "--method", "single")),
    ("recording", 10_000, ("check", "M", "F")),
    ("recording", 10_000, ("replay", "M", "F")),
    ("components", 1_000_000, ("info", "M")),
    ("components", 1_000_000, ("check", "M")),
    ("components", 1_000_000, ("replay", "M", "F", "--no-check", "--method", "none")),
    ("intervals", 300_000, ("replay", "M", "F", "--report", "REPORT")),
)
SCENES = {"combs": combs, "torus": torus, "recording": recording, "components": components, "intervals": intervals}


def make_files(name, count, names):
    """Makes them in a process of its own: what this one holds would count as memory of the commands that it starts."""
    maker = os.fork()
    if maker == 0:
        vertices, triangles, frames, frame = SCENES[name](count)
        write_mesh(names["M"], vertices, triangles)
        write_frames(names["F"], frames, len(vertices) // 3, frame)
        os._exit(0)
    assert os.waitstatus_to_exitcode(os.waitpid(maker, 0)[1]) == 0, name


def run(command, names):
    """Returns (seconds, MiB at most) of one command."""
    arguments = [CSCD, *(names.get(word, word) for word in command)]
    begin = time.perf_counter()
    quiet = [(os.POSIX_SPAWN_OPEN, stream, os.devnull, os.O_WRONLY, 0) for stream in (1, 2)]
    child = os.posix_spawn(CSCD, arguments, os.environ, file_actions=quiet)
    _, status, usage = os.wait4(child, 0)
    assert os.waitstatus_to_exitcode(status) == 0, arguments
    return time.perf_counter() - begin, usage.ru_maxrss / 1024.0


def measure(folder, wanted):
    made = None
    print("| input | command | seconds | MiB |\n| --- | --- | --- | --- |")
    for name, usual, command in ROWS:
        if wanted and name not in wanted:
            continue
        count = wanted.get(name) or usual
        names = {"M": os.path.join(folder, "mesh.ply"), "F": os.path.join(folder, "frames.pc2"),
                 "REPORT": os.path.join(folder, "page.html")}
        if made != name:
            make_files(name, count, names)
            made = name
        seconds, size = run(command, names)
        shown = " ".join(word for word in command if word not in names)
        print(f"| {name} {count:,} | `{shown}` | {seconds:.1f} | {size:,.0f} |", flush=True)


def main():
    wanted = {}
    for word in sys.argv[2:]:
        name, _, count = word.partition("=")
        if name not in SCENES:
            sys.exit(__doc__)
        wanted[name] = int(count or 0)
    with tempfile.TemporaryDirectory() as folder:
        measure(folder, wanted)


if __name__ == "__main__":
    main()
