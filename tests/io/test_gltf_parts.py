"""The parts of glTF files, which face of the file a triangle is, copies of meshes, and notes about what is not read."""
import pytest

from support.tool.mesh_files import BYTE, FLOAT, UNSIGNED_BYTE, Gltf
from support.tool.read_back import errors_of, expect_mesh, frames_read, write_file
from support.tool.reading import read_json
from support.tool.running import run

CORNERS = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]


def primitive(**members):
    return {"attributes": {"POSITION": 0}, **members}


def parts_file(*nodes):
    """Meshes: 0 has a point, a triangle, one that names a vertex twice and a third one; 1 one triangle; 2 points alone."""
    file = Gltf(("VEC3", CORNERS), ("SCALAR", [0, 1, 2, 3, 3, 0, 1, 2, 3], UNSIGNED_BYTE), ("SCALAR", [0, 1, 2], UNSIGNED_BYTE))
    meshes = [{"primitives": [primitive(mode=0), primitive(indices=1)]},
              {"name": "Arm", "primitives": [primitive(indices=2)]},
              {"name": "Dust", "primitives": [primitive(mode=0)]}]
    return file.glb(nodes=list(nodes), meshes=meshes)


def info_of(content, options=""):
    """What --json of info says of a file, and the warnings."""
    error = run(f"info {write_file('mesh.glb', content)} --json info.json {options}").error
    return read_json("info.json"), error


@pytest.mark.parametrize("nodes, names", [
    ([{"name": "Body", "mesh": 0}, {"mesh": 1}, {"mesh": 0, "name": ""}, {"name": "Hand/L", "mesh": 1},
      {"name": "Dust", "mesh": 2}, {"name": "Empty"}], ["Body", "Arm", "node 2", "Hand/L"]),
    ([{"name": name, "mesh": 1} for name in ("Body", "Body", "Body.001", "Body.003", "Body", "Body")],
     ["Body", "Body.001", "Body.001.001", "Body.003", "Body.002", "Body.004"]),
])
def test_calls_parts_by_their_nodes(nodes, names):
    """Equal names are told apart."""
    assert [part["name"] for part in info_of(parts_file(*nodes))[0]["parts"]] == names


def test_numbers_the_faces_of_the_file():
    """Two nodes with mesh 0, and one with mesh 1 between them."""
    content = parts_file({"mesh": 0}, {"mesh": 1}, {"mesh": 0}, {"mesh": 2})
    (mesh,) = frames_read(content)
    assert mesh.triangles == [(0, 1, 2), (1, 2, 3), (4, 5, 6), (8, 9, 10), (9, 10, 11)]
    assert mesh.faces("polygon") == [0, 2, 3, 4, 6] and mesh.faces("part") == [0, 0, 1, 2, 2]
    own = info_of(content)[0]
    assert own["file_faces"] == 7 and own["repairs"]["dropped"] == {"faces": 2, "first": 1}
    assert own["repairs"]["skipped_primitives"] == 3


# ---- materials

MATERIALS = [{"name": "Steel"}, {"name": "Unused"}, {"name": "Red Skin #1"}, {}, {"name": "Seen nowhere"}, {"name": "Steel"}]


def materials_file(last):
    """Mesh 0 is of material 2, of none, of points of material 4, and of material 0, whose third triangle names a vertex twice.

    Mesh 1 is of material 2, of a triangle that names a vertex twice of material 4, and of material `last`.
    """
    file = Gltf(("VEC3", CORNERS))
    for corners in ([0, 1, 2, 1, 2, 3, 3, 3, 1], [0, 1, 2], [3, 3, 1]):
        file.add("SCALAR", corners, UNSIGNED_BYTE)
    meshes = [[primitive(indices=2, material=2), primitive(indices=2), primitive(mode=0, material=4),
               primitive(indices=1, material=0)],
              [primitive(indices=2, material=2), primitive(indices=3, material=4), primitive(indices=2, material=last)]]
    return file.glb(nodes=[{"name": "A", "mesh": 0}, {"name": "B", "mesh": 1}], materials=MATERIALS,
                    meshes=[{"primitives": primitives} for primitives in meshes])


@pytest.mark.parametrize("last, parts_by, expected", [
    (3, "material", ["Red Skin #1", None, "Steel", "Steel", "Red Skin #1", "material 3"]),
    (5, "material", ["Red Skin #1", None, "Steel", "Steel", "Red Skin #1", "Steel.001"]),
    (3, "object", ["A", "A", "A", "A", "B", "B"]),
])
def test_calls_parts_by_their_materials(last, parts_by, expected):
    """Whatever parts are, vertices are joined within nodes alone, of which each has three or more of its own."""
    (mesh,) = frames_read(materials_file(last), options=f"--parts-by {parts_by}")
    assert [mesh.named("part").get(part) for part in mesh.faces("part")] == expected
    assert info_of(materials_file(last), f"--parts-by {parts_by}")[0]["vertices"] == 8


def test_refuses_materials_that_are_not_there():
    """Where nobody asks for materials, nobody misses one."""
    info_of(materials_file(6))
    by_material = {"parts-by": "material"}
    (error,) = errors_of([materials_file(6)], options=by_material)
    assert "mesh 1, primitive 2: material is 6" in error
    (error,) = errors_of([parts_file({"mesh": 0})], options=by_material)
    assert "finds no parts: none of its triangles has a material" in error


# ---- copies

