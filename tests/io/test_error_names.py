"""Names of users in the errors of glTF files: long ones are cut, and never within a character."""
import json

import pytest

from support.tool.mesh_files import FLOAT, Gltf
from support.tool.read_back import expect_errors, shown, whole, write_file
from support.tool.running import run

MESH = {"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]}


def document(**members):
    return json.dumps({"asset": {"version": "2.0"}, **members}, ensure_ascii=False)


def in_buffer(uri):
    """A file whose buffer is beside it."""
    return Gltf(("VEC3", [0] * 9)).text(uri, **MESH).encode().decode("unicode_escape")


def test_names_of_gltf_are_cut():
    accessors = [{"componentType": FLOAT, "count": 3, "type": whole(20)}]
    expect_errors([(content, f"{before}{shown(most)}{after}") for content, most, before, after in [
        (document(asset={"version": whole(20)}), 20, "is a glTF file of version ", ", expected 2.0"),
        (document(asset={"version": "2.1", "minVersion": whole(20)}), 20, "needs a reader of glTF ", ", this one"),
        (document(extensionsRequired=[whole(80)]), 80, "requires the extension ", ", which is not read"),
        (document(**{**MESH, "nodes": [{"mesh": whole(40)}]}), 40, "node 0: mesh is ", ", expected a whole number"),
        (document(**{**MESH, "nodes": [{"mesh": 0, "scale": [1, whole(40), 1]}]}), 40, "node 0: scale[1] is ",
         ", expected a finite number"),
        (document(**MESH, accessors=accessors), 20, "accessor 0: type is ", ", expected VEC3 for POSITION"),
        (in_buffer(f"/{whole(79)}"), 79, "buffer 0: uri /", ", expected a file in the folder"),
        (in_buffer(f"{whole(80)}%"), 80, "buffer 0: uri ", " has a percent sign"),
    ]], name="mesh.gltf")


def animated(*animations):
    file = Gltf(("VEC3", [0, 0, 0, 1, 0, 0, 0, 1, 0]), ("SCALAR", [0, 1]), ("VEC3", [0, 0, 0, 1, 0, 0]))
    return file.glb(**MESH, animations=animations)


def test_names_of_animations_are_cut():
    """Names of animations that do not fit are three dots."""
    channel = {"sampler": 0, "target": {"node": 0, "path": "translation"}}
    sampler = {"input": 1, "output": 2, "interpolation": whole(40)}
    expect_errors([(animated({"samplers": [sampler], "channels": [channel]}), f"interpolation is {shown(40)}, expected LINEAR")])
    write_file("mesh.glb", animated(*[{"name": whole(60)}] * 6))
    error = run("check mesh.glb --animation", whole(100), code=1).error
    assert error.endswith(f"holds no animation {shown(100)}, but: {f'{shown(60)}, ' * 4}...\n")


@pytest.mark.parametrize("name", ["\u00e9" * 350 + "y.obj", "x" + "\u00e9" * 350 + "yy.obj"])
def test_the_ends_of_paths_are_shown(name):
    """From a whole character on."""
    error = run("check", name, code=1).error.encode("utf-8")  # which refuses parts of characters
    assert error.startswith("cscd: ...\u00e9".encode("utf-8"))
