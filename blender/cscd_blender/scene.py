"""Reads what is to be checked out of a Blender scene: evaluated meshes in world space, and their parts.

Faces keep Blender's own numbers: those of the polygons of the evaluated mesh.
"""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import bpy
import numpy as np

import cscd

Array = Any

#: What Blender evaluates to a mesh.
MESH_TYPES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}

#: How the names of marks begin that the extension adds to a scene; a check does not look at them.
MARK_PREFIX = "cscd "


class SceneError(Exception):
    """Why a scene cannot be checked, as a sentence for the user."""


class Polygons(NamedTuple):
    """The faces of an object, at one frame."""

    #: (n, 3) float64, in world space.
    positions: Array
    #: (c,) the vertices of all faces, one face after the other.
    corners: Array
    #: (m,) how many corners each face has.
    counts: Array


class Target(NamedTuple):
    """An object that is checked."""

    #: The name of the object in Blender.
    name: str
    vertex_count: int
    face_count: int
    #: The first of its faces in the numbers of the checked mesh.
    first_face: int
    first_vertex: int


def objects_by_name(view_layer: Any) -> Dict[str, Any]:
    """The objects of a view layer by their names. Of several with one name, those of other files go by their full names."""
    found: Dict[str, Any] = {}
    for thing in view_layer.objects:
        found.setdefault(thing.name, thing)
    found.update((thing.name_full, thing) for thing in view_layer.objects)
    return found


def objects_of(view_layer: Any, names: Sequence[str] = (), collections: Sequence[str] = ()) -> List[Any]:
    """The objects that are named, or lie in a named collection, in the order of the scene; without names all visible ones."""
    by_name = objects_by_name(view_layer)
    wanted = set()
    for name in names:
        if name not in by_name:
            raise SceneError(f"there is no object {name!r} in the view layer {view_layer.name!r}")
        wanted.add(by_name[name].name_full)
    for name in collections:
        if name not in bpy.data.collections:
            raise SceneError(f"there is no collection {name!r}")
        wanted.update(thing.name_full for thing in bpy.data.collections[name].all_objects)
    candidates = [thing for thing in view_layer.objects
                  if thing.type in MESH_TYPES and not thing.name.startswith(MARK_PREFIX)]
    if names or collections:
        return [thing for thing in candidates if thing.name_full in wanted]
    return [thing for thing in candidates if thing.visible_get(view_layer=view_layer)]


def read_polygons(thing: Any, depsgraph: Any) -> Polygons:
    """The evaluated mesh of an object, with modifiers, shape keys and simulations, in world space.

    Where the object's matrix mirrors, faces are turned over, so that their normals stay outside; Blender's exporters do
    the same.
    """
    evaluated = thing.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        positions = np.empty(3 * len(mesh.vertices), np.float32)
        corners = np.empty(len(mesh.loops), np.int32)
        counts = np.empty(len(mesh.polygons), np.int32)
        mesh.vertices.foreach_get("co", positions)
        mesh.loops.foreach_get("vertex_index", corners)
        mesh.polygons.foreach_get("loop_total", counts)
    finally:
        evaluated.to_mesh_clear()
    matrix = np.array(evaluated.matrix_world, np.float64)
    world = positions.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    if not np.isfinite(world).all():
        vertex = int(np.flatnonzero(~np.isfinite(world).all(axis=1))[0])
        place = ", ".join(f"{x:g}" for x in world[vertex])
        raise SceneError(f"{thing.name}: vertex {vertex} is at ({place}) at frame {depsgraph.scene.frame_current}; look at "
                         "its shape keys, drivers and simulation")
    if np.linalg.det(matrix[:3, :3]) < 0.0:
        corners = _turned(corners, counts)
    return Polygons(world, corners, counts)


def _turned(corners: Array, counts: Array) -> Array:
    """Each face the other way around, from the same corner on."""
    ends = np.cumsum(counts)
    starts = ends - counts
    places = np.arange(len(corners)) - np.repeat(starts, counts)
    sizes = np.repeat(counts, counts)
    return corners[np.repeat(starts, counts) + (sizes - places) % sizes]


class CheckedScene:
    """Objects as one mesh of the module, and their positions frame by frame.

    Attributes
    ----------
    mesh : cscd.Scene
    targets : list of Target
    """

    def __init__(self, things: Sequence[Any], view_layer: Any, depsgraph: Any) -> None:
        by_name = objects_by_name(view_layer)
        self._things = [thing.name if by_name[thing.name] == thing else thing.name_full for thing in things]
        polygons = [read_polygons(thing, depsgraph) for thing in things]
        kept = [(name, item) for name, item in zip(self._things, polygons) if len(item.counts)]
        if not kept:
            raise SceneError("there is nothing to check: none of the objects has faces; objects that the view layer excludes "
                             "are not among them")
        self._things = [name for name, _ in kept]
        self._counts = [item.counts for _, item in kept]
        self._corners = [item.corners for _, item in kept]
        self.targets: List[Target] = []
        first_face = first_vertex = 0
        for name, item in kept:
            self.targets.append(Target(name, len(item.positions), len(item.counts), first_face, first_vertex))
            first_face += len(item.counts)
            first_vertex += len(item.positions)
        meshes = [cscd.Mesh.from_polygons(item.positions, item.corners, item.counts) for _, item in kept]
        for name, mesh in zip(self._things, meshes):
            if mesh.triangle_count == 0:
                raise SceneError(f"{name} has no face with three different corners; leave it out")
        self.mesh = cscd.Scene(meshes)

    def read(self, view_layer: Any, depsgraph: Any) -> Array:
        """The positions of all vertices at the frame that the dependency graph has: (n, 3) float64."""
        parts = []
        by_name = objects_by_name(view_layer)
        for i, name in enumerate(self._things):
            thing = by_name.get(name)
            if thing is None:
                raise SceneError(f"{name} is no longer in the view layer")
            item = read_polygons(thing, depsgraph)
            if not (np.array_equal(item.counts, self._counts[i]) and np.array_equal(item.corners, self._corners[i])):
                raise SceneError(f"{name} has other faces than in the first frame ({len(item.counts)} instead of "
                                 f"{len(self._counts[i])}); apply or switch off the modifier that changes them, or leave "
                                 "the object out")
            parts.append(item.positions)
        return np.concatenate(parts)

    def place_of(self, face: int) -> Tuple[str, int]:
        """The object of a face, and Blender's number of it there."""
        target = self.targets[self.object_of(face)]
        return target.name, face - target.first_face

    def object_of(self, face: int) -> int:
        """Which target has a face."""
        firsts = [target.first_face for target in self.targets]
        return int(np.searchsorted(firsts, face, side="right")) - 1


