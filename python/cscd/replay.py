"""A recording, frame by frame: what intersects in each frame, what touches on the way, and the events that follow."""

from __future__ import annotations

import ctypes
import threading
from typing import Any, Callable, Iterable, Iterator, List, NamedTuple, NoReturn, Optional, Sequence, Tuple

import numpy as np

from ._arrays import as_indices, as_positions, check_magnitudes, count_of, describe
from ._host import Handle, new_handle
from ._library import address_of, copy_list, items_of, library, new_struct, structs
from .detector import Detector
from .errors import Error
from .intersections import Intersections, _Surface, collapsed_of, labels_of
from .mesh import Mesh
from .questions import mesh_of
from .results import Contacts, Events, INTERSECTION_KINDS, copy_records

__all__ = ["Frame", "Replay", "replay"]

Array = Any

_NO_PART = 2**32 - 1
_MOST_PARTS = 8192  # of tables of pairs, tool/common/ignore_pairs.c
_RESTS = (None, "pairs", "parts")
_END = object()


class Frame(NamedTuple):
    """The findings of a replay in one frame."""

    #: The number of the frame: its index, or what ``frame_numbers`` says.
    number: int
    #: The contacts of the interval that ends here; of the first frame none.
    contacts: Contacts
    #: The intersections of this frame.
    intersections: Intersections
    #: The events that have ended before this frame, and were not given out yet. ``Replay.events`` lacks those of them
    #: that turn out to follow from others.
    events: Events


class LeftOut(Handle):
    """Pairs of parts, and pairs of triangles at rest, that a replay leaves out, by the rules of the tool."""

    __slots__ = ("mesh", "_part_count")

    def __init__(self, mesh: Mesh, labels: Array, part_count: int) -> None:
        super().__init__(mesh.host, library.cscdpy_left_out_destroy)
        self.mesh = mesh
        self._part_count = part_count
        error = ctypes.create_string_buffer(1024)
        if not library.cscdpy_left_out_create(mesh.pointer, address_of(labels), part_count, self.place,
                                              ctypes.addressof(error)):
            raise MemoryError(error.value.decode())

    def add_parts(self, pairs: Any) -> None:
        """Leaves out all pairs of two parts, (k, 2); -1 stands for what is in no part."""
        part_count = self._part_count
        for a, b in pairs.tolist():
            if not (-1 <= a < part_count and -1 <= b < part_count):
                raise ValueError(f"ignore_parts: ({a}, {b}): expected numbers from 0 to {part_count - 1}, or -1")
            if not library.cscdpy_left_out_add_parts(self.pointer, a & _NO_PART, b & _NO_PART):
                self._fail("ignore_parts")

    def add_rest(self, found: Array, by_parts: bool) -> None:
        """Leaves out what meets at rest, a list of the library."""
        if not library.cscdpy_left_out_add_rest(self.pointer, address_of(found), by_parts):
            self._fail("ignore_rest")

    def _fail(self, option: str) -> NoReturn:
        """Says why there is no table."""
        if self._part_count > _MOST_PARTS:
            raise ValueError(f"{option}: expected at most {_MOST_PARTS} parts, got {self._part_count}")
        raise MemoryError(f"{option}: out of memory")


