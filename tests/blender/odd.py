"""Scenes that cannot be checked, for farm.sh: `blender --background --python odd.py -- FOLDER`."""
import os
import sys

import bpy


def save(name):
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(sys.argv[-1], name))


def add_grid():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4)
    bpy.context.object.name = 'Grid'
    bpy.context.scene.frame_end = 5
    return bpy.context.object


bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.collection.objects.link(bpy.data.objects.new('Points', bpy.data.meshes.new('Points')))
save('empty.blend')

# A modifier that makes more faces from frame 3 on.
grid = add_grid()
modifier = grid.modifiers.new('Subdivision', 'SUBSURF')
for frame, levels in ((1, 0), (3, 1)):
    modifier.levels = levels
    modifier.keyframe_insert('levels', frame=frame)
save('changing.blend')

# A grid that is hidden by a scale of 0 in frames 2 and 3, beside another one, and alone.
grid = add_grid()
grid.location.x = 5.0
for frame, size in ((1, 1), (2, 0), (3, 0), (4, 1)):
    grid.scale = size, size, size
    grid.keyframe_insert('scale', frame=frame)
save('alone.blend')
bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4)
bpy.context.object.name = 'Other'
save('hidden.blend')

# A shape key that is not a number.
grid = add_grid()
grid.shape_key_add(name='Basis')
broken = grid.shape_key_add(name='broken')
broken.data[3].co = float('nan'), 0.0, 0.0
broken.value = 1.0
save('nan.blend')
