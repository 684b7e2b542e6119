"""The tool's parts by object, group and material: names change with them, and what is found does not."""
from pathlib import Path
from typing import NamedTuple, Optional, Tuple

import pytest

from support.tool.mesh_files import SIDES, corners_of, write_glb
from support.tool.reading import read_json
from support.tool.running import fails, run, usage_error, write_list

MATERIALS = ("Brushed Steel #2", "Rubber", "Glass")
LID = 1
SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


class Box(NamedTuple):
    """A box whose side above is of another material than the five others; name: None for one object with the box before."""

    name: Optional[str]
    low: Tuple[float, ...]
    high: Tuple[float, ...]
    walls: Optional[int]
    lid: Optional[int]
    inverted: bool = False

    def sides(self):
        return [side[::-1] if self.inverted else side for side in SIDES]


def write_obj(path, boxes):
    """Each box shares its vertices between its sides. Only changes of material are written, also across objects."""
    lines, now = [], None
    for b, each in enumerate(boxes):
        lines += [f"o {each.name}"] * (each.name is not None)
        lines += ["v {:g} {:g} {:g}".format(*corner) for corner in corners_of(each.low, each.high)]
        for s, side in enumerate(each.sides()):
            material = each.lid if s == LID else each.walls
            if material != now:
                lines.append(f"usemtl {'(null)' if material is None else MATERIALS[material]}")
            now = material
            lines.append("f " + " ".join(str(8 * b + 1 + corner) for corner in side))
    Path(path).write_text("\n".join(lines) + "\n")


def write_gltf(path, boxes):
    """A node for each box with a name, and three primitives for each box, whose triangles have vertices of their own."""
    arrays, meshes, nodes = [], [], []
    for each in boxes:
        if each.name is not None:
            nodes.append({"name": each.name, "mesh": len(meshes)})
            meshes.append({"primitives": []})
        corners, sides = corners_of(each.low, each.high), each.sides()
        for quads, material in ((sides[:LID], each.walls), ([sides[LID]], each.lid), (sides[LID + 1 :], each.walls)):
            triangles = [corner for a, b, c, d in quads for corner in (a, b, c, a, c, d)]
            arrays.append(("VEC3", [x for corner in triangles for x in corners[corner]]))
            of = {} if material is None else {"material": material}
            meshes[-1]["primitives"].append({"attributes": {"POSITION": len(arrays) - 1}, **of})
    write_glb(path, arrays, nodes=nodes, meshes=meshes, materials=[{"name": name} for name in MATERIALS])


def write(path, boxes):
    (write_gltf if path.endswith(".glb") else write_obj)(path, boxes)
    return path


# ---- what stays, and what changes


def numbers_of(line):
    run(f"check {line} --quiet --json out.json")
    root = read_json("out.json")
    frame = root["frames"][0]
    return frame["depth"], len(root["inside_out"]), frame["crossing_pairs"], frame["touching_pairs"], len(frame["pairs"])


SUNK = (Box("slab", (0, 0, 0), (2, 2, 1), 0, 0), Box("crate", (0.5, 0.5, 0.75), (1.5, 1.5, 2), 0, 1))
OF_GLASS = (SUNK[0]._replace(walls=1), SUNK[1]._replace(walls=2, lid=2))
SCENES = [
    # A crate has sunk into a slab; of the five materials of the two boxes four are the same.
    (SUNK, 0.25, 0, "slab x crate  cross", "Brushed Steel #2 x itself  cross"),
    (OF_GLASS, 0.25, 0, "slab x crate  cross", "Brushed Steel #2 x Glass  cross"),
    # A crate within another one, and one that is inside out besides.
    ((Box("slab", (0, 0, 0), (4, 4, 4), 0, 1), Box("crate", (1, 1, 1), (2, 2, 2), 0, 0)), 2, 0, "slab x crate  inside",
     "Brushed Steel #2 x itself  inside"),
    ((Box("slab", (0, 0, 0), (4, 4, 4), 0, 0), Box("crate", (1, 1, 1), (2, 2, 2), 0, 0, True)), 2, 1, "slab x crate  inside",
     "Brushed Steel #2 x itself  inside"),
    # The wall of a bottle, whose cavity is of another material than its outside.
    ((Box("bottle", (0, 0, 0), (4, 4, 4), 0, 0), Box(None, (1, 1, 1), (2, 2, 2), 2, 2, True)), 0, 0, None, None),
]


@pytest.mark.parametrize("path", ["scene.obj", "scene.glb"])
@pytest.mark.parametrize("boxes, depth, inside_out, by_object, by_material", SCENES)
def test_parts_change_names_alone(path, boxes, depth, inside_out, by_object, by_material):
    """inside_out: so many boxes are taken as turned around; rows of the event: None if all is clean."""
    write(path, boxes)
    plain = numbers_of(f"{path} --weld exact")
    assert plain[:2] == (pytest.approx(depth, abs=1e-12), inside_out)
    for by, row in (("object", by_object), ("material", by_material)):
        assert numbers_of(f"{path} --weld exact --parts-by {by}") == plain
        out = run(f"check {path} --parts-by {by}").out
        assert f"\n{row} " in out if row else out == "Clean: no two triangles cross or touch.\n"
    if path == "scene.glb":  # without welding the sides are apart, and nothing has an inside
        assert numbers_of(f"{path} --weld none --parts-by material") == numbers_of(f"{path} --weld none")


