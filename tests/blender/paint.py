"""Draws docs/images/doll-faces.png: paints the faces that docs/artist/from-your-program.md has selected, and looks at them with Cycles.

Runs behind a step of the page, in the same Blender: page.py puts both together.
"""
import math
import os

import bpy
from mathutils import Vector


def make_material(name, colour):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.node_tree.nodes['Principled BSDF'].inputs['Base Color'].default_value = (*colour, 1)
    material.node_tree.nodes['Principled BSDF'].inputs['Roughness'].default_value = 0.6
    return material


def paint_faces():
    bpy.ops.object.mode_set(mode='OBJECT')
    skin, cloth = make_material('skin', (0.13, 0.2, 0.33)), make_material('cloth', (0.4, 0.2, 0.14))
    red = make_material('crossing', (0.8, 0.02, 0.02))
    for thing in bpy.data.objects:
        if thing.type == 'MESH':
            thing.data.materials.append(cloth if thing.name == 'Skirt' else skin)
            thing.data.materials.append(red)
            for polygon in thing.data.polygons:
                polygon.material_index = int(polygon.select)


def add_light(kind, energy, place, size=None):
    light = bpy.data.objects.new('Light', bpy.data.lights.new('Light', kind))
    light.data.energy = energy
    if size is not None:
        light.data.size = size
    light.location = place
    light.rotation_euler = (Vector((0, 0, 1.1)) - Vector(place)).to_track_quat('-Z', 'Y').to_euler()
    bpy.context.scene.collection.objects.link(light)


def look(place, target, lens):
    camera = bpy.data.objects.new('Camera', bpy.data.cameras.new('Camera'))
    camera.location, camera.data.lens = place, lens
    camera.rotation_euler = (Vector(target) - Vector(place)).to_track_quat('-Z', 'Y').to_euler()
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def draw(path):
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.device, scene.cycles.samples = 'CYCLES', 'CPU', 64
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 720, 512, 100
    scene.world = bpy.data.worlds.new('World')
    scene.world.use_nodes = True
    scene.world.node_tree.nodes['Background'].inputs['Color'].default_value = (1, 1, 1, 1)
    scene.world.node_tree.nodes['Background'].inputs['Strength'].default_value = 1.0
    scene.view_settings.view_transform = 'Standard'
    scene.render.filepath = path
    for name in dir(scene.render):  # the time of the run among them
        if name.startswith('use_stamp_'):
            setattr(scene.render, name, False)
    bpy.ops.render.render(write_still=True)


paint_faces()
add_light('AREA', 25, (2, -3, 3), 2)
look((1.1, -1.75, 1.5), (0.1, 0, 1.0), 52)
draw(os.environ['PICTURE'])
