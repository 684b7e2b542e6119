"""glTF files that are wrong: each error says what and where."""
import struct

from support.tool.mesh_files import FLOAT, UNSIGNED_BYTE, UNSIGNED_INT, UNSIGNED_SHORT, Gltf, glb_of
from support.tool.read_back import expect_errors

POSITIONS = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
FAN = {"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 6}]}]}
RICH = {
    "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"mesh": 0, "skin": 0}, {"children": [2], "rotation": [0, 0, 0, 1], "mesh": 1}, {"matrix": IDENTITY}],
    "skins": [{"joints": [1, 2], "inverseBindMatrices": 4}],
    "meshes": [{"weights": [0.5], "primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 1,
                                                  "targets": [{"POSITION": 5}]}]},
               {"primitives": [{"attributes": {"POSITION": 0}, "mode": 6}]}]}


def rich():
    """Accessors: 0 positions, 1 indices, 2 joints, 3 weights, 4 matrices, 5 sparse, 6 the numbers 0 to 2, 7 without data."""
    file = Gltf(("VEC3", POSITIONS), ("SCALAR", [0, 1, 2, 0, 2, 3], UNSIGNED_SHORT),
                ("VEC4", [0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0], UNSIGNED_BYTE),
                ("VEC4", [1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0, 1, 0, 0, 0]), ("MAT4", IDENTITY * 2))
    sparse = {"count": 3, "indices": {"bufferView": file.view([0, 2, 3], UNSIGNED_BYTE), "componentType": UNSIGNED_BYTE},
              "values": {"bufferView": 0}}
    file.accessors.append({"componentType": FLOAT, "count": 4, "type": "VEC3", "sparse": sparse})
    file.add("SCALAR", [0, 1, 2])
    file.accessors.append({"componentType": FLOAT, "count": 4, "type": "VEC3"})
    return file


def replaced(file, members, text, by):
    """The file with one part of its text replaced, the first one."""
    whole = file.text(**members)
    assert text in whole, text
    return glb_of(whole.replace(text, by, 1), file.data)


def expect_replaced(file, members, table):
    """table: a text, what stands in its place, what is said to be found, and to be expected."""
    expect_errors([(replaced(file, members, text, by), found, expected) for text, by, found, expected in table])


def test_refuses_wrong_nodes():
    expect_replaced(rich(), RICH, [
        ('"mesh":1', '"mesh":2', "node 1: mesh is 2", "2 meshes, from 0"),
        ('"mesh":1', '"mesh":-1', "node 1: mesh is -1", "expected 0 to"),
        ('"mesh":1', '"mesh":0.5', "node 1: mesh is 0.5", "a whole number"),
        ('"mesh":1', '"mesh":"1"', "node 1: mesh is 1", "a whole number"),
        ('"skin":0', '"skin":1', "node 0: skin is 1", "1 skins"),
        ('"children":[2]', '"children":[3]', "node 1: children[0] is 3", "3 nodes"),
        ('"children":[2]', '"children":[2,2]', "node 1: children[1] is node 2", "child of node 1"),
        ('"children":[2]', '"children":[1]', "node 1 is its own ancestor", "circle"),
        ('{"matrix"', '{"children":[1],"matrix"', "is its own ancestor", "circle"),
        ("[0,0,0,1]", "[0,0,1]", "node 1: rotation has 3 numbers", "expected 4"),
        ("[0,0,0,1]", "[0,0,0,null]", "node 1: rotation[3] is null", "finite"),
        ("[0,0,0,1]", "[0,0,1e999,1]", "node 1: rotation[2] is", "finite"),
        ("[0,0,0,1]", "1", "node 1: rotation is no array", ""),
        ('"nodes":[0,1]', '"nodes":[0,7]', "scene 0: nodes[1] is 7", "3 nodes"),
        ('"scene":0', '"scene":1', "scene is 1", "1 scenes"),
        ('"nodes":[0,1]', '"nodes":[2]', "no triangles found", "default scene"),
    ])


