"""Untangles an object: reads frames, leads its vertices out of what they cross, and keeps the result in shape keys.

A shape key lies below the modifiers, and the surface is to be clean above them. Armatures move a vertex by a linear map that
depends on the frame alone, so that three small shifts of the shape tell the map, and its inverse the way back.
"""

from __future__ import annotations

import threading
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import bpy
import numpy as np

import cscd

from .checking import Request
from .scene import MARK_PREFIX, CheckedScene, KeptFrame, SceneError, objects_by_name, objects_of, read_polygons
from .sentences import say_untangled

Array = Any

#: How the names of shape keys begin.
KEY_NAME = f"{MARK_PREFIX}untangled"

#: Surfaces keep this part of the scene's size at least, so that nothing touches when Blender rounds to floats.
_LEAST_GAP = 4e-6
#: A shift that tells the map of the modifiers, as a part of the object's size.
_SHIFT = 0.02


class UntangleRequest(NamedTuple):
    """What is to be untangled."""

    #: The object whose vertices move.
    name: str
    #: The objects beside it, which stay.
    beside: Request
    #: The frames, one or several that follow each other.
    frames: Tuple[int, ...]
    gap: float = 0.0
    #: A vertex group whose vertices stay, the more the larger their weights; "" for none.
    pin_group: str = ""
    steady: float = 0.0
    threads: int = 0


class Untangled(NamedTuple):
    """What has become of it."""

    sentence: str
    #: All frames are clean as Blender shows them.
    clean: bool
    #: Names of shape keys that were added, by frame.
    keys: Dict[int, str]


def _check_object(thing: Any) -> None:
    """An object that can have shape keys which move it alone."""
    name = thing.name
    if thing.type != "MESH":
        raise SceneError(f"{name} is not a mesh object: only these have shape keys")
    if thing.library is not None or thing.data.library is not None:
        raise SceneError(f"{name} is linked from another file; make it local first")
    if thing.data.users > 1:
        raise SceneError(f"{name} shares its mesh with other objects, which would move, too; make it single-user first "
                         "(Object > Relations)")
    keys = thing.data.shape_keys
    if keys is not None and not keys.use_relative:
        raise SceneError(f"{name} has absolute shape keys; its keys must be relative")
    if thing.show_only_shape_key:
        raise SceneError(f"{name} shows one shape key alone; switch that off (the pin below its shape keys)")


def _local_positions(thing: Any) -> Array:
    """The vertices of the basis: (n, 3)."""
    keys = thing.data.shape_keys
    source = thing.data.vertices if keys is None else keys.reference_key.data
    positions = np.empty(3 * len(thing.data.vertices), np.float32)
    source.foreach_get("co", positions)
    return positions.reshape(-1, 3)


def _add_key(thing: Any, name: str, positions: Array) -> Any:
    """A shape key with these vertices, at the value 1. The first key of an object needs one that it is relative to."""
    if thing.data.shape_keys is None:
        thing.shape_key_add(name="Basis", from_mix=False)
    key = thing.shape_key_add(name=name, from_mix=False)
    key.relative_key = thing.data.shape_keys.reference_key
    key.data.foreach_set("co", np.ascontiguousarray(positions, np.float32).ravel())
    key.value = 1.0
    return key


class _Probe:
    """Finds how the modifiers and the matrix of an object move its vertices, in the frame at hand."""

    def __init__(self, thing: Any, view_layer: Any) -> None:
        self._thing, self._view_layer = thing, view_layer
        self._rest = _local_positions(thing)
        size = float(np.ptp(self._rest, axis=0).max()) if len(self._rest) else 0.0
        self._shift = _SHIFT * size if size > 0.0 else 1.0

    def _shown(self) -> Array:
        self._view_layer.update()
        return read_polygons(self._thing, self._view_layer.depsgraph).positions

    def maps(self) -> Array:
        """(n, 3, 3): what a shift of the shape does to each vertex in world space."""
        had_keys = self._thing.data.shape_keys is not None
        index = self._thing.active_shape_key_index
        before = self._shown()
        maps = np.empty((len(before), 3, 3))
        key = _add_key(self._thing, f"{KEY_NAME} probe", self._rest)
        try:
            for axis in range(3):
                shifted = self._rest.copy()
                shifted[:, axis] += self._shift
                key.data.foreach_set("co", shifted.ravel())
                self._thing.data.update()
                maps[:, :, axis] = (self._shown() - before) / self._shift
        finally:
            self._thing.shape_key_remove(key)
            if not had_keys:
                self._thing.shape_key_clear()
            self._thing.active_shape_key_index = index
            self._view_layer.update()
        return maps


