"""glTF files at rest: containers, accessors of all types, primitives, nodes, targets and skins, with numbers by hand."""
import os
from pathlib import Path

import pytest

from support.tool.mesh_files import BYTE, FLOAT, SHORT, UNSIGNED_BYTE, UNSIGNED_INT, UNSIGNED_SHORT, Gltf
from support.tool.read_back import expect_errors, expect_mesh, frames_read

SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
HALVES = [(0, 1, 2), (0, 2, 3)]
CORNER = [(0, 0, 0), (1, 0, 0), (0, 2, 0)]
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def flat(rows):
    return [number for row in rows for number in row]


def primitive(position=0, **members):
    return {"attributes": {"POSITION": position}, **members}


def one_mesh(*primitives, **members):
    """The members of a file with a node for a mesh of these primitives."""
    return {"nodes": [{"mesh": 0}], "meshes": [{"primitives": list(primitives), **members}]}


def square(component=UNSIGNED_SHORT):
    return Gltf(("VEC3", flat(SQUARE)), ("SCALAR", flat(HALVES), component))


SQUARE_MESH = one_mesh(primitive(indices=1))

# ---- containers and buffers


def test_reads_all_containers():
    expect_mesh(square().glb(**SQUARE_MESH), SQUARE, HALVES)
    for padding in range(5):
        file = square()
        file.data += bytes(padding)
        expect_mesh(file.embedded(**SQUARE_MESH), SQUARE, HALVES, "mesh.gltf")


@pytest.mark.parametrize("uri, name", [
    ("mesh.bin", "mesh.bin"), ("my%20mesh%2b.bin", "my mesh+.bin"), ("%C3%A4.bin", "\u00e4.bin")])
def test_reads_buffers_beside_the_file(uri, name):
    Path(name).write_bytes(square().data)
    expect_mesh(square().text(uri, **SQUARE_MESH), SQUARE, HALVES, "mesh.gltf")


def test_refuses_buffers_that_are_not_there():
    os.mkdir("case4")
    Path("case4/mesh.bin").write_bytes(square().data)
    expect_errors([(square().text(uri, **SQUARE_MESH), "buffer 0: ", says) for uri, says in [
        ("other.bin", "cannot open"),
        ("my%2.bin", "percent sign"),
        ("my%00.bin", "percent sign"),
        ("https://example.org/mesh.bin", "expected a file in the folder"),
        ("/mesh.bin", "expected a file"),
        ("../case4/mesh.bin", "in the folder of the glTF file or below"),
        ("a/%2e%2E/mesh.bin", "or below"),
        ("..%5cmesh.bin", "or below"),
        ("data:,AAAA", "expected base64"),
        ("data:;base64", "without a comma"),
        ("data:;base64,AA*A", "no base64 at character 2"),
        ("data:;base64,AAAA", "cut off"),
    ]], name="mesh.gltf")


# ---- accessors

@pytest.mark.parametrize("component", [UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT])
def test_reads_all_types_of_indices(component):
    expect_mesh(square(component).glb(**SQUARE_MESH), SQUARE, HALVES)


@pytest.mark.parametrize("normalised", [False, True])
@pytest.mark.parametrize("component, largest, numbers", [
    (BYTE, 127, [0, 127, -128, 1, 0, 0, -127, 2, 3]),
    (UNSIGNED_BYTE, 255, [0, 255, 51, 1, 0, 0, 9, 2, 3]),
    (SHORT, 32767, [0, 32767, -32768, 1, 0, 0, 9, -32767, 3]),
    (UNSIGNED_SHORT, 65535, [0, 65535, 13107, 1, 0, 0, 9, 2, 3]),
])
def test_reads_all_types_of_positions(component, largest, numbers, normalised):
    """Positions may be integers, which stand for themselves or, normalised, for -1 to 1 or 0 to 1."""
    file = Gltf(("VEC3", numbers, component))
    file.accessors[0]["normalized"] = normalised
    expected = [max(-1.0, number / largest) for number in numbers] if normalised else numbers
    expect_mesh(file.glb(extensionsRequired=["KHR_mesh_quantization"], **one_mesh(primitive())),
                zip(*[iter(expected)] * 3), [(0, 1, 2)])


def test_reads_what_compressed_files_have_besides():
    """Data that are compressed and, for readers without that extension, also not compressed."""
    extension = "KHR_draco_mesh_compression"
    expect_mesh(square().glb(extensionsUsed=[extension], **one_mesh(primitive(indices=1, extensions={extension: {}}))),
                SQUARE, HALVES)


def test_reads_interleaved_elements():
    """Each vertex has a normal behind its position, and the view begins four bytes before."""
    file = Gltf()
    file.view([9, *CORNER[0], 5, 5, 5, *CORNER[1], 5, 5, 5, *CORNER[2], 5, 5, 5])
    file.views[0]["byteStride"] = 24
    file.accessors.append({"bufferView": 0, "byteOffset": 4, "componentType": FLOAT, "count": 3, "type": "VEC3"})
    expect_mesh(file.glb(**one_mesh(primitive())), CORNER, [(0, 1, 2)])


