"""Changes to a detector between two calls: how far apart features have to stay, and which pairs are left out."""

from __future__ import annotations

import copy
from typing import Any, Dict, Optional, Tuple

from ._arrays import as_indices, count_of, number_of
from ._host import Host
from ._library import address_of, library
from ._options import matrix_of, rules_of
from .intersections import labels_of
from .mesh import Mesh

__all__ = ["LiveSettings"]

Array = Any


class LiveSettings:
    """The changes that are possible on a live ``Detector`` (include/cscd/live.h)."""

    mesh: Mesh
    _host: Host
    _detector: int
    _inputs: Dict[str, Any]
    _labels: Optional[Tuple[Array, int]] = None  # of set_parts
    _bodies: Optional[Tuple[Array, int]] = None  # of set_bodies

    def set_separation(self, min_separation: float, tolerance: float = 0.0) -> None:
        """Changes ``min_separation`` and ``tolerance`` from the next call on."""
        self._set(library.cscd_detector_set_separation, number_of("min_separation", min_separation),
                  number_of("tolerance", tolerance))
        self._inputs.update(min_separation=min_separation, tolerance=tolerance)

    def set_rest(self, rest: Any) -> None:
        """Takes positions at rest (n, 3) for the thresholds and weights of ``near``; None forgets them."""
        views, kept = (None, None) if rest is None else self._views("rest", rest)
        host = self._host
        with host.lock:
            host.call(library.cscdpy_detector_set_rest, self._detector, None if views is None else address_of(views))

    def set_parts(self, labels: Any, part_count: Optional[int] = None) -> None:
        """Says which part each triangle is in, by numbers from 0 on, -1 for none; None: the objects are the parts."""
        self._set_labels(None if labels is None else labels_of(labels, self.mesh.triangle_count, part_count))

    def _set_labels(self, labels: Optional[Tuple[Array, int]]) -> None:
        array, count = (None, 0) if labels is None else labels
        with self._host.lock:
            self._set(library.cscd_detector_set_parts, None if array is None else address_of(array), count)
            self._labels = labels

    def set_bodies(self, labels: Any, label_count: Optional[int] = None) -> None:
        """Says what belongs together, for depths, by such numbers; None: the parts say so (include/cscd/surface.h)."""
        self._set_bodies(None if labels is None else labels_of(labels, self.mesh.triangle_count, label_count))

    def _set_bodies(self, labels: Optional[Tuple[Array, int]]) -> None:
        array, count = (None, 0) if labels is None else labels
        with self._host.lock:
            self._set(library.cscd_detector_set_bodies, None if array is None else address_of(array), count)
            self._bodies = labels

    def set_active(self, vertices: Any) -> None:
        """Only these vertices move, all others rest (include/cscd/live.h); None: all may move."""
        array = as_indices("vertices", () if vertices is None else vertices, 1, self.mesh.vertex_count, "vertices")
        if vertices is None:
            self._set(library.cscd_detector_set_active, None, 0)
        else:
            self._set(library.cscd_detector_set_active, address_of(array), len(array))

    def set_longest_list(self, longest_list: int) -> None:
        """Changes ``longest_list`` from the next call on; 0: lists may have any length."""
        self._set(library.cscd_detector_set_longest_list, count_of("longest_list", longest_list))
        self._inputs.update(longest_list=longest_list)

    def set_rules(self, rules: Any, thickness_matrix: Any = None) -> None:
        """Replaces ``rules`` and ``thickness_matrix`` from the next call on (include/cscd/live.h); None: none."""
        array = None if rules is None else rules_of(self.mesh, rules)
        matrix = None if thickness_matrix is None else matrix_of(thickness_matrix)
        self._set(library.cscd_detector_set_rules, None if array is None else address_of(array),
                  0 if array is None else len(array), None if matrix is None else address_of(matrix),
                  0 if matrix is None else len(matrix))
        self._inputs.update(copy.deepcopy({"rules": rules, "thickness_matrix": thickness_matrix}))

    def set_seams(self, seams: Any) -> None:
        """Replaces the seams: (k, 2) vertices; None: none."""
        array = as_indices("seams", () if seams is None else seams, 2, self.mesh.vertex_count, "vertices")
        self._set(library.cscd_detector_set_seams, address_of(array) if len(array) else None, len(array))
        self._inputs.update(seams=copy.deepcopy(seams))

    def set_ignored(self, ignored: Any) -> None:
        """Replaces the pairs of triangles that are left out: (k, 2); None: none."""
        array = as_indices("ignored", () if ignored is None else ignored, 2, self.mesh.triangle_count, "triangles")
        self._set(library.cscd_detector_set_ignored, address_of(array) if len(array) else None, len(array))
        self._inputs.update(ignored=copy.deepcopy(ignored))

    def _set(self, function: Any, *arguments: Any) -> None:
        host = self._host
        with host.lock:
            host.call_public(function, self._detector, *arguments)

    def _views(self, name: str, positions: Any) -> Tuple[Array, Any]:
        raise NotImplementedError
