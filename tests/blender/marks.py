"""The operators of the extension: marks in the scene, the way back, and nothing left behind.

Run by `blender --background FILE.blend --python marks.py` on the doll of doll.py.
"""
import os
import sys
import tempfile

import bpy
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'blender'))
import cscd_blender
from cscd_blender import marks
from cscd_blender.properties import findings_of


def state():
    """All that a check and its marks could change."""
    meshes = {thing.name: (tuple(name for name in thing.data.attributes.keys() if name[0] != '.'),  # those keep the selection
                           tuple(thing.vertex_groups.keys()),
                           tuple(m.name if m else None for m in thing.data.materials),
                           tuple(p.material_index for p in thing.data.polygons))
              for thing in bpy.data.objects if thing.type == 'MESH'}
    scene = bpy.context.scene
    return (meshes, sorted(bpy.data.objects.keys()), sorted(bpy.data.materials.keys()), sorted(bpy.data.curves.keys()),
            [(m.name, m.frame) for m in scene.timeline_markers], scene.frame_current, sorted(bpy.data.collections.keys()))


def run(name, **options):
    group, operator = name.split('.')
    assert getattr(getattr(bpy.ops, group), operator)(**options) == {'FINISHED'}, name


def check_event(findings):
    """Going to an event selects its faces and no others."""
    settings = bpy.context.scene.cscd
    settings.event_index = 1
    settings.event_index = 0
    event = settings.events[0]
    assert bpy.context.scene.frame_current == event.worst
    faces = findings.faces_in(event.worst, event.a, event.b)
    assert len(faces) > 0
    for target, thing in marks.marked_meshes(findings, bpy.context.view_layer):
        own = sorted(face - target.first_face for face in faces.tolist() if 0 <= face - target.first_face < target.face_count)
        assert own == [p.index for p in thing.data.polygons if p.select], thing.name


def check_marks(findings):
    levels = marks.levels_of_faces(findings)
    run('cscd.mark_attributes')
    run('cscd.mark_groups')
    run('cscd.mark_materials')
    run('cscd.mark_timeline')
    marked = list(marks.marked_meshes(findings, bpy.context.view_layer))
    assert len(marked) >= 3
    for target, thing in marked:
        own = levels[target.first_face: target.first_face + target.face_count]
        kinds = np.empty(target.face_count, np.int32)
        thing.data.attributes[marks.KIND_ATTRIBUTE].data.foreach_get('value', kinds)
        assert np.array_equal(kinds, own + 1)
        for polygon, level in zip(thing.data.polygons, own.tolist()):
            if level >= 0:
                assert thing.data.materials[polygon.material_index].name == marks.COLOURS[level][0]
        assert (marks.GROUP in thing.vertex_groups) == bool((own >= 0).any()), thing.name
    assert len(bpy.context.scene.timeline_markers) == len(bpy.context.scene.cscd.events)
    bpy.context.scene.frame_set(bpy.context.scene.cscd.events[0].worst)
    run('cscd.mark_curves')
    assert len(bpy.data.curves[marks.CURVES].splines) > 0


def check_report():
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, 'page.html')
        run('cscd.report', filepath=path)
        with open(path, encoding='utf-8') as file:
            assert 'Body' in file.read()


def check_undo():
    """One step back takes a mark away, and no more."""
    if bpy.app.background and not bpy.context.preferences.edit.use_global_undo:
        return
    bpy.ops.ed.undo_push(message='before')
    run('cscd.mark_timeline')
    bpy.ops.ed.undo_push(message='markers')
    assert bpy.context.scene.timeline_markers
    bpy.ops.ed.undo()
    assert not bpy.context.scene.timeline_markers and bpy.context.scene.cscd.events


def main():
    cscd_blender.register()
    before = state()
    run('cscd.check')
    assert state() == before, 'a check has changed the scene'
    findings = findings_of(bpy.context.scene)
    assert findings.found_anything and len(bpy.context.scene.cscd.events) == len(findings.events)
    frame = bpy.context.scene.frame_current
    check_event(findings)
    check_marks(findings)
    run('cscd.check')  # marks do not change what is found
    assert findings_of(bpy.context.scene).events == findings.events
    check_report()
    run('cscd.ignore', from_event=True)
    settings = bpy.context.scene.cscd
    left_out = {settings.events[0].a, settings.events[0].b}
    run('cscd.check')
    assert all({event.a, event.b} != left_out for event in settings.events)
    run('cscd.look_at_again')
    run('cscd.clear')
    bpy.context.scene.frame_set(frame)
    assert state() == before, 'something is left behind'
    assert not settings.events and not settings.summary
    run('cscd.check')
    check_undo()
    cscd_blender.unregister()
    print('marks: selection, attributes, groups, colours, curves, markers, page and undo work, and nothing is left behind')


main()
