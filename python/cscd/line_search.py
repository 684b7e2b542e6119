"""One motion for many questions, as in the line search of an implicit solver (Li et al. 2020)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Tuple

import numpy as np

from ._arrays import mutable_view, number_of
from ._host import Handle
from ._library import address_of, copy_items, library, new_struct
from .results import Contacts, Proximities, copy_records, near_form

if TYPE_CHECKING:
    from .detector import Detector

__all__ = ["LineSearch"]

Array = Any



class LineSearch:
    """The motion from ``x0`` to ``x1`` of ``Detector.line_search``: its candidates are collected once.

    Attributes
    ----------
    candidate_count : int
        Pairs of features whose volumes come near each other on the way.
    """

    def __init__(self, detector: Detector, x0: Any, x1: Any, reach: float = 0.0) -> None:
        self.detector = detector
        self._host = detector._host
        start, kept0 = detector._views("x0", x0)
        end, kept1 = detector._views("x1", x1)
        self._single = all(array.itemsize == 4 for array in kept0)
        host = self._host
        with host.lock:
            self._handle = Handle(host, library.cscd_line_search_destroy)
            host.call_public(library.cscd_line_search_create, detector._detector, self._handle.place)
            detector._call(host, "free_step", library.cscdpy_line_search_begin, self._handle.pointer, address_of(start),
                           address_of(end), number_of("reach", reach))
        self.candidate_count: int = library.cscd_line_search_candidate_count(self._handle.pointer)

    def candidates(self) -> Array:
        """(k, 3) int64: kind (``CONTACT_KINDS``), a and b of every pair that comes within reach on the way, sorted."""
        found = new_struct("candidates")
        host = self._host
        with host.lock:
            host.call(library.cscdpy_line_search_candidates, self._handle.pointer, address_of(found))
            items = copy_items(int(found["items"][0]), int(found["count"][0]), "candidate")
        return np.stack([items["kind"], items["a"], items["b"]], axis=1)

    def positions(self, fraction: float) -> Array:
        """(n, 3): ``x0 + fraction * (x1 - x0)``, rounded to the type of ``x0``; fraction in [0, 1]."""
        reached = self._empty()
        target = mutable_view(reached)
        host = self._host
        with host.lock:
            self.detector._call(host, "free_step", library.cscdpy_line_search_positions, self._handle.pointer,
                                number_of("fraction", fraction), address_of(target))
        return reached

    def max_step(self, longest: float = 1.0) -> Tuple[Array, float, Optional[Contacts]]:
        """As ``Detector.max_step``, and no farther than ``longest`` in (0, 1]."""
        from .detector import free_step_of
        reached = self._empty()
        target = mutable_view(reached)
        detector = self.detector
        host = self._host
        with host.lock:
            detector._call(host, "free_step", library.cscdpy_line_search_max_step, self._handle.pointer,
                           number_of("longest", longest), address_of(target), detector._at["free_step"])
            return free_step_of(detector._lists["free_step"], reached)

    def near(self, fraction: float, distance: float, unique: bool = False, beyond: bool = False) -> Proximities:
        """As ``Detector.near``, at ``positions(fraction)``; ``distance`` is at most the reach of the line."""
        detector = self.detector
        host = self._host
        with host.lock:
            detector._call(host, "proximities", library.cscdpy_line_search_find_near, self._handle.pointer,
                           number_of("fraction", fraction), number_of("distance", distance),
                           near_form(unique, beyond), detector._at["proximities"])
            found: Proximities = copy_records(detector._lists["proximities"], "proximity").view(Proximities)
            return found

    def _empty(self) -> Array:
        return np.empty((self.detector.mesh.vertex_count, 3), np.float32 if self._single else np.float64)
