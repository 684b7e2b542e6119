"""Options, numbers and callbacks that do not fit raise a Python exception, and the object goes on being right."""

from __future__ import annotations

import gc
from typing import Any, Callable, Dict, List

import numpy as np
import pytest

import cscd
import oracle

V = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 1], [1, 1, 3], [3, 3, 3]], np.float64)
DOWN = V + np.array([[0, 0, 0]] * 3 + [[0, 0, -2]] * 3)
F = np.array([[0, 1, 2], [3, 4, 5]])

WRONG_OPTIONS: Dict[str, List[Any]] = {
    "method": ["fast", "", None, 1, b"auto", "auto\0", "kmeans", "charge"],
    "mode": ["some", None, 0], "start": ["proven", None, 0], "volume": ["ball", None], "simd": ["mmx", None, 2],
    "threads": [-1, 257, 2**40, 1.5, "two", None, [1], True, np.True_],
    "min_separation": [-1e-3, np.nan, np.inf, "near", None, [1.0], 1j, np.complex128(1 + 2j), np.True_],
    "tolerance": [-1.0, np.nan, 2.0, "fine", None], "step_factor": [0.0, -1.0, 1.5, np.nan, None],
    "floor_ratio": [0.0, 1.0, np.nan, -0.5, "half"], "seam_reach": [-1.0, np.nan, "far"],
    "longest_list": [-1, 2**70, "long", None, 1.5], "coherence": ["on", None, 1, True],
    "seams": [[[0, 6]], [[0, -1]], [[0, 1, 2]], [0, 1], [[0.5, 1]], "seam", [[0, 0]], 5, [[True, False]], [[None, 1]]],
    "ignored": [[[0, 2]], [[-1, 0]], [[0, 1, 1]], [0, 1], [[0.0, 1.0]], 7, "pair"],
    "rules": [[], [{}, {}], [{"mask": -1}], [{"self": "maybe", "colour": 3}], [{"thickness": -1.0}],
              [{"thickness": np.nan}], [{"category": 2**64}], [None], 3, "rules", [{"thickness_class": -1}], [[1, 2]]],
    "thickness_matrix": [[[0.1, 0.2], [0.3, 0.1]], [[0.1, 0.2]], [0.1], [[np.nan]], [[-1.0]], "thick", 0.1, [["a"]]],
    "ignore": [1, "function", []], "progress": [1, "function", {}],
    "plan": [1, "plan", F, {}], "speed": [3],
}


def test_options() -> None:
    """Every option of a detector with values of other types and out of range."""
    mesh = cscd.Mesh(F)
    for name, values in WRONG_OPTIONS.items():
        for value in values:
            with pytest.raises((ValueError, TypeError)) as caught:
                cscd.Detector(mesh, **{name: value})
            assert len(str(caught.value)) > 15, (name, value, str(caught.value))


def test_plans() -> None:
    """A plan of another mesh, of a method that has none, and with numbers out of range."""
    scene = oracle.make_scene("noisy sphere", 1)
    mesh = cscd.Mesh(scene.F)
    plan = cscd.Plan.kmeans(mesh, scene.x0, k=2)
    with pytest.raises(ValueError):
        cscd.Detector(F, plan=plan)
    for k in (0, -1, 2**40, 1.5, "two", None):
        with pytest.raises(ValueError):
            cscd.Plan.kmeans(mesh, scene.x0, k=k)  # type: ignore[arg-type]
    regions, points = plan.triangle_regions, plan.detector_points
    for wrong in (regions[:-1], regions + 7, regions.astype(float) + 0.5, "regions"):
        with pytest.raises(ValueError):
            cscd.Plan.from_parts(mesh, scene.x0, wrong, points, method="kmeans")
    for wrong in (points[:, :2], points * np.nan, points[:1], "points"):
        with pytest.raises(ValueError):
            cscd.Plan.from_parts(mesh, scene.x0, regions, wrong, method="kmeans")