@pytest.mark.parametrize("component", [UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT])
@pytest.mark.parametrize("based, middle", [({}, (0, 0, 0)), ({"bufferView": 2}, (3, 3, 3))])
def test_reads_sparse_accessors(component, based, middle):
    file = Gltf()
    indices = {"bufferView": file.view([0, 2], component), "componentType": component}
    sparse = {"count": 2, "indices": indices, "values": {"bufferView": file.view([1, 0, 0, 0, 1, 0])}}
    file.view([9, 9, 9, 3, 3, 3, 8, 8, 8])
    file.accessors.append({"componentType": FLOAT, "count": 3, "type": "VEC3", "sparse": sparse, **based})
    expect_mesh(file.glb(**one_mesh(primitive())), [(1, 0, 0), middle, (0, 1, 0)], [(0, 1, 2)])


def test_reads_accessors_without_data_as_zeros():
    file = Gltf()
    file.view([0], UNSIGNED_BYTE)
    file.accessors.append({"componentType": FLOAT, "count": 3, "type": "VEC3"})
    expect_mesh(file.glb(**one_mesh(primitive())), [(0, 0, 0)] * 3, [(0, 1, 2)])


# ---- primitives

FAN = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]


@pytest.mark.parametrize("primitives, triangles", [
    ([primitive()], [(0, 1, 2), (3, 4, 5)]),
    ([primitive(mode=5)], [(0, 1, 2), (1, 3, 2), (2, 3, 4), (3, 5, 4)]),
    ([primitive(mode=6)], FAN),
    # 0 1 2, 1 2 2, 2 2 2, 2 3 2, 2 3 5: the first and the last have three corners; the last is number 4, so not turned.
    ([primitive(mode=5, indices=1)], [(0, 1, 2), (2, 3, 5)]),
    # Primitives of one set of vertices share it; points and lines are passed over.
    ([primitive(mode=0), primitive(), primitive(mode=3), primitive(mode=6)], [(0, 1, 2), (3, 4, 5), *FAN]),
])
def test_reads_triangles_strips_and_fans(primitives, triangles):
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 2, 0), (1, 2, 0)]
    file = Gltf(("VEC3", flat(points)), ("SCALAR", [0, 1, 2, 2, 2, 3, 5], UNSIGNED_BYTE))
    expect_mesh(file.glb(**one_mesh(*primitives)), points, triangles)


def test_primitives_share_what_is_the_same_in_all():
    """Two with the same positions but not the same targets, and one with others, which has indices."""
    other, moved = [(5, 0, 0), (6, 0, 0), (5, 1, 0)], [(0, 0, 1), (0, 0, 2), (0, 0, 3)]
    file = Gltf(("VEC3", flat(CORNER)), ("VEC3", flat(other)), ("VEC3", flat(moved)), ("SCALAR", [2, 0, 1], UNSIGNED_BYTE))
    primitives = [primitive(targets=[{"POSITION": 2}]), primitive(targets=[{}]), primitive(1, targets=[{}], indices=3)]
    expect_mesh(file.glb(**one_mesh(*primitives, weights=[1])), [(0, 0, 1), (1, 0, 2), (0, 2, 3), *CORNER, *other],
                [(0, 1, 2), (3, 4, 5), (8, 6, 7)])


# ---- nodes

PLACED = [(10, 20, 30), (10, 22, 30), (6, 20, 30)]  # scaled by 2, turned by 90 degrees around z, and moved
BEHIND = [(0, 0, 5), (1, 0, 5), (0, 2, 5)]
TWO_NODES = [{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 5]}]


@pytest.mark.parametrize("nodes, points, triangles, scenes", [
    ([{"mesh": 0, "scale": [2, 2, 2], "rotation": [0, 0, 3, 3], "translation": [10, 20, 30]}], PLACED, [(0, 1, 2)], {}),
    ([{"mesh": 0, "matrix": [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 10, 20, 30, 1]}], PLACED, [(0, 1, 2)], {}),  # by columns
    ([{"mesh": 0, "rotation": [0, 0, 3, 3]}, {"children": [2]},
      {"children": [0], "scale": [2, 2, 2], "translation": [10, 20, 30]}], PLACED, [(0, 1, 2)], {}),
    ([{"mesh": 0, "scale": [-1, 1, 1]}], [(0, 0, 0), (-1, 0, 0), (0, 2, 0)], [(0, 2, 1)], {}),
    ([{"mesh": 0, "scale": [1, 1, -1]}], CORNER, [(0, 2, 1)], {}),
    (TWO_NODES, CORNER + BEHIND, [(0, 1, 2), (3, 4, 5)], {}),
    (TWO_NODES, BEHIND, [(0, 1, 2)], {"scene": 1, "scenes": [{"nodes": [0]}, {"nodes": [1]}]}),
    (TWO_NODES, BEHIND, [(0, 1, 2)], {"scenes": [{"nodes": [1, 1]}, {"nodes": [0]}]}),
    # A child that the scene names before its parent, which has another one.
    ([{"children": [1, 2]}, *TWO_NODES], CORNER + BEHIND, [(0, 1, 2), (3, 4, 5)], {"scenes": [{"nodes": [1, 0, 2]}]}),
])
def test_places_the_nodes_of_the_scene_in_their_tree(nodes, points, triangles, scenes):
    file = Gltf(("VEC3", flat(CORNER)))
    expect_mesh(file.glb(nodes=nodes, meshes=[{"primitives": [primitive()]}], **scenes), points, triangles)


