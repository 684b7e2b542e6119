"""Rigs in Blender, exported as glTF with the vertices that Blender itself evaluates at every frame.

Run by `blender --background --factory-startup --python rigs.py -- FOLDER`. Of each rig it writes NAME.glb, NAME.gltf with NAME.bin,
NAME.embedded.gltf, and NAME.json: frames a second, and for every frame the evaluated vertices of each object in the axes
of glTF.
"""
import json
import math
import os
import sys

import bpy
from mathutils import Euler, Quaternion, Vector

FPS = 24


def clear_file():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = FPS


def set_range(first, last):
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = first, last


def add_object(name, data, parent=None):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    thing.parent = parent
    return thing


def tube(name, rings, around, radius, height):
    """A closed tube along z."""
    vertices, faces = [], []
    for ring in range(rings + 1):
        for k in range(around):
            angle = 2 * math.pi * k / around
            vertices.append((radius * math.cos(angle), radius * math.sin(angle), height * ring / rings))
    for ring in range(rings):
        for k in range(around):
            a, b = ring * around + k, ring * around + (k + 1) % around
            faces.append((a, b, b + around, a + around))
    faces.append(tuple(reversed(range(around))))
    faces.append(tuple(range(rings * around, (rings + 1) * around)))
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.update()
    return mesh


def key_curve(owner, path, index, points, interpolation, slopes=(0.0, 0.3, -0.2, 0.1)):
    """Keys (frame, value); Bezier handles at a third of the way, as a cubic in time has them."""
    if owner.animation_data is None:
        owner.animation_data_create()
    if owner.animation_data.action is None:
        owner.animation_data.action = bpy.data.actions.new(owner.name)
    curve = owner.animation_data.action.fcurves.new(path, index=index)
    curve.keyframe_points.add(len(points))
    for i, (point, (frame, value)) in enumerate(zip(curve.keyframe_points, points)):
        point.co = frame, value
        point.interpolation = interpolation
        point.handle_left_type = point.handle_right_type = 'FREE'
        before = (frame - points[i - 1][0]) / 3 if i > 0 else 1
        after = (points[i + 1][0] - frame) / 3 if i + 1 < len(points) else 1
        slope = slopes[i % len(slopes)]
        point.handle_left = frame - before, value - slope * before
        point.handle_right = frame + after, value + slope * after
    curve.update()


def rig_arm():
    """A skinned arm of three bones under an armature that is moved, turned and scaled itself."""
    clear_file()
    set_range(1, 48)
    armature = add_object('Rig', bpy.data.armatures.new('Rig'))
    armature.location, armature.rotation_euler, armature.scale = (0.3, -0.2, 0.5), (0.2, 0.4, -0.3), (1.5, 1.5, 1.5)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode='EDIT')
    above = None
    for i in range(3):
        bone = armature.data.edit_bones.new(f'bone{i}')
        bone.head, bone.tail, bone.roll = (0.01 * i, 0, i), (0.01 * (i + 1), 0, i + 1), 0.3 * i
        bone.parent, bone.use_connect = above, above is not None
        above = bone
    bpy.ops.object.mode_set(mode='OBJECT')
    arm = add_object('Arm', tube('Arm', 24, 12, 0.25, 3.0), armature)
    for i in range(3):
        group = arm.vertex_groups.new(name=f'bone{i}')
        for vertex in arm.data.vertices:
            weight = max(0.0, 1 - abs(vertex.co.z - (i + 0.5)))
            if weight > 0:
                group.add([vertex.index], weight, 'REPLACE')
    arm.modifiers.new('Armature', 'ARMATURE').object = armature
    for i, bone in enumerate(armature.pose.bones):
        bone.rotation_mode = 'QUATERNION'
        for frame, angle in ((1, 0.0), (17, 0.9), (33, -0.7), (48, 1.3)):
            bone.rotation_quaternion = Quaternion(Vector((1, 0.3 * i, 0.2)).normalized(), angle * (1 + 0.2 * i))
            bone.keyframe_insert('rotation_quaternion', frame=frame)
    root = armature.pose.bones['bone0']
    for frame, place in ((1, (0, 0, 0)), (48, (0.4, 0.1, -0.3))):
        root.location = place
        root.keyframe_insert('location', frame=frame)
    return {'export_force_sampling': True}


def rig_face():
    """Shape keys with Bezier keys, exported as they are. Blender stops their values at 0 and 1, its exporter does not."""
    clear_file()
    set_range(0, 40)
    face = add_object('Face', tube('Face', 8, 10, 0.6, 1.0))
    face.shape_key_add(name='Basis')
    for i, name in enumerate(('Smile', 'Blink', 'Bulge')):
        key = face.shape_key_add(name=name)
        for j, point in enumerate(key.data):
            if j % 3 != i:  # many vertices stay where they are
                point.co += Vector((0.1 * math.sin(j + i), 0.2 * math.cos(2 * j), 0.15 * i))
    keys = face.data.shape_keys
    for name, values in (('Smile', (0.1, 0.8, 0.2, 0.9)), ('Blink', (0.9, 0.1, 0.7, 0.3)), ('Bulge', (0.2, 0.5, 0.4, 0.3))):
        key_curve(keys, f'key_blocks["{name}"].value', 0, list(zip((0, 13, 29, 40), values)), 'BEZIER',
                  (0.0, 0.01, -0.01, 0.005))
    return {'export_force_sampling': False, 'export_morph': True}