def test_refuses_wrong_meshes():
    draco = '"mode":6,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0}}'
    expect_replaced(rich(), RICH, [
        ('"POSITION":0,', "", "mesh 0, primitive 0: POSITION is missing", ""),
        ('"POSITION":0,', '"POSITION":1,', "accessor 1: type is SCALAR", "VEC3 for POSITION"),
        ('"POSITION":0,', '"POSITION":9,', "primitive 0: POSITION is 9", "8 accessors"),
        ('"indices":1', '"indices":6', "indices are no unsigned integers", "mesh 0, primitive 0"),
        ('"mode":6', '"mode":7', "primitive 0: mode is 7", "0 to 6"),
        ('"mode":6', '"mode":4', "has 4 corners", "a multiple of 3"),
        ('[{"POSITION":5}]', '[{"POSITION":4}]', "type is MAT4", "target 0"),
        ('"weights":[0.5]', '"weights":[]', "mesh 0: weights has 0 numbers", "expected 1"),
        ('"WEIGHTS_0":3', '"WEIGHTS_0":4', "accessor 4: type is MAT4", "VEC4 for WEIGHTS_0"),
        ('"JOINTS_0":2', '"JOINTS_0":3', "JOINTS_0 are no unsigned integers", "mesh 0"),
        ('"joints":[1,2]', '"joints":[1]', "names joint 1, but skin 0 has 1", ""),
        ('"joints":[1,2]', '"joints":[1,2,1]', "skin 0: has 3 joints, but 2 inverse", ""),
        ('"joints":[1,2]', '"joints":[]', "skin 0: has 0 joints", ""),
        ('"mode":6', '"mode":6,"targets":[{}]},{"attributes":{"POSITION":0}', "mesh 1, primitive 1: has 0 targets",
         "the first primitive has 1"),
        ('"POSITION":0},"mode":6', '"POSITION":7},' + draco, "KHR_draco_mesh_compression, which is not read",
         "without compression"),
    ])


def test_refuses_wrong_numbers():
    far = Gltf(("VEC3", POSITIONS), ("SCALAR", [0, 1, 2, 0, 2, 4], UNSIGNED_INT))
    large = Gltf(("VEC3", [0, 0, 0, 1e30, 0, 0, 1, 1, 0]))
    expect_errors([(replaced(far, FAN, '"mode":6', '"indices":1'), "mesh 0, primitive 0: index 5 is vertex 4", "4, from 0"),
                   (replaced(large, FAN, '{"mesh":0', '{"mesh":0,"scale":[1e300,1,1]'),
                    "node 0, mesh 0: coordinate x of vertex 1 is inf", "a finite number")])


# ---- accessors

def positions_by(accessor, view):
    """The positions by an accessor and a view in the place of those that fit."""
    file = Gltf(("VEC3", POSITIONS))
    file.views = [view]
    file.accessors = [accessor]
    return file.glb(**FAN)


def test_refuses_accessors_out_of_bounds():
    view, accessor, large = {"buffer": 0, "byteLength": 48}, {"bufferView": 0, "componentType": FLOAT}, 9007199254740992
    whole = {**accessor, "type": "VEC3", "count": 4}
    accessors = [
        ({**whole, "count": 5}, "accessor 0: 5 elements end at byte 60", "48 bytes"),
        ({**whole, "byteOffset": 1}, "4 elements end at byte 49", "48 bytes"),
        ({**whole, "byteOffset": large}, "4 elements end at byte", "48 bytes"),
        ({**whole, "byteOffset": large + 1}, "accessor 0: byteOffset is", "expected 0 to"),
        ({**whole, "count": 2147483647}, "2147483647 elements end at byte", "48 bytes"),
        ({**whole, "count": 2147483648}, "count is 2147483648", "1 to 2147483647"),
        ({**whole, "count": 0}, "count is 0", "1 to 2147483647"),
        ({**whole, "count": 1e300}, "count is 1e", "whole number"),
        ({**whole, "bufferView": 1}, "bufferView is 1", "1 buffer views"),
        ({**whole, "componentType": 5124}, "componentType is 5124", "5120 to 5123, 5125 or 5126"),
        ({"bufferView": 0, "type": "VEC3", "count": 4}, "componentType is missing", ""),
        ({**accessor, "count": 4}, "type is missing", "VEC3"),
    ]
    views = [
        (4, {**view, "byteLength": 49}, "buffer view 0: byteOffset 0 and byteLength 49", "48 bytes of buffer 0"),
        (4, {**view, "byteOffset": large}, f"buffer view 0: byteOffset {large}", "48 bytes of buffer 0"),
        (4, {**view, "buffer": 1}, "buffer view 0: buffer is 1", "1 buffers"),
        (4, {"byteLength": 48}, "buffer view 0: buffer is missing", ""),
        (4, {"buffer": 0}, "byteLength is missing", ""),
        (2, {**view, "byteStride": 4}, "byteStride 4 is shorter", "12 bytes"),
        (3, {**view, "byteStride": 20}, "3 elements end at byte 52", "48 bytes"),
    ]
    expect_errors([(positions_by(wrong, view), *says) for wrong, *says in accessors]
                  + [(positions_by({**whole, "count": count}, wrong), *says) for count, wrong, *says in views])


def test_refuses_what_lies_behind_the_buffer():
    """There are 36 bytes, and the buffer is said to have 24."""
    file = Gltf(("VEC3", [0] * 9))
    text = file.embedded(**FAN).replace('{"byteLength":36,"uri"', '{"byteLength":24,"uri"')
    expect_errors([(text, "byteLength 36 reach beyond the 24 bytes of buffer 0")], name="mesh.gltf")


