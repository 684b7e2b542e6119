"""Answers about meshes in one call: does it intersect itself, where, in which frames, and what meets on the way."""

from __future__ import annotations

import threading
from typing import Any, Callable, Iterator, List, Optional, Tuple

import numpy as np

from ._arrays import as_faces, as_positions, check_magnitudes
from ._host import processor_count, thread_count_of
from .detector import Detector
from .intersections import Intersections, kind_set
from .mesh import Mesh, Scene
from .results import Contacts

__all__ = ["contacts", "intersections", "is_self_intersecting", "self_intersecting_faces", "self_intersections"]

Array = Any
Progress = Optional[Callable[[str, float], Any]]


def mesh_of(F: Any, V: Any, name: str = "V") -> Mesh:
    """The mesh that is given, or one of these faces; faces of four corners are cut by ``V``, which is called so."""
    if not isinstance(F, Mesh):
        if V is not None:
            V = as_positions(name, V)
            F = as_faces("F", F, len(V))
            if F.shape[1] == 4:
                check_magnitudes(name, V)
        return Mesh(F, positions=V)
    if V is not None:
        as_positions(name, V, F.vertex_count)
    return F


def check_nothing(positions: Array, kinds: Any) -> None:
    """Without triangles there is nothing to ask the library, which else would look at these."""
    check_magnitudes("V", positions)
    kind_set(kinds)


def self_intersections(V: Any, F: Any, kinds: Any = None, *, threads: int = 1, progress: Progress = None,
                       **options: Any) -> Intersections:
    """The pairs of triangles of a mesh that intersect or touch, and how; exact, and complete.

    Parameters
    ----------
    V : (n, 3) float32 or float64
        Vertex positions.
    F : (m, 3) or (m, 4) integers, or Mesh
        Faces; those of four corners are cut into triangles by their shape.
    kinds : str or iterable of str, optional
        Which pairs count: "crossing", "coplanar", "folded", "duplicate", "touching" (include/cscd/surface.h).
        By default all. Curves, buried vertices and depths need all.
    threads : int
        0: one per processor.
    progress : function (stage, fraction), optional
    options
        Further ones of ``Detector``, as ``seams`` and ``ignored``.

    Raises
    ------
    ValueError
        A shape, a type, an index, or a number that is not finite.

    Two triangles that cross, of one mesh:

    >>> V = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [3, 3, 1]]
    >>> found = self_intersections(V, [[0, 1, 2], [3, 4, 5]])
    >>> found, found.pairs.tolist(), found.kind_names()
    (Intersections(1 crossing), [[0, 1]], ['crossing'])
    >>> round(found.curves[0].length, 3)
    1.414
    """
    positions = as_positions("V", V)
    mesh = mesh_of(F, positions)
    if mesh.triangle_count == 0:
        check_nothing(positions, kinds)
        return Intersections.none(mesh)
    detector = Detector(mesh, threads=threads, progress=progress, **options)
    return detector._called("V").find_intersections(positions, kinds)


def is_self_intersecting(V: Any, F: Any, kinds: Any = None, *, threads: int = 1, progress: Progress = None,
                         **options: Any) -> bool:
    """Whether any two triangles of a mesh intersect or touch; the search stops at the first pair.

    Parameters are those of ``self_intersections``. Components all of whose triangles have no area are not looked at:
    ``self_intersections(...).collapsed`` names them.

    >>> is_self_intersecting([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 1]], [[0, 1, 2], [2, 1, 3]])
    False
    """
    positions = as_positions("V", V)
    mesh = mesh_of(F, positions)
    if mesh.triangle_count == 0:
        check_nothing(positions, kinds)
        return False
    detector = Detector(mesh, threads=threads, progress=progress, **options)
    return detector._called("V").is_intersecting(positions, kinds)


