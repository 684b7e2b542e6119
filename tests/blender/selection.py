"""Selects in Blender what the tool has found in Blender's own export, by the script of the docs.

Run by `blender --background --factory-startup --python selection.py -- TOOL FOLDER`. Two objects are exported as one OBJ file for
each frame, in which a rod passes through a cushion. At every frame, and over all of them, the faces that are selected must be
those that Blender's own BVH trees find overlapping.
"""
import glob
import importlib.util
import os
import subprocess
import sys

import bpy
from mathutils.bvhtree import BVHTree

HERE = os.path.dirname(os.path.abspath(__file__))
FRAMES = range(3, 8)


def load_script():
    path = os.path.join(HERE, '..', '..', 'docs', 'scripts', 'select_in_blender.py')
    spec = importlib.util.spec_from_file_location('select_in_blender', path)
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    return script


def make_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=20, ring_count=12, radius=1.0)
    cushion = bpy.context.object
    cushion.name = cushion.data.name = 'Cushion'
    cushion.data.vertices.add(1)  # a vertex without a face at the end
    bpy.ops.mesh.primitive_cylinder_add(vertices=9, radius=0.2, depth=3.0, location=(0.03, 0.01, 0))
    rod = bpy.context.object
    rod.name = rod.data.name = 'Rod'
    for frame, height in ((FRAMES[0], 3.0), (FRAMES[-1], 0.4)):
        rod.location = 0.03, 0.01, height
        rod.keyframe_insert('location', frame=frame)
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = FRAMES[0], FRAMES[-1]
    return cushion, rod


def export_frames(folder):
    for frame in FRAMES:
        bpy.context.scene.frame_set(frame)
        bpy.ops.wm.obj_export(filepath=os.path.join(folder, f'scene_{frame:04}.obj'), export_materials=False)
    return sorted(glob.glob(os.path.join(folder, 'scene_*.obj')))


def overlapping_faces(frame, things):
    """Of each object the faces that overlap one of the other object."""
    bpy.context.scene.frame_set(frame)
    bpy.context.view_layer.update()
    trees = [BVHTree.FromPolygons([thing.matrix_world @ v.co for v in thing.data.vertices],
                                  [tuple(p.vertices) for p in thing.data.polygons]) for thing in things]
    pairs = trees[0].overlap(trees[1])
    return [{pair[side] for pair in pairs} for side in (0, 1)]


def selected_faces(things):
    bpy.ops.object.mode_set(mode='OBJECT')
    return [{p.index for p in thing.data.polygons if p.select} for thing in things]


def refuse_triangles(tool, folder, script):
    """Faces of a triangulated file have other numbers, and the script says so."""
    path, lists = os.path.join(folder, 'triangles.obj'), os.path.join(folder, 'triangles.json')
    bpy.ops.wm.obj_export(filepath=path, export_materials=False, export_triangulated_mesh=True)
    subprocess.run([tool, 'check', path, '--select', lists, '--quiet'], check=True)
    try:
        script.select(lists)
    except RuntimeError as error:
        assert 'export it as OBJ' in str(error), error
    else:
        raise AssertionError('triangles were taken for faces')


def main():
    tool, folder = sys.argv[sys.argv.index('--') + 1:]
    things = make_scene()
    paths = export_frames(folder)
    lists = os.path.join(folder, 'lists.json')
    subprocess.run([tool, 'check', *paths, '--select', lists, '--quiet'], check=True)
    script, union, counts = load_script(), [set(), set()], []
    for frame in FRAMES:
        expected = overlapping_faces(frame, things)
        script.select(lists, frame)
        found = selected_faces(things)
        assert found == expected, f'frame {frame}: {found} instead of {expected}'
        union = [a | b for a, b in zip(union, expected)]
        counts.append(sum(map(len, expected)))
    script.select(lists)
    assert selected_faces(things) == union, 'all frames'
    refuse_triangles(tool, folder, script)
    assert counts[0] == 0 and min(counts[-2:]) >= 10 and len(set(counts)) > 2, counts
    print('selection: faces of', len(counts), 'frames:', counts, 'passed')


main()
