"""Arrays that do not fit raise ValueError with what was expected and found, before anything has changed."""

from __future__ import annotations

import contextlib
import copy
import pickle
import re
from typing import Any, Callable, Dict, List, Tuple

import numpy as np
import pytest

import cscd

V = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [3, 3, 1]], np.float64)
F = np.array([[0, 1, 2], [3, 4, 5]])
MESH = cscd.Mesh(F)


class Refuses:
    """An object that numpy asks for its array, and that fails."""

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise RuntimeError("no array here")


def spoiled(value: float, scalar: Any = np.float64) -> Any:
    array = V.astype(scalar)
    array[4, 1] = value
    return array


WRONG_POSITIONS: Dict[str, Any] = {
    "two columns": V[:, :2], "four columns": np.hstack([V, V[:, :1]]), "flat": V.ravel(), "one number": 3.5,
    "three axes": V[None], "transposed": V.T, "too few": V[:-1], "too many": np.vstack([V, V]), "empty": V[:0],
    "objects": V.astype(object), "complex": V.astype(complex), "text": V.astype(str), "words": "positions",
    "truth values": V > 0, "None": None, "dates": V.astype("datetime64[s]"), "long doubles": V.astype(np.longdouble),
    "records": np.zeros(6, [("x", "f8"), ("y", "f8"), ("z", "f8")]), "ragged": [[0, 0, 0], [1, 2], [1], [2], [3], [4]],
    "mixed": [[0, 0, 0], [1, 2, "three"]] + V[2:].tolist(), "a dict": {0: 1}, "a function": len, "refuses": Refuses(),
    "NaN": spoiled(np.nan), "NaN as float": spoiled(np.nan, np.float32), "infinite": spoiled(np.inf),
    "infinite as float": spoiled(-np.inf, np.float32), "infinite half": spoiled(np.inf, np.float16),
    "too large": spoiled(1e308), "no exact double": (V + 2.0**60).astype(np.int64) + 1,
}

WRONG_FACES: Dict[str, Any] = {
    "two columns": F[:, :2], "five columns": np.zeros((2, 5), int), "flat": F.ravel(), "one number": 7,
    "three axes": F[None], "floats": F.astype(float), "truth values": F > 0, "objects": F.astype(object),
    "text": F.astype(str), "None": None, "ragged": [[0, 1, 2], [3, 4]], "negative": F - 1, "least": F - 2**63,
    "out of range": F + 1, "far out of range": F + 2**40, "no vertex": F + (2**32 - 6), "unsigned": F.astype(np.uint64) + 2**63,
    "refuses": Refuses(), "words": "faces", "complex": F.astype(complex),
}

# What a sentence says: what was expected and what is there, or which number is wrong.
SAYS = re.compile(r"expected .*(got|but)|got .*expected|is [-\d]+; expected|vertex 4|coordinate|finite|none of", re.S)

Call = Callable[[Any], Any]


def calls_with_positions() -> List[Tuple[str, str, Call]]:
    """Calls, the name of their argument, and how it is put in."""
    detector = cscd.Detector(MESH)
    line = detector.line_search
    return [
        ("self_intersections", "V", lambda x: cscd.self_intersections(x, MESH)),
        ("is_self_intersecting", "V", lambda x: cscd.is_self_intersecting(x, MESH)),
        ("self_intersecting_faces", "frames", lambda x: cscd.self_intersecting_faces([V, x], MESH)),
        ("self_intersecting_faces on threads", "frames",
         lambda x: cscd.self_intersecting_faces([V, V, x], MESH, threads=2)),
        ("intersections 1", "V1", lambda x: cscd.intersections(x, MESH, V, F)),
        ("intersections 2", "V2", lambda x: cscd.intersections(V, F, x, MESH)),
        ("contacts 0", "x0", lambda x: cscd.contacts(x, V, MESH)),
        ("contacts 1", "x1", lambda x: cscd.contacts(V, x, MESH)),
        ("step 0", "x0", lambda x: detector.step(x, V)),
        ("step 1", "x1", lambda x: detector.step(V, x)),
        ("check", "x", detector.check),
        ("find_intersections", "x", detector.find_intersections),
        ("is_intersecting", "x", detector.is_intersecting),
        ("near", "x", lambda x: detector.near(x, 0.1)),
        ("max_step 0", "x0", lambda x: detector.max_step(x, V)),
        ("max_step 1", "x1", lambda x: detector.max_step(V, x)),
        ("bounds", "x", lambda x: detector.bounds(x, 0.1)),
        ("truncate 0", "x0", lambda x: detector.truncate(x, V, 0.1)),
        ("truncate 1", "x1", lambda x: detector.truncate(V, x, 0.1)),
        ("make_safe 0", "x0", lambda x: detector.make_safe(x, V)),
        ("make_safe 1", "x1", lambda x: detector.make_safe(V, x)),
        ("line_search 0", "x0", lambda x: line(x, V)),
        ("line_search 1", "x1", lambda x: line(V, x)),
        ("set_rest", "rest", lambda x: detector.set_rest("None" if x is None else x)),
        ("Plan.kmeans", "V", lambda x: cscd.Plan.kmeans(MESH, x, k=1)),
    ]


