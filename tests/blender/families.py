"""Run by Blender: meshes whose faces a fan would fill wrongly (booleans, a prism over a dart, text), exported as OBJ with their polygons.
The tool must find them clean, frame by frame. Arguments after --: the tool, a folder."""
import math
import os
import subprocess
import sys

import bpy

TOOL, FOLDER = sys.argv[sys.argv.index("--") + 1:]


def clear():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def active(name):
    item = bpy.context.view_layer.objects.active
    item.name = name
    return item


def boolean_cube():
    """A cube less a turned prism, a cylinder and a bar: concave faces and faces with holes, as the exact solver leaves them."""
    bpy.ops.mesh.primitive_cube_add(size=2)
    cube = active("Cube")
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, radius=0.45, depth=3, location=(0.2, 0.1, 0))
    round_hole = active("Round")
    bpy.ops.mesh.primitive_cylinder_add(vertices=5, radius=0.5, depth=1.3, location=(0.9, 0.8, 0.9), rotation=(0.3, 0.4, 0.2))
    corner = active("Corner")
    bpy.ops.mesh.primitive_cube_add(size=0.5, location=(-0.7, 0, 0.9), rotation=(0, 0, math.pi / 6))
    bar = active("Bar")
    bar.scale = (1, 6, 1)
    for cutter in (round_hole, corner, bar):
        modifier = cube.modifiers.new("Cut", "BOOLEAN")
        modifier.operation, modifier.solver, modifier.object = "DIFFERENCE", "EXACT", cutter
        bpy.context.view_layer.objects.active = cube
        bpy.ops.object.modifier_apply(modifier=modifier.name)
        bpy.data.objects.remove(cutter)
    return cube


def dart_prism():
    """A prism over one dart: a quad whose two diagonals are not both inside."""
    ring = [(0, 0), (2, 1), (0, 2), (0.7, 1)]
    mesh = bpy.data.meshes.new("Dart")
    points = [(x, y, z) for z in (0, 1) for x, y in ring]
    sides = [(i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i) for i in range(4)]
    mesh.from_pydata(points, [], [(3, 2, 1, 0), (4, 5, 6, 7), *sides])
    item = bpy.data.objects.new("Dart", mesh)
    bpy.context.collection.objects.link(item)
    return item


def text():
    """Letters with and without holes, as solids. Blender fills their caps with triangles and quads; dissolved, they are polygons."""
    bpy.ops.object.text_add()
    item = active("Text")
    item.data.body, item.data.extrude = "BRaS 8&%", 0.2
    bpy.ops.object.convert(target="MESH")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.remove_doubles(threshold=1e-6)
    bpy.ops.mesh.dissolve_limited(angle_limit=0.001)
    bpy.ops.object.mode_set(mode="OBJECT")
    return item


def main():
    for make in (boolean_cube, dart_prism, text):
        clear()
        item = make()
        bpy.ops.object.select_all(action="DESELECT")
        item.select_set(True)
        path = os.path.join(FOLDER, make.__name__ + ".obj")
        bpy.ops.wm.obj_export(filepath=path, export_selected_objects=True, export_materials=False, export_triangulated_mesh=False)
        corners = [len(polygon.vertices) for polygon in item.data.polygons]
        run = subprocess.run([TOOL, "check", path], capture_output=True, text=True)
        print(f"families: {make.__name__}: {len(corners)} faces of up to {max(corners)} corners: {run.stdout.splitlines()[0]}")
        if run.returncode != 0 or not run.stdout.startswith("Clean:"):
            raise SystemExit(run.stdout + run.stderr)


main()
