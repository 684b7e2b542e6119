"""The scene of docs/artist/from-your-program.md: a doll whose forearm passes through its trunk, with eyes and a skirt.

Run by `blender --background --factory-startup --python doll.py -- FILE.blend`. The skin has a vertex group for each bone, the eyes
sit in the head and turn, and a shape key swings the skirt, which is an open surface.
"""
import math
import sys

import bpy
from mathutils import Vector

# Joints: where they are, how thick the limb is there, and which joint comes before.
JOINTS = {
    'hip': ((0, 0, 0.95), 0.15, None),
    'chest': ((0, 0, 1.3), 0.17, 'hip'),
    'neck': ((0, 0, 1.5), 0.07, 'chest'),
    'head': ((0, 0, 1.68), 0.13, 'neck'),
    'top': ((0, 0, 1.8), 0.1, 'head'),
}
for side, sign in (('L', 1), ('R', -1)):
    JOINTS.update({
        f'shoulder.{side}': ((0.22 * sign, 0, 1.38), 0.07, 'chest'),
        f'elbow.{side}': ((0.5 * sign, 0, 1.34), 0.05, f'shoulder.{side}'),
        f'hand.{side}': ((0.78 * sign, 0, 1.3), 0.045, f'elbow.{side}'),
        f'thigh.{side}': ((0.11 * sign, 0, 0.8), 0.09, 'hip'),
        f'knee.{side}': ((0.13 * sign, -0.01, 0.45), 0.065, f'thigh.{side}'),
        f'foot.{side}': ((0.14 * sign, 0, 0.06), 0.055, f'knee.{side}'),
    })
# Bones from joint to joint.
BONES = [('trunk', 'hip', 'neck', None), ('head', 'neck', 'top', 'trunk')]
for side in 'LR':
    BONES += [(f'arm.{side}', f'shoulder.{side}', f'elbow.{side}', 'trunk'),
              (f'forearm.{side}', f'elbow.{side}', f'hand.{side}', f'arm.{side}'),
              (f'leg.{side}', f'thigh.{side}', f'knee.{side}', 'trunk'),
              (f'shin.{side}', f'knee.{side}', f'foot.{side}', f'leg.{side}')]
FRAMES = (1, 24)


def add_object(name, mesh):
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def select_only(thing):
    bpy.ops.object.select_all(action='DESELECT')
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing


def make_skin():
    """A skin around the joints, as Blender's skin modifier makes it, smoothed once."""
    names = list(JOINTS)
    mesh = bpy.data.meshes.new('Body')
    mesh.from_pydata([JOINTS[n][0] for n in names], [(names.index(JOINTS[n][2]), i) for i, n in enumerate(names) if JOINTS[n][2]], [])
    body = add_object('Body', mesh)
    select_only(body)
    body.modifiers.new('Skin', 'SKIN')
    for vertex, name in zip(mesh.skin_vertices[0].data, names):
        vertex.radius = (JOINTS[name][1],) * 2
    mesh.skin_vertices[0].data[0].use_root = True
    body.modifiers.new('Smooth', 'SUBSURF').levels = 2
    bpy.ops.object.convert(target='MESH')
    for polygon in body.data.polygons:
        polygon.use_smooth = True
    return body


def make_rig():
    rig = add_object('Rig', bpy.data.armatures.new('Rig'))
    select_only(rig)
    bpy.ops.object.mode_set(mode='EDIT')
    for name, start, end, above in BONES:
        bone = rig.data.edit_bones.new(name)
        bone.head, bone.tail = JOINTS[start][0], JOINTS[end][0]
        bone.parent = rig.data.edit_bones[above] if above else None
    bpy.ops.object.mode_set(mode='OBJECT')
    return rig


def distance_to_bone(point, bone):
    along = bone.tail_local - bone.head_local
    t = min(1.0, max(0.0, (point - bone.head_local).dot(along) / along.length_squared))
    return (point - bone.head_local - t * along).length


def bind_skin(body, rig):
    """Weights fall off fast with the distance from a bone, in its own thickness."""
    groups = {bone.name: body.vertex_groups.new(name=bone.name) for bone in rig.data.bones}
    for vertex in body.data.vertices:
        near = {bone.name: (0.02 + distance_to_bone(vertex.co, bone) / (2.4 if bone.name in ('trunk', 'head') else 1)) ** -6
                for bone in rig.data.bones}
        whole = sum(near.values())
        for name, weight in near.items():
            if weight / whole > 0.02:
                groups[name].add([vertex.index], weight / whole, 'REPLACE')
    body.modifiers.new('Armature', 'ARMATURE').object = rig
    body.parent = rig


