"""Scenes that change during a check, and objects that share names and meshes: `blender --background --python changes.py -- FOLDER`."""
import json
import os
import sys

import bpy
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'blender'))
import cscd_blender
from cscd_blender import farm, marks
from cscd_blender.checking import Request, Run, run_to_end
from cscd_blender.properties import findings_of, is_running, keep_findings
from cscd_blender.scene import SceneError

FOLDER = sys.argv[-1]


def add_grid(name, tilt=0.0, height=0.0):
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4, location=(0, 0, height), rotation=(tilt, 0, 0))
    bpy.context.object.name = name
    return bpy.context.object


def begin():
    """Two grids of which the second sinks into the first, in frames 1 to 6."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.frame_end = 6
    add_grid('Ground')
    tilted = add_grid('Tilted', 0.7, 3.0)
    for frame, height in ((1, 3.0), (6, 0.2)):
        tilted.location.z = height
        tilted.keyframe_insert('location', frame=frame)
    bpy.context.scene.frame_set(2)


def events_of(findings):
    return [(event.a, event.b, event.first, event.last, event.pairs, event.depth) for event in findings.events]


def expected():
    begin()
    found = events_of(run_to_end(bpy.context, Request()))
    assert found and found[0][:2] == ('Ground', 'Tilted'), found
    return found


def run_with(change):
    """Events of a check in whose middle the scene is changed."""
    run = Run(bpy.context, Request())
    while run.done < 2:
        run.step(10.0)
    change()
    while run.step(10.0):
        pass
    return events_of(run.findings)


def fails_with(words, change):
    try:
        run_with(change)
    except SceneError as problem:
        assert words in str(problem), problem
    else:
        raise AssertionError(f'the check did not notice: {words}')


def check_changes(found):
    begin()
    bpy.data.scenes.new('Other')
    assert run_with(lambda: setattr(bpy.context.window, 'scene', bpy.data.scenes['Other'])) == found
    assert bpy.data.scenes['Scene'].frame_current == 2

    begin()
    fails_with('Tilted is no longer in the view layer', lambda: bpy.data.objects.remove(bpy.data.objects['Tilted']))
    assert bpy.context.scene.frame_current == 2

    begin()
    bpy.data.scenes.new('Other')

    def remove_scene():
        bpy.context.window.scene = bpy.data.scenes['Other']
        bpy.data.scenes.remove(bpy.data.scenes['Scene'])
    fails_with("the scene 'Scene'", remove_scene)


def check_undo(found):
    """An undo gives Blender's things other addresses, and the check goes on."""
    begin()
    bpy.ops.ed.undo_push(message='begun')
    bpy.data.objects['Ground'].pass_index = 7
    bpy.ops.ed.undo_push(message='changed')
    assert run_with(bpy.ops.ed.undo) == found
    assert bpy.data.objects['Ground'].pass_index == 0
    assert bpy.context.scene.frame_current == 2


def check_names(found):
    """An object of another file with the name of one of ours."""
    begin()
    library = os.path.join(FOLDER, 'library.blend')
    bpy.data.objects['Tilted'].name = 'Other'
    bpy.data.objects['Ground'].name = 'Tilted'
    bpy.data.objects['Other'].name = 'Ground'
    bpy.ops.wm.save_as_mainfile(filepath=library)
    begin()
    bpy.data.objects.remove(bpy.data.objects['Tilted'])
    with bpy.data.libraries.load(library, link=True) as (_, there):
        there.objects = ['Ground']
    bpy.context.scene.collection.objects.link(there.objects[0])
    findings = run_to_end(bpy.context, Request())
    named = events_of(findings)
    assert [event[2:] for event in named] == [event[2:] for event in found], named
    assert named[0][:2] == ('Ground', 'Ground [library.blend]'), named
    assert marks.unmarked_names(findings, bpy.context.view_layer) == ['Ground [library.blend]']
    one = Request(objects=('Ground [library.blend]',))
    assert [target.name for target in run_to_end(bpy.context, one).checked.targets] == ['Ground [library.blend]']


def check_shared_mesh():
    """Marks of two objects with one mesh are those of both, and an empty slot stays."""
    begin()
    ground = bpy.data.objects['Ground']
    far = bpy.data.objects.new('Zfar', ground.data)
    far.location = (0, 0, -50)
    bpy.context.scene.collection.objects.link(far)
    ground.data.materials.append(None)
    assert bpy.ops.cscd.check() == {'FINISHED'}
    findings = findings_of(bpy.context.scene)
    assert bpy.ops.cscd.mark_materials() == {'FINISHED'} and bpy.ops.cscd.mark_attributes() == {'FINISHED'}
    levels = np.empty(len(ground.data.polygons), np.int32)
    ground.data.attributes[marks.KIND_ATTRIBUTE].data.foreach_get('value', levels)
    own = marks.levels_of_faces(findings)[:len(levels)]
    assert (own >= 0).any() and np.array_equal(levels, own + 1)
    assert {polygon.index for polygon in ground.data.polygons if polygon.material_index} == set(np.flatnonzero(own >= 0))
    assert bpy.ops.cscd.clear() == {'FINISHED'}
    assert ground.data.materials[:] == [None] and not any(polygon.material_index for polygon in ground.data.polygons)
    assert bpy.data.objects['Tilted'].data.materials[:] == []


