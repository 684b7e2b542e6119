"""Parts that are asked for by --parts-by and that a file does not have: said, with what to do."""
from pathlib import Path

import pytest

from support.tool.mesh_files import write_glb
from support.tool.running import fails, run

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
FILES = {
    "plain.obj": f"{SQUARE}f 1 2 3\n",
    "plain.off": "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    "plain.stl": "solid A\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
                 "endsolid A\n",
    "plain.ply": "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                 "element face 1\nproperty list uchar int vertex_indices\nproperty int part\nend_header\n"
                 "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 7\n",
}


@pytest.fixture(autouse=True)
def files(own_folder):
    """Triangles of no material."""
    for name, text in FILES.items():
        Path(name).write_text(text)
    write_glb("plain.glb", [("VEC3", [0, 0, 0, 1, 0, 0, 0, 1, 0])], nodes=[{"mesh": 0}],
              meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}], materials=[{}])


@pytest.mark.parametrize("name, by, reason", [
    ("plain.glb", "group", "glTF files have no groups; leave it out, or export the model as OBJ with them"),
    ("plain.glb", "material", "none of its triangles has a material"),
    ("plain.obj", "object", "no line 'o' names an object of its faces"),
    ("plain.obj", "group", "no line 'g' names a group of its faces"),
    ("plain.obj", "material", "no line 'usemtl' names a material of its faces"),
    ("plain.off", "object", "the file names no objects"),
    ("plain.off", "group", "OFF files have no groups"),
    ("plain.stl", "material", "STL files have no materials; leave it out, or export the model as OBJ or glTF with them"),
    ("plain.ply", "group", "PLY files have no groups"),
    ("plain.ply", "material", "PLY files have no materials"),
])
def test_who_gets_no_parts_is_told(name, by, reason):
    for command in ("info", "check"):
        fails(f"{command} {name} --parts-by {by}", name, f"--parts-by {by} finds no parts: ", reason)


def test_a_part_is_what_a_file_names_anyway():
    assert "\nparts       1: 7 (1 triangle)\n" in run("info plain.ply --parts-by object").out


def test_parts_are_said_by_one_option():
    Path("parts.csv").write_text("face,name\n0,A\n")
    Path("named.obj").write_text(f"{SQUARE}usemtl A\nf 1 2 3\n")
    both = "--parts and --parts-by both say what the parts are; give one of them"
    fails("check named.obj --parts-by material --parts parts.csv", both)