CORNER = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
# By hand: scale, then turn, then move, then move with node 0. Copy 1 turns by 90 degrees around z, copy 2 by 180 around x.
PLACED = [(10, 0, 0), (11, 0, 0), (10, 1, 0), (10, 0, 5), (10, 2, 5), (7, 0, 5), (11, 1, 1), (10, 1, 1), (11, 0, 1)]
MOVED = [(x + dx + 10, y + dy, dz) for dx, dy, dz in ((0, 0, 0), (0, 0, 5), (1, 1, 1)) for x, y, _ in CORNER]
SCALED = [(10, 0, 0), (11, 0, 0), (10, 1, 0), (10, 0, 0), (12, 0, 0), (10, 3, 0), (10, 0, 0), (9, 0, 0), (10, 1, 0)]
PLAIN, MIRRORED = [(0, 1, 2), (3, 4, 5), (6, 7, 8)], [(0, 1, 2), (3, 4, 5), (6, 8, 7)]
ALL = {"TRANSLATION": 1, "ROTATION": 2, "SCALE": 3}


def copies_file(attributes, **members):
    """Node 0 is 10 along x and above node 1, a triangle, of which there are three copies.

    Accessors: 1 to 3 translations, rotations and scales, 4 rotations as integers, 5 translations without data, 6 and 7 times and
    places of an animation.
    """
    rotations = [0, 0, 0, 1, 0, 0, 1, 1, 1, 0, 0, 0]
    file = Gltf(("VEC3", [0, 0, 0, 1, 0, 0, 0, 1, 0]), ("VEC3", [0, 0, 0, 0, 0, 5, 1, 1, 1]), ("VEC4", rotations),
                ("VEC3", [1, 1, 1, 2, 3, 1, -1, 1, 1]))
    file.add("VEC4", [127 * number for number in rotations], BYTE, normalized=True)
    file.accessors.append({"componentType": FLOAT, "count": 3, "type": "VEC3"})
    file.add("SCALAR", [0, 1])
    file.add("VEC3", [10, 0, 0, 18, 4, 0])
    tree = {"name": "tree", "mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}}
    return file.glb(**{"nodes": [{"translation": [10, 0, 0], "children": [1]}, tree], "scenes": [{"nodes": [0]}],
                       "meshes": [{"primitives": [primitive()]}], **members})


@pytest.mark.parametrize("attributes, members, points, triangles", [
    *((attributes, members, PLACED, MIRRORED) for attributes in (ALL, {**ALL, "ROTATION": 4})
      for members in ({}, {"extensionsUsed": ["EXT_mesh_gpu_instancing"]}, {"extensionsRequired": ["EXT_mesh_gpu_instancing"]})),
    ({"TRANSLATION": 1, "_AGE": 6}, {}, MOVED, PLAIN),
    ({"SCALE": 3}, {}, SCALED, MIRRORED),
    ({"TRANSLATION": 5, "SCALE": 3}, {}, SCALED, MIRRORED),
])
def test_copies_stand_where_they_should(attributes, members, points, triangles):
    expect_mesh(copies_file(attributes, **members), points, triangles)


def test_each_copy_is_a_part():
    parts = info_of(copies_file(ALL))[0]["parts"]
    assert parts == [{"name": name, "triangles": 1} for name in ("tree", "tree.001", "tree.002")]


def test_copies_go_with_nodes_that_move():
    """Node 0 moves by (8, 4, 0) in a second."""
    channel = {"sampler": 0, "target": {"node": 0, "path": "translation"}}
    animations = [{"samplers": [{"input": 6, "output": 7}], "channels": [channel]}]
    frames = frames_read(copies_file(ALL, animations=animations), options="--fps 4")
    assert [mesh.points for mesh in frames] == [[(x + 2.0 * f, y + 1.0 * f, z) for x, y, z in PLACED] for f in range(5)]


# ---- what is not read

def note_of(node, mesh, own_primitive, **members):
    """What is said of extensions that a node, its mesh and a primitive have."""
    content = Gltf(("VEC3", CORNERS[:9])).glb(**{
        "nodes": [{}, {"mesh": 0, "extensions": node}], "scenes": [{"nodes": [0, 1]}],
        "meshes": [{"extensions": mesh, "primitives": [primitive(extensions=own_primitive)]}], **members})
    return info_of(content)[0]["unread"]


LONG = {f"ACME_{i}_of_a_name_that_is_so_long_that_it_is_cut": {} for i in range(12)}


@pytest.mark.parametrize("extensions, says", [
    (({}, {}, {}), None),
    (({"KHR_lights_punctual": {}, "EXT_instance_features": {}}, {}, {}), None),
    (({"ACME_fur": {}}, {}, {}), ["the glTF extension ACME_fur (node 1) is not read: ", "not what other programs show"]),
    (({"ACME_fur": {}, "KHR_node_visibility": {}}, {"ACME_fur": {}}, {"ACME_hair": {}}),
     ["extensions ACME_fur (node 1 and 1 more), KHR_node_visibility (node 1), ACME_hair (mesh 0, primitive 0) are not read"]),
    (({}, {}, {"KHR_draco_mesh_compression": {}}),
     ["KHR_draco_mesh_compression (mesh 0, primitive 0) is not read: the uncompressed data"]),
    ((LONG, {}, {}), ["ACME_0_of", "ACME_7_of", " and others are not read"]),
])
def test_what_is_not_read_is_named(extensions, says):
    note = note_of(*extensions)
    assert note is None if says is None else all(text in note for text in says)


def test_what_is_not_shown_is_not_named():
    """A node and a mesh that are in no scene."""
    fur = {"extensions": {"ACME_fur": {}}}
    assert note_of({}, {}, {}, scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}, {"mesh": 1, **fur}],
                   meshes=[{"primitives": [primitive()]}, {**fur, "primitives": [primitive()]}]) is None
