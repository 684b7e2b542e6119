"""Selects in Blender what `cscd check --select LIST.json` or `cscd replay --select LIST.json` has found.

In Blender's text editor: open this file, fill in the three lines below, and run it; the objects are then in edit mode with
the faces selected. From a shell: blender scene.blend --python select_in_blender.py -- LIST.json [FRAME]

Faces and vertices have Blender's numbers in an OBJ file that is exported as it is: without triangulating, without modifiers that
add or join vertices, and without materials, by which the exporter sorts the faces. glTF files number vertices otherwise.
"""
import json
import sys

import bpy

LIST = ''  # the path of the list
FRAME = None  # a frame number, or None for what intersects in any frame
TOUCHING = False  # also what only touches


def names_in_blender(part):
    """What the object of a part may be called: Body/Sleeve, Body, or as the whole model is."""
    name = part['name']
    if name.startswith(part['object'] + '/'):  # cscd was given several models
        name = name[len(part['object']) + 1:]
    pieces = name.split('/')
    return ['/'.join(pieces[:n]) for n in range(len(pieces), 0, -1)] + [part['object']]


def find_object(part):
    for name in names_in_blender(part):
        thing = bpy.data.objects.get(name)
        if thing is not None and thing.type == 'MESH':
            return thing
    thing = bpy.context.view_layer.objects.active
    if thing is None or thing.type != 'MESH':
        raise RuntimeError(f"no mesh is called {part['name']}, and none is active")
    return thing


def find_offsets(lists):
    """Of each object in Blender its first vertex and its first face in the model file, which may hold several objects."""
    models = {model['name']: model for model in lists['objects']}
    offsets = {}
    for part in lists['parts']:
        thing = find_object(part)
        if len(thing.data.vertices) == models[part['object']]['vertices']:  # it is the whole file
            first = 0, 0
        else:
            first = part['first_vertex'], part['first_polygon']
        before = offsets.get(thing, first)
        offsets[thing] = min(before[0], first[0]), min(before[1], first[1])
    for part in lists['parts']:
        thing = find_object(part)
        first_vertex, first_face = offsets[thing]
        if (part['last_vertex'] - first_vertex >= len(thing.data.vertices) or
                part['last_polygon'] - first_face >= len(thing.data.polygons)):
            raise RuntimeError(f'{thing.name} has fewer vertices or faces than in the file that cscd has read: export it as OBJ, '
                               'as it is')
    return offsets


def find_numbers(lists, frame, touching):
    """Of each object in Blender the numbers of vertices and of faces."""
    offsets = find_offsets(lists)
    listed = lists['union'] if frame is None else [p for f in lists['frames'] if f['frame'] == frame for p in f['parts']]
    numbers = {thing: (set(), set()) for thing in offsets}
    for part in listed:
        thing = find_object(part if part['name'] is not None else dict(part, name=part['object']))
        first_vertex, first_face = offsets.get(thing, (0, 0))
        vertices, faces = numbers.setdefault(thing, (set(), set()))
        for prefix in ('', 'touching_') if touching else ('',):
            vertices.update(n - first_vertex for n in part[prefix + 'vertices'])
            faces.update(n - first_face for n in part[prefix + 'polygons'])
    return numbers


def select_numbers(mesh, vertices, faces):
    edges = {key for i in faces for key in mesh.polygons[i].edge_keys}
    corners = vertices.union(v for i in faces for v in mesh.polygons[i].vertices)
    mesh.polygons.foreach_set('select', [i in faces for i in range(len(mesh.polygons))])
    mesh.edges.foreach_set('select', [edge.key in edges for edge in mesh.edges])
    mesh.vertices.foreach_set('select', [i in corners for i in range(len(mesh.vertices))])
    mesh.update()


def select(path, frame=None, touching=False):
    """Selects the faces, and deselects all others of the same objects. Returns these objects."""
    with open(path, encoding='utf-8') as file:
        lists = json.load(file)
    if bpy.context.mode != 'OBJECT':
        bpy.ops.object.mode_set(mode='OBJECT')
    numbers = find_numbers(lists, frame, touching)
    bpy.ops.object.select_all(action='DESELECT')
    bpy.context.tool_settings.mesh_select_mode = False, False, True
    for thing, (vertices, faces) in numbers.items():
        select_numbers(thing.data, vertices, faces)
        thing.select_set(bool(faces))
        if faces:
            bpy.context.view_layer.objects.active = thing
    if frame is not None:
        bpy.context.scene.frame_set(frame)
    if any(faces for _, faces in numbers.values()):
        bpy.ops.object.mode_set(mode='EDIT')
    return list(numbers)


if __name__ == '__main__':
    given = sys.argv[sys.argv.index('--') + 1:] if '--' in sys.argv else []
    select(given[0] if given else LIST, int(given[1]) if len(given) > 1 else FRAME, TOUCHING)
