"""The cost of a call from Python over the same call of the C layer: cost.py [ROUNDS].

The C layer is called with everything prepared, so that its time lacks the reading of arrays and the copying of results;
it has the microsecond of ctypes, which the last row shows. Both take turns; a cell is the least of all rounds.
"""

from __future__ import annotations

import sys
import time
from typing import Any, Callable, List, Tuple

import numpy as np

import cscd
from cscd._arrays import views_of
from cscd._host import Host
from cscd._library import address_of, library, new_struct
from cscd.pairs import _pairs_of

Call = Callable[[], Any]


def sheets(rows: int, columns: int, layers: int, roughness: float) -> Tuple[Any, Any]:
    """Sheets of ``2 * rows * columns`` triangles each, a tenth above each other, and how rough they are."""
    corner = np.arange((rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
    faces = np.concatenate([np.stack([corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:]], -1).reshape(-1, 3),
                            np.stack([corner[:-1, :-1], corner[1:, 1:], corner[:-1, 1:]], -1).reshape(-1, 3)])
    grid = np.stack(np.meshgrid(np.arange(rows + 1.0), np.arange(columns + 1.0), indexing="ij"), -1).reshape(-1, 2)
    random = np.random.default_rng(1)
    height = [0.1 * layer + random.uniform(-roughness, roughness, len(grid)) for layer in range(layers)]
    return (np.concatenate([np.column_stack([grid, z]) for z in height]),
            np.concatenate([faces + layer * corner.size for layer in range(layers)]))


def of_detector(detector: Any, function: Any, result: str, *positions: Any) -> Call:
    """A call of the C layer, with views that are prepared."""
    views = [detector._views("x", x) for x in positions]
    addresses = [address_of(view) for view, kept in views]
    host, pointer, out = detector._host.handle, detector._detector, detector._at[result]
    if result == "proximities":
        return lambda: (function(host, pointer, *addresses, 0.12, 0, out), views)
    if result == "intersections":
        return lambda: (function(host, pointer, *addresses, None, out), views)
    return lambda: (function(host, pointer, *addresses, out), views)


def of_pairs(x0: Any, x1: Any, points: Any) -> Call:
    """The same of single pairs, in a host that is there already."""
    pairs, indices = _pairs_of("vf", len(x0), points)
    views = [views_of("x", x, [len(x)]) for x in (x0, x1)]
    host, found = Host(), new_struct("pair_contact", len(points))
    addresses = [address_of(pairs), *(address_of(view) for view, kept in views), 0.0, 0.0, address_of(found)]
    return lambda: (library.cscdpy_pairs_step(host.handle, *addresses), views, indices, found, pairs)


def rows() -> List[Tuple[str, int, Call, Call]]:
    """A measurement: its name, the number of calls in a round, in Python and in C."""
    x, faces = sheets(50, 25, 2, 0.03)
    end = x + np.random.default_rng(2).normal(0.0, 0.02, x.shape)
    detector = cscd.Detector(faces)
    rough, many = sheets(50, 25, 2, 1.0)
    crossing = cscd.Detector(many)
    turned = rough * [1.0, 1.0, -1.0]
    vertices = np.random.default_rng(3).permuted(np.tile(np.arange(len(x)), (10_000, 1)), axis=1)[:, :4].copy()
    check, step, near = (library.cscdpy_detector_find_intersections, library.cscdpy_detector_step,
                         library.cscdpy_detector_find_near)
    size = f"{len(faces):,} triangles"
    host = detector._host.handle
    pair = cscd.Detector(faces[:2])
    corners = np.ascontiguousarray(x[: int(faces[:2].max()) + 1])
    return [
        (f"check, 2 triangles, {len(pair.check(corners))} pairs", 500, lambda: pair.check(corners),
         of_detector(pair, check, "intersections", corners)),
        (f"check, {size}, {len(detector.check(x))} pairs", 20, lambda: detector.check(x),
         of_detector(detector, check, "intersections", x)),
        (f"step, {size}, {len(detector.step(x, end)):,} contacts", 10, lambda: detector.step(x, end),
         of_detector(detector, step, "contacts", x, end)),
        (f"near, {size}, {len(detector.near(x, 0.12)):,} pairs", 5, lambda: detector.near(x, 0.12),
         of_detector(detector, near, "proximities", x)),
        (f"check, {size}, {len(crossing.check(rough)):,} pairs", 5, lambda: crossing.check(rough),
         of_detector(crossing, check, "intersections", rough)),
        (f"step, {size}, {len(crossing.step(rough, turned)):,} contacts", 2, lambda: crossing.step(rough, turned),
         of_detector(crossing, step, "contacts", rough, turned)),
        ("10,000 single pairs", 5, lambda: cscd.pairs_step("vf", x, end, vertices), of_pairs(x, end, vertices)),
        ("ctypes alone, beside nothing", 2000, lambda: library.cscdpy_host_is_busy(host), lambda: None),
    ]


def time_of(call: Call, count: int) -> float:
    """Microseconds of one call, the mean of this number."""
    begin = time.perf_counter()
    for _ in range(count):
        call()
    return 1e6 * (time.perf_counter() - begin) / count


def main(rounds: int = 31) -> None:
    """Prints a table."""
    print("| call | C, µs | Python, µs | more, µs | more, % |\n| --- | ---: | ---: | ---: | ---: |")
    for name, count, python, c in rows():
        pairs = [(time_of(c, count), time_of(python, count)) for _ in range(rounds)]
        in_c, in_python = (min(column) for column in zip(*pairs))
        more = in_python - in_c
        print(f"| {name} | {in_c:,.1f} | {in_python:,.1f} | {more:,.1f} | {100.0 * more / in_c:.1f} |")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
