"""Processes: every start method, pools over frames, and objects that go from one process to another by their inputs."""

from __future__ import annotations

import gc
import multiprocessing
import os
import pickle
from typing import Any, Dict, List, Tuple

import numpy as np
import pytest

import cscd
import oracle

V = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 1], [1, 1, 3], [3, 3, 3]], np.float64)
DOWN = V + np.array([[0, 0, 0]] * 3 + [[0, 0, -2]] * 3)
F = np.array([[0, 1, 2], [3, 4, 5]])
SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float64)
METHODS = ["fork", "spawn", "forkserver"]

Answers = Dict[str, Any]


def answers_of(detector: cscd.Detector, x0: Any, x1: Any) -> Answers:
    """What a detector says of a motion, as plain arrays."""
    found = detector.find_intersections(x0)
    return {"pairs": found.pairs, "depth": found.depth, "step": np.asarray(detector.step(x0, x1)), "check": detector.check(x1),
            "guarantee": detector.guarantee(), "near": np.asarray(detector.near(x0, 0.2)), "bounds": detector.bounds(x0, 0.2)}


def assert_same(a: Answers, b: Answers) -> None:
    """All answers are the same, bit by bit."""
    assert a.keys() == b.keys()
    for name in a:
        assert np.array_equal(a[name], b[name]), name


def copied(thing: Any) -> Any:
    """What pickle makes of it, in each of its protocols; the last one."""
    copies = [pickle.loads(pickle.dumps(thing, protocol)) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)]
    return copies[-1]


def torus_of() -> Any:
    return oracle.make_scene("squashed torus", 1)


# ---- by their inputs -------------------------------------------------------------------------------------------------


def test_pickled_meshes() -> None:
    """Faces of four corners, scenes with every sort of object, and obstacles."""
    square = cscd.Mesh([[0, 1, 2, 3]], positions=SQUARE)
    objects = [square, cscd.Mesh(F), cscd.Wires([[0, 1]]), cscd.Points(2), cscd.HalfSpace([0, 0, 1])]
    scene = cscd.Scene(objects, obstacles=[1, 4])
    for mesh in (square, scene, cscd.Mesh(F, 9)):
        mesh.hash  # pickling does not depend on whether the library has it already
        other = copied(mesh)
        assert type(other) is type(mesh) and repr(other) == repr(mesh) and other.hash == mesh.hash
        assert np.array_equal(other.triangles, mesh.triangles) and np.array_equal(other.triangle_face, mesh.triangle_face)
        assert np.array_equal(other.edges, mesh.edges) and other.vertex_counts == mesh.vertex_counts
    points = np.array([[0.2, 0.2, 2.0], [0.3, 0.2, 2.0]])
    start = [SQUARE, V, points, points + 1.0, np.zeros((1, 3))]
    end = [SQUARE + [0, 0, 4], DOWN, points - [0, 0, 3], points - [0, 0, 3], np.zeros((1, 3))]
    found = cscd.Detector(scene).step(start, end)
    assert len(found) > 3 and np.array_equal(found, cscd.Detector(copied(scene)).step(start, end))


def test_what_was_given_may_change_later() -> None:
    """A pickle has what the detector has, and not what the caller's arrays have become."""
    V = np.array([[0., 0, 0], [1, 0, 0], [0, 1, 0]] * 2)
    F, ignored = [[0, 1, 2], [3, 4, 5]], np.array([[0, 1]])
    detector = cscd.Detector(cscd.Mesh(F), ignored=ignored)
    ignored[:] = 0, 0
    later = np.array([[0, 1]])
    for thing in (detector, pickle.loads(pickle.dumps(detector))):
        assert len(thing.check(V)) == 0
    detector.set_ignored(later)
    later[:] = 0, 0
    assert len(pickle.loads(pickle.dumps(detector)).check(V)) == 0


