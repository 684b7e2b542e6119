"""Threads of Python side by side, the lock that calls give back, and signals that end them."""

from __future__ import annotations

import gc
import signal
import threading
import time
from typing import Any, Callable, List

import numpy as np
import pytest

import cscd
import oracle

V = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 1], [1, 1, 3], [3, 3, 3]], np.float64)
DOWN = V + np.array([[0, 0, 0]] * 3 + [[0, 0, -2]] * 3)
F = np.array([[0, 1, 2], [3, 4, 5]])


def sheets(n: int, layers: int = 2) -> Any:
    """Rough sheets in one place: most triangles cross some others."""
    corner = np.arange(n * n).reshape(n, n)
    faces = np.concatenate([np.stack([corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:]], -1).reshape(-1, 3),
                            np.stack([corner[:-1, :-1], corner[1:, 1:], corner[:-1, 1:]], -1).reshape(-1, 3)])
    grid = np.stack(np.meshgrid(np.arange(n), np.arange(n), indexing="ij"), -1).reshape(-1, 2)
    random = np.random.default_rng(1)
    x = np.concatenate([np.column_stack([grid, random.uniform(-1, 1, len(grid))]) for _ in range(layers)])
    return x, np.concatenate([faces + i * n * n for i in range(layers)])


def run_together(*functions: Callable[[], Any]) -> List[Any]:
    """Runs functions on threads of their own; raises what one of them raises."""
    results: List[Any] = [None] * len(functions)
    failures: List[BaseException] = []

    def run(i: int) -> None:
        try:
            results[i] = functions[i]()
        except BaseException as problem:
            failures.append(problem)

    threads = [threading.Thread(target=run, args=(i,)) for i in range(len(functions))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
        assert not thread.is_alive(), "a thread hangs"
    if failures:
        raise failures[0]
    return results


def test_detectors_side_by_side() -> None:
    """Each thread has its own detector of a common mesh; all have the results of one alone."""
    soups = [oracle.make_grid_soup(seed) for seed in range(4)]
    mesh = cscd.Mesh(soups[0].F, len(soups[0].x0))
    ends = [(soup.x0, soup.x1) for soup in soups]
    truth = [cscd.Detector(mesh).step(x0, x1) for x0, x1 in ends]
    assert all(len(found) > 20 for found in truth)

    def work(threads: int) -> int:
        detector = cscd.Detector(mesh, threads=threads)
        for i in range(100):
            found = detector.step(*ends[i % len(ends)])
            assert np.array_equal(found, truth[i % len(ends)])
        return len(cscd.self_intersections(V, F))

    assert run_together(*[lambda t=t: work(t) for t in (1, 2, 1, 2)]) == [0] * 4  # type: ignore[misc]


def test_one_detector_from_several_threads() -> None:
    """Calls wait for each other; what each gives back is its own."""
    scene = oracle.make_grid_soup(5)
    detector = cscd.Detector(cscd.Mesh(scene.F, len(scene.x0)))
    step, near, check = detector.step(scene.x0, scene.x1), detector.near(scene.x1, 0.2), detector.check(scene.x0)
    back = detector.step(scene.x1, scene.x0)
    assert min(map(len, (step, near, check, back))) > 20

    def each(call: Callable[[], Any], wanted: Any) -> Callable[[], None]:
        def work() -> None:
            for _ in range(150):
                assert np.array_equal(call(), wanted)
        return work

    run_together(each(lambda: detector.step(scene.x0, scene.x1), step), each(lambda: detector.near(scene.x1, 0.2), near),
                 each(lambda: detector.check(scene.x0), check), each(lambda: detector.step(scene.x1, scene.x0), back))


def test_objects_that_go_during_a_call() -> None:
    """Another thread makes line searches, asks for curves, and lets go of all that while the detector works."""
    x, faces = sheets(40)
    mesh = cscd.Mesh(faces)
    detector = cscd.Detector(mesh)
    truth = detector.check(x)
    done = threading.Event()

    def work() -> None:
        try:
            for _ in range(60):
                assert np.array_equal(detector.check(x), truth)
        finally:
            done.set()

    def come_and_go() -> None:
        while not done.is_set():
            line = detector.line_search(x, x)
            threading.Thread(target=line.positions, args=(0.5,)).start()
            del line
            cscd.Detector(mesh).line_search(x, x)
            gc.collect()

    run_together(work, come_and_go)


def test_the_lock_is_given_back() -> None:
    """While a call runs, Python goes on in another thread; also with frames on threads of the package."""
    x, faces = sheets(150)
    detector = cscd.Detector(faces)
    detector.check(x)
    ticks: List[float] = []
    over = threading.Event()

    def count() -> None:
        while not over.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0)

    counter = threading.Thread(target=count)
    counter.start()
    try:
        for call in (lambda: detector.check(x), lambda: detector.find_intersections(x), lambda: detector.near(x, 0.3),
                     lambda: detector.step(x, x + 0.01), lambda: cscd.Mesh(np.tile(faces, (4, 1)))):
            begin = time.perf_counter()
            call()
            end = time.perf_counter()
            inside = [begin] + [tick for tick in ticks if begin < tick < end] + [end]
            # Arrays are prepared and copied with the lock; the call itself is most of the time.
            assert end - begin > 0.01 and np.diff(inside).max() < 0.6 * (end - begin), np.diff(inside).max() / (end - begin)
    finally:
        over.set()
        counter.join()