# ---- targets and skins

@pytest.mark.parametrize("of_node, of_mesh, first, second", [
    ({}, {}, 0, 0),
    ({}, {"weights": [0.5, 0.25, 1]}, 0.5, 0.25),
    ({"weights": [0.75, -1, 7]}, {"weights": [0.5, 0.25, 1]}, 0.75, -1),
])
def test_adds_morph_targets(of_node, of_mesh, first, second):
    """One target moves vertex 1 by 4 along z, the next moves all by 1 along x."""
    file = Gltf(("VEC3", flat(CORNER)), ("VEC3", [0, 0, 0, 0, 0, 4, 0, 0, 0]), ("VEC3", [1, 0, 0] * 3))
    targets = [{"POSITION": 1}, {"POSITION": 2}, {"NORMAL": 1}]
    mesh = one_mesh(primitive(targets=targets), **of_mesh)
    mesh["nodes"][0].update(of_node)
    expect_mesh(file.glb(**mesh), [(second, 0, 0), (1 + second, 0, 4 * first), (second, 2, 0)], [(0, 1, 2)])


def skinned(weights, joints, later=None, component=FLOAT, **node):
    """A primitive of three vertices with joints 1 and 2. later: joints and weights of another set."""
    file = Gltf(("VEC3", [0, 0, 0, 1, 1, 0, 2, 0, 0]), ("MAT4", IDENTITY + IDENTITY[:12] + [-1, 0, 0, 1]))
    attributes = {"POSITION": 0}
    for i, (own_joints, own_weights) in enumerate([(joints, weights)] + ([later] if later else [])):
        attributes[f"JOINTS_{i}"] = file.add("VEC4", own_joints, UNSIGNED_SHORT if i else UNSIGNED_BYTE)
        attributes[f"WEIGHTS_{i}"] = file.add("VEC4", own_weights, component, normalized=component != FLOAT)
    nodes = [{"mesh": 0, "skin": 0, **node}, {"translation": [0, 0, 10]}, {"translation": [1, 0, 0], "scale": [3, 3, 3]}]
    return file.glb(nodes=nodes, skins=[{"joints": [1, 2], "inverseBindMatrices": 1}],
                    meshes=[{"primitives": [{"attributes": attributes}]}])


@pytest.mark.parametrize("component, weights", [
    (FLOAT, [1, 0, 0, 0, 0.5, 0.5, 0, 0, 0.75, 0.25, 0, 0]),
    (FLOAT, [2, 0, 0, 0, 1, 1, 0, 0, 1.5, 0.5, 0, 0]),  # sums of weights are divided out
    (UNSIGNED_BYTE, [255, 0, 0, 0, 100, 100, 0, 0, 150, 50, 0, 0]),
    (UNSIGNED_SHORT, [255, 0, 0, 0, 100, 100, 0, 0, 150, 50, 0, 0]),
])
@pytest.mark.parametrize("sets", [1, 2])
def test_moves_skins_by_their_joints(component, weights, sets):
    """Joint 0 rests at the origin and stands at z = 10, joint 1 rests at x = 1 and is scaled by 3 there.

    Vertex 0 follows joint 0, vertex 1 both by halves, vertex 2 joint 1 by three quarters. sets: of two, the second has the
    second weight of each vertex as its first one. Joint 0 takes the vertices to (0 0 10), (1 1 10), (2 0 10), and joint 1 to
    (-2 0 0), (1 3 0), (4 0 0).
    """
    joints, later = [0, 9, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0], None
    if sets == 2:
        later = [[numbers[i + 1] if i % 4 == 0 else 0 for i in range(12)] for numbers in (joints, weights)]
        weights = [0 if i % 4 == 1 else weight for i, weight in enumerate(weights)]
    (mesh,) = frames_read(skinned(weights, joints, later, component, translation=[50, 50, 50]))
    assert flat(mesh.points) == pytest.approx([0, 0, 10, 1, 2, 5, 3.5, 0, 2.5], abs=1e-14) and mesh.triangles == [(0, 1, 2)]


def test_leaves_vertices_without_weights():
    """They go with their node, as unskinned ones do."""
    expect_mesh(skinned([0] * 12, [0] * 12, translation=[5, 0, 0]), [(5, 0, 0), (6, 1, 0), (7, 0, 0)], [(0, 1, 2)])


