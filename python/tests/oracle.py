"""Brute force and scenes of the C tests (tests/python/oracle.c), and scenes on small grids, for the tests of the package."""

from __future__ import annotations

import ctypes
import os
from typing import Any, Iterator, List, NamedTuple, Sequence, Tuple

import numpy as np

Array = Any

SOURCES = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", ".."))
BUILD = os.path.join(SOURCES, os.environ.get("BUILD", "build/release"))
VERTICES_MAX, TRIANGLES_MAX = 1200, 2000


def _load() -> ctypes.CDLL:
    path = os.path.join(BUILD, "tests", "python", "oracle.so")
    if not os.path.exists(path):
        raise RuntimeError(f"{path} is missing; `make python-oracle` builds it")
    library = ctypes.CDLL(path)
    pointer, size = ctypes.c_void_p, ctypes.c_size_t
    for name, result, arguments in (
            ("families", ctypes.c_uint32, []),
            ("family_name", ctypes.c_char_p, [ctypes.c_uint32]),
            ("make", None, [ctypes.c_uint32, ctypes.c_uint64, pointer]),
            ("copy_scene", None, [pointer, pointer, pointer]),
            ("set", ctypes.c_bool, [ctypes.c_uint32, ctypes.c_uint32, pointer, pointer, pointer]),
            ("contacts", size, [ctypes.c_double, ctypes.c_double]),
            ("contacts_by_rules", size, [pointer, ctypes.c_uint32, pointer]),
            ("copy_contacts", None, [pointer, pointer]),
            ("kinds", size, [ctypes.c_bool]),
            ("copy_kinds", None, [pointer])):
        function = getattr(library, f"oracle_python_{name}")
        function.restype, function.argtypes = result, arguments
    return library


_oracle = _load()

#: Names of the families of scenes of the C tests.
FAMILIES: Tuple[str, ...] = tuple(_oracle.oracle_python_family_name(i).decode()
                                  for i in range(_oracle.oracle_python_families()))


class Scene(NamedTuple):
    """A mesh and its positions at both ends of an interval."""

    x0: Array
    x1: Array
    F: Array


def make_scene(family: str, seed: int) -> Scene:
    """A scene of the C tests: about a hundred to a thousand triangles, with contacts or without."""
    sizes = (ctypes.c_uint32 * 2)()
    _oracle.oracle_python_make(FAMILIES.index(family), seed, sizes)
    scene = Scene(np.empty((sizes[0], 3)), np.empty((sizes[0], 3)), np.empty((sizes[1], 3), np.uint32))
    _oracle.oracle_python_copy_scene(scene.x0.ctypes.data, scene.x1.ctypes.data, scene.F.ctypes.data)
    return scene