def replay(frames: Iterable[Any], F: Any, *, parts: Any = None, bodies: Any = None, ignore_parts: Any = (),
           ignore_rest: Optional[str] = None, contacts: bool = True, depths: bool = True,
           frame_numbers: Optional[Sequence[int]] = None, rings: int = 2, gap: int = 0, threads: int = 1,
           progress: Optional[Callable[[str, float], Any]] = None, **options: Any) -> Replay:
    """Follows a mesh through the frames of a recording.

    Parameters
    ----------
    frames : (B, n, 3), or an iterable of (n, 3)
        Read as they come; two are held at a time.
    F : (m, 3) or (m, 4) integers, or Mesh
    parts : (t,) integers, optional
        The part of each triangle of the mesh, -1 for none; events are between parts. By default objects are the parts.
    bodies : (t,) integers, optional
        What belongs together, in which depths are measured, as ``Recording.body_labels``; by default the parts.
    ignore_parts : (k, 2) integers
        Pairs of parts that are not looked at with each other; a part with itself as well.
    ignore_rest : "pairs" or "parts", optional
        Leaves out the pairs of triangles that meet in the first frame, or all pairs of the parts that do.
    contacts : bool
        Whether to look at what happens between the frames.
    depths : bool
        Whether to look for curves and depths.
    frame_numbers : sequence of int, optional
        What frames are called, ascending.
    rings, gap : int
        How near in space and time things belong to one event (include/cscd/events.h).
    options
        Further ones of ``Detector``, but ``ignored`` and ``ignore``.

    Returns
    -------
    Replay
        An iterator of ``Frame``. After the last one its ``events`` are those that the tool finds in the recording. An
        exception ends it, as it ends a generator.

    >>> below = [[0, 0, 0], [4, 0, 0], [0, 4, 0]]
    >>> moving = [below + [[1, 1, z], [1, 1, z + 1], [2, 1, z + 1]] for z in (0.5, -0.5, -2)]
    >>> run = replay(moving, [[0, 1, 2], [3, 4, 5]], parts=[0, 1])
    >>> [len(frame.intersections) for frame in run]
    [0, 1, 0]
    >>> run.events.first_frame.tolist(), run.events.last_frame.tolist(), run.events.kind_names()
    ([1], [2], (('crossing',),))
    """
    return Replay(frames, F, parts=parts, bodies=bodies, ignore_parts=ignore_parts, ignore_rest=ignore_rest, contacts=contacts,
                  depths=depths, frame_numbers=frame_numbers, rings=rings, gap=gap, threads=threads,
                  progress=progress, **options)