def test_numbers() -> None:
    """Distances, fractions and kinds."""
    detector = cscd.Detector(F)
    line = detector.line_search(V, DOWN, reach=0.5)
    calls: List[Callable[[], Any]] = []
    for distance in (-1.0, 0.0, np.nan, "far", None, [1.0, 2.0]):
        calls += [lambda d=distance: detector.near(V, d), lambda d=distance: detector.bounds(V, d),
                  lambda d=distance: detector.truncate(V, DOWN, d), lambda d=distance: line.near(0.5, d)]
    for fraction in (-0.1, 1.1, np.nan, "half", None):
        calls += [lambda f=fraction: line.positions(f), lambda f=fraction: line.near(f, 0.1),
                  lambda f=fraction: line.max_step(f)]
    for kinds in ("cross", [], ["crossing", "deep"], 5, [0], [None], b"crossing"):
        calls += [lambda k=kinds: detector.find_intersections(V, k), lambda k=kinds: detector.is_intersecting(V, k),
                  lambda k=kinds: cscd.self_intersections(V, F, k), lambda k=kinds: cscd.self_intersecting_faces([V], F, k)]
    for count in (-1, 1.5, "one", None, 2**70):
        calls.append(lambda c=count: detector.find_intersections(V, stop_after=c))
    calls += [lambda: line.near(0.5, 0.6), lambda: line.max_step(0.0), lambda: detector.line_search(V, DOWN, -1.0),
              lambda: detector.line_search(V, DOWN, np.nan), lambda: detector.set_separation(-1.0),
              lambda: detector.set_separation(np.nan), lambda: detector.set_parts([0]), lambda: detector.set_parts([0, -2]),
              lambda: detector.set_parts([0, 3], 2), lambda: detector.set_parts([0, 1], 2.5),  # type: ignore[arg-type]
              lambda: detector.set_parts([0, 1], 2**40), lambda: detector.set_parts([0, 1], -5),
              lambda: detector.set_parts([0.0, 1.0]), lambda: detector.set_bodies([0]), lambda: detector.set_bodies([0, 3], 2),
              lambda: detector.set_active([6]), lambda: detector.set_active([-1]), lambda: detector.set_active([0.5]),
              lambda: detector.set_seams([[0, 9]]), lambda: detector.set_ignored([[0, 9]])]
    for out in (V[:, :2].copy(), V[:-1].copy(), V.astype(int), np.asfortranarray(V.copy()), V.tolist(), "out",
                np.broadcast_to(V[:1], V.shape)):
        calls += [lambda o=out: detector.max_step(V, DOWN, out=o), lambda o=out: detector.truncate(V, DOWN, 0.5, out=o),
                  lambda o=out: detector.make_safe(V, DOWN, out=o)]
    for numbers in (-1.0, [1.0], [np.nan] * len(V), [np.inf] * len(V), "heavy", [0.0] * len(V)):
        calls += [lambda n=numbers: detector.make_safe(V, DOWN, inverse_masses=n)]
    calls += [lambda: detector.make_safe(V, DOWN, friction=-0.1), lambda: detector.make_safe(V, DOWN, friction=[0.1, 0.2])]
    for call in calls:
        with pytest.raises((ValueError, TypeError)) as caught:
            call()
        assert len(str(caught.value)) > 10 and "cscd_" not in str(caught.value), str(caught.value)
    for index in (-1, 2, 2**40):
        with pytest.raises(IndexError):
            detector.mesh.component(index)
        with pytest.raises(IndexError):
            detector.guarantee(index)
    assert detector.step(V, DOWN).toi.tolist() == [0.5, 1.0, 1.0] or len(detector.step(V, DOWN)) > 0