def intersections(V1: Any, F1: Any, V2: Any, F2: Any, kinds: Any = None, *, threads: int = 1,
                  progress: Progress = None) -> Intersections:
    """The pairs of triangles of which one is of the first mesh, the other of the second one.

    ``pairs[:, 0]`` are rows of ``F1``, ``pairs[:, 1]`` rows of ``F2``. The mesh of the answer is a ``Scene`` of both,
    in whose numbers ``triangles``, ``depth`` and ``buried`` are.

    >>> V = [[0, 0, 0], [4, 0, 0], [0, 4, 0]]
    >>> intersections(V, [[0, 1, 2]], [[1, 1, -1], [1, 1, 1], [3, 3, 1]], [[0, 1, 2]]).pairs.tolist()
    [[0, 0]]
    """
    first, second = as_positions("V1", V1), as_positions("V2", V2)
    check_magnitudes("V1", first)
    check_magnitudes("V2", second)
    meshes = [mesh_of(F1, first, "V1"), mesh_of(F2, second, "V2")]
    if any(mesh.triangle_count == 0 for mesh in meshes):
        return Intersections.none(Scene(meshes))
    detector = Detector(Scene(meshes), rules=[{"self": False}, {"self": False}], threads=threads, progress=progress)
    found = detector.find_intersections([first, second], kinds)
    found.first_faces = np.array([0, meshes[0].face_count])
    return found


def contacts(x0: Any, x1: Any, F: Any, *, min_separation: float = 0.0, threads: int = 1, progress: Progress = None,
             **options: Any) -> Contacts:
    """The contacts of a mesh with itself while every vertex moves in a straight line from ``x0`` to ``x1``.

    Parameters
    ----------
    x0, x1 : (n, 3) float32 or float64
    F : (m, 3) or (m, 4) integers, or Mesh
    min_separation : float
        A length: coming within it is a contact. 0: touching is.
    options
        Further ones of ``Detector``. Who asks for many intervals keeps a ``Detector``.
    """
    start, end = as_positions("x0", x0), as_positions("x1", x1)
    mesh = mesh_of(F, start, "x0")
    if mesh.triangle_count == 0 and mesh.object_count == 1:  # in a scene, wires and points have contacts, too
        as_positions("x1", x1, len(start))
        check_magnitudes("x0", start)
        check_magnitudes("x1", end)
        return np.empty(0, Contacts.record()).view(Contacts)
    detector = Detector(mesh, min_separation=min_separation, threads=threads, progress=progress, **options)
    return detector.step(start, end)


# ---- many frames -------------------------------------------------------------------------------------------


def self_intersecting_faces(frames: Any, F: Any, kinds: Any = "crossing", *, threads: int = 1,
                            progress: Progress = None) -> Array:
    """The faces that intersect another one, in each of many frames.

    Parameters
    ----------
    frames : (B, n, 3), or an iterable of (n, 3)
        Positions of one mesh. An iterable is read as it comes, and may fill one array again and again.
    F : (m, 3) or (m, 4) integers, or Mesh
    kinds : str or iterable of str
        The pairs that count. Publications give the share of self-intersecting faces by "crossing", the default.
    threads : int
        Frames that are looked at side by side; 0: one per processor.
    progress : function (stage, fraction), optional
        Called after frames; the fraction is NaN where nobody knows how many there are.

    Returns
    -------
    (B, m) bool
        Its ``.mean(axis=1)`` is the share of self-intersecting faces of each frame.
    """
    total = len(frames) if hasattr(frames, "__len__") else None
    if isinstance(frames, np.ndarray) and frames.ndim != 3:
        raise ValueError(f"frames: expected an array (B, n, 3), got shape {frames.shape}; one frame is frames[None]")
    workers = thread_count_of(threads)
    queue = _FrameQueue(frames, F, kinds, total, progress)
    if queue.mesh is None or queue.mesh.triangle_count == 0:
        faces = 0 if queue.mesh is None else queue.mesh.face_count
        return np.zeros((queue.drain(), faces), bool)
    if workers == 0:
        workers = processor_count()
    if total is not None:
        workers = max(1, min(workers, total))
    return queue.run(workers)


