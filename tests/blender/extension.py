"""What the extension finds in a scene, beside what the tool finds in the same frames as OBJ files.

Run by `blender --background FILE.blend --python extension.py -- TOOL FOLDER`, or without a file, when it makes a scene of its own:
cloth that falls on a ball, a cube whose shape key grows, and a mirrored rod. Compared are the faces and kinds of all pairs in all
frames, depths, and events; and positions and faces with those of Blender's own exporter.
"""
import csv
import glob
import json
import os
import subprocess
import sys

import bpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'blender'))
from cscd_blender.checking import KINDS, Request, run_to_end
from cscd_blender.scene import CheckedScene, objects_of, read_polygons

FRAMES = range(1, 17)


def make_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=10, radius=0.8)
    bpy.context.object.name = 'Ball'
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=14, y_subdivisions=14, size=2.4, location=(0.01, 0.02, 0.95))
    cloth = bpy.context.object
    cloth.name = 'Cloth'
    settings = cloth.modifiers.new('Cloth', 'CLOTH').settings
    settings.effector_weights.gravity = 3.0
    bpy.ops.mesh.primitive_cube_add(size=0.5, location=(0.9, 0.1, 0.0))
    cube = bpy.context.object
    cube.name = 'Cube'
    cube.shape_key_add(name='Basis')
    grown = cube.shape_key_add(name='grown')
    for point in grown.data:
        point.co *= 1.7
    for frame, value in ((FRAMES[0], 0.0), (FRAMES[-1], 1.0)):
        grown.value = value
        grown.keyframe_insert('value', frame=frame)
    bpy.ops.mesh.primitive_cylinder_add(vertices=9, radius=0.15, depth=2.5, location=(0.1, 0.6, 0.2))
    rod = bpy.context.object
    rod.name = 'Rod'
    rod.scale = -1.0, 1.3, 1.0
    rod.rotation_euler = 0.4, 0.2, 0.1
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = FRAMES[0], FRAMES[-1]


def write_object(path, item):
    """An object as OBJ, every coordinate as it is."""
    with open(path, 'w') as file:
        for x, y, z in item.positions.tolist():
            file.write(f'v {x!r} {y!r} {z!r}\n')
        corners = iter((item.corners + 1).tolist())
        for count in item.counts.tolist():
            file.write('f ' + ' '.join(str(next(corners)) for _ in range(count)) + '\n')


def write_frames(folder, findings):
    scene, layer = bpy.context.scene, bpy.context.view_layer
    for frame in findings.frames:
        scene.frame_set(frame)
        for target in findings.checked.targets:
            write_object(os.path.join(folder, f'{target.name}_{frame:04}.obj'),
                         read_polygons(layer.objects[target.name], layer.depsgraph))
    with open(os.path.join(folder, 'parts.csv'), 'w') as file:
        file.write('triangle,name\n')
        of_objects = findings.checked.mesh.triangle_objects.tolist()
        for triangle, part in enumerate(findings.parts.labels.tolist()):
            name = findings.checked.targets[of_objects[triangle]].name
            file.write(f'{name}:{triangle - of_objects.index(of_objects[triangle])},{findings.parts.names[part]}\n')


def run_tool(tool, folder, findings, command, *options):
    """Each object is an object of the tool, as each is one of the extension."""
    names = [target.name for target in findings.checked.targets]
    arguments = []
    for name in names:
        first = sorted(glob.glob(os.path.join(folder, f'{name}_*.obj')))[0]
        pattern = os.path.join(folder, f'{name}_%04d.obj')
        arguments += ['--object', f'{name}={first}', '--frames-of', f'{name}={pattern}']
    subprocess.run([tool, command, *arguments, '--parts', os.path.join(folder, 'parts.csv'), *options], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def compare_pairs(tool, folder, findings):
    path = os.path.join(folder, 'pairs.csv')
    run_tool(tool, folder, findings, 'check', '--csv', path)
    with open(path) as file:
        theirs = sorted((int(row['frame']), row['object_a'], int(row['face_a']), row['object_b'], int(row['face_b']),
                         row['kind']) for row in csv.DictReader(file))
    ours = sorted((frame, *findings.checked.place_of(a), *findings.checked.place_of(b), KINDS[kind])
                  for frame, found in findings.frames.items() for (a, b), kind in zip(found.faces.tolist(), found.kinds.tolist()))
    assert ours == theirs, (len(ours), len(theirs), sorted(set(ours) ^ set(theirs))[:5])
    return len(ours)


def compare_events(tool, folder, findings):
    path = os.path.join(folder, 'replay.json')
    run_tool(tool, folder, findings, 'replay', '--json', path)
    with open(path) as file:
        found = json.load(file)
    theirs = sorted((e['first'], e['a'], e['b'], e['last'], e['worst'], e['pairs'], e['contacts'], e['depth'] or 0.0)
                    for e in found['events'])
    ours = sorted((e.first, e.a, e.b, e.last, e.worst, e.pairs, e.contacts, e.depth) for e in findings.events)
    assert ours == theirs, (ours[:3], theirs[:3])
    return len(ours)


def compare_export(folder, request):
    """The first object's frame as Blender exports it, six digits behind the point."""
    layer = bpy.context.view_layer
    for frame in (FRAMES[0], FRAMES[-1]):
        bpy.context.scene.frame_set(frame)
        for thing in objects_of(layer, request.objects):
            bpy.ops.object.select_all(action='DESELECT')
            thing.select_set(True)
            path = os.path.join(folder, 'exported.obj')
            bpy.ops.wm.obj_export(filepath=path, export_selected_objects=True, export_materials=False, forward_axis='Y',
                                  up_axis='Z')
            with open(path) as file:
                lines = [line.split() for line in file]
            checked = CheckedScene([thing], layer, layer.depsgraph)
            positions = checked.read(layer, layer.depsgraph)
            exported = [tuple(map(float, line[1:4])) for line in lines if line[:1] == ['v']]
            faces = [[int(corner.split('/')[0]) - 1 for corner in line[1:]] for line in lines if line[:1] == ['f']]
            assert abs(positions - exported).max() < 1e-5, thing.name
            own = iter(checked._corners[0].tolist())
            assert faces == [[next(own) for _ in range(count)] for count in checked._counts[0].tolist()], thing.name


def main():
    tool, folder = sys.argv[-2:]
    if not bpy.data.filepath:
        make_scene()
    os.makedirs(folder, exist_ok=True)
    current = bpy.context.scene.frame_current
    request = Request()
    findings = run_to_end(bpy.context, request)
    assert bpy.context.scene.frame_current == current, 'the run has moved the scene to another frame'
    compare_export(folder, request)
    write_frames(folder, findings)
    pairs = compare_pairs(tool, folder, findings)
    events = compare_events(tool, folder, findings)
    assert pairs > 100 and events > 1
    print(f'extension: {len(findings.checked.targets)} objects, {len(findings.parts.names)} parts, {len(findings.frames)} frames: '
          f'{pairs} pairs and {events} events are those of the tool')


main()