def check_other_file():
    """What was found in one file says nothing of another one with a scene of that name."""
    begin()
    assert bpy.ops.cscd.check() == {'FINISHED'} and findings_of(bpy.context.scene) is not None
    path = os.path.join(FOLDER, 'other.blend')
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    assert findings_of(bpy.context.scene) is None and not is_running() and len(bpy.context.scene.cscd.events) > 0
    bpy.context.scene.cscd.event_index = 0
    assert bpy.context.scene.frame_current == bpy.context.scene.cscd.events[0].worst
    keep_findings(bpy.context.scene, None)


def check_edit_mode(found):
    """The panel refuses; the farm script checks what is rendered."""
    begin()
    solid = bpy.data.objects['Tilted'].modifiers.new('Wave', 'SIMPLE_DEFORM')
    solid.show_in_editmode = False
    rendered = events_of(run_to_end(bpy.context, Request()))
    assert rendered != found
    bpy.context.view_layer.objects.active = bpy.data.objects['Tilted']
    bpy.ops.object.mode_set(mode='EDIT')
    assert not bpy.ops.cscd.check.poll()
    path = os.path.join(FOLDER, 'edit.json')
    assert farm.check_file(['--json', path]) == farm.FOUND
    with open(path) as file:
        assert [(event['pairs'], event['depth']) for event in json.load(file)['events']] == [event[4:] for event in rendered]
    bpy.ops.object.mode_set(mode='OBJECT')
    assert events_of(run_to_end(bpy.context, Request())) == rendered


def check_other_types():
    """Metaballs of one family, curves and texts without faces, an empty that shows a collection."""
    begin()
    bpy.ops.object.metaball_add(location=(9, 0, 0))
    bpy.ops.object.metaball_add(location=(9.5, 0, 0))
    bpy.ops.curve.primitive_bezier_curve_add(location=(0, 9, 0))
    text = bpy.data.curves.new('Empty text', 'FONT')
    text.body = ''
    bpy.context.scene.collection.objects.link(bpy.data.objects.new('Empty text', text))
    shown = bpy.data.objects.new('Instance', None)
    shown.instance_type, shown.instance_collection = 'COLLECTION', bpy.context.scene.collection.children[0] \
        if bpy.context.scene.collection.children else None
    bpy.context.scene.collection.objects.link(shown)
    names = [target.name for target in run_to_end(bpy.context, Request()).checked.targets]
    assert names == ['Ground', 'Tilted', 'Mball'], names


def refused(words):
    try:
        bpy.ops.cscd.check()
    except RuntimeError as problem:  # what an operator reports as an error
        assert words in str(problem), problem
    else:
        raise AssertionError(f'the check ran: {words}')


def check_choices():
    """What is wrong with the choice of objects is said in words that name no program's inside."""
    begin()
    settings = bpy.context.scene.cscd
    settings.source = 'SELECTED'
    bpy.ops.object.select_all(action='DESELECT')
    refused('no object is selected')
    settings.source = 'COLLECTION'
    refused('no collection is chosen')
    settings.collection = bpy.data.collections.new('Apart')
    bpy.context.scene.collection.children.link(settings.collection)
    settings.collection.objects.link(bpy.data.objects['Ground'])
    bpy.context.scene.collection.objects.unlink(bpy.data.objects['Ground'])
    bpy.context.view_layer.layer_collection.children['Apart'].exclude = True
    refused('objects that the view layer excludes are not among them')


def check_instances(found):
    """They are not checked, and the summary says so."""
    begin()
    bpy.ops.cscd.check()
    assert 'nstances' not in bpy.context.scene.cscd.summary
    shown = bpy.data.objects.new('Instance', None)
    shown.instance_type, shown.instance_collection = 'COLLECTION', bpy.data.collections.new('Shown')
    shown.instance_collection.objects.link(bpy.data.objects['Ground'])
    bpy.context.scene.collection.objects.link(shown)
    bpy.ops.cscd.check()
    assert bpy.context.scene.cscd.summary.endswith('Instances are not checked: make them real (Object > Apply > Make '
                                                   'Instances Real).'), bpy.context.scene.cscd.summary
    assert events_of(findings_of(bpy.context.scene)) == found
    keep_findings(bpy.context.scene, None)


def check_pages():
    """A page calls frames as the timeline does, and needs two of them."""
    begin()
    settings = bpy.context.scene.cscd
    settings.use_range, settings.first, settings.last, settings.step = True, -2, 6, 4
    bpy.ops.cscd.check()
    path = os.path.join(FOLDER, 'a page #1 ä.html')
    bpy.ops.cscd.report(filepath=path)
    with open(path, encoding='utf-8') as file:
        page = file.read()
    assert '"frame":-2,' in page and '"frame":2,' in page and '"frame":6,' in page and '"frame":0,' not in page
    assert bpy.context.scene.frame_current == 2
    settings.last = -2
    bpy.ops.cscd.check()
    assert 'in 1 frame.' in settings.summary, settings.summary
    try:
        bpy.ops.cscd.report(filepath=path)
    except RuntimeError as problem:
        assert 'check two frames or more' in str(problem)
    else:
        raise AssertionError('a page of one frame')


def main():
    cscd_blender.register()
    found = expected()
    check_choices()
    check_instances(found)
    check_pages()
    check_changes(found)
    check_undo(found)
    check_names(found)
    check_shared_mesh()
    check_other_file()
    check_edit_mode(found)
    check_other_types()
    cscd_blender.unregister()
    print('changes: undo, other scenes, files and modes, objects removed, linked and shared')


main()
