"""Files for ParaView, PLY files and lists of what to select hold what the other outputs say, and what is known by hand.

The wall is a box from -1 to 1 (Box) with a seed in its middle (Seed). The bar (Rod) reaches 0.5 deep into it through the side
where x is largest, is out in the second frame, and then in by 0.25. Each of the three has 8 vertices and 12 triangles, two for
each of its six quads.
"""
import os
import re
import struct
from collections import Counter
from pathlib import Path

import pytest

from support.tool.exported import Vtp, read_array
from support.tool.mesh_files import box
from support.tool.reading import read_contacts, read_csv, read_json
from support.tool.recordings import cube
from support.tool.running import fails, run, usage_error

SCENE = "wall.obj --object bar=bar_0007.obj --frames-of bar=bar_%04d.obj"
FRAMES, APART = (7, 8, 9), 8
REACH = {7: 0.5, 8: 0.0, 9: 0.25}
WALL, BAR = 0, 1
FIRST_TRIANGLE, FIRST_VERTEX = {"wall": 0, "bar": 24}, {"wall": 0, "bar": 16}
KINDS = ("crossing", "coplanar", "folded", "duplicate", "touching")
# Of each box, in the order of its faces; along x they are the sides 4 and 5, along y 2 and 3, along z 0 and 1.
SIDE_OF_LARGEST_X = 5


def rod(reach):
    return box((reach, -0.2, -0.125), (3, 0.125, 0.2), "Rod")


@pytest.fixture(autouse=True)
def scene(own_folder):
    Path("wall.obj").write_text(box((-1, -1, -1), (1, 1, 1), "Box") + box((-0.1, -0.1, -0.1), (0.1, 0.1, 0.1), "Seed"))
    for frame, deep in REACH.items():
        Path(f"bar_{frame:04}.obj").write_text(rod(1.0 - deep if deep else 1.5))


# ---- .vtp


@pytest.fixture
def exported(scene):
    run(f"replay {SCENE} --fps 25 --method charge --quiet --vtk out --ply out.ply --contacts contacts.csv --report page.html")
    run(f"check {SCENE} --quiet --csv pairs.csv")


@pytest.mark.parametrize("frame", FRAMES)
def test_surfaces_hold_what_is_found(exported, frame):
    file = Vtp(f"out_{frame:04}.vtp")
    points = [float(x) for name in ("wall.obj", f"bar_{frame:04}.obj") for line in Path(name).read_text().splitlines()
              if line.startswith("v ") for x in line.split()[1:]]
    assert (file.counts["Points"], file.counts["Polys"]) == (24, 36)
    assert file.values("Points", "Points", "Float64") == points
    assert file.values("Polys", "offsets", "Int64") == list(range(3, 109, 3))
    assert file.values("FieldData", "frame", "Int32") == [frame]
    assert file.values("FieldData", "TimeValue", "Float64") == [frame / 25]
    assert file.values("FieldData", "part_names", "String") == ["wall/Box", "wall/Seed", "wall", "bar/Rod", "bar"]
    assert file.values("FieldData", "object_names", "String") == ["wall", "bar"]
    rows = [row for row in read_csv("pairs.csv") if row["frame"] == str(frame)]
    counts = {kind: [0] * 36 for kind in KINDS}
    for row in rows:
        for side in "ab":
            counts[row["kind"]][FIRST_TRIANGLE[row[f"object_{side}"]] + int(row[side])] += 1
    for kind in KINDS:
        assert file.values("CellData", kind, "UInt32") == counts[kind]
    assert file.values("CellData", "intersecting", "UInt8") == [
        2 if counts["crossing"][t] else int(any(counts[kind][t] for kind in KINDS)) for t in range(36)]
    contacts = Counter(FIRST_VERTEX[name] + v for contact in read_contacts("contacts.csv") if contact.frame == frame - 1
                       for name, corners in zip(contact.objects, (contact.a, contact.b)) for v in corners)
    assert file.values("PointData", "contacts", "UInt32") == [contacts[v] for v in range(24)]