def test_scenes() -> None:
    """Objects of a scene, and positions by object."""
    mesh = cscd.Mesh(F)
    for objects in ([], [mesh, None], [mesh, F], [cscd.Scene([mesh, mesh])], 5, "objects", None):
        with pytest.raises((ValueError, TypeError)):
            cscd.Scene(objects)  # type: ignore[arg-type]
    for obstacles in ([2], [-1], ["floor"], 1, [0.5]):
        with pytest.raises((ValueError, TypeError)):
            cscd.Scene([mesh, mesh], obstacles=obstacles)  # type: ignore[arg-type]
    for make in (lambda: cscd.Wires([[0, 1, 2]]), lambda: cscd.Wires([[0, -1]]), lambda: cscd.Wires([[0, 5]], 3),
                 lambda: cscd.Wires([[0.0, 1.0]]), lambda: cscd.Points(-1), lambda: cscd.Points(1.5),
                 lambda: cscd.Points("many"), lambda: cscd.HalfSpace([0, 0]), lambda: cscd.HalfSpace("up"),
                 lambda: cscd.Scene([mesh, cscd.HalfSpace([0, 0, 0])]),
                 lambda: cscd.Scene([mesh, cscd.HalfSpace([0, np.nan, 1])]),
                 lambda: cscd.Scene([mesh, cscd.Points(2**31), cscd.Points(2**31)])):
        with pytest.raises(ValueError):
            make()
    detector = cscd.Detector(cscd.Scene([mesh, mesh]))
    for x in ([V, V[:-1]], [V], [V, V, V], [V, None], [V, V * np.nan], V, (V, V[:, :2])):
        with pytest.raises(ValueError):
            detector.check(x)
    assert len(detector.check([V, V + [0.0, 0.0, 0.5]])) >= 0
    one = cscd.Detector(cscd.Scene([mesh]))
    assert np.array_equal(one.step([V], (DOWN,)), one.step(V, DOWN)), "a list with an array for each object, of one object"


# ---- callbacks --------------------------------------------------------------------------------------------------------


class Oops(Exception):
    """What a callback raises."""


@pytest.fixture(scope="module")
def large() -> Any:
    """A sheet over a sheet, whose check takes some hundred milliseconds."""
    n = 220
    grid = np.stack(np.meshgrid(np.arange(n), np.arange(n), indexing="ij"), -1).reshape(-1, 2)
    corner = np.arange(n * n).reshape(n, n)
    faces = np.concatenate([np.stack([corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:]], -1).reshape(-1, 3),
                            np.stack([corner[:-1, :-1], corner[1:, 1:], corner[:-1, 1:]], -1).reshape(-1, 3)])
    random = np.random.default_rng(1)
    x = np.concatenate([np.column_stack([grid, random.uniform(-1, 1, len(grid))]) for _ in range(2)])
    return x, np.concatenate([faces, faces + n * n])


def test_progress_that_raises(large: Any) -> None:
    """The call ends, and raises the same exception; the next call is right."""
    x, faces = large
    seen: List[Any] = []
    fail_at = 3

    def progress(stage: str, fraction: float) -> None:
        seen.append((stage, fraction))
        if len(seen) == fail_at:
            raise Oops("no more")

    detector = cscd.Detector(faces, progress=progress)
    for call in (lambda: detector.check(x), lambda: detector.step(x, x[::-1].copy()), lambda: detector.near(x, 0.5),
                 lambda: detector.find_intersections(x)):
        seen.clear()
        with pytest.raises(Oops, match="no more"):
            call()
        assert len(seen) == fail_at
    fail_at = 0
    seen.clear()
    truth = cscd.Detector(faces).check(x)
    assert np.array_equal(detector.check(x), truth) and len(truth) > 10**5
    assert len(seen) > 3 and all(isinstance(stage, str) and 0.0 <= fraction <= 1.0 for stage, fraction in seen)
    with pytest.raises(Oops):
        fail_at = 2
        seen.clear()
        cscd.self_intersections(x, faces, progress=progress)


def test_progress_that_calls_its_detector(large: Any) -> None:
    """A call from its own callback is refused, with a sentence; other objects may be asked there."""
    x, faces = large
    refused: List[str] = []
    others: List[int] = []

    def progress(stage: str, fraction: float) -> None:
        for call in (lambda: detector.check(x), lambda: detector.live_bytes and detector.counters,
                     lambda: detector.near(x, 0.1), lambda: detector.set_seams(None)):
            try:
                call()
            except cscd.Error as problem:
                refused.append(str(problem))
        others.append(len(cscd.self_intersections(V, F)))

    detector = cscd.Detector(faces, progress=progress)
    truth = cscd.Detector(faces).check(x)
    assert np.array_equal(detector.check(x), truth)
    assert len(others) > 2 and len(refused) == 3 * len(others) and set(others) == {0}
    assert all("callback" in sentence for sentence in refused)
    assert np.array_equal(detector.check(x), truth)