class _FrameQueue:
    """Frames on their way to detectors, and the faces that these have found."""

    def __init__(self, frames: Any, F: Any, kinds: Any, total: Optional[int], progress: Progress) -> None:
        self._frames: Iterator[Tuple[int, Any]] = enumerate(iter(frames))
        self._kinds = kinds if kinds is None or isinstance(kinds, str) else list(kinds)  # for every frame
        kind_set(self._kinds)
        # A generator may fill one array again and again, while threads still look at what it held before.
        self._copies = not isinstance(frames, (np.ndarray, list, tuple))
        self._total = total
        self._progress = progress
        self._lock = threading.Lock()
        self._rows: List[Optional[Array]] = []
        self._failure: Optional[BaseException] = None
        self._first: Optional[Tuple[int, Any]] = next(self._frames, None)
        self.mesh: Optional[Mesh] = None
        if self._first is not None:
            self.mesh = mesh_of(F, as_positions("frames[0]", self._first[1]), "frames[0]")
        elif isinstance(F, Mesh) or np.size(F) == 0 or np.shape(F)[1:] == (3,):
            self.mesh = mesh_of(F, None)
        else:
            self.mesh = mesh_of(np.empty((0, 3), int), None)
            self.mesh.face_count = len(F)

    def drain(self) -> int:
        """The number of frames; no frame needs to be examined for it."""
        return (self._first is not None) + sum(1 for _ in self._frames)

    def _take(self) -> Optional[Tuple[int, Any]]:
        with self._lock:
            if self._failure is not None:
                return None
            taken: Optional[Tuple[int, Any]] = self._first
            if taken is None:
                taken = next(self._frames, None)
            self._first = None
            if taken is not None:
                self._rows.append(None)
                if self._copies:
                    taken = taken[0], np.array(self._positions(*taken))
            return taken

    def _positions(self, index: int, frame: Any) -> Array:
        assert self.mesh is not None
        return as_positions(f"frames[{index}]", frame, self.mesh.vertex_count)

    def _work(self, detector: Detector, report: bool) -> None:
        while True:
            taken = self._take()
            if taken is None:
                return
            index, frame = taken
            name = f"frames[{index}]"
            positions = self._positions(index, frame)
            self._rows[index] = detector._called(name).find_intersections(positions, self._kinds).faces
            if report:
                self.report(index + 1)

    def report(self, done: int) -> None:
        """Says how far the frames are, on the caller's thread."""
        if self._progress is not None:
            self._progress("frames", done / self._total if self._total else float("nan"))

    def _work_aside(self, detector: Detector) -> None:
        try:
            self._work(detector, False)
        except BaseException as problem:
            with self._lock:
                self._failure = self._failure or problem

    def run(self, workers: int) -> Array:
        """Examines all frames on this number of threads."""
        detectors = [Detector(self.mesh) for _ in range(workers)]
        if workers == 1:
            self._work(detectors[0], True)
        else:
            self._run_threads(detectors)
        assert self.mesh is not None
        return np.stack([row for row in self._rows if row is not None]) if self._rows else \
            np.zeros((0, self.mesh.face_count), bool)

    def _run_threads(self, detectors: List[Detector]) -> None:
        """The caller's thread waits in short steps, so that signals and progress have their turn."""
        threads = [threading.Thread(target=self._work_aside, args=(detector,), daemon=True) for detector in detectors]
        for thread in threads:
            thread.start()
        try:
            while any(thread.is_alive() for thread in threads):
                threads[0].join(0.02)
                for thread in threads[1:]:
                    thread.join(0.001)
                self.report(sum(row is not None for row in self._rows))
        except BaseException as problem:
            with self._lock:
                self._failure = self._failure or problem
            for detector in detectors:
                detector.cancel()
            for thread in threads:
                thread.join()
            raise
        if self._failure is not None:
            raise self._failure
