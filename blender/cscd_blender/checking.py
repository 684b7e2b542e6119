"""The run: frame by frame through the module, in steps that leave the window alive, and what it has found."""

from __future__ import annotations

import threading
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

import cscd

from .scene import CheckedScene, KeptFrame, Parts, SceneError, frames_of, has_instances, objects_of, parts_of, read_frames

Array = Any

#: How two faces meet, by the code.
KINDS = cscd.INTERSECTION_KINDS


class Request(NamedTuple):
    """What is to be checked."""

    objects: Tuple[str, ...] = ()
    collections: Tuple[str, ...] = ()
    first: Optional[int] = None
    last: Optional[int] = None
    step: int = 1
    #: Parts by vertex group; else an object is a part.
    by_groups: bool = True
    #: Pairs of names of parts that are not looked at with each other; an object's name stands for all its parts.
    ignored: Tuple[Tuple[str, str], ...] = ()
    #: "pairs" or "parts": what meets in the first frame is left out.
    ignore_rest: Optional[str] = None
    depths: bool = True
    threads: int = 0


class FoundFrame(NamedTuple):
    """What was found in one frame."""

    frame: int
    #: (k, 2) the faces of each pair, in the numbers of the checked mesh.
    faces: Array
    #: (k, 2) the parts of each pair, -1 for none.
    parts: Array
    #: (k,) codes of ``KINDS``.
    kinds: Array
    contact_count: int
    #: (n,) depths of vertices, 0 where not buried; None where nobody looked.
    depth: Optional[Array]
    #: Points of each curve, closed ones ending where they begin.
    curves: List[Array]
    #: Names of parts all of whose faces have no area, as those that are hidden by a scale of 0: they were not looked at.
    hidden: Tuple[str, ...]
    #: No face of the frame has an area, so that nothing was looked at.
    is_empty: bool


class FoundEvent(NamedTuple):
    """What two parts have to do with each other for some frames."""

    a: str
    b: str
    first: int
    last: int
    worst: int
    kinds: Tuple[str, ...]
    pairs: int
    contacts: int
    depth: float
    #: Where to look, in world space; None: nobody knows.
    place: Optional[Tuple[float, float, float]]


class Findings:
    """The results of a run.

    Attributes
    ----------
    request : Request
    checked : CheckedScene
    parts : Parts
    frames : dict of FoundFrame, by frame
    events : list of FoundEvent, the worst first
    left_instances : bool
        Whether the scene shows instances, which are not checked.
    """

    def __init__(self, request: Request, checked: CheckedScene, parts: Parts) -> None:
        self.request = request
        self.checked = checked
        self.parts = parts
        self.frames: Dict[int, FoundFrame] = {}
        self.events: List[FoundEvent] = []
        self.left_instances = False

    @property
    def found_anything(self) -> bool:
        """Whether surfaces cross, share area or touch anywhere."""
        return bool(self.events)

    def faces_in(self, frame: int, a: Optional[str] = None, b: Optional[str] = None) -> Array:
        """The faces that take part in a pair in a frame, of two parts or of any, in the numbers of the checked mesh."""
        found = self.frames.get(frame)
        if found is None:
            return np.empty(0, np.int64)
        if a is None:
            return np.unique(found.faces)
        numbers = [self.parts.names.index(name) if name in self.parts.names else -1 for name in (a, b)]
        wanted = (np.sort(found.parts, axis=1) == sorted(numbers)).all(axis=1)
        return np.unique(found.faces[wanted])