def test_pickled_plans_and_detectors() -> None:
    """A detector in the middle of its work: the copy has the plan and all that was set, and the same answers."""
    torus = torus_of()
    mesh = cscd.Mesh(torus.F)
    plan = cscd.Plan.kmeans(mesh, torus.x0, k=4)
    same = copied(plan)
    assert same.method == plan.method and np.array_equal(same.triangle_regions, plan.triangle_regions)
    assert np.array_equal(same.detector_points, plan.detector_points)
    charged = cscd.Plan.charge(mesh, torus.x0)
    same = copied(charged)
    assert charged.charges is not None and charged.charges.max() > 0.0
    assert np.array_equal(same.charges, charged.charges) and np.array_equal(same.capacitances, charged.capacitances)
    detector = cscd.Detector(mesh, plan=plan, min_separation=1e-3, threads=2, progress=print)
    detector.step(torus.x0, torus.x1)
    detector.set_ignored([[0, 1]])
    detector.set_seams([torus.F[0][:2]])
    detector.set_separation(2e-3, 0.1)
    other = copied(detector)
    end = torus.x0 * [1.0, 0.9, -0.8]
    for start, stop in ((torus.x0, end), (end, torus.x1)):
        assert_same(answers_of(detector, start, stop), answers_of(other, start, stop))
    assert len(detector.step(torus.x0, end)) > 0
    found = copied(detector.find_intersections(torus.x1))
    assert np.array_equal(found.pairs, detector.find_intersections(torus.x1).pairs)


# ---- start methods ---------------------------------------------------------------------------------------------------


def work_on(detector: cscd.Detector, x0: Any, x1: Any, queue: Any) -> None:
    """In a child: the answers of a detector that came here by pickle."""
    queue.put(answers_of(detector, x0, x1))


@pytest.mark.parametrize("method", METHODS)
def test_detector_goes_to_a_process(method: str) -> None:
    """By every start method; under fork it is the very object, with its trees."""
    scene = oracle.make_grid_soup(3)
    detector = cscd.Detector(cscd.Mesh(scene.F, len(scene.x0)))
    wanted = answers_of(detector, scene.x0, scene.x1)
    assert len(wanted["step"]) > 20
    context = multiprocessing.get_context(method)
    queue = context.Queue()
    child = context.Process(target=work_on, args=(detector, scene.x0, scene.x1, queue))
    child.start()
    found = queue.get(timeout=60)
    child.join(60)
    assert child.exitcode == 0
    assert_same(found, wanted)
    assert_same(answers_of(detector, scene.x0, scene.x1), wanted)


def check_frame(task: Tuple[cscd.Mesh, Any]) -> Any:
    """In a worker: the pairs of one frame."""
    mesh, x = task
    return cscd.self_intersections(x, mesh).pairs


@pytest.mark.parametrize("method", METHODS)
def test_pool_over_frames(method: str) -> None:
    """A pool looks at frames side by side, and each has the pairs that one process finds."""
    scene = oracle.make_grid_soup(6)
    mesh = cscd.Mesh(scene.F, len(scene.x0))
    frames = [scene.x0 + t * (scene.x1 - scene.x0) for t in np.linspace(0.0, 1.0, 7)]
    wanted = [cscd.self_intersections(x, mesh).pairs for x in frames]
    assert min(map(len, wanted)) > 5
    with multiprocessing.get_context(method).Pool(2) as pool:
        found = pool.map(check_frame, [(mesh, x) for x in frames], chunksize=2)
    assert all(np.array_equal(a, b) for a, b in zip(found, wanted)) and len(found) == len(wanted)


def in_child(work: Any) -> Any:
    """What ``work`` says in a process that forks here, without multiprocessing; it must end."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            answer: Any = work()
        except BaseException as problem:
            answer = problem
        os.write(writer, pickle.dumps(answer))
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as file:
        answer = pickle.loads(file.read())
    assert os.waitpid(child, 0)[1] == 0
    return answer


def test_fork_with_threads() -> None:
    """Threads stay behind: a detector with threads goes on without them, can be let go of, and another one works."""
    scene = oracle.make_grid_soup(3)
    kept = [cscd.Detector(cscd.Mesh(scene.F, len(scene.x0)), threads=3)]
    wanted = kept[0].check(scene.x0)

    def work() -> Any:
        alone = kept[0].check(scene.x0)
        mesh = kept[0].mesh
        line = pickle.loads(pickle.dumps(kept[0]))
        kept.clear()
        gc.collect()
        return alone, cscd.Detector(mesh, threads=2).check(scene.x0), line.check(scene.x0)

    for found in in_child(work):
        assert np.array_equal(found, wanted)
    assert np.array_equal(kept[0].check(scene.x0), wanted)
