"""Checks one mesh and draws what intersects in it: check_a_mesh.py MESH [PICTURE.svg]."""

from __future__ import annotations

import os
import sys

import numpy as np

import cscd
from svg_picture import MARKED, SURFACE, Picture


def describe(path: str, recording: cscd.Recording, found: cscd.Intersections) -> None:
    """Prints the answer."""
    mesh = recording.mesh
    open_edges = sum(mesh.component(i)["open_edges"] for i in range(mesh.component_count))
    print(f"{os.path.basename(path)}: {mesh.vertex_count} vertices, {mesh.face_count} faces, {mesh.component_count} components, "
          f"{open_edges} open edges")
    if not found:
        print("no two triangles intersect or touch")
        return
    kinds = ", ".join(f"{found.count(kind)} {kind}" for kind in cscd.INTERSECTION_KINDS if found.count(kind))
    print(f"{len(found)} pairs of triangles intersect or touch: {kinds}")
    print(f"{found.faces.sum()} faces take part, {100.0 * found.faces.mean():.1f} %")
    print(f"{len(found.curves)} curves, {sum(curve.closed for curve in found.curves)} of them closed, "
          f"{sum(curve.length for curve in found.curves):.3f} long in all")
    print(f"{found.buried.sum()} vertices are buried, the deepest {found.max_depth:.3f} below the surface")
    sums = found.by_parts(recording.part_labels, len(recording.part_names), bodies=recording.body_labels)
    for row in sorted(sums[sums.curves > 0], key=lambda row: -row.depth):
        print(f"  {recording.part_names[row.a]} x {recording.part_names[row.b]}: {row.crossing} pairs of triangles, "
              f"curves {row.length:.3f} long, {row.depth:.3f} deep")


def draw(path: str, V: np.ndarray, mesh: cscd.Mesh, found: cscd.Intersections) -> None:  # type: ignore[type-arg]
    """Left the surface, with the faces of the pairs in red; right curves, and what is buried."""
    picture = Picture(900, 520, panels=2)
    around = V[mesh.triangles[found.triangles].ravel()] if found else V
    low, high = around.min(axis=0), around.max(axis=0)
    centre, extent = 0.5 * (low + high), 0.6 * float((high - low).max())
    closed = mesh.is_closed_manifold
    marked = found.faces[mesh.triangle_face]
    picture.look(0, 25.0, 10.0, centre, extent)
    picture.surface(V, mesh.triangles, np.where(marked[:, None], MARKED, SURFACE), closed)
    picture.caption(0, f"{found.faces.sum()} faces of crossing pairs")
    picture.look(1, 25.0, 10.0, centre, extent)
    picture.dots(V[~found.buried], "#d8d4cc", 2.4)
    picture.dots(V[found.buried], "#3a6ea5", 3.6)
    for curve in found.curves:
        picture.curve(curve.points, "#d64028")
    picture.caption(1, f"{len(found.curves)} curves, {found.buried.sum()} buried vertices")
    picture.write(path)


def main(path: str, picture: str = "") -> int:
    """Returns the status that the script ends with."""
    recording = cscd.read(path)
    found = cscd.self_intersections(recording.vertices, recording.mesh, threads=0)
    describe(path, recording, found)
    if picture:
        draw(picture, recording.vertices, recording.mesh, found)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
