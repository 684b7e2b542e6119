"""Which format a mesh file has, and what is said of files of others, and of what is no file."""
import os

import pytest

from support.tool.read_back import SQUARE, expect_errors, expect_mesh
from support.tool.running import fails

OBJ = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"
OFF = "4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"
PLY = ("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")


@pytest.mark.parametrize("name, content", [
    ("a.obj", OBJ), ("a.OBJ", OBJ), ("a.obj", f"OFF\n{OFF}"), ("a.off", PLY), ("a", PLY), ("a.Off", OFF),
    ("a.obj", f"#usda\n{OBJ}"),  # a comment like another
])
def test_chooses_the_format(name, content):
    expect_mesh(content, SQUARE, [(0, 1, 2), (0, 2, 3)], name)


@pytest.mark.parametrize("name, content, says", [
    ("a.txt", OBJ, ["unknown format", "expected a mesh: .obj, .ply"]),
    (".obj", OBJ, ["unknown format", "expected a mesh: .obj, .ply"]),
    ("a.PLY", OBJ, ["1: ", "found 'v'", "expected ply"]),
    ("a.off", OBJ, ["1: ", "found 'v'", "the number of vertices"]),
    ("a.obj", "", ["the file is empty", "expected an OBJ, PLY, OFF, STL, glTF or GIFTI mesh"]),
    ("a.ply", "", ["the file is empty", "expected an OBJ, PLY, OFF, STL, glTF or GIFTI mesh"]),
    *((name, content, ["which is not read: export the mesh as OBJ", "docs/artist/formats.md"]) for name, content in [
        ("a.abc", "?"), ("a", b"Ogawa\xff"), ("a.usd", "?"), ("a.USDA", "?"), ("a.usdc", "?"), ("a.usdz", "PK"), ("a.fbx", "?"),
        ("a.txt", "#usda 1.0\n"), ("a", "Kaydara FBX Binary  \0"), ("a.blend", "?"), ("a", "BLENDER-v304"), ("a.x3d", "<X3D/>"),
        ("a.dae", "<COLLADA/>"), ("a.hipnc", "?"), ("a.ztl", "?"), ("a.zprj", "?"), ("a.c4d", "?")]),
    ("a.vtp", "?", ["a VTK file", "convert it to OBJ"]),
    *((name, b"\xff\xff\xfe", ["FreeSurfer", "mris_convert"]) for name in ("lh.pial", "surface")),
])
def test_names_the_way_out_of_other_formats(name, content, says):
    expect_errors([(content, *says)], name=name)


def test_refuses_what_is_no_file():
    os.mkdir("folder")
    for path in ("none.obj", "none/a.obj", ""):
        fails(f"check '{path}'", f"{path}: cannot open: No such file")
    fails("check folder", "folder: is a directory, expected a file")
