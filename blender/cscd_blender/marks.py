"""Findings back in the scene: selection and view, timeline markers, attributes, groups, colours, curves; and all of it gone.

Everything that is added has a name that begins with ``cscd``, by which ``clear`` finds it.
"""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, Tuple

import bpy
import numpy as np
from mathutils import Vector

from .checking import KINDS, Findings
from .properties import findings_of
from .scene import MARK_PREFIX, SceneError, objects_by_name

Array = Any

KIND_ATTRIBUTE, DEPTH_ATTRIBUTE, MATERIAL_ATTRIBUTE = "cscd_kind", "cscd_depth", "cscd_material_before"
GROUP = "cscd intersecting"

#: The material slot, as remembered, of faces of a mesh that had none.
_NO_SLOT = -1
CURVES = "cscd curves"

#: What a face has: the worst of its kinds, and crossing faces by thirds of the greatest depth.
COLOURS: Tuple[Tuple[str, Tuple[float, float, float, float]], ...] = (
    ("cscd touching", (0.95, 0.85, 0.2, 1.0)),
    ("cscd sharing area", (0.6, 0.3, 0.8, 1.0)),
    ("cscd crossing", (1.0, 0.6, 0.3, 1.0)),
    ("cscd crossing, deeper", (0.95, 0.25, 0.1, 1.0)),
    ("cscd crossing, deepest", (0.5, 0.0, 0.05, 1.0)),
)
_TOUCHING, _SHARING, _CROSSING = 0, 1, 2
_LEVEL_OF_KIND = {"touching": _TOUCHING, "duplicate": _SHARING, "coplanar": _SHARING, "folded": _SHARING,
                  "crossing": _CROSSING}


def marked_meshes(findings: Findings, view_layer: Any) -> Iterator[Tuple[Any, Any]]:
    """The targets and objects whose own faces are those of their evaluated meshes, so that they can carry marks."""
    by_name = objects_by_name(view_layer)
    for target in findings.checked.targets:
        thing = by_name.get(target.name)
        if thing is not None and thing.type == "MESH" and len(thing.data.polygons) == target.face_count \
                and len(thing.data.vertices) == target.vertex_count and thing.library is None and thing.data.library is None:
            yield target, thing


def unmarked_names(findings: Findings, view_layer: Any) -> List[str]:
    """The objects that cannot carry marks: their modifiers make other faces, or they belong to other files."""
    marked = {target.name for target, _ in marked_meshes(findings, view_layer)}
    return [target.name for target in findings.checked.targets if target.name not in marked]


# ---- an event in the view --------------------------------------------------------------------------------------


def select_faces(findings: Findings, view_layer: Any, faces: Array) -> None:
    """Selects these faces, of the checked mesh, and the objects that have them; nothing else is selected."""
    for thing in view_layer.objects:
        thing.select_set(False)
    for target, thing in marked_meshes(findings, view_layer):
        chosen = np.zeros(target.face_count, bool)
        own = faces - target.first_face
        chosen[own[(own >= 0) & (own < target.face_count)]] = True
        _select_in_mesh(thing.data, chosen)
    by_name = objects_by_name(view_layer)
    for target in findings.checked.targets:
        inside = (faces >= target.first_face) & (faces < target.first_face + target.face_count)
        thing = by_name.get(target.name)
        if thing is not None and inside.any():
            thing.select_set(True)
            view_layer.objects.active = thing


