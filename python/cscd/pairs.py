"""Single pairs of features: the elementary tests of a step by themselves, in batches."""

from __future__ import annotations

from typing import Any, Tuple

import numpy as np

from ._arrays import as_indices, as_positions, check_magnitudes, number_of, views_of
from ._host import Host
from ._library import address_of, library, new_struct
from .results import CONTACT_KINDS, PairContacts, PairDistances

__all__ = ["pairs_near", "pairs_step"]

Array = Any


def _pairs_of(kind: str, point_count: int, points: Any) -> Tuple[Array, Array]:
    """The struct of the library, and the indices that it points to."""
    if kind not in ("vf", "ee"):
        raise ValueError(f"kind: expected 'vf' or 'ee', got {kind!r}")
    pairs = new_struct("pairs")
    pairs["kind"] = CONTACT_KINDS.index(kind)
    pairs["point_count"] = point_count
    if points is None:
        if point_count % 4:
            raise ValueError(f"points: expected four positions for each pair, got {point_count} positions in all")
        pairs["pair_count"] = point_count // 4
        return pairs, np.empty((0, 4), np.uint32)
    indices = as_indices("points", points, 4, point_count, "points")
    pairs["pair_count"] = len(indices)
    pairs["points"] = address_of(indices)
    return pairs, indices


def pairs_step(kind: str, x0: Any, x1: Any, points: Any = None, *, min_separation: float = 0.0, tolerance: float = 0.0,
               threads: int = 1) -> PairContacts:
    """Tests each pair for contact while its points move in straight lines from ``x0`` to ``x1``.

    Parameters
    ----------
    kind : str
        "vf": a vertex and the three corners of a triangle; "ee": the ends of one edge, then those of the other one.
    x0, x1 : (p, 3)
        Positions of points; ``x1`` None: they rest.
    points : (k, 4) integers, optional
        The points of each pair; by default pair i has the points 4 i to 4 i + 3.

    Results are those of a step on a mesh with just these features, bit for bit. toi is inf where there is no contact.

    >>> x0 = [[.2, .2, 1], [0, 0, 0], [1, 0, 0], [0, 1, 0]]
    >>> x1 = [[.2, .2, -1], [0, 0, 0], [1, 0, 0], [0, 1, 0]]
    >>> pairs_step("vf", x0, x1).toi.round(6).tolist()
    [0.5]
    """
    start = as_positions("x0", x0)
    end = None if x1 is None else as_positions("x1", x1, len(start))
    pairs, kept = _pairs_of(kind, len(start), points)
    found = new_struct("pair_contact", int(pairs["pair_count"][0]))
    if len(found):
        views0, kept0 = views_of("x0", start, [len(start)])
        views1, kept1 = (None, None) if end is None else views_of("x1", end, [len(start)])
        host = Host(threads)
        with host.lock:
            host.call(library.cscdpy_pairs_step, address_of(pairs), address_of(views0),
                      None if views1 is None else address_of(views1), number_of("min_separation", min_separation),
                      number_of("tolerance", tolerance),
                      address_of(found))
    return found.view(PairContacts)


def pairs_near(kind: str, x: Any, points: Any = None, *, distance: float = np.inf, threads: int = 1) -> PairDistances:
    """Measures the distance of each pair at rest, as far as ``distance``; parameters are those of ``pairs_step``.

    >>> pairs_near("ee", [[0, 0, 0], [2, 0, 0], [1, -1, 1], [1, 1, 1]]).distance.tolist()
    [1.0]
    """
    positions = as_positions("x", x)
    check_magnitudes("x", positions)
    pairs, kept = _pairs_of(kind, len(positions), points)
    found = new_struct("pair_distance", int(pairs["pair_count"][0]))
    if len(found):
        views, kept_positions = views_of("x", positions, [len(positions)])
        host = Host(threads)
        with host.lock:
            host.call(library.cscdpy_pairs_find_near, address_of(pairs), address_of(views),
                      number_of("distance", distance),
                      address_of(found))
    return found.view(PairDistances)