# ---- parts ---------------------------------------------------------------------------------------------------


class Parts(NamedTuple):
    """The part of each triangle, and what the parts are called."""

    labels: Array
    names: List[str]

    def find(self, name: str) -> List[int]:
        """The parts of that name, and those below it: OBJECT stands for all of OBJECT/GROUP."""
        found = [i for i, part in enumerate(self.names) if part == name or part.startswith(name + "/")]
        if not found:
            raise SceneError(f"there is no part {name!r}; there are {', '.join(self.names[:12])}"
                             f"{', ...' if len(self.names) > 12 else ''}")
        return found


def _dominant_groups(thing: Any, depsgraph: Any) -> Tuple[Array, List[str]]:
    """The vertex group with the largest weight of each vertex, -1 without one, and the names of groups.

    Where bones deform the object, only groups of bones count, as they say which limb a vertex belongs to.
    """
    names = [group.name for group in thing.vertex_groups]
    bones = {bone.name for modifier in thing.modifiers if modifier.type == "ARMATURE" and modifier.object is not None
             for bone in modifier.object.data.bones if bone.use_deform}
    counted = [name in bones if bones else not name.startswith(MARK_PREFIX) for name in names]
    evaluated = thing.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        groups = np.full(len(mesh.vertices), -1, np.int64)
        for i, vertex in enumerate(mesh.vertices):
            weights = [(entry.weight, -entry.group) for entry in vertex.groups
                       if entry.group < len(names) and counted[entry.group] and entry.weight > 0.0]
            if weights:
                groups[i] = -max(weights)[1]
    finally:
        evaluated.to_mesh_clear()
    return groups, names


def _of_triangles(triangles: Array, of_vertices: Array) -> Array:
    """The label that most corners of a triangle have; of equally many that of its first corner."""
    a, b, c = (of_vertices[triangles[:, i]] for i in range(3))
    return np.where(b == c, b, a)


def parts_of(checked: CheckedScene, view_layer: Any, depsgraph: Any, by_groups: bool = True) -> Parts:
    """Parts by vertex group, as OBJECT/GROUP, of objects that have some; else an object is one part."""
    labels = np.empty(checked.mesh.triangle_count, np.int64)
    names: List[str] = []
    of_objects = checked.mesh.triangle_objects
    by_name = objects_by_name(view_layer)
    for i, target in enumerate(checked.targets):
        triangles = np.flatnonzero(of_objects == i)
        thing = by_name[target.name]
        groups, group_names = _dominant_groups(thing, depsgraph) if by_groups and thing.type == "MESH" else (None, [])
        if groups is None or not np.any(groups >= 0):
            labels[triangles] = len(names)
            names.append(target.name)
            continue
        own = checked.mesh.triangles[triangles] - target.first_vertex
        found = _of_triangles(own, groups)
        used = {group: len(names) + place for place, group in enumerate(sorted(set(found.tolist())))}
        names += [f"{target.name}/{group_names[group]}" if group >= 0 else f"{target.name}/(no group)"
                  for group in sorted(used)]
        labels[triangles] = [used[group] for group in found.tolist()]
    return Parts(labels, names)


def has_instances(depsgraph: Any) -> bool:
    """Whether the scene shows instances, of collections, particles or geometry nodes, which are not checked."""
    return any(instance.is_instance for instance in depsgraph.object_instances)


def frames_of(scene: Any, first: Optional[int], last: Optional[int], step: int = 1) -> range:
    """The frames to check; by default those of the scene."""
    begin = scene.frame_start if first is None else first
    end = scene.frame_end if last is None else last
    if end < begin:
        raise SceneError(f"there are no frames from {begin} to {end}")
    return range(begin, end + 1, max(step, 1))


class KeptFrame:
    """The frame that a scene is at, to go back to. It knows the scene by its name, as undo makes another one of it."""

    def __init__(self, scene: Any) -> None:
        self._scene_name = scene.name
        self._frame, self._subframe = scene.frame_current, scene.frame_subframe

    def restore(self) -> None:
        """Goes back."""
        scene = bpy.data.scenes.get(self._scene_name)
        if scene is not None:
            scene.frame_set(self._frame, subframe=self._subframe)


def read_frames(scene: Any, checked: CheckedScene, view_layer: Any, frames: Sequence[int]) -> Iterator[Array]:
    """The positions of each frame, to which the scene goes.

    The user may undo or remove something between two frames, so that the scene is looked up for each.
    """
    scene_name, layer_name = scene.name, view_layer.name
    for frame in frames:
        there = bpy.data.scenes.get(scene_name)
        layer = None if there is None else there.view_layers.get(layer_name)
        if layer is None:
            raise SceneError(f"the scene {scene_name!r} or its view layer {layer_name!r} is no longer there")
        there.frame_set(frame)
        yield checked.read(layer, layer.depsgraph)