def _select_in_mesh(mesh: Any, chosen: Array) -> None:
    corners = np.empty(len(mesh.loops), np.int32)
    counts = np.empty(len(mesh.polygons), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    mesh.polygons.foreach_get("loop_total", counts)
    vertices = np.zeros(len(mesh.vertices), bool)
    vertices[corners[np.repeat(chosen, counts)]] = True
    mesh.vertices.foreach_set("select", vertices)
    mesh.edges.foreach_set("select", np.zeros(len(mesh.edges), bool))
    mesh.polygons.foreach_set("select", chosen)
    mesh.update()


def frame_view(context: Any, place: Vector, size: float) -> None:
    """Turns the 3D views to a place, so near that ``size`` fills about a third of them."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                region = area.spaces.active.region_3d
                if region.view_perspective == "CAMERA":
                    region.view_perspective = "PERSP"
                region.view_location = place
                region.view_distance = max(3.0 * size, 10.0 * area.spaces.active.clip_start)


def show_event(context: Any, event: Any) -> None:
    """Goes to the worst frame of an event, frames it, and selects its faces."""
    scene, view_layer = context.scene, context.view_layer
    if context.mode != "OBJECT" and context.active_object is not None:
        bpy.ops.object.mode_set(mode="OBJECT")
    scene.frame_set(event.worst)
    findings = findings_of(scene)
    size = 0.0
    if findings is not None:
        faces = findings.faces_in(event.worst, event.a, event.b)
        select_faces(findings, view_layer, faces)
        size = _size_of(findings, view_layer, faces)
    if event.has_place:
        frame_view(context, Vector(event.place), max(size, 2.0 * event.depth))


def _size_of(findings: Findings, view_layer: Any, faces: Array) -> float:
    """The longest side of the box around faces."""
    mesh = findings.checked.mesh
    triangles = np.isin(mesh.triangle_face, faces)
    if not triangles.any():
        return 0.0
    try:
        points = findings.checked.read(view_layer, view_layer.depsgraph)[mesh.triangles[triangles].ravel()]
    except SceneError:  # the scene has changed since the check
        return 0.0
    return float((points.max(axis=0) - points.min(axis=0)).max())


# ---- marks -----------------------------------------------------------------------------------------------------


def add_timeline_markers(scene: Any) -> int:
    """A marker where each event of the list is worst; returns how many there are."""
    remove_timeline_markers(scene)
    for event in scene.cscd.events:
        scene.timeline_markers.new(f"{MARK_PREFIX}{event.name}"[:63], frame=event.worst)
    return len(scene.cscd.events)


def remove_timeline_markers(scene: Any) -> None:
    for marker in [marker for marker in scene.timeline_markers if marker.name.startswith(MARK_PREFIX)]:
        scene.timeline_markers.remove(marker)


def levels_of_faces(findings: Findings) -> Array:
    """Per face of the checked mesh: its place in ``COLOURS``, the worst over all frames; -1: no pair has it."""
    levels = np.full(findings.checked.mesh.face_count, -1)
    level_of_kind = np.array([_LEVEL_OF_KIND.get(name, _TOUCHING) for name in KINDS])
    for found in findings.frames.values():
        np.maximum.at(levels, found.faces.ravel(), np.repeat(level_of_kind[found.kinds], 2))
    depths = depths_of_faces(findings)
    deepest = float(depths.max(initial=0.0))
    if deepest > 0.0:
        thirds = np.minimum((3.0 * depths / deepest).astype(int), 2)
        levels = np.where(levels == _CROSSING, _CROSSING + thirds, levels)
    return levels


def depths_of_vertices(findings: Findings) -> Array:
    """The greatest depth of each vertex over all frames."""
    depths = np.zeros(findings.checked.mesh.vertex_count)
    for found in findings.frames.values():
        if found.depth is not None:
            np.maximum(depths, found.depth, out=depths)
    return depths


def depths_of_faces(findings: Findings) -> Array:
    """The greatest depth of a corner of each face over all frames."""
    mesh = findings.checked.mesh
    depths = np.zeros(mesh.face_count)
    np.maximum.at(depths, mesh.triangle_face, depths_of_vertices(findings)[mesh.triangles].max(axis=1))
    return depths


def _parts_of_objects(findings: Findings, view_layer: Any) -> Iterator[Tuple[Any, Array, Array]]:
    """Each markable object with the levels of its faces and the depths of its vertices.

    Objects that share a mesh have its marks in common: the first of them comes, with the worst of all.
    """
    levels, depths = levels_of_faces(findings), depths_of_vertices(findings)
    found: Dict[str, Tuple[Any, Array, Array]] = {}
    for target, thing in marked_meshes(findings, view_layer):
        own = levels[target.first_face: target.first_face + target.face_count]
        deep = depths[target.first_vertex: target.first_vertex + target.vertex_count]
        first, worst, deepest = found.get(thing.data.name, (thing, own, deep))
        found[thing.data.name] = first, np.maximum(worst, own), np.maximum(deepest, deep)
    yield from found.values()


def add_attributes(findings: Findings, view_layer: Any) -> int:
    """Face attribute ``cscd_kind`` (0: none, then as in ``COLOURS``) and vertex attribute ``cscd_depth``."""
    count = 0
    for thing, levels, depths in _parts_of_objects(findings, view_layer):
        _set_attribute(thing.data, KIND_ATTRIBUTE, "INT", "FACE", (levels + 1).astype(np.int32))
        _set_attribute(thing.data, DEPTH_ATTRIBUTE, "FLOAT", "POINT", depths.astype(np.float32))
        count += 1
    return count


def _set_attribute(mesh: Any, name: str, kind: str, domain: str, values: Array) -> None:
    if name in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[name])
    mesh.attributes.new(name, kind, domain).data.foreach_set("value", values)


def add_groups(findings: Findings, view_layer: Any) -> int:
    """A vertex group of the vertices whose faces are in a pair; its weights are depths as a share of the greatest."""
    deepest = float(depths_of_vertices(findings).max(initial=0.0))
    count = 0
    for thing, levels, depths in _parts_of_objects(findings, view_layer):
        _remove_group(thing)
        corners = np.empty(len(thing.data.loops), np.int32)
        counts = np.empty(len(thing.data.polygons), np.int32)
        thing.data.loops.foreach_get("vertex_index", corners)
        thing.data.polygons.foreach_get("loop_total", counts)
        marked = np.union1d(corners[np.repeat(levels >= 0, counts)], np.flatnonzero(depths > 0.0))
        if len(marked) == 0:
            continue
        group = thing.vertex_groups.new(name=GROUP)
        for vertex in marked.tolist():
            group.add([vertex], max(float(depths[vertex]) / deepest, 0.01) if deepest > 0.0 else 1.0, "REPLACE")
        count += 1
    return count


def _remove_group(thing: Any) -> None:
    group = thing.vertex_groups.get(GROUP)
    if group is not None:
        thing.vertex_groups.remove(group)


def _material(name: str, colour: Tuple[float, float, float, float]) -> Any:
    material = bpy.data.materials.get(name) or bpy.data.materials.new(name)
    material.diffuse_color = colour
    material.use_nodes = True
    for node in material.node_tree.nodes:
        if node.type == "BSDF_PRINCIPLED":
            node.inputs["Base Color"].default_value = colour
    return material


def add_materials(findings: Findings, view_layer: Any) -> int:
    """Materials by kind and depth on the faces that are in a pair. What a face had is remembered, for ``clear``."""
    count = 0
    for thing, levels, _ in _parts_of_objects(findings, view_layer):
        restore_materials(thing)
        if not (levels >= 0).any():
            continue
        mesh = thing.data
        before = np.empty(len(mesh.polygons), np.int32)
        mesh.polygons.foreach_get("material_index", before)
        if not mesh.materials:
            mesh.materials.append(None)  # what faces without a material have
            before[:] = _NO_SLOT
        slots: Dict[int, int] = {}
        for level in sorted(set(levels[levels >= 0].tolist())):
            slots[level] = len(mesh.materials)
            mesh.materials.append(_material(*COLOURS[level]))
        _set_attribute(mesh, MATERIAL_ATTRIBUTE, "INT", "FACE", before)
        mesh.polygons.foreach_set("material_index", [slots.get(level, max(old, 0)) for level, old in
                                                     zip(levels.tolist(), before.tolist())])
        mesh.update()
        count += 1
    return count


def restore_materials(thing: Any) -> None:
    """Gives faces the materials back that they had."""
    mesh = thing.data
    attribute = mesh.attributes.get(MATERIAL_ATTRIBUTE)
    if attribute is None:
        return
    before = np.empty(len(mesh.polygons), np.int32)
    attribute.data.foreach_get("value", before)
    mesh.polygons.foreach_set("material_index", np.maximum(before, 0))
    mesh.attributes.remove(mesh.attributes[MATERIAL_ATTRIBUTE])
    names = {name for name, _ in COLOURS}
    for slot in reversed(range(len(mesh.materials))):
        if mesh.materials[slot] is not None and mesh.materials[slot].name in names:
            mesh.materials.pop(index=slot)
    if (before == _NO_SLOT).any() and len(mesh.materials) == 1 and mesh.materials[0] is None:
        mesh.materials.clear()
    mesh.update()


def add_curves(findings: Findings, scene: Any, frame: int) -> int:
    """The curves along which surfaces cross in a frame, as one object; returns how many there are."""
    remove_curves()
    found = findings.frames.get(frame)
    if found is None or not found.curves:
        return 0
    data = bpy.data.curves.new(CURVES, "CURVE")
    data.dimensions = "3D"
    for points in found.curves:
        spline = data.splines.new("POLY")
        spline.points.add(len(points) - 1)
        spline.points.foreach_set("co", np.column_stack([points, np.ones(len(points))]).astype(np.float32).ravel())
    thing = bpy.data.objects.new(CURVES, data)
    thing.show_in_front = True
    thing.hide_render = True
    scene.collection.objects.link(thing)
    return len(found.curves)


def remove_curves() -> None:
    for data in [data for data in bpy.data.curves if data.name.split(".")[0] == CURVES]:
        for thing in [thing for thing in bpy.data.objects if thing.data == data]:
            bpy.data.objects.remove(thing)
        bpy.data.curves.remove(data)


def clear(context: Any) -> None:
    """Takes away all that was added to the scene."""
    remove_timeline_markers(context.scene)
    remove_curves()
    for thing in bpy.data.objects:
        if thing.type != "MESH" or thing.library is not None or thing.data.library is not None:
            continue
        _remove_group(thing)
        restore_materials(thing)
        for name in (KIND_ATTRIBUTE, DEPTH_ATTRIBUTE):
            if name in thing.data.attributes:
                thing.data.attributes.remove(thing.data.attributes[name])
    for name, _ in COLOURS:
        material = bpy.data.materials.get(name)
        if material is not None and material.users == 0:
            bpy.data.materials.remove(material)