def test_cancel_from_another_thread() -> None:
    """Detector.cancel ends a call that runs, and no later one."""
    x, faces = sheets(200)
    detector = cscd.Detector(faces)
    truth = detector.check(x)
    for delay in np.linspace(0.0, 0.05, 6):
        timer = threading.Timer(delay, detector.cancel)
        timer.start()
        try:
            assert np.array_equal(detector.check(x), truth)
        except cscd.Cancelled:
            pass
        timer.join()
    cancelled = 0
    for _ in range(5):
        stop = threading.Event()

        def cancel() -> None:
            while not stop.wait(0.002):
                detector.cancel()

        thread = threading.Thread(target=cancel)
        thread.start()
        try:
            detector.near(x, 1.0)
        except cscd.Cancelled:
            cancelled += 1
        stop.set()
        thread.join()
    assert cancelled == 5
    try:  # the last cancel may have come when no call was running, and meets this one
        detector.check(x)
    except cscd.Cancelled:
        pass
    assert np.array_equal(detector.check(x), truth)


# ---- signals ---------------------------------------------------------------------------------------------------------


@pytest.fixture
def alarm() -> Any:
    """An alarm raises KeyboardInterrupt, as Ctrl-C does."""
    before = signal.signal(signal.SIGALRM, signal.SIG_IGN)
    yield
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


def repeat(call: Callable[[], Any]) -> None:
    """Calls until an alarm interrupts it."""
    while True:
        call()


def interrupt_repeat(number: int, frame: Any) -> None:
    """A handler that raises within ``repeat`` alone, so that no alarm interrupts the test itself."""
    while frame is not None:
        if frame.f_code is repeat.__code__:
            raise KeyboardInterrupt
        frame = frame.f_back


def interrupt(call: Callable[[], Any], delay: float, again: float) -> float:
    """Repeats a call until an alarm interrupts it, after ``delay``; returns how much later that was, in seconds.

    An alarm that comes just before ``repeat`` raises nothing, so others follow.
    """
    signal.signal(signal.SIGALRM, interrupt_repeat)
    due = time.monotonic() + delay
    signal.setitimer(signal.ITIMER_REAL, delay, again)
    try:
        repeat(call)
    except KeyboardInterrupt:
        pass
    signal.setitimer(signal.ITIMER_REAL, 0)
    return time.monotonic() - due