def _stiffness(thing: Any, group_name: str, vertex_count: int, count: int) -> Array:
    """How strongly each vertex of the scene is drawn to its place: the object's own come first, all others stay."""
    weights = np.full(count, np.inf)
    weights[:vertex_count] = 1.0
    if not group_name:
        return weights
    group = thing.vertex_groups.get(group_name)
    if group is None:
        raise SceneError(f"{thing.name} has no vertex group {group_name!r}")
    for i, vertex in enumerate(thing.data.vertices):
        weight = max((entry.weight for entry in vertex.groups if entry.group == group.index), default=0.0)
        weights[i] = np.inf if weight >= 1.0 else 1.0 / (1.0 - weight)
    if not np.isfinite(weights[:vertex_count]).any():
        raise SceneError(f"every vertex of {thing.name} is pinned by {group_name!r}, so nothing could be moved")
    return weights


def _follow(frames: Sequence[Array], mesh: Any, **options: Any) -> List[Any]:
    """All frames, forwards, and those before the first clean one once more backwards from it."""
    results = list(cscd.untangle_frames(frames, mesh, **options))
    first = next((i for i, found in enumerate(results) if found.clean), 0)
    if first > 0:
        back = list(cscd.untangle_frames(list(frames[first::-1]), mesh, **options))
        for i, found in zip(range(first, -1, -1), back):
            if i < first and found.clean:
                results[i] = found
    return results


def _without_gap(found: Any) -> Any:
    """What is said where nobody asked for a gap: the least one is for the rounding alone."""
    return found._replace(near_before=0, near_after=0, clean=found.pairs_after == 0)


