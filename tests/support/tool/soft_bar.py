"""Writes a bar that is soft at one place: between rings 26 and 28 of 40."""
from math import cos, pi, sin
from pathlib import Path

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