class Replay:
    """An iterator of ``Frame``; see ``replay``.

    Attributes
    ----------
    mesh : Mesh
        Known from the first frame on.
    events : Events
        Those that have ended so far; after the last frame all of them, by their first frames.
    """

    def __init__(self, frames: Iterable[Any], F: Any, *, parts: Any, bodies: Any, ignore_parts: Any,
                 ignore_rest: Optional[str], contacts: bool, depths: bool,
                 frame_numbers: Optional[Sequence[int]], rings: int, gap: int, **options: Any) -> None:
        if isinstance(frames, np.ndarray) and frames.ndim != 3:
            raise ValueError(f"frames: expected an array (B, n, 3), got shape {frames.shape}; one frame is "
                             "frames[None]")
        for name in ("ignored", "ignore"):
            if name in options:
                raise ValueError(f"{name}: a replay leaves out by ignore_parts= and ignore_rest=")
        if ignore_rest not in _RESTS:
            raise ValueError(f"ignore_rest: expected None, 'pairs' or 'parts', got {ignore_rest!r}")
        self._frames = iter(frames)
        self._numbers = _numbers_of(frame_numbers)
        self._faces = F
        self._bodies = bodies
        self._parts, self._ignore_parts, self._ignore_rest = parts, _part_pairs_of(ignore_parts), ignore_rest
        self._contacts, self._depths = contacts, depths
        self._tracking = {name: count_of(name, value, int(np.iinfo(structs["event_options"][name]).max))
                          for name, value in (("rings", rings), ("gap", gap))}
        self._options = options
        self._detector: Any = None
        self._lock: Any = threading.RLock()  # another thread waits for its frame
        self._running = False
        self._ended = ""
        self._index = 0
        self._before: Any = None
        self._taken: List[Array] = []
        self._finished = False

    def cancel(self) -> None:
        """Ends a call of this iterator that is running in another thread, which then raises ``Cancelled``."""
        if self._detector is not None:
            self._detector.cancel()

    # ---- before the first frame ---------------------------------------------------------------------------

    def _open(self, first: Any) -> None:
        """Makes what is needed, now that there are positions."""
        self.mesh = mesh_of(self._faces, first if self._is_single(first) else None)
        labels, part_count = self._label()
        self._left_out = self._leave_out(first, labels, part_count)
        self._detector = Detector(self.mesh, _left_out=self._left_out, **self._options)
        if self._parts is not None:
            self._detector.set_parts(self._parts, part_count)
        if self._bodies is not None:
            self._detector.set_bodies(self._bodies)
        tracking = new_struct("event_options")
        library.cscd_event_defaults_sized(address_of(tracking), tracking.nbytes)
        for name, value in self._tracking.items():
            tracking[name] = value
        tracking["part_count"], tracking["labels"] = part_count, address_of(labels)
        tracking["max_memory"] = self._detector._inputs["max_memory"]
        self._follow_seams(tracking)
        host = self._detector._host
        with host.lock:
            self._tracker = new_handle(host, library.cscd_event_tracker_destroy, library.cscdpy_tracker_create,
                                       self.mesh.pointer, address_of(tracking))
        self._found_options = self._detector._find_options(2**64 - 1, 0, False, self._depths, True)

    @staticmethod
    def _is_single(positions: Any) -> bool:
        return not isinstance(positions, (list, tuple)) or len(positions) == 0 or np.ndim(positions[0]) != 2

    def _label(self) -> Tuple[Array, int]:
        if self._parts is not None:
            return labels_of(self._parts, self.mesh.triangle_count, None, "parts")
        return labels_of(self.mesh.triangle_objects, self.mesh.triangle_count, self.mesh.object_count)

    def _leave_out(self, first: Any, labels: Array, part_count: int) -> Optional[LeftOut]:
        if len(self._ignore_parts) == 0 and self._ignore_rest is None:
            return None
        left_out = LeftOut(self.mesh, labels, part_count)
        left_out.add_parts(self._ignore_parts)
        if self._ignore_rest is not None:
            options = {name: value for name, value in self._options.items() if name in ("seams", "threads", "rules")}
            detector = Detector(self.mesh, **options)
            detector.find_intersections(first, [kind for kind in INTERSECTION_KINDS if kind != "duplicate"])
            left_out.add_rest(detector._lists["intersections"], self._ignore_rest == "parts")
        return left_out

    def _follow_seams(self, tracking: Array) -> None:
        if self._options.get("seams") is not None:
            self._seams = as_indices("seams", self._options["seams"], 2, self.mesh.vertex_count, "vertices")
            tracking["seams"], tracking["seam_count"] = address_of(self._seams), len(self._seams)

    # ---- frame by frame -----------------------------------------------------------------------------------

    def __iter__(self) -> Iterator[Frame]:
        return self

    def __next__(self) -> Frame:
        with self._lock:
            if self._running:
                raise Error("this replay is in the middle of a frame, of which a callback cannot ask for the next one")
            if self._ended:
                raise Error(f"this replay ended in frames[{self._index}], by {self._ended}; begin another one")
            self._running = True
            try:
                frame = self._next()
            except BaseException as problem:
                self._ended = type(problem).__name__
                if isinstance(problem, StopIteration):  # of a callback; it would look like the end of the frames
                    raise RuntimeError("a callback of the replay raised StopIteration") from problem
                raise
            finally:
                self._running = False
        if frame is None:
            raise StopIteration
        return frame

    def _next(self) -> Optional[Frame]:
        """The next frame, as ``__next__`` gives it; None after the last one."""
        positions = next(self._frames, _END)
        if positions is _END:
            self._finish()
            return None
        name = f"frames[{self._index}]"
        if self._index == 0:
            if self._is_single(positions):
                positions = as_positions(name, positions)
            self._open(positions)
        number = self._number()
        views, kept = self._detector._views(name, positions)
        kept = [array.copy() for array in kept]
        for i, array in enumerate(kept):
            check_magnitudes(name if len(kept) == 1 else f"{name}[{i}]", array)
        touched = self._step(kept)
        found = self._find(kept)
        self._before = kept
        self._index += 1
        return Frame(number, touched, found, self._take(library.cscdpy_tracker_take))

    def _number(self) -> int:
        if self._numbers is None:
            return self._index
        if self._index >= len(self._numbers):
            raise ValueError(f"frame_numbers: expected one for each frame, got {len(self._numbers)}")
        return self._numbers[self._index]

    def _step(self, positions: List[Array]) -> Contacts:
        """The contacts on the way here, which the tracker gets, too."""
        if self._before is None or not self._contacts:
            return np.empty(0, Contacts.record()).view(Contacts)
        found = self._detector._lists["contacts"]
        host = self._detector._host
        with host.lock:  # the list lives until another call of this detector, as a frame's answer makes in another thread
            touched: Contacts = self._detector.step(_joined(self._before), _joined(positions))
            host.call(library.cscdpy_tracker_add_contacts, self._tracker.pointer, int(found["items"][0]),
                      int(found["count"][0]))
        return touched

    def _find(self, positions: List[Array]) -> Intersections:
        detector = self._detector
        views, kept = detector._called(f"frames[{self._index}]")._views("frames", _joined(positions))
        found = detector._lists["intersections"]
        host = detector._host
        with host.lock:
            detector._find(host, views, self._found_options)
            pairs = copy_records(found, "intersection")
            collapsed = collapsed_of(found)
            if self._left_out is not None and not library.cscdpy_left_out_show(self._left_out.pointer,
                                                                               address_of(found)):
                raise MemoryError("out of memory for the depths of a frame")
            surface = _Surface(found, self.mesh.vertex_count, self._depths, True)
            host.call(library.cscdpy_tracker_add_frame, self._tracker.pointer, self._index, address_of(found))
        answer = Intersections(self.mesh, detector, kept, pairs, False, True)
        answer.collapsed = collapsed
        if self._depths:
            answer._surface = surface
        answer.part_pairs = surface._found_parts
        answer.left_out = surface.left_out
        return answer

    # ---- events -------------------------------------------------------------------------------------------

    def _take(self, function: Any) -> Events:
        """Events that have ended, in the caller's numbers."""
        out = new_struct("events")
        host = self._detector._host
        with host.lock:
            host.call(function, self._tracker.pointer, address_of(out))
            taken = copy_list(int(out["items"][0]), int(out["count"][0]), structs["event"])
        self._taken.append(taken)
        return self._shown(taken)

    def _shown(self, taken: Array) -> Events:
        """Without the events that only follow from others; ``taken`` are structs of the library."""
        shown = taken.copy()
        count = ctypes.c_size_t(len(shown))
        if not library.cscdpy_choose_events(address_of(shown), ctypes.addressof(count)):
            raise MemoryError("out of memory for the events")
        shown = items_of(shown[: count.value], "event")
        if self._numbers is not None:
            for name in ("first_frame", "last_frame", "worst_frame"):
                shown[name] = np.asarray(self._numbers, np.int64)[shown[name]]
        found: Events = shown.view(Events)
        return found

    def _finish(self) -> None:
        if self._index > 0 and not self._finished:
            self._take(library.cscdpy_tracker_finish)
        self._finished = True

    @property
    def events(self) -> Events:
        taken = np.concatenate(self._taken) if self._taken else np.empty(0, structs["event"])
        order = np.lexsort((taken["first_triangle"], taken["b"], taken["a"], taken["first_frame"]))
        return self._shown(taken[order])