class UntangleRun:
    """Untangling in steps: each reads a frame in Blender's own thread, and another thread does the work.

    Call ``step`` until it returns false; ``cancel`` ends it early, and nothing is left behind.
    """

    def __init__(self, context: Any, request: UntangleRequest) -> None:
        self.request = request
        self.result: Optional[Untangled] = None
        self._scene_name, self._layer_name = context.scene.name, context.view_layer.name
        self._kept = KeptFrame(context.scene)
        try:
            self._begin(context)
        except BaseException:
            self._kept.restore()
            raise

    def _begin(self, context: Any) -> None:
        scene, layer, request = context.scene, context.view_layer, self.request
        scene.frame_set(request.frames[0])
        thing = self._thing(layer)
        _check_object(thing)
        others = [other for other in objects_of(layer, request.beside.objects, request.beside.collections) if other != thing]
        self._checked = CheckedScene([thing, *others], layer, layer.depsgraph)
        own = self._checked.targets[0]
        if own.name not in (thing.name, thing.name_full):
            raise SceneError(f"{thing.name} has no faces")
        if own.vertex_count != len(thing.data.vertices):
            raise SceneError(f"a modifier of {thing.name} makes {own.vertex_count} vertices of "
                             f"{len(thing.data.vertices)}: switch it off, or apply it")
        self._own_count = own.vertex_count
        self._weights = _stiffness(thing, request.pin_group, self._own_count, self._checked.mesh.vertex_count)
        self._probe = _Probe(thing, layer)
        self._frames: List[Array] = []
        self._maps: List[Array] = []
        self._results: List[Any] = []
        self._thread: Optional[threading.Thread] = None
        self._failure: Optional[BaseException] = None
        self._stop = False
        self.total = len(request.frames)

    @property
    def done(self) -> int:
        """Frames that were read."""
        return len(self._frames)

    def _thing(self, layer: Any) -> Any:
        thing = objects_by_name(layer).get(self.request.name)
        if thing is None:
            raise SceneError(f"{self.request.name} is no longer in the view layer")
        return thing

    def _scene(self) -> Tuple[Any, Any]:
        scene = bpy.data.scenes.get(self._scene_name)
        layer = None if scene is None else scene.view_layers.get(self._layer_name)
        if layer is None:
            raise SceneError(f"the scene {self._scene_name!r} or its view layer is no longer there")
        return scene, layer

    def _read(self, number: int) -> None:
        scene, layer = self._scene()
        scene.frame_set(number)
        self._frames.append(self._checked.read(layer, layer.depsgraph))
        self._maps.append(self._probe.maps())

    def _goes_on(self, *_: Any) -> None:
        if self._stop:
            raise KeyboardInterrupt

    def _work(self) -> None:
        """Untangles all frames, on a thread of its own."""
        try:
            size = float(np.ptp(self._frames[0], axis=0).max())
            gap = max(self.request.gap, _LEAST_GAP * size)
            self._results = _follow(self._frames, self._checked.mesh, gap=gap, weights=self._weights, steady=self.request.steady,
                                    threads=self.request.threads, progress=self._goes_on)
        except BaseException as problem:
            self._failure = problem

    def step(self, patience: float = 0.05) -> bool:
        """Goes on for about ``patience`` seconds; returns whether there is more to do."""
        try:
            if self._thread is None and self.done < self.total:
                self._read(self.request.frames[self.done])
                return True
            if self._thread is None:
                self._kept.restore()
                self._thread = threading.Thread(target=self._work, daemon=True)
                self._thread.start()
            self._thread.join(patience)
            if self._thread.is_alive():
                return True
            if self._failure is not None:
                raise SceneError(str(self._failure)) from self._failure
            self._finish()
        except BaseException:
            self.cancel()
            raise
        return False

    def cancel(self) -> None:
        """Ends the run; the scene is at its own frame again."""
        self._stop = True
        if self._thread is not None:
            self._thread.join()
        self._kept.restore()

    def _finish(self) -> None:
        scene, layer = self._scene()
        thing = self._thing(layer)
        keys = self._add_keys(thing)
        seen = dict(self._look(scene, layer))
        self._kept.restore()
        results = self._results if self.request.gap > 0.0 else [_without_gap(found) for found in self._results]
        sentence = say_untangled(self.request.frames, results)
        crossing = [number for number, pairs in seen.items() if pairs > 0]
        if crossing and all(found.clean for found in results):
            sentence += (f" In Blender {sum(seen.values())} pairs of triangles still cross or touch, first in frame "
                         f"{crossing[0]}: a modifier undoes a part of it, or rounding; take a larger gap.")
        self.result = Untangled(sentence, not crossing, keys)

    def _add_keys(self, thing: Any) -> Dict[int, str]:
        """A key for each frame in which something moved; of several frames each is there in its own alone."""
        rest = _local_positions(thing)
        keys = {}
        for number, frame, maps, found in zip(self.request.frames, self._frames, self._maps, self._results):
            if not found.moved:
                continue
            shift = found.vertices[:self._own_count] - frame[:self._own_count]
            moved = (shift != 0.0).any(axis=1)
            local = np.zeros_like(shift)
            local[moved] = np.einsum("vij,vj->vi", np.linalg.pinv(maps[moved]), shift[moved])
            several = self.total > 1
            key = _add_key(thing, f"{KEY_NAME} {number}", rest + local)
            if several:
                for place, value in ((number - 1, 0.0), (number, 1.0), (number + 1, 0.0)):
                    key.value = value
                    key.keyframe_insert("value", frame=place)
            keys[number] = key.name
        if self.total > 1 and keys:
            for curve in thing.data.shape_keys.animation_data.action.fcurves:
                if any(curve.data_path == f'key_blocks["{name}"].value' for name in keys.values()):
                    for point in curve.keyframe_points:
                        point.interpolation = "LINEAR"
        return keys

    def _look(self, scene: Any, layer: Any) -> Iterator[Tuple[int, int]]:
        """How many pairs cross or touch in each frame, as Blender shows it now."""
        for number in self.request.frames:
            scene.frame_set(number)
            layer.update()
            yield number, len(cscd.self_intersections(self._checked.read(layer, layer.depsgraph), self._checked.mesh))


def untangle_to_end(context: Any, request: UntangleRequest) -> Untangled:
    """A whole run at once."""
    run = UntangleRun(context, request)
    while run.step(3600.0):
        pass
    assert run.result is not None
    return run.result
