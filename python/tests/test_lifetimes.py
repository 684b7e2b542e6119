"""Objects go in any order, from any thread and at any time, and take all of their memory with them."""

from __future__ import annotations

import gc
import itertools
import os
import subprocess
import sys
import textwrap
from typing import Any, Dict

import numpy as np
import pytest

import cscd
import oracle

V = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 1], [1, 1, 3], [3, 3, 3]], np.float64)
DOWN = V + np.array([[0, 0, 0]] * 3 + [[0, 0, -2]] * 3)
F = np.array([[0, 1, 2], [3, 4, 5]])


def resident_bytes() -> int:
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_every_order_of_destruction() -> None:
    """Whatever goes first, the others go on working."""
    names = ("mesh", "plan", "detector", "line", "found", "contacts")
    torus = oracle.make_scene("squashed torus", 1)
    for order in itertools.permutations(names):
        mesh = cscd.Mesh(torus.F) if order[0] == "mesh" else cscd.Mesh(F)
        x0, x1 = (torus.x0, torus.x1) if order[0] == "mesh" else (V, DOWN)
        things: Dict[str, Any] = {"mesh": mesh}
        if mesh.is_closed_manifold:
            things["plan"] = cscd.Plan.kmeans(mesh, x0, k=2)
        things["detector"] = cscd.Detector(mesh, plan=things.get("plan"))
        things["line"] = things["detector"].line_search(x0, x1, reach=0.1)
        things["found"] = things["detector"].find_intersections(x0)
        things["contacts"] = things["detector"].step(x0, x1)
        del mesh
        for name in order:
            things.pop(name, None)
            for thing in things.values():
                if isinstance(thing, cscd.Detector):
                    assert len(thing.check(x0)) == 0
                elif isinstance(thing, cscd.LineSearch):
                    assert np.array_equal(thing.positions(1.0), x1)
                elif isinstance(thing, cscd.Intersections):
                    assert len(thing.curves) == 0
                elif isinstance(thing, cscd.Mesh):
                    assert len(thing.edges) == (len(thing.triangles) * 3 // 2 if thing.is_closed_manifold else 6)
                elif isinstance(thing, cscd.Plan):
                    assert thing.region_count >= 1


def test_cycles() -> None:
    """Objects that hold each other are found by the garbage collector."""
    class Solver:
        pass

    for _ in range(50):
        solver: Any = Solver()
        solver.detector = cscd.Detector(F, progress=lambda *_: solver, ignore=lambda *_: solver is None)
        solver.line = solver.detector.line_search(V, DOWN)
        solver.found = solver.detector.find_intersections(V)
        solver.detector.owner = solver
        solver.found.detector = solver.detector
    del solver
    before = len(gc.get_objects())
    gc.collect()
    assert len(gc.get_objects()) < before


def run(script: str, *arguments: str) -> str:
    """Runs a script with the package; it must end well and say nothing on stderr."""
    path = os.pathsep.join([os.path.dirname(os.path.dirname(cscd.__file__)), os.path.dirname(__file__)])
    done = subprocess.run([sys.executable, "-X", "faulthandler", "-c", textwrap.dedent(script), *arguments],
                          env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and done.stderr == "", (done.returncode, done.stderr[-2000:])
    return done.stdout


AT_EXIT = """
    import atexit, gc, sys, threading
    import numpy as np
    import cscd, oracle
    scene = oracle.make_scene("soup", 4)
    mesh = cscd.Mesh(scene.F, len(scene.x0))
    detector = cscd.Detector(mesh, threads=2, progress=lambda *_: None)
    line = detector.line_search(scene.x0, scene.x1)
    found = detector.find_intersections(scene.x0)
    detector.me = found.me = [detector, found, line]
    sys.kept = [detector, mesh]
    np.kept = cscd.Detector(mesh)
    atexit.register(lambda: detector.check(scene.x0))
    class Late:
        def __del__(self, detector=np.kept, x=scene.x0):
            detector.check(x)
    late = Late()
    late.me = late
    gc.disable()
    def work():
        own = cscd.Detector(mesh, threads=2)
        while True:
            own.step(scene.x0, scene.x1)
    for _ in range(int(sys.argv[1])):
        threading.Thread(target=work, daemon=True).start()
    print(len(detector.step(scene.x0, scene.x1)))
"""


@pytest.mark.parametrize("threads", [0, 1, 3])
def test_exit_with_live_objects(threads: int) -> None:
    """Objects in modules, in cycles and in atexit, and daemon threads in the middle of calls."""
    for _ in range(4 if threads else 1):
        assert int(run(AT_EXIT, str(threads))) > 50


def test_memory_of_many_calls() -> None:
    """10^5 calls leave nothing behind: neither in the library nor in the process."""
    detector = cscd.Detector(F)
    x = [V, DOWN, V.astype(np.float32), np.asfortranarray(V)]
    calls = [lambda i: detector.step(x[i % 4], x[1]), lambda i: detector.check(x[i % 4]), lambda i: detector.near(x[i % 4], 1.5),
             lambda i: detector.find_intersections(x[i % 4], kinds="crossing"), lambda i: detector.bounds(x[i % 4], 1.0),
             lambda i: detector.max_step(x[2 * (i % 2)], x[1]), lambda i: detector.near(V, 2.0, unique=True),
             lambda i: detector.set_active(None if i % 2 else [3, 4, 5]), lambda i: detector.counters]
    count = 0

    def rounds(number: int) -> None:
        nonlocal count
        for i in range(number):
            for call in calls:
                call(i)
                count += 1

    rounds(500)
    held, resident = detector.live_bytes, resident_bytes()
    rounds(100_000 // len(calls) + 1)
    assert detector.live_bytes == held
    assert count > 100_000 and resident_bytes() - resident < 2**20


def test_memory_of_many_objects() -> None:
    """Objects that are made, used, fail and go, also with exceptions that hold them."""
    wrong = V.copy()
    wrong[0, 0] = np.nan
    line: Any = None

    def rounds(number: int) -> None:
        nonlocal line
        for i in range(number):
            detector = cscd.Detector(F, threads=1 + (i % 16 == 0), progress=lambda *_: None)
            line = detector.line_search(V, DOWN, reach=0.5)
            assert len(line.near(0.9, 0.5)) > 0
            assert len(cscd.self_intersections(DOWN, F).curves) == 1
            for x in (wrong, V[:3], DOWN):
                try:
                    detector.max_step(x, V)
                except (ValueError, cscd.InContact):
                    pass
            try:
                cscd.Mesh([[0, 1, -7]])
            except ValueError:
                pass
            try:
                cscd.Detector(F, min_separation=-1.0)
            except ValueError:
                pass

    rounds(300)
    gc.collect()
    resident = resident_bytes()
    rounds(1500)
    gc.collect()
    assert resident_bytes() - resident < 2**20