def test_positions() -> None:
    """Every call with every wrong array; the sentence names the argument."""
    for call, name, function in calls_with_positions():
        with contextlib.suppress(cscd.InContact):
            function(V)
        for wrong, x in WRONG_POSITIONS.items():
            with pytest.raises(ValueError) as caught:
                function(x)
            text = str(caught.value)
            assert SAYS.search(text), (call, wrong, text)
            if "NaN" not in wrong and "infinite" not in wrong and wrong != "too large":
                assert text.startswith(name), (call, wrong, text)


def test_faces() -> None:
    """Every call that takes faces."""
    calls: List[Tuple[str, Call]] = [
        ("F", lambda faces: cscd.self_intersections(V, faces)),
        ("F", lambda faces: cscd.is_self_intersecting(V, faces)),
        ("F", lambda faces: cscd.self_intersecting_faces(V[None], faces)),
        ("F", lambda faces: cscd.contacts(V, V, faces)),
        ("F", lambda faces: cscd.intersections(V, faces, V, F)),
        ("F", lambda faces: cscd.intersections(V, F, V, faces)),
        ("F", lambda faces: cscd.Mesh(faces, 6)),
        ("F", lambda faces: cscd.Mesh(faces, positions=V)),
    ]
    for name, function in calls:
        function(F)
        for wrong, faces in WRONG_FACES.items():
            with pytest.raises(ValueError) as caught:
                function(faces)
            text = str(caught.value)
            assert SAYS.search(text) and text.startswith(name), (wrong, text)


def test_arrays_that_change_later() -> None:
    """A mesh never changes, whatever its caller does with the array of its faces, and cannot be changed."""
    faces, edges = np.array(F, np.uint32), np.array([[0, 1]], np.uint32)
    mesh, wires = cscd.Mesh(faces), cscd.Wires(edges)
    faces[:] = edges[:] = 9
    assert wires.edges.tolist() == [[0, 1]]
    for copied in (copy.deepcopy(mesh), pickle.loads(pickle.dumps(mesh)), cscd.Scene([mesh])):
        assert np.array_equal(copied.triangles, F)
    for array in (mesh.triangles, mesh.triangle_face, mesh.edges):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_what_a_sentence_says() -> None:
    """The place of a wrong index or number, and how many there may be."""
    nan = spoiled(np.nan)
    for named, calls in {"V": [lambda: cscd.self_intersections(nan, [[0, 1, 2, 4]]), lambda: cscd.Plan.kmeans(MESH, nan)],
                         "x0": [lambda: cscd.contacts(nan, V, [[0, 1, 2, 4]])],
                         "x": [lambda: cscd.pairs_near("vf", nan, [[0, 1, 2, 4]])],
                         "positions": [lambda: cscd.Mesh([[0, 1, 2, 4]], positions=nan),
                                       lambda: cscd.Mesh.from_polygons(nan, [0, 1, 2, 4], [4])]}.items():
        for call in calls:
            with pytest.raises(ValueError, match=f"^{named}: vertex 4 has y = nan, expected"):
                call()
    with pytest.raises(ValueError, match="^mesh: expected a Mesh, got ndarray"):
        cscd.Plan.kmeans(F, V)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"F\[0, 0\] is 0, but there are no vertices"):
        cscd.self_intersections([], [[0, 1, 2]])
    with pytest.raises(ValueError, match=r"got the whole number -9223372036854775808, beyond 2\^53"):
        cscd.self_intersections(np.full((6, 3), -2**63), MESH)
    with pytest.raises(ValueError, match=r"F\[1, 2\] is 6; expected an index from 0 to 5, of 6 vertices"):
        cscd.self_intersections(V, [[0, 1, 2], [3, 4, 6]])
    with pytest.raises(ValueError, match=r"F\[0, 1\] is -1; expected"):
        cscd.Mesh([[0, -1, 2]])
    with pytest.raises(ValueError, match=r"x: expected an array \(6, 3\) of float32 or float64, got shape \(6, 2\) of"):
        cscd.Detector(MESH).check(V[:, :2])
    for call in (lambda x: cscd.self_intersections(x, MESH), lambda x: cscd.contacts(V, x, MESH)):
        with pytest.raises(ValueError, match="vertex 4"):
            call(spoiled(np.nan))