def turn_bone(rig, name, axis, keys):
    bone = rig.pose.bones[name]
    bone.rotation_mode = 'AXIS_ANGLE'
    local = rig.data.bones[name].matrix_local.to_3x3().inverted() @ Vector(axis)
    for frame, degrees in keys:
        bone.rotation_axis_angle = (math.radians(degrees), *local)
        bone.keyframe_insert('rotation_axis_angle', frame=frame)


def sphere(name, rings, around, radius):
    """Blender's own spheres have their faces in another order at each start."""
    vertices = [(0, 0, radius), (0, 0, -radius)]
    vertices += [(radius * math.sin(math.pi * r / rings) * math.cos(2 * math.pi * k / around),
                  radius * math.sin(math.pi * r / rings) * math.sin(2 * math.pi * k / around),
                  radius * math.cos(math.pi * r / rings)) for r in range(1, rings) for k in range(around)]
    at = lambda r, k: 2 + (r - 1) * around + k % around
    faces = [(0, at(1, k), at(1, k + 1)) for k in range(around)]
    faces += [(at(r, k), at(r + 1, k), at(r + 1, k + 1), at(r, k + 1)) for r in range(1, rings - 1) for k in range(around)]
    faces += [(1, at(rings - 1, k + 1), at(rings - 1, k)) for k in range(around)]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    return mesh


def add_eye(rig, name, x):
    eye = add_object(name, sphere(name, 10, 16, 0.032))
    eye.location = (x, -0.108, 1.71)
    eye.parent, eye.parent_type, eye.parent_bone = rig, 'BONE', 'head'
    eye.matrix_parent_inverse = (rig.matrix_world @ rig.pose.bones['head'].matrix @ bone_to_tail(rig, 'head')).inverted()
    for frame, degrees in ((1, -20), (12, 25), (24, -10)):
        eye.rotation_euler = (0, 0, math.radians(degrees))
        eye.keyframe_insert('rotation_euler', frame=frame)


def bone_to_tail(rig, name):
    """Children of a bone stand at its tail."""
    from mathutils import Matrix
    return Matrix.Translation((0, rig.data.bones[name].length, 0))


def add_skirt():
    rings, around = 10, 48
    vertices = [((0.2 + 0.17 * r / rings) * math.cos(2 * math.pi * k / around), (0.2 + 0.17 * r / rings) * math.sin(2 * math.pi * k / around),
                 1.0 - 0.4 * r / rings) for r in range(rings + 1) for k in range(around)]
    faces = [(r * around + k, r * around + (k + 1) % around, (r + 1) * around + (k + 1) % around, (r + 1) * around + k)
             for r in range(rings) for k in range(around)]
    mesh = bpy.data.meshes.new('Skirt')
    mesh.from_pydata(vertices, [], faces)
    skirt = add_object('Skirt', mesh)
    skirt.shape_key_add(name='Basis')
    swing = skirt.shape_key_add(name='Swing')
    for i, point in enumerate(swing.data):
        point.co.x += 0.16 * (i // around / rings) ** 2
    for frame, value in ((1, 0), (12, 1), (24, 0)):
        swing.value = value
        swing.keyframe_insert('value', frame=frame)


def main():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = 24
    scene.frame_start, scene.frame_end = FRAMES
    body, rig = make_skin(), make_rig()
    bind_skin(body, rig)
    turn_bone(rig, 'arm.L', (0, 1, 0), ((1, 0), (10, 62), (14, 62), (24, 0)))
    turn_bone(rig, 'forearm.L', (0, 1, 0), ((1, 0), (12, 95), (24, 0)))
    turn_bone(rig, 'head', (0, 0, 1), ((1, 0), (12, 25), (24, 0)))
    add_eye(rig, 'Eye.L', 0.05)
    add_eye(rig, 'Eye.R', -0.05)
    add_skirt()
    bpy.ops.wm.save_as_mainfile(filepath=sys.argv[sys.argv.index('--') + 1])


main()