def _numbers_of(numbers: Any) -> Optional[List[int]]:
    """The numbers of frames, ascending."""
    if numbers is None:
        return None
    array = np.asarray(numbers if hasattr(numbers, "__len__") else list(numbers))
    if array.size and (array.ndim != 1 or array.dtype.kind not in "iu" or int(array.max()) >= 2**63):
        raise ValueError(f"frame_numbers: expected whole numbers, one for each frame, got {describe(array)}")
    found: List[int] = array.tolist()
    for i in range(1, len(found)):
        if found[i] <= found[i - 1]:
            raise ValueError(f"frame_numbers: expected them to ascend, got {found[i]} after {found[i - 1]}")
    return found


def _part_pairs_of(pairs: Any) -> Array:
    """Pairs of parts, which are checked when it is known how many parts there are."""
    array = np.asarray(pairs if hasattr(pairs, "__len__") else list(pairs))
    if array.size == 0:
        return np.empty((0, 2), np.int64)
    if array.shape == (2,):
        array = array[None]
    if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iu":
        raise ValueError(f"ignore_parts: expected an array (k, 2) of whole numbers, got {describe(array)}")
    return array


def _joined(arrays: List[Array]) -> Any:
    """Positions as they were given: one array, or one for each object."""
    return arrays if len(arrays) > 1 else arrays[0]
