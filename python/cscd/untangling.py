"""Meshes and recordings without intersections: ``untangle``, ``untangle_frames``."""

from __future__ import annotations

from typing import Any, Iterable, Iterator, Optional

from ._arrays import as_positions
from .detector import Detector
from .questions import Progress, mesh_of
from .results import Untangled


def untangle(V: Any, F: Any, *, gap: float = 0.0, threads: int = 1, progress: Progress = None, weights: Any = None,
             start: Any = None, spread: float = 0.0, rest: Any = None, bending: float = 0.0, max_seconds: float = float("inf"),
             **options: Any) -> Untangled:
    """Positions near ``V`` at which no two triangles intersect, with the same faces; never worse than ``V``.

    Parameters
    ----------
    V : (n, 3) float32 or float64
    F : (m, 3) or (m, 4) integers, or Mesh
    gap : float
        The distance that surfaces keep in the result.
    threads : int
        0: one per processor.
    progress : function (stage, fraction), optional
        If it raises or the call is interrupted, the best so far is lost; ``max_seconds`` keeps it.
    weights, start, spread, rest, bending, max_seconds
        Those of ``Detector.untangle``.
    options
        Further ones of ``Detector``, as ``seams`` and ``ignored``.

    Two boxes, one of which sticks in the other:

    >>> corners = [[v & 1, v >> 1 & 1, v >> 2] for v in range(8)]
    >>> box = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
    ...        [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]
    >>> V = corners + [[0.5 * x + 0.9, 0.5 * y + 0.3, 0.5 * z + 0.2] for x, y, z in corners]
    >>> F = box + [[a + 8, b + 8, c + 8] for a, b, c in box]
    >>> result = untangle(V, F)
    >>> result.clean, result.pairs_before, result.pairs_after, result.displacement < 0.2
    (True, 10, 0, True)
    """
    positions = as_positions("V", V)
    detector = Detector(mesh_of(F, positions), threads=threads, progress=progress, min_separation=gap, **options)
    return detector.untangle(positions, weights=weights, start=start, spread=spread, rest=rest, bending=bending,
                             max_seconds=max_seconds)


def untangle_frames(frames: Iterable[Any], F: Any, *, gap: float = 0.0, steady: float = 0.0, threads: int = 1,
                    weights: Any = None, spread: float = 0.0, rest: Any = None, bending: float = 0.0,
                    max_seconds: float = float("inf"), **options: Any) -> Iterator[Untangled]:
    """Untangles the frames of a recording one after the other; each starts from the clean result of the one before.

    Parameters
    ----------
    frames : iterable of (n, 3)
    steady : float
        In [0, 1): how far the displacement of a frame goes on in the next one, against jitter.
    rest : (n, 3), optional
        The rest shape of all frames, as of ``Detector.untangle``.
    max_seconds : float
        For each frame.
    gap, threads, weights, spread, bending, options
        Those of ``untangle``.
    """
    detector: Optional[Detector] = None
    start = start_input = None
    for frame in frames:
        positions = as_positions("frame", frame)
        if detector is None:
            detector = Detector(mesh_of(F, positions), threads=threads, min_separation=gap, **options)
        result = detector.untangle(positions, start=start, start_input=start_input, steady=steady, weights=weights, spread=spread,
                                   rest=rest, bending=bending, max_seconds=max_seconds)
        if result.clean:
            start, start_input = result.vertices.copy(), positions.copy()
        yield result