def test_polygons() -> None:
    """Faces of any number of corners: indices, counts, and their sum."""
    mesh = cscd.Mesh.from_polygons(V, [0, 1, 2, 3, 4, 5], [3, 3])
    assert mesh.face_count == 2
    for corners, counts in (([0, 1, 2], [4]), ([0, 1, 2], [2]), ([0, 1, 6], [3]), ([0, 1, -1], [3]), ([0.5, 1, 2], [3]),
                            ([[0, 1, 2]], [3]), ([0, 1, 2], [[3]]), ([0, 1, 2], [3.0]), ([0, 1, 2], [-3]),
                            ([0, 1, 2], [2**32 + 3]), (None, [3]), ([0, 1, 2], None), ([0, 1, 2], ["three"]),
                            ([True, False, True], [3]), ([0, 1, 2], [2**62, 2**62])):
        with pytest.raises(ValueError):
            cscd.Mesh.from_polygons(V, corners, counts)
    for x in ("NaN", "flat", "infinite", "objects"):
        with pytest.raises(ValueError):
            cscd.Mesh.from_polygons(WRONG_POSITIONS[x], [0, 1, 4, 2], [4])


def test_single_pairs() -> None:
    """Points, their indices, and the kind of pairs."""
    x = V[:4]
    for kind, x0, x1, points in (("vv", x, x, None), (0, x, x, None), (None, x, x, None), ("vf", x[:3], x[:3], None),
                                 ("vf", x, x[:3], None), ("ee", x, x, [[0, 1, 2]]), ("ee", x, x, [[0, 1, 2, 4]]),
                                 ("ee", x, x, [[0, 1, 2, -1]]), ("vf", x, x, [[0.5, 1, 2, 3]]), ("vf", x, x, [0, 1, 2, 3]),
                                 ("vf", spoiled(np.nan), V, [[0, 1, 2, 4]]), ("vf", x[:, :2], x, None),
                                 ("vf", x, "text", None), ("vf", None, x, None)):
        with pytest.raises(ValueError):
            cscd.pairs_step(kind, x0, x1, points)  # type: ignore[arg-type]
    for distance in (-1.0, 0.0, np.nan):
        with pytest.raises(ValueError):
            cscd.pairs_near("vf", x, distance=distance)


def test_nothing() -> None:
    """Empty meshes and no frames are answered, not refused."""
    none, faces = np.empty((0, 3)), np.empty((0, 3), int)
    for x, triangles in ((none, faces), (V, faces), (none, []), ([], []), (V, np.empty((0, 4), int))):
        found = cscd.self_intersections(x, triangles)
        assert len(found) == 0 and not found and found.pairs.shape == (0, 2) and found.kind_names() == []
        assert not cscd.is_self_intersecting(x, triangles)
        assert cscd.contacts(x, x, triangles).shape == (0,)
        assert len(cscd.intersections(x, triangles, V, F)) == len(cscd.intersections(V, F, x, triangles)) == 0
        assert cscd.self_intersecting_faces([x, x], triangles).shape == (2, 0)
        assert len(found.curves) == 0 and found.depth.shape == found.buried.shape == (len(x),)
    assert cscd.self_intersecting_faces(np.empty((0, 6, 3)), F).shape == (0, 2)
    assert cscd.self_intersecting_faces([], F).shape == (0, 2)
    assert len(cscd.Detector(MESH).near(V + V[::-1] * 100, 1e-9)) == 0
    assert cscd.pairs_step("vf", none, none).shape == (0,)
    with pytest.raises(ValueError):
        cscd.self_intersections(none, F)


def test_nothing_has_changed() -> None:
    """After every refused call a detector has the same answers and holds the same memory."""
    detector = cscd.Detector(MESH)
    x1 = V + [[0, 0, 0], [0, 0, 2], [0, 0, 3]] * 2
    step, check, near = detector.step(V, x1), detector.check(V), detector.near(V, 2.0)
    assert len(check) == 1 and len(near) > 3
    calls: List[Call] = [lambda x: detector.step(V, x), lambda x: detector.step(x, V), detector.check,
                         lambda x: detector.near(x, 1.0), lambda x: detector.bounds(x, 1.0),
                         lambda x: detector.max_step(V, x)]
    for call in calls:
        for x in (V, V.astype(np.float32)):  # floats have buffers of their own
            with contextlib.suppress(cscd.InContact):
                call(x)
    held = detector.live_bytes
    for x in WRONG_POSITIONS.values():
        for call in calls:
            with pytest.raises(ValueError):
                call(x)
    assert detector.live_bytes == held
    assert np.array_equal(detector.step(V, x1), step)
    assert np.array_equal(detector.check(V), check) and np.array_equal(detector.near(V, 2.0), near)