class Run:
    """A check of a scene that is done in steps: reading a frame in Blender's own thread, looking at it in another.

    Call ``step`` until it returns false; ``cancel`` ends it early, and nothing is left behind.

    Attributes
    ----------
    done, total : int
        Frames.
    findings : Findings
        Complete once ``step`` has returned false.
    """

    def __init__(self, context: Any, request: Request) -> None:
        self._kept = KeptFrame(context.scene)
        try:
            self._begin(context.scene, context.view_layer, request)
        except BaseException:
            self._kept.restore()
            raise

    def _begin(self, scene: Any, view_layer: Any, request: Request) -> None:
        self._numbers = list(frames_of(scene, request.first, request.last, request.step))
        scene.frame_set(self._numbers[0])
        things = objects_of(view_layer, request.objects, request.collections)
        checked = CheckedScene(things, view_layer, view_layer.depsgraph)
        parts = parts_of(checked, view_layer, view_layer.depsgraph, request.by_groups)
        self.findings = Findings(request, checked, parts)
        self.findings.left_instances = has_instances(view_layer.depsgraph)
        self._positions = read_frames(scene, checked, view_layer, self._numbers)
        self._waiting: List[Array] = []
        self._replay = cscd.replay(self._feed(), checked.mesh, parts=parts.labels, ignore_rest=request.ignore_rest,
                                   ignore_parts=_ignored_pairs(parts, request.ignored), depths=request.depths,
                                   threads=request.threads, frame_numbers=None)
        self.total = len(self._numbers)
        self.done = 0
        self._thread: Optional[threading.Thread] = None
        self._failure: Optional[BaseException] = None

    def _feed(self) -> Iterator[Array]:
        """The frames for the replay, of which one waits at a time."""
        while self._waiting:
            yield self._waiting.pop()

    def _look(self) -> None:
        """Looks at the frame that waits, on a thread of its own."""
        try:
            found = next(self._replay)
            number = self._numbers[found.number]
            answer = found.intersections
            depths = self.findings.request.depths
            self.findings.frames[number] = FoundFrame(
                number, answer.pairs, self.findings.parts.labels[answer.triangles], answer.kind,
                len(found.contacts), answer.depth if depths else None,
                [curve.points for curve in answer.curves if not curve.touching] if depths else [],
                self._hidden(answer), len(answer.collapsed) == answer.mesh.component_count > 0)
        except BaseException as problem:
            self._failure = problem

    def _hidden(self, answer: Any) -> Tuple[str, ...]:
        """The names of the parts that have no surface in a frame."""
        if len(answer.collapsed) == 0:
            return ()
        labels = self.findings.parts.labels
        seen = set(labels[~np.isin(answer.mesh.triangle_components, answer.collapsed)].tolist())
        return tuple(name for part, name in enumerate(self.findings.parts.names)
                     if part not in seen and (labels == part).any())

    def step(self, patience: float = 0.05) -> bool:
        """Goes on for about ``patience`` seconds; returns whether there is more to do."""
        if self._thread is None:
            try:
                positions = next(self._positions, None)
            except BaseException:
                self.cancel()
                raise
            if positions is None:
                self._finish()
                return False
            self._waiting.append(positions)
            self._thread = threading.Thread(target=self._look, daemon=True)
            self._thread.start()
        self._thread.join(patience)
        if not self._thread.is_alive():
            self._thread = None
            self.done += 1
            if self._failure is not None:
                self.cancel()
                raise SceneError(str(self._failure)) from self._failure
        return True

    def cancel(self) -> None:
        """Ends the run; the scene is at its own frame again."""
        while self._thread is not None and self._thread.is_alive():
            self._replay.cancel()
            self._thread.join(0.02)
        self._thread = None
        self._kept.restore()

    def _finish(self) -> None:
        self._kept.restore()
        next(self._replay, None)  # there is no frame left: the last events end
        events = self._replay.events
        kinds = events.kind_names()
        self.findings.events = [self._event(events[i], kinds[i]) for i in events.worst_first()]

    def _event(self, event: Any, kinds: Tuple[str, ...]) -> FoundEvent:
        names = self.findings.parts.names
        a, b = (names[part] if 0 <= part < len(names) else "(no part)" for part in (int(event.a), int(event.b)))
        place = None if np.isnan(event.x).any() else tuple(float(x) for x in event.x)
        return FoundEvent(a, b, *(self._numbers[int(frame)] for frame in (event.first_frame, event.last_frame,
                                                                          event.worst_frame)),
                          kinds, int(event.pairs), int(event.contacts), float(event.depth), place)


def _ignored_pairs(parts: Parts, ignored: Sequence[Tuple[str, str]]) -> List[Tuple[int, int]]:
    """Names of pairs as numbers of parts."""
    return [(a, b) for first, second in ignored for a in parts.find(first) for b in parts.find(second)]


def run_to_end(context: Any, request: Request) -> Findings:
    """A whole run at once."""
    run = Run(context, request)
    try:
        while run.step(3600.0):
            pass
    except BaseException:
        run.cancel()
        raise
    return run.findings
