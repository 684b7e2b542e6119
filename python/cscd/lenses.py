"""Lenses, what surfaces that pass through each other bound together; and the patches that their curves cut surfaces into."""

from __future__ import annotations

from typing import Any, List

import numpy as np

from ._library import copy_items, copy_list, structs
from .results import names_of

__all__ = ["LENS_REASONS", "Lenses", "Patches"]

Array = Any

_NONE = 2**32 - 1

#: Why the points of a lens are on the wrong side, by their codes: "buried", "inside out", "looks out", "smaller side",
#: "edge", "flush".
LENS_REASONS = names_of("CSCD_LENS_REASONS")


class Lenses:
    """Where surfaces are in each other, the thickest lens first: which points are on the wrong side, where on the other
    sheet each belongs, in which direction, and how far (``Detector.find_lenses``; include/cscd/untangle.h).

    Attributes
    ----------
    items : (k,) record array
        Of each lens: reason, a code of ``LENS_REASONS``; patch, the number in ``Intersections.patches``, or -1; components,
        objects and parts (2 each), of its points and of the sheet where they belong; fold, whether both sides of a curve
        are in the patch; first_point and point_count, its range of ``points``; thickest, the index of the thickest one;
        thickness; axis (3), a unit vector, the way on which the points leave together.
    points : (p,) record array
        Of each point: vertex, or -1 if it is on an edge; edge, or -1; triangle, u and v, the place on the other sheet,
        which is (1 - u - v) p0 + u p1 + v p2; s, for an edge (1 - s) e0 + s e1; x (3), the point; direction (3) and
        thickness: x + thickness * direction is the place, unless along_normal is true. The direction is then a normal,
        and the way there is next to nothing, or along the sheet.
    thickness : float
        Of the thickest lens; 0 if there is none.
    pairs : int
        How many pairs of triangles intersect.
    undecided : int
        How many curves bound none of the points: they say of no side that it is the wrong one.
    """

    def __init__(self, found: Array) -> None:
        self.items: Array = copy_items(int(found["items"][0]), int(found["count"][0]), "lens").view(np.recarray)
        self.points: Array = copy_items(int(found["points"][0]), int(found["point_count"][0]),
                                        "lens_point").view(np.recarray)
        self.thickness = float(found["thickness"][0])
        self.pairs = int(found["pairs"][0])
        self.undecided = int(found["undecided"][0])

    def __len__(self) -> int:
        return len(self.items)

    def points_of(self, index: int) -> Array:
        """The points of one lens."""
        lens = self.items[index]
        return self.points[lens.first_point: lens.first_point + lens.point_count]

    def reason_names(self) -> List[str]:
        """The name of each lens's reason."""
        return [LENS_REASONS[reason] for reason in self.items.reason]

    def __repr__(self) -> str:
        return f"Lenses({len(self)} with {len(self.points)} points, thickness {self.thickness:g})"


class Patches:
    """What curves cut surfaces into, and what they cut off of open ones (``Intersections.patches``; include/cscd/surface.h).

    Attributes
    ----------
    items : (k,) record array
        Of each patch: component, object, body; triangle and corner, an example; vertex_count and triangle_count, of those
        wholly in it; first_winding and winding_count, its range of ``windings``; own, how often its own body winds around
        what is just outside: above 0 the patch is buried in its own body, below 0 it is inside out.
    windings : (w,) record array
        body, and number: how often that one winds around the patch. It contains the patch if that is 1 or more.
    vertex_patches : (n,) int64
        The patch of each vertex; -1 if it has no triangle, or if curves end at it.
    triangle_patches : (t,) int64
        The patch of each triangle of the mesh; -1 if a curve cuts it.
    corner_patches : (t, 3) int64
        The patch of each corner.
    turned : (c,) bool
        The components that are taken as turned around.
    cut_offs : (m,) record array
        What a curve divides off of an open component: curve, the index in ``Intersections.curves``; trace, 0 or 1 for that
        on the first or second sheet, 2 for both as one; component, object; area, and rest, that of the other part;
        first_patch and patch_count: see ``cut_off_patches``.
    """

    def __init__(self, found: Array, vertex_count: int, triangle_count: int, component_count: int) -> None:
        patches = copy_list(int(found["patches"][0]), 1, structs["patches"])[0]
        self.items: Array = copy_items(int(patches["items"]), int(patches["count"]), "patch").view(np.recarray)
        self.windings: Array = copy_items(int(patches["windings"]), int(patches["winding_count"]),
                                          "winding").view(np.recarray)
        self.vertex_patches: Array = _signed_list(patches["vertex_patches"], vertex_count)
        self.triangle_patches: Array = _signed_list(patches["triangle_patches"], triangle_count)
        self.corner_patches: Array = _signed_list(patches["corner_patches"], 3 * triangle_count).reshape(-1, 3)
        turned = int(patches["turned"])
        self.turned: Array = copy_list(turned, component_count, bool) if turned else np.zeros(component_count, bool)
        cut_offs = copy_list(int(found["cut_offs"][0]), 1, structs["cut_offs"])[0]
        self.cut_offs: Array = copy_items(int(cut_offs["items"]), int(cut_offs["count"]), "cut_off").view(np.recarray)
        self._cut_off_patches = _signed_list(cut_offs["patches"], int(cut_offs["patch_count"]))

    def __len__(self) -> int:
        return len(self.items)

    def vertices_of(self, index: int) -> Array:
        """The vertices of one patch: int64, ascending."""
        return np.flatnonzero(self.vertex_patches == index)

    def triangles_of(self, index: int) -> Array:
        """The triangles that are wholly in one patch: int64, ascending."""
        return np.flatnonzero(self.triangle_patches == index)

    def cut_off_patches(self, index: int) -> Array:
        """The patches that a cut-off consists of: int64, ascending; empty if it lies within triangles."""
        cut_off = self.cut_offs[index]
        return self._cut_off_patches[cut_off.first_patch: cut_off.first_patch + cut_off.patch_count].copy()

    def __repr__(self) -> str:
        return f"Patches({len(self)}, {len(self.cut_offs)} cut-offs)"


def _signed_list(address: Any, count: int) -> Array:
    """Indices of the library; -1: none."""
    indices = (copy_list(int(address), count, np.uint32) if count else np.empty(0, np.uint32)).astype(np.int64)
    indices[indices == _NONE] = -1
    return indices