@pytest.mark.parametrize("options", ["", "--parts-by object", "--parts-by material"])
def test_materials_are_welded_by_node(options):
    """The materials of one node are joined, as its triangles are without the option; boxes that stand on each other are not."""
    write_gltf("stand.glb", [Box("a", (0, 0, 0), (1, 1, 1), 0, 1), Box("b", (1, 0, 0), (2, 1, 1), 0, 0)])
    out = run(f"info stand.glb {options}").out
    assert "vertices    16\n" in out and "components  2\n" in out and "not a closed surface" not in out


def test_what_lies_in_its_own_material_is_told():
    """A crate lies in a slab of the same material, which a post of another one crosses at another place."""
    write_obj("post.obj", [Box("slab", (0, 0, 0), (8, 4, 4), 0, 0), Box("crate", (1, 1, 1), (2, 2, 2), 0, 0),
                           Box("post", (5.25, 1.25, 3.75), (6, 2, 9), 2, 2)])
    for options, worst in (("", "slab x crate"), ("--parts-by material", "Brushed Steel #2 x itself")):
        out = run(f"check post.obj --json out.json {options}").out
        assert "; 1 part lies inside another. " in out and f"2 places, worst: {worst}, 2 deep." in out
        assert len(read_json("out.json")["events"]) == 2
        run(f"check post.obj --quiet --fail-depth 1 {options}", code=3)
    assert "\nBrushed Steel #2 x itself  inside " in out and "\nBrushed Steel #2 x Glass   cross " in out


def lists(path, by, line):
    assert f"\nparts       {line}\n" in run(f"info {path} --parts-by {by}").out


def test_info_lists_them():
    boxes = [Box("a", (0, 0, 0), (1, 1, 1), 0, 1), Box("b", (5, 0, 0), (6, 1, 1), None, 0)]
    for path in ("two.obj", "two.glb"):
        lists(write(path, boxes), "material", "2: Brushed Steel #2 (12 triangles), Rubber (2 triangles); 10 in none")
        lists(path, "object", "2: a (12 triangles), b (12 triangles)")
    Path("group.obj").write_text(f"{SQUARE}o a\ng Left Arm\nf 1 2 3\no b\nf 1 3 4\n")
    lists("group.obj", "group", "1: Left Arm (1 triangle); 1 in none")
    lists("group.obj", "object", "2: a (1 triangle), b (1 triangle)")
    run("info two.obj --parts-by material --json out.json")
    parts = [(part["name"], part["triangles"]) for part in read_json("out.json")["parts"]]
    assert parts == [(MATERIALS[0], 12), (MATERIALS[1], 2)]


@pytest.mark.parametrize("path", ["rules.obj", "rules.glb"])
def test_rules_take_materials(path):
    """Rules know materials by their names, and gates go by what is left."""
    line = f"check {write(path, OF_GLASS)} --quiet --parts-by material --fail-on crossing"
    run(f"{line} --only 'Glass,Brushed Steel #2'", code=3)
    run(f"{line} --only Glass,Rubber")
    run(f"{line} --ignore-parts Glass")
    fails(f"check {path} --parts-by material --only slab", "--only: there is no part 'slab'",
          "the parts are Rubber, Brushed Steel #2, Glass")


# ---- other commands, several files


def test_every_command_takes_it():
    write_obj("all.obj", OF_GLASS)
    steel = "Brushed Steel #2 x Glass"
    assert steel in run("check --each all.obj --parts-by material").out
    assert steel in run("replay all.obj all.obj all.obj --parts-by material").out
    write_list("jobs.jsonl", {"model": "all.obj", "options": {"parts-by": "material"}}, {"model": "all.obj"})
    run("check --list jobs.jsonl --results results.jsonl --quiet --fail-on crossing", code=3)
    first, second = Path("results.jsonl").read_text().splitlines()
    assert ("Brushed Steel #2" in first) != ("Brushed Steel #2" in second) and ("slab" in first) != ("slab" in second)
    run("render all.obj --parts-by material --only Glass -o all.png")
    usage_error("check all.obj --parts-by node", "--parts-by cannot be 'node'")


def test_objects_without_materials_are_whole():
    """A file that has none is a part as a whole beside one that has some."""
    write_obj("body.obj", SUNK)
    Path("floor.off").write_text("OFF\n3 1 0\n-9 -9 0.5\n9 -9 0.5\n0 9 0.5\n3 0 1 2\n")
    answer = run("check body.obj --object floor=floor.off --parts-by material")
    assert "floor: OFF files have no materials, so that it is one part" in answer.error
    assert "\nbody/Brushed Steel #2 x floor " in answer.out
