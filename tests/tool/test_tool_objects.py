"""The tool takes several meshes, each with its own frames, as one recording."""
from pathlib import Path

import pytest

from support.tool.mesh_files import write_soft_bar
from support.tool.reading import CONTACT_COLUMNS, read_contacts, read_json
from support.tool.recordings import tetrahedra
from support.tool.running import fails, run, usage_error

FRAMES = 8
BOTH = "wall.obj --object dart=dart.obj --frames-of dart=dart.pc2"
WALL, DART = (range(0, 4), range(0, 4)), (range(4, 8), range(4, 8))


@pytest.fixture(autouse=True)
def files(own_folder):
    both = tetrahedra(FRAMES)
    for name, scene in (("both", both), ("wall", both.part(*WALL)), ("dart", both.part(*DART))):
        scene.write_mesh(f"{name}.obj")
        scene.write_cache(f"{name}.pc2")


# ---- contacts


@pytest.mark.parametrize("objects", [
    "wall.obj wall.pc2 --object dart=dart.obj --frames-of dart=dart.pc2",
    "--object wall=wall.obj --frames-of dart=dart.pc2 --object dart=dart.obj",  # the wall rests
])
def test_objects_meet_as_in_one_mesh(objects):
    run("replay both.obj both.pc2 --quiet --method none --contacts out.jsonl")
    expected = read_contacts("out.jsonl")
    run(f"replay {objects} --quiet --method none --contacts out.jsonl")
    first = {"wall": 0, "dart": 4}
    found = []
    for contact in read_contacts("out.jsonl"):
        a, b = (tuple(v + first[name] for v in corners) for name, corners in zip(contact.objects, (contact.a, contact.b)))
        found.append(contact._replace(a=a, b=b, objects=()))
    assert found == expected != []


def test_obstacles_do_not_meet_each_other():
    run("replay --obstacle wall=wall.obj --obstacle dart=dart.obj --frames-of dart=dart.pc2 --no-check --contacts out.csv")
    assert Path("out.csv").read_text() == ",".join([*CONTACT_COLUMNS, "object_a", "object_b"]) + "\n"


def test_tables_name_objects_in_quotes():
    run("replay --object 'a \"b\"=wall.obj' --object dart=dart.obj --frames-of dart=dart.pc2 --quiet --contacts out.csv")
    assert ',"dart","a ""b"""\n' in Path("out.csv").read_text()
    assert {contact.objects for contact in read_contacts("out.csv")} == {("dart", 'a "b"')}


# ---- checks


def test_lists_of_pairs_name_objects():
    def pairs(options):
        run(f"check {BOTH} --quiet --json check.json {options}")
        frames = read_json("check.json")["frames"]
        assert len(frames) == FRAMES
        return len(frames[5]["pairs"])

    Path("pairs.txt").write_text("".join(f"wall:{a} dart:{b}\n" for a in range(4) for b in range(4)))
    assert pairs("") > 0 and pairs("--ignore pairs.txt") == 0
    Path("bad.txt").write_text("wall:1 hat:2\n")
    fails("check wall.obj --object dart=dart.obj --ignore bad.txt", "bad.txt:1", "NAME:A NAME:B")


# ---- errors


def test_unfit_objects_are_refused():
    tetrahedra(FRAMES + 2).part(*DART).write_cache("longer.pc2")
    fails("replay wall.obj wall.pc2 --object dart=dart.obj --frames-of dart=longer.pc2",
          "wall has 8 frames", "dart has 10", "longer.pc2")
    fails("replay wall.obj wall.pc2 --object wall=wall.obj", "two objects are called wall")
    fails("replay wall.obj wall.pc2 --frames-of dart=dart.pc2", "--frames-of dart", "no object of that name")
    fails("replay wall.obj wall.pc2 --frames-of wall=wall.pc2", "--frames-of wall", "has frames already")
    for value in ("dart", "=x.obj", "a:b=x.obj"):
        usage_error(f"check wall.obj --object {value}", f"--object cannot be '{value}'")
    usage_error("check", "no MODEL given")
    usage_error("replay --object dart=dart.obj", "no FRAMES given")


def test_errors_in_frames_name_their_object():
    dart = tetrahedra(3).part(*DART)
    dart.frames[2][3] = (1e-320, *dart.frames[2][3][1:])
    dart.write_sequence("s_%d.obj", 1000)
    fails("check wall.obj --object dart=dart.obj --frames-of dart=s_%d.obj", "frame 1002 could not be read: dart: vertex 3 has x")


def test_differing_numbers_are_told():
    scene = tetrahedra(3)
    scene.part(*DART).write_sequence("n_%d.obj", 11)
    scene.part(*WALL).write_cache("n.pc2")
    answer = run("check wall.obj n.pc2 --object dart=dart.obj --frames-of dart=n_%d.obj")
    assert "dart calls its frames 11 to 13, and wall calls them 0 to 2" in answer.error


# ---- plans


def test_every_object_has_the_stiffness_of_its_model():
    """The bar is the last object, so that its triangles have other numbers in the mesh than in its model."""
    line = "replay --object wall=wall.obj --object dart=dart.obj --frames-of dart=dart.pc2 --object bar=bar.ply"
    for soft, regions in ((3.0, 3), (0.25, 4)):
        write_soft_bar("bar.ply", soft)
        assert f"plan: charge, {regions} regions, made in memory in " in run(f"{line} --no-check").out
    write_soft_bar("bar.ply", bad=(90, -1.0))
    assert "bar.ply: the stiffness of face 90 is -1, expected" in run(f"{line} --method charge", code=1).error
