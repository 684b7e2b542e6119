"""Volumes of overlaps and lengths of intersection curves with their gradients; and the surface of tetrahedra."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np

from ._arrays import as_indices, count_of
from ._host import Host, new_handle
from ._library import address_of, copy_items, copy_list, library, new_struct

__all__ = ["Measures", "TetSurface", "tet_surface"]

Array = Any

_MOST_VERTICES = 2**32 - 2


class Measures:
    """A measure of all pairs of bodies, and of bodies with themselves, that is not 0. ``float()`` of it is ``sum``.

    Attributes
    ----------
    bodies : (k, 2) int64
        Two bodies, the smaller number first, sorted; twice the same: of one with itself.
    values : (k,) float64
        Their volumes or lengths; NaN: unknown.
    sum : float
        Of those that are known.
    unknown : int
        The number of those that are not.
    """

    def __init__(self, found: Array, vertex_count: int) -> None:
        items = copy_items(int(found["items"][0]), int(found["count"][0]), "measure")
        gradients = copy_items(int(found["gradients"][0]), int(found["gradient_count"][0]), "vertex_gradient")
        self.bodies: Array = np.stack([items["a"], items["b"]], axis=1)
        self.values: Array = items["value"].copy()
        self.sum = float(found["sum"][0])
        self.unknown = int(found["unknown"][0])
        self._first, self._count = items["first_gradient"], items["gradient_count"]
        self._vertices, self._gradients = gradients["vertex"], gradients["gradient"]
        self._vertex_count = vertex_count

    def __float__(self) -> float:
        return self.sum

    def __len__(self) -> int:
        return len(self.values)

    @property
    def gradient(self) -> Array:
        """(n, 3) float64: the derivatives of ``sum``."""
        return self.weighted(np.ones(len(self)))

    def gradient_of(self, index: int) -> Array:
        """(n, 3) float64: the derivatives of ``values[index]``; NaN if it is unknown."""
        if np.isnan(self.values[index]):
            return np.full((self._vertex_count, 3), np.nan)
        weights = np.zeros(len(self))
        weights[index] = 1.0
        return self.weighted(weights)

    def weighted(self, weights: Any) -> Array:
        """(n, 3) float64: the derivatives of ``(weights * values).sum()``, without what is unknown; ``weights``: (k,)."""
        scale = np.asarray(weights, np.float64)
        if scale.shape != (len(self),):
            raise ValueError(f"weights: expected {len(self)} numbers, one for each value, got shape {scale.shape}")
        dense = np.zeros((self._vertex_count, 3))
        for i in np.flatnonzero(scale != 0.0):
            rows = slice(self._first[i], self._first[i] + self._count[i])
            dense[self._vertices[rows]] += scale[i] * self._gradients[rows]
        return dense

    def __repr__(self) -> str:
        return f"Measures({len(self)} pairs of bodies, sum {self.sum:g}, {self.unknown} unknown)"


class TetSurface(NamedTuple):
    """The boundary of tetrahedra (``tet_surface``)."""

    #: (m, 3) int64: triangles by numbers of surface vertices, counter-clockwise from outside.
    triangles: Array
    #: (s,) int64: the vertex behind each surface vertex, ascending: ``x = nodes[vertices]``, ``forces[vertices] -= g``.
    vertices: Array
    #: (m,) int64: the tetrahedron of each triangle.
    tetrahedra: Array


def tet_surface(tetrahedra: Any, vertex_count: Optional[int] = None) -> TetSurface:
    """The faces that only one tetrahedron has, outwards, and the way from their vertices back.

    Parameters
    ----------
    tetrahedra : (k, 4) integers
        In the order in which ``dot(cross(b - a, c - a), d - a)`` is positive.

    >>> tet_surface([[2, 3, 5, 7]]).triangles.tolist()
    [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    """
    limit = _MOST_VERTICES if vertex_count is None else count_of("vertex_count", vertex_count, _MOST_VERTICES)
    rows = as_indices("tetrahedra", tetrahedra, 4, limit, "vertices")
    vertices = int(rows.max(initial=0)) + 1 if vertex_count is None else limit
    found = new_struct("tet_surface_arrays")
    host = Host()
    with host.lock:
        handle = new_handle(host, library.cscd_tet_surface_destroy, library.cscdpy_tet_surface_create, address_of(rows),
                            len(rows), vertices)
        library.cscdpy_tet_surface_get(handle.pointer, address_of(found))
        count, points = int(found["triangle_count"][0]), int(found["vertex_count"][0])
        triangles = copy_list(int(found["triangles"][0]), 3 * count, np.uint32)
        surface = copy_list(int(found["vertices"][0]), points, np.uint32)
        owners = copy_list(int(found["tetrahedra"][0]), count, np.uint32)
    return TetSurface(triangles.reshape(-1, 3).astype(np.int64), surface.astype(np.int64), owners.astype(np.int64))
