"""Shows what docs/artist/from-your-program.md says of shape keys: Blender stops them at the ends of their range, its exporter does not.

Run by `blender --background --factory-startup --python-exit-code 1 --python clamp.py -- FOLDER`.
"""
import base64
import json
import os
import struct
import sys

import bpy

HIGHEST = 1.5  # of the curve; the range of the key ends at 1


def make_overshoot():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end = 24, 1, 21
    mesh = bpy.data.meshes.new('Face')
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    face = bpy.data.objects.new('Face', mesh)
    scene.collection.objects.link(face)
    face.shape_key_add(name='Basis')
    key = face.shape_key_add(name='Up')
    for point in key.data:
        point.co.z += 1
    for frame in (1, 11, 21):
        key.keyframe_insert('value', frame=frame)
    curve = mesh.shape_keys.animation_data.action.fcurves[0]
    curve.keyframe_points[1].co[1] = HIGHEST
    curve.update()
    scene.frame_set(11)
    return face


def exported_values(path, sampled):
    bpy.ops.export_scene.gltf(filepath=path, export_format='GLTF_EMBEDDED', export_force_sampling=sampled)
    document = json.load(open(path))
    accessor = document['accessors'][document['animations'][0]['samplers'][0]['output']]
    view = document['bufferViews'][accessor['bufferView']]
    content = base64.b64decode(document['buffers'][view['buffer']]['uri'].split(',')[1])
    return struct.unpack_from(f'<{accessor["count"]}f', content, view.get('byteOffset', 0) + accessor.get('byteOffset', 0))


def main():
    folder = sys.argv[sys.argv.index('--') + 1]
    face = make_overshoot()
    shown = face.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh().vertices[0].co.z
    assert shown == 1, shown
    for sampled in (True, False):
        values = exported_values(os.path.join(folder, 'clamp.gltf'), sampled)
        assert abs(max(values) - HIGHEST) < 1e-6, values
    print('shape keys: Blender stops them, its exporter does not')


main()