def test_control_c_ends_long_calls(alarm: Any) -> None:
    """50 times at random moments: the call ends within 0.1 s, and the object goes on being right.

    Half of them must, and nearly all within 0.3 s, so that a busy machine does not fail the test.
    """
    x, faces = sheets(100, 6)
    mesh, last = cscd.Mesh(faces), x + np.random.default_rng(7).normal(0.0, 0.3, x.shape)
    detector, frames = cscd.Detector(mesh), [x] * 50
    truth = detector.check(x)
    random = np.random.default_rng(2)
    calls = [lambda: detector.step(x, last), lambda: detector.near(x, 1.5), lambda: detector.find_intersections(last).depth,
             lambda: cscd.self_intersecting_faces(frames, mesh), lambda: cscd.self_intersecting_faces(frames, mesh, threads=2)]
    late: List[float] = []
    for i in range(50):
        late.append(interrupt(calls[i % len(calls)], random.uniform(0.0005, 0.06), 0.3))
        if i % 10 == 9:
            assert np.array_equal(detector.check(x), truth)
    late.sort()
    assert late[24] < 0.1 and late[44] < 0.3, late[20:]


def test_control_c_between_short_calls(alarm: Any) -> None:
    """Wherever in Python's own code it comes, nothing stays locked, and no result is mixed up."""
    detector = cscd.Detector(F)
    line = detector.line_search(V, DOWN, reach=0.5)
    step, near = detector.step(V, DOWN), line.near(0.5, 0.5)
    random = np.random.default_rng(3)

    def call() -> None:
        detector.step(V, DOWN)
        line.near(0.5, 0.5)
        detector.counters
        cscd.Detector(F).set_seams(None)

    for _ in range(400):
        interrupt(call, random.uniform(2e-5, 3e-3), 5e-3)
        assert np.array_equal(detector.step(V, DOWN), step) and np.array_equal(line.near(0.5, 0.5), near)


def test_no_control_c_is_lost(alarm: Any) -> None:
    """Each one arrives, also one that comes while objects are made or destroyed: Python drops what a __del__ raises."""
    raised = arrived = 0

    def handle(number: int, frame: Any) -> None:
        nonlocal raised
        # numpy drops what is raised while it looks at records, Python what is raised while a thread leaves its weak set
        if not frame.f_globals["__name__"].startswith(("numpy", "_weakrefset")):
            raised += 1
            interrupt_repeat(number, frame)
            raised -= 1  # it has not
        signal.setitimer(signal.ITIMER_REAL, 1e-4)

    def call() -> None:
        assert arrived == raised
        mesh = cscd.Mesh(F)
        cscd.Detector(mesh).line_search(V, DOWN)
        list(cscd.replay([V, DOWN], F, ignore_rest="pairs"))
        cycle: List[Any] = [cscd.self_intersections(DOWN, F), cscd.Mesh(np.array([[0, 1, 2, 4]]), positions=V)]
        cycle.append(cycle)

    call()
    signal.signal(signal.SIGALRM, handle)
    random = np.random.default_rng(5)
    while raised < 1500:
        signal.setitimer(signal.ITIMER_REAL, random.uniform(1e-4, 2e-3))  # one: the next may interrupt the handler
        try:
            repeat(call)
        except KeyboardInterrupt:
            arrived += 1
    assert arrived == raised


def test_other_handlers(alarm: Any) -> None:
    """What a handler raises is what the call raises; one that returns lets it go on, and may ask other objects."""
    x, faces = sheets(100, 4)
    detector, other = cscd.Detector(faces), cscd.Detector(F)
    truth = detector.check(x)
    seen: List[int] = []
    running = True

    def ask(*_: Any) -> None:
        seen.append(len(other.step(V, DOWN)))
        if running:
            signal.setitimer(signal.ITIMER_REAL, 0.004)  # not before this step has returned: its object is busy until then

    signal.signal(signal.SIGALRM, ask)
    signal.setitimer(signal.ITIMER_REAL, 0.002)
    assert np.array_equal(detector.check(x), truth)
    running = False
    signal.setitimer(signal.ITIMER_REAL, 0)
    assert len(seen) > 3 and min(seen) > 0

    def fail(*_: Any) -> None:
        raise LookupError("from a handler")

    signal.signal(signal.SIGALRM, fail)
    with pytest.raises(LookupError, match="from a handler"):
        signal.setitimer(signal.ITIMER_REAL, 0.002)
        while True:
            detector.check(x)
    assert np.array_equal(detector.check(x), truth)