def make_grid_soup(seed: int, vertices: int = 30, triangles: int = 40, width: int = 4) -> Scene:
    """Triangles of any topology on a small grid: most pairs are degenerate. No triangle has one vertex twice."""
    random = np.random.default_rng(seed)
    x0 = random.integers(0, width, (vertices, 3)).astype(np.float64)
    x1 = random.integers(0, width, (vertices, 3)).astype(np.float64)
    F = np.array([random.choice(vertices, 3, replace=False) for _ in range(triangles)], np.uint32)
    for repeated in random.integers(0, triangles, triangles // 10):
        F[repeated] = np.roll(F[random.integers(0, triangles)], random.integers(0, 3))
    return Scene(x0, x1, F)


def _set_scene(x0: Array, x1: Array, F: Array) -> None:
    x0, x1 = np.ascontiguousarray(x0, np.float64), np.ascontiguousarray(x1, np.float64)
    F = np.ascontiguousarray(F, np.uint32)
    assert x0.shape == x1.shape and F.shape[1] == 3
    assert _oracle.oracle_python_set(len(x0), len(F), x0.ctypes.data, x1.ctypes.data, F.ctypes.data), "too large"


def _copy_contacts(count: int) -> Tuple[Array, Array]:
    names, toi = np.empty((count, 3), np.uint32), np.empty(count)
    _oracle.oracle_python_copy_contacts(names.ctypes.data, toi.ctypes.data)
    return names, toi


def contacts(x0: Array, x1: Array, F: Array, distance: float = 0.0, tolerance: float = 0.0) -> Tuple[Array, Array]:
    """Rows (kind, a, b) and times of all contacts, or of what comes within a distance, sorted by time, then by name."""
    _set_scene(x0, x1, F)
    return _copy_contacts(_oracle.oracle_python_contacts(distance, tolerance))


def near(x: Array, F: Array, distance: float) -> Array:
    """Rows (kind, a, b), sorted, of all features that are within a distance at one moment."""
    names, _ = contacts(x, x, F, distance, distance * 2.0**-21)
    return names[np.lexsort(names.T[::-1])]


def contacts_by_rules(x0: Array, x1: Array, F: Array, vertex_objects: Array, distances: Array) -> Tuple[Array, Array]:
    """The same for objects: their rows of `distances` are 0 for touching, and below 0 for what is not looked at."""
    _set_scene(x0, x1, F)
    vertex_objects = np.ascontiguousarray(vertex_objects, np.uint32)
    distances = np.ascontiguousarray(distances, np.float64)
    return _copy_contacts(_oracle.oracle_python_contacts_by_rules(vertex_objects.ctypes.data, len(distances),
                                                                  distances.ctypes.data))


def kinds(x: Array, F: Array) -> Array:
    """Rows (a, b, kind, shared vertices) of all pairs of triangles that intersect or touch, each decided by itself.

    Whole numbers up to 100 go to an oracle that has no code of the library.
    """
    integers = bool(np.all(np.abs(x) <= 100) and np.all(x == np.round(x)))
    _set_scene(x, x, F)
    rows = np.empty((_oracle.oracle_python_kinds(integers), 4), np.uint32)
    _oracle.oracle_python_copy_kinds(rows.ctypes.data)
    return rows


# ---- the same positions as callers may have them --------------------------------------------------------------------


def layouts(x: Array) -> Iterator[Tuple[str, Array]]:
    """Arrays of the same numbers with other strides."""
    n = len(x)
    yield "packed", np.ascontiguousarray(x)
    yield "Fortran", np.asfortranarray(x)
    around = np.nan if x.dtype.kind == "f" else 99
    wide = np.full((n, 7), around, x.dtype)
    wide[:, 2:5] = x
    yield "columns", wide[:, 2:5]
    spread = np.full((2 * n, 6), around, x.dtype)
    spread[::2, ::2] = x
    yield "spread", spread[::2, ::2]
    yield "backwards", np.ascontiguousarray(x[::-1])[::-1]
    yield "mirrored", np.ascontiguousarray(x[:, ::-1])[:, ::-1]
    unaligned = np.frombuffer(b"\0" + np.ascontiguousarray(x).tobytes(), np.uint8)[1:].view(x.dtype).reshape(n, 3)
    yield "unaligned", unaligned
    record = np.zeros(n, [("flag", "u1"), ("co", x.dtype, 3)])
    record["co"] = x
    yield "in a record", record["co"]
    frozen = np.array(x)
    frozen.flags.writeable = False
    yield "read-only", frozen
    yield "other byte order", x.astype(x.dtype.newbyteorder())


def joined(scenes: Sequence[Scene], shift: float = 0.4) -> Tuple[Scene, Array, List[Scene]]:
    """Scenes as objects of one, each moved to the side a little; and the object of each vertex."""
    x0: List[Array] = []
    x1: List[Array] = []
    F: List[Array] = []
    first, moved = 0, []
    for i, scene in enumerate(scenes):
        offset = shift * i * np.array([1.0, 0.3, 0.2])
        moved.append(Scene(scene.x0 + offset, scene.x1 - offset, scene.F))
        x0.append(moved[-1].x0)
        x1.append(moved[-1].x1)
        F.append(scene.F + np.uint32(first))
        first += len(scene.x0)
    objects = np.repeat(np.arange(len(scenes), dtype=np.uint32), [len(s.x0) for s in scenes])
    return Scene(np.concatenate(x0), np.concatenate(x1), np.concatenate(F)), objects, moved