def rig_train():
    """Objects under objects with keys of all three kinds, which are exported as they are."""
    clear_file()
    set_range(2, 50)
    engine = add_object('Engine', tube('Engine', 2, 8, 0.5, 1.0))
    engine.location, engine.rotation_euler = (0, 0, 1), (0.1, 0.2, 0.3)
    wagon = add_object('Wagon', tube('Wagon', 3, 6, 0.3, 2.0), engine)
    wagon.location, wagon.scale, wagon.rotation_euler = (3, 0.5, 0.2), (1, 2, 0.5), Euler((0.4, -0.3, 0.2))
    lamp = add_object('Lamp', tube('Lamp', 1, 5, 0.1, 0.2), wagon)
    lamp.location = (0, 0, 2.5)
    times = (2, 15, 31, 50)
    for axis, values in enumerate(((0, 1, -1, 2), (1, 0, 2, 1), (0.5, 1.5, 1, 0))):
        key_curve(engine, 'location', axis, list(zip(times, values)), 'BEZIER')
        key_curve(wagon, 'scale', axis, [(t, 1 + 0.3 * abs(v)) for t, v in zip(times, values)], 'LINEAR')
        key_curve(lamp, 'location', axis, [(t, v + 0.1 * axis) for t, v in zip(times, values)], 'CONSTANT')
    return {'export_force_sampling': False}


def rig_crane():
    """Mirrored and sheared objects, turned by keys, sampled."""
    clear_file()
    set_range(1, 30)
    mast = add_object('Mast', tube('Mast', 4, 6, 0.2, 4.0))
    mast.scale = (1, 0.5, 2)
    beam = add_object('Beam', tube('Beam', 4, 6, 0.1, 3.0), mast)
    beam.location, beam.rotation_euler, beam.scale = (0, 0, 4), (0.3, 1.2, 0.1), (-1, 1, 1)
    hook = add_object('Hook', tube('Hook', 1, 4, 0.3, 0.3), beam)
    hook.location = (0, 0, 3)
    for frame, angle in ((1, 0), (12, 2.5), (30, -4)):
        mast.rotation_euler = (0, 0, angle)
        mast.keyframe_insert('rotation_euler', frame=frame)
        hook.rotation_euler = (angle, 0.2, 0)
        hook.keyframe_insert('rotation_euler', frame=frame)
    return {'export_force_sampling': True}


def rig_fin():
    """Vertices of six joints each, which shape keys move as well."""
    clear_file()
    set_range(1, 24)
    armature = add_object('Spine', bpy.data.armatures.new('Spine'))
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode='EDIT')
    for i in range(6):
        bone = armature.data.edit_bones.new(f'ray{i}')
        bone.head, bone.tail = (0.2 * i, 0, 0), (0.2 * i, 0.1 * i, 1)
    bpy.ops.object.mode_set(mode='OBJECT')
    fin = add_object('Fin', tube('Fin', 12, 8, 0.4, 1.5), armature)
    for i in range(6):
        group = fin.vertex_groups.new(name=f'ray{i}')
        for vertex in fin.data.vertices:
            group.add([vertex.index], 0.1 + abs(math.sin(vertex.index + i)), 'REPLACE')
    fin.modifiers.new('Armature', 'ARMATURE').object = armature
    fin.shape_key_add(name='Basis')
    swell = fin.shape_key_add(name='Swell')
    for j, point in enumerate(swell.data):
        point.co += Vector((0.2 * math.cos(j), 0.1 * math.sin(j), 0))
    key_curve(fin.data.shape_keys, 'key_blocks["Swell"].value', 0, [(1, 0.2), (11, 1.0), (24, 0.0)], 'LINEAR')
    for i, bone in enumerate(armature.pose.bones):
        bone.rotation_mode = 'XYZ'
        for frame, angle in ((1, 0.1), (13, -0.5), (24, 0.8)):
            bone.rotation_euler = (angle, 0.3 * angle * i, -angle)
            bone.scale = (1, 1 + angle / 4, 1)
            bone.keyframe_insert('rotation_euler', frame=frame)
            bone.keyframe_insert('scale', frame=frame)
    return {'export_force_sampling': True, 'export_all_influences': True}


def evaluated_vertices():
    """Of each object, in the axes of glTF: x, z, -y."""
    graph = bpy.context.evaluated_depsgraph_get()
    objects = {}
    for thing in bpy.context.scene.objects:
        if thing.type != 'MESH':
            continue
        evaluated = thing.evaluated_get(graph)
        mesh = evaluated.to_mesh()
        places = [evaluated.matrix_world @ vertex.co for vertex in mesh.vertices]
        objects[thing.name] = [[p.x, p.z, -p.y] for p in places]
        evaluated.to_mesh_clear()
    return objects


def export_rig(folder, name, options):
    common = dict(export_animations=True, export_frame_range=True, export_nla_strips=False, export_apply=False,
                  export_yup=True, **options)
    for kind, ending in (('GLB', '.glb'), ('GLTF_SEPARATE', '.gltf'), ('GLTF_EMBEDDED', '.embedded.gltf')):
        bpy.ops.export_scene.gltf(filepath=os.path.join(folder, name + ending), export_format=kind, **common)


def write_truth(folder, name):
    scene = bpy.context.scene
    frames = []
    for frame in range(scene.frame_start, scene.frame_end + 1):
        scene.frame_set(frame)
        frames.append({'frame': frame, 'objects': evaluated_vertices()})
    with open(os.path.join(folder, name + '.json'), 'w') as out:
        json.dump({'fps': FPS, 'frames': frames}, out)


def main():
    folder = sys.argv[sys.argv.index('--') + 1]
    for name, rig in (('arm', rig_arm), ('face', rig_face), ('train', rig_train), ('crane', rig_crane),
                      ('fin', rig_fin)):
        options = rig()
        bpy.context.view_layer.update()
        write_truth(folder, name)
        export_rig(folder, name, options)
        print('rig', name, 'written')


main()