def test_some_intervals_have_contacts(exported):
    assert {contact.frame for contact in read_contacts("contacts.csv")} == {7, 8}


@pytest.mark.parametrize("frame", FRAMES)
def test_surfaces_hold_what_the_scene_was_built_for(exported, frame):
    file, out = Vtp(f"out_{frame:04}.vtp"), frame == APART
    triangles = [t if t < 24 else t - 24 for t in range(36)]
    assert file.values("CellData", "triangle", "UInt32") == triangles
    assert file.values("CellData", "polygon", "UInt32") == [t // 2 for t in triangles]
    assert file.values("CellData", "object", "UInt32") == 24 * [WALL] + 12 * [BAR]
    assert file.values("CellData", "part", "Int32") == 12 * [0] + 12 * [1] + 12 * [3]
    buried = []
    for t in range(36):
        body, side = t // 12, t % 12 // 2
        cut = not out and (body == 0 and side == SIDE_OF_LARGEST_X or body == 2 and side < 4)
        buried.append(2 if cut else int(body == 1 or not out and body == 2 and side == 4))
    assert file.values("CellData", "buried", "UInt8") == buried
    depths = 8 * [0.0] + 8 * [0.9] + 4 * [REACH[frame], 0.0]
    assert file.values("PointData", "depth", "Float64") == pytest.approx(depths, abs=1e-12)


def test_surfaces_hold_the_plan(exported):
    """As the page of the report has it, whose charges are float32."""
    file = Vtp("out_0007.vtp")
    charges = file.values("CellData", "charge", "Float64")
    assert charges[0] != 0 and struct.pack("<36f", *charges) == read_array("page.html", "charge")
    assert struct.pack("<36I", *file.values("CellData", "region", "UInt32")) == read_array("page.html", "region")


@pytest.mark.parametrize("frame", FRAMES)
def test_curves_are_where_the_bar_goes_in(exported, frame):
    """Once around the bar, in the side of the wall where x is 1."""
    file = Vtp(f"out_curves_{frame:04}.vtp")
    if frame == APART:
        assert (file.counts["Points"], file.counts["Lines"]) == (0, 0)
        return
    x, y, z = (file.values("Points", "Points", "Float64")[axis::3] for axis in range(3))
    assert file.counts["Lines"] == 1 and file.counts["Points"] == len(x) >= 4
    assert x == pytest.approx([1] * len(x), abs=1e-15)
    assert all(min(abs(b + 0.2), abs(b - 0.125), abs(c + 0.125), abs(c - 0.2)) < 1e-15 for b, c in zip(y, z))
    assert file.values("Lines", "connectivity", "Int64") == [*range(len(x)), 0]
    assert file.values("Lines", "offsets", "Int64") == [len(x) + 1]
    assert file.values("CellData", "length", "Float64") == pytest.approx([1.3], abs=1e-12)
    assert file.values("CellData", "closed", "UInt8") == [1] and file.values("CellData", "touching", "UInt8") == [0]
    assert file.values("CellData", "object_a", "UInt32") == [WALL] and file.values("CellData", "object_b", "UInt32") == [BAR]


def pvd(*sets):
    """A collection: of each set its time and its file."""
    lines = "".join(f'<DataSet timestep="{time}" group="" part="0" file="{name}"/>\n' for time, name in sets)
    return f'<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n{lines}</Collection>\n</VTKFile>\n'


def test_a_pvd_names_the_frames(exported):
    times = ("0.28000000000000003", "0.32000000000000001", "0.35999999999999999")
    assert Path("out.pvd").read_text() == pvd(*((time, f"out_{frame:04}.vtp") for time, frame in zip(times, FRAMES)))


def test_a_pvd_names_the_frames_that_exist():
    """Of a run that ends early it names what is there; times are frame numbers, and names may have any characters."""
    Path("bar_0008.obj").write_text("v nan 0 0\n")
    run(f"check {SCENE} --quiet --vtk 'a&b.pvd'", code=1)
    assert Path("a&b.pvd").read_text() == pvd((7, "a&#38;b_0007.vtp"))
    assert Path("a&b_curves.pvd").read_text() == pvd((7, "a&#38;b_curves_0007.vtp"))
    arrays = Vtp("a&b_0007.vtp").arrays
    assert not {"region", "charge"} & set(arrays["CellData"]) and "contacts" not in arrays["PointData"]


# ---- PLY

PLY_TYPES = {"double": ("Float64", "d"), "uchar": ("UInt8", "B"), "int": ("Int32", "i"), "uint": ("UInt32", "I")}


def properties_of(header, element):
    """The types and names of an element's properties, but for the corners of faces."""
    lines = re.search(rf"^element {element}\n((?:property .*\n)+)", header, re.MULTILINE).group(1).splitlines()
    return [line.split()[1:] for line in lines if not line.startswith("property list uchar uint vertex_indices")]


@pytest.mark.parametrize("frame", FRAMES)
def test_ply_files_hold_the_same(exported, frame):
    """Each property is the array of the same name in the .vtp file, and each such array is a property."""
    file = Vtp(f"out_{frame:04}.vtp")
    header, data = Path(f"out_{frame:04}.ply").read_bytes().split(b"end_header\n", 1)
    header = header.decode("utf-8")
    for line in (f"comment frame {frame}", "comment part 1 wall/Seed", "comment object 1 bar"):
        assert f"\n{line}\n" in header
    vertices, faces = properties_of(header, "vertex 24"), properties_of(header, "face 36")
    of_vertex = struct.Struct("<" + "".join(PLY_TYPES[kind][1] for kind, _ in vertices))
    of_face = struct.Struct("<B3I" + "".join(PLY_TYPES[kind][1] for kind, _ in faces))
    assert len(data) == 24 * of_vertex.size + 36 * of_face.size
    rows = list(of_vertex.iter_unpack(data[: 24 * of_vertex.size]))
    assert [x for row in rows for x in row[:3]] == file.values("Points", "Points", "Float64")
    for section, properties, columns in (("PointData", vertices[3:], list(zip(*rows))[3:]),
                                         ("CellData", faces, list(zip(*of_face.iter_unpack(data[24 * of_vertex.size :])))[4:])):
        arrays = {name: (PLY_TYPES[kind][0], list(column)) for (kind, name), column in zip(properties, columns)}
        assert arrays == file.arrays[section]
    run(f"info out_{frame:04}.ply --json info.json")
    root = read_json("info.json")
    assert (root["vertices"], root["triangles"], len(root["parts"])) == (24, 36, 3)


# ---- lists


def selected(part):
    return part["name"], part["object"], part["vertices"], part["polygons"]


CROSSING = [("wall/Box", "wall", [1, 3, 5, 7], [SIDE_OF_LARGEST_X]), ("bar/Rod", "bar", list(range(8)), [0, 1, 2, 3])]


def test_lists_name_what_to_select():
    run(f"check {SCENE} --quiet --select list.json")
    root = read_json("list.json")
    assert root["version"] == 1
    assert root["objects"][0] == {"name": "wall", "model": "wall.obj", "vertices": 16, "polygons": 12}
    for part, (name, first) in zip(root["parts"], (("wall/Box", 0), ("wall/Seed", 8), ("bar/Rod", 0))):
        assert part == {"name": name, "object": name.split("/")[0], "first_vertex": first, "last_vertex": first + 7,
                        "first_polygon": first // 8 * 6, "last_polygon": first // 8 * 6 + 5}
    assert len(root["parts"]) == 3 and [frame["frame"] for frame in root["frames"]] == [7, 9]
    for parts in (*(frame["parts"] for frame in root["frames"]), root["union"]):
        assert [selected(part) for part in parts] == CROSSING
        assert parts[0]["touching_vertices"] == parts[0]["touching_polygons"] == []


def test_the_union_has_what_any_frame_has():
    """A corner that touches in one frame and crosses in the next is in both lists of the union."""
    for i in (0, 1):
        Path(f"u_{i}.obj").write_text(f"v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 {-i}\nv 1 1 1\nv 2 1 1\nf 1 2 3\nf 4 5 6\n")
    run("check u_0.obj u_1.obj --select list.json --quiet")
    union = read_json("list.json")["union"]
    assert [(part["polygons"], part["touching_polygons"]) for part in union] == [([0], [0]), ([1], [1])]


def test_welded_corners_are_those_of_the_file():
    """Corners are those that a face has in the file, also where another vertex stands for them."""
    split = cube(True)
    split.write_mesh("cube.obj")
    split.write_cache("cube.pc2")
    run("check cube.obj cube.pc2 --quiet --weld exact --select list.json")
    parts = read_json("list.json")["union"]
    assert len(parts) == 2
    for part in parts:
        assert part["vertices"] == sorted({corner for t in part["polygons"] for corner in split.triangles[t]}) != []


# ---- what is written, and what is refused


def test_the_tool_writes_what_is_asked_for():
    run(f"check {SCENE} --quiet --ply checked --select list.json --vtk checked --no-depths")
    run(f"replay {SCENE} --quiet --vtk replayed.pvd --select again.json --frames 8:")
    for name in ("checked_0009.ply", "checked.pvd", "checked_0009.vtp", "replayed.pvd", "replayed_curves_0009.vtp"):
        assert os.path.exists(name)
    assert not os.path.exists("checked_curves.pvd") and not os.path.exists("replayed_0007.vtp")
    run("check checked_0007.ply --quiet --fail-on crossing", code=3)
    assert len(read_json("again.json")["frames"]) == 1


@pytest.mark.parametrize("line, says", [
    ("replay a.obj a.pc2 --no-check --vtk x", ["--no-check"]),
    *((f"check a.obj --vtk x.{ending}", ["--vtk", f"'x.{ending}'", "ends in .pvd"]) for ending in ("png", "vtp", "obj")),
    *((f"check a.obj --ply x.{ending}", ["--ply", f"'x.{ending}'", "ends in .ply"]) for ending in ("obj", "json")),
    ("check a.obj --select x.csv", ["--select", "'x.csv'", "ends in .json"]),
    ("check a.obj --vtk -", ["--vtk", "several files"]),
    ("check a.obj --ply -", ["--ply", "several files"]),
    ("check a.obj --json x.json --select x.json", ["--select", "would overwrite"]),
    ("check wall.obj --select wall.obj", ["--select"]),
    ("replay a.obj a.pc2 --json - --select -", ["standard output twice"]),
])
def test_what_does_not_fit_is_refused(line, says):
    usage_error(line, *says)


def test_endings_may_be_left_out_or_large():
    run(f"check {SCENE} --vtk x.pvd --ply x.PLY --select - --quiet")
    run(f"check {SCENE} --vtk y --ply y --select y --quiet")


def test_meshes_of_others_are_not_written_over():
    """A mesh that somebody else wrote stays, byte for byte."""
    older = "ply\nformat binary_little_endian 1.0\ncomment cscd plan 1\nelement vertex 0\n"
    Path("mine_0008.ply").write_text(older)
    fails(f"check {SCENE} --ply mine", "mine_0008.ply' exists")
    assert Path("mine_0008.ply").read_text() == older
    for option, output in (("--ply", "missing/out_0007.ply"), ("--vtk", "missing/out.pvd"), ("--select", "missing/out")):
        fails(f"check {SCENE} {option} missing/out", f"{output}: cannot write")


def test_a_folder_of_frames_gets_no_meshes():
    """Frames that are read from a folder would have the exported ones among them the next time."""
    Path("frames").mkdir()
    for frame, deep in REACH.items():
        Path(f"frames/bar_{frame}.obj").write_text(rod(1.0 - deep))
    fails("check frames/bar_7.obj frames --ply frames/more", "among the frames")