def test_refuses_more_zeros_than_bytes():
    """Elements without data are zeros: of vertices, of sparse ones, and of indices."""
    view, zeros = {"buffer": 0, "byteLength": 48}, {"componentType": FLOAT, "type": "VEC3"}
    sparse = {"count": 1, "indices": {"bufferView": 0, "componentType": UNSIGNED_INT}, "values": {"bufferView": 0}}
    file = Gltf(("VEC3", POSITIONS))
    file.accessors.append({"componentType": UNSIGNED_INT, "type": "SCALAR", "count": 2100000000})
    expect_errors([(content, says, "the bytes of the file") for content, says in [
        *((positions_by({**zeros, **members}, view), f"accessor 0: has {members['count']} elements without a bufferView")
          for members in ({"count": 2147483647}, {"count": 10000}, {"count": 2147483646, "sparse": sparse})),
        (replaced(file, FAN, '"mode":6', '"indices":1'), "accessor 1: has 2100000000 elements without a bufferView"),
    ]])


def test_refuses_sparse_indices_that_do_not_rise():
    table = []
    for places, expected in (([2, 2], "rising"), ([2, 1], "rising"), ([0, 4], "4 elements")):
        file = Gltf()
        sparse = {"count": 2, "indices": {"bufferView": file.view(places, UNSIGNED_SHORT), "componentType": UNSIGNED_SHORT},
                  "values": {"bufferView": file.view(POSITIONS[:6])}}
        file.accessors = [{"componentType": FLOAT, "count": 4, "type": "VEC3", "sparse": sparse}]
        table.append((file.glb(**FAN), "accessor 0: sparse index 1 is", expected))
    expect_errors(table)


# ---- containers

def test_refuses_wrong_containers():
    whole = rich().glb(**RICH)

    def changed(at, by):
        return whole[:at] + by + whole[at + len(by) :]

    expect_errors([
        (whole[:11], " ends after 11 bytes", "header"),
        (whole[:-1], "cut off"),
        (changed(4, b"\1"), "version 1", "expected 2"),
        (changed(12, struct.pack("<I", struct.unpack_from("<I", whole, 12)[0] + 1)),),
        (changed(14, b"\x7f"), " byte 12: ", "a chunk of", "cut off"),
        (changed(16, b"X"), " byte 12: ", "first chunk is not the JSON"),
        (changed(20, b"}"), " byte ", "no valid JSON"),
    ])
    expect_errors([
        ('{\n"asset":{"version":}}', "2: no valid JSON"),
        ('{\n"asset":', "2: no valid JSON", "ends too early"),
        ("[1]", " no object"),
        # Each object would take a thousand bytes of memory.
        ('{"asset":{"version":"2.0"},"nodes":[{}' + ",{}" * 2000 + "]}", "more objects than one in ten bytes", "a glTF file"),
        ('{"asset":{"version":"1.0"}}', "version 1.0", "expected 2.0"),
        ('{"asset":{"version":"2.1","minVersion":"2.1"}}', "needs a reader of glTF 2.1", "2.0"),
        ('{"asset":{}}', "asset.version is missing", "2.0"),
    ], name="mesh.gltf")


def test_refuses_extensions_that_it_would_need():
    names = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "ACME_fur"]
    expect_errors([(rich().glb(extensionsRequired=["KHR_materials_unlit", name], **RICH), f"requires the extension {name}",
                    "not read") for name in names])


# ---- copies

def test_refuses_wrong_copies():
    """Accessors: 1 three translations, 2 rotations, 3 scales, 4 two translations, 5 three of no data."""
    file = Gltf(("VEC3", POSITIONS), ("VEC3", [1] * 9), ("VEC4", [0, 0, 0, 1] * 3), ("VEC3", [1] * 9), ("VEC3", [1] * 6))
    file.accessors.append({"componentType": FLOAT, "count": 3, "type": "VEC3"})

    def copies(extension, skin=False):
        node = {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": extension}, **({"skin": 0} if skin else {})}
        return file.glb(**{**FAN, "nodes": [{}, node]}, **({"skins": [{"joints": [0]}]} if skin else {}))

    expect_errors([(copies({"attributes": attributes}), found, *expected) for attributes, found, *expected in [
        ({"TRANSLATION": 1, "SCALE": 4}, "node 1", "SCALE is of 2 instances"),
        ({"TRANSLATION": 4, "SCALE": 3}, "node 1", "SCALE is of 3 instances, the attribute before it of 2"),
        ({"TRANSLATION": 2}, "accessor 2: type is VEC4", "VEC3 for TRANSLATION"),
        ({"ROTATION": 99}, "node 1", "ROTATION is 99"),
        ({"TRANSLATION": 5}, "node 1", "nothing says where its instances are"),
        ({"_AGE": 1}, "node 1", "nothing says where its instances are"),
    ]] + [(copies({}), "node 1", "no attributes"), (copies(3), "node 1", "is no object"),
          (copies({"attributes": {"TRANSLATION": 1}}, skin=True), "node 1: has a skin", "does not say")])