def test_progress_that_lets_go_of_its_detector(large: Any) -> None:
    """The detector lives until its call returns, though nobody holds it any more."""
    x, faces = large
    held = {}

    def progress(stage: str, fraction: float) -> None:
        held.clear()
        gc.collect()

    held["detector"] = cscd.Detector(faces, progress=progress)
    assert len(held["detector"].check(x)) > 10**5 and not held


def test_ignore() -> None:
    """What it leaves out; what it raises; and answers that are no truth values."""
    class Undecided:
        def __bool__(self) -> bool:
            raise Oops("neither")

    scene = oracle.make_scene("soup", 4)
    mesh = cscd.Mesh(scene.F, len(scene.x0))
    names, _ = oracle.contacts(*scene)
    asked: List[Any] = []

    def ignore(kind: str, a: int, b: int) -> bool:
        asked.append((cscd.CONTACT_KINDS.index(kind), a, b))
        return (a + b) % 3 == 0

    found = cscd.Detector(mesh, ignore=ignore).step(scene.x0, scene.x1)
    kept = names[(names[:, 1] + names[:, 2]) % 3 != 0]
    assert np.array_equal(np.column_stack([found.kind, found.a, found.b]), kept) and 0 < len(kept) < len(names)
    assert sorted(set(asked)) == sorted(map(tuple, names.tolist()))

    answers: Dict[str, Any] = {"value": False}

    def answer(*_: Any) -> Any:
        if answers["value"] is Oops:
            raise Oops("cannot say")
        return answers["value"]

    detector = cscd.Detector(mesh, ignore=answer)
    for value in (Oops, Undecided(), np.array([True, False])):
        answers["value"] = value
        for call in (lambda: detector.step(scene.x0, scene.x1), lambda: detector.near(scene.x0, 0.3)):
            with pytest.raises((Oops, ValueError)):
                call()
    answers["value"] = None
    assert len(detector.step(scene.x0, scene.x1)) == len(names)
    answers["value"] = "all"
    assert len(detector.step(scene.x0, scene.x1)) == 0
    takes_none: Any = lambda: False  # noqa: E731
    with pytest.raises(TypeError):
        cscd.Detector(mesh, ignore=takes_none).step(scene.x0, scene.x1)


def test_lists_that_are_too_long() -> None:
    """longest_list bounds them; the exception counts what there would be, and the next call is right."""
    scene = oracle.make_scene("soup", 4)
    names, _ = oracle.contacts(*scene)
    detector = cscd.Detector(cscd.Mesh(scene.F, len(scene.x0)), longest_list=len(names) - 1)
    with pytest.raises(cscd.ListTooLong) as caught:
        detector.step(scene.x0, scene.x1)
    assert caught.value.count == len(names)
    assert len(detector.step(scene.x0, scene.x0 + 1e-9)) < len(names)


def test_objects_that_were_not_made() -> None:
    """Objects whose __init__ did not run or has failed raise, and are let go of."""
    uses: Dict[Any, List[Callable[[Any], Any]]] = {
        cscd.Detector: [lambda d: d.step(V, V), lambda d: d.check(V), lambda d: d.counters, lambda d: d.cancel()],
        cscd.Mesh: [lambda m: m.edges, lambda m: m.component(0), lambda m: cscd.Detector(m)],
        cscd.Plan: [lambda p: p.region_count, lambda p: cscd.Detector(F, plan=p)],
        cscd.LineSearch: [lambda s: s.positions(0.5), lambda s: s.max_step()],
        cscd.Intersections: [lambda i: i.pairs, lambda i: i.curves]}
    for cls, calls in uses.items():
        thing = cls.__new__(cls)
        for call in calls:
            with pytest.raises(AttributeError):
                call(thing)
        del thing
    for arguments in ((), (F, F, F), ("faces",)):
        with pytest.raises((TypeError, ValueError)):
            cscd.Detector(*arguments)
    gc.collect()
