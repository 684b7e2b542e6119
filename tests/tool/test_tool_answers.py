"""The answers of check and replay: the sentence, the events in every form, and the rules that fail a run."""
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from support.tool.reading import read_csv, read_json
from support.tool.recordings import tetrahedra
from support.tool.running import fails, run, usage_error

WALL = '<Wall>&"Co"'
CROSSING = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 -1\nv 2 1 -1\nv 1 1 1\nf 4 5 6\n"
TOUCHING = "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 0\nv 2 1 1\nv 1 2 1\nf 4 5 6\n"
# The wall's deepest point of the dart at frame 6 is as far above the face z = 0 as its z.
EVENT = {"a": WALL, "b": "Dart", "first": 4, "last": 7, "worst": 6, "kinds": ["crossing"], "pairs": 18, "contacts": 0,
         "depth": 0.833984375, "length": 4.424960917984071, "point": [-0.84375, 0.875, 0.833984375], "triangle": 7, "face": 7,
         "object": "named"}


@pytest.fixture(autouse=True)
def files(own_folder):
    flight = tetrahedra(8)
    flight.write_mesh("named.obj", records=[f"o {WALL}"] * 4 + ["o Dart"] * 4)
    flight.write_cache("flight.pc2")


# ---- the sentence


def test_the_answer_comes_first():
    found = f"Frames 4 to 7 cross (4 of 8). 1 event, {WALL} x Dart, frames 4 to 7, "
    assert run("replay named.obj flight.pc2").first_line == found + "0.834 deep at frame 6."
    answer = run("check named.obj flight.pc2")
    assert answer.first_line == found + "0.834 deep at frame 6."
    assert f"\n{WALL} x Dart  cross    4 to 7               6      0.834  " in answer.out
    assert run("replay named.obj flight.pc2 --unit cm").first_line == found + "8.34 mm deep at frame 6."
    assert run("replay named.obj flight.pc2 --first-frame 1001 --frames 1001:1003").first_line == \
        "No frame crosses or touches (3 checked). Only frames 1001 to 1003 of 1001 to 1008 were looked at."
    assert "All 3 frames cross. 1 event, " in run("replay named.obj flight.pc2 --frames 4:6").out


def test_quiet_says_nothing_of_the_mesh():
    Path("one.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert "is an open surface" in run("check one.obj").error
    assert run("check one.obj --quiet") == (0, "", "")


def test_each_third_frame_is_looked_at():
    assert run("check named.obj flight.pc2 --frames 0:6:3 --json out.json").first_line.startswith("Frame 6 crosses (1 of 3).")
    assert [(frame["frame"], frame["crossing_pairs"] > 0) for frame in read_json("out.json")["frames"]] == \
        [(0, False), (3, False), (6, True)]


@pytest.mark.parametrize("text, sentence", [
    ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "Clean: no two triangles cross or touch."),
    (CROSSING, "1 pair of triangles crosses, with 2 of 2 triangles (100 %). 1 place, A x B, crossing along 0.5."),
    (TOUCHING, "1 pair of triangles touches, none cross. 1 place, A x B."),
])
def test_one_mesh_has_a_sentence_of_its_own(text, sentence):
    Path("one.obj").write_text(text.replace("f 1 2 3", "o A\nf 1 2 3").replace("f 4 5 6", "o B\nf 4 5 6"))
    assert run("check one.obj").first_line == sentence


# ---- events


def test_events_are_the_same_in_every_form():
    run("check named.obj flight.pc2 --json out.json --events out.csv")
    root = read_json("out.json")
    assert root["events"] == [pytest.approx(EVENT, rel=1e-12)] and root["unit"] is None
    event, (row,) = root["events"][0], read_csv("out.csv")
    assert list(row) == "a,b,first,last,worst,kinds,pairs,contacts,depth,length,x,y,z,triangle,face,object".split(",")
    assert [float(row[axis]) for axis in "xyz"] == event["point"] and row["kinds"] == "crossing"
    for key in set(row) & set(event) - {"kinds"}:
        assert type(event[key])(row[key]) == event[key]
    assert '\n"<Wall>&""Co""","Dart",4,7,6,' in Path("out.csv").read_text()
    run("check named.obj flight.pc2 --json out.json --no-depths")
    assert read_json("out.json")["events"] == [{**EVENT, "depth": None, "point": None, "length": 0, "triangle": 0, "face": 0}]


def test_events_of_a_replay_have_contacts():
    """Contacts of intervals belong to the frames at their ends, so the event is that of check and theirs."""
    run("replay named.obj flight.pc2 --json out.json --unit mm")
    root = read_json("out.json")
    frame, contacts = root["frames"][6], root["summary"]["vf"] + root["summary"]["ee"]
    assert root["events"] == [pytest.approx({**EVENT, "contacts": contacts}, rel=1e-12)] and contacts == 2
    assert root["unit"] == "mm"
    assert frame["depth"] == EVENT["depth"] and frame["crossing_share"] == frame["crossing_faces"] / 8
    run("replay named.obj flight.pc2 --json out.json --no-check")
    root = read_json("out.json")
    assert root["events"][0]["pairs"] == 0 and root["events"][0]["contacts"] > 0
    assert root["frames"][6]["crossing"] is None


def test_polygons_have_the_numbers_of_the_file():
    """Two quads and a triangle that passes through the second one: triangles 2 and 3 are the polygon 1."""
    Path("quads.obj").write_text("v 9 0 0\nv 10 0 0\nv 10 1 0\nv 9 1 0\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n"
                                 "v 0.9 0.8 -1\nv 1.1 0.8 -1\nv 1 1.1 1\nf 1 2 3 4\nf 5 6 7 8\nf 9 10 11\n")
    run("check quads.obj --json out.json --csv out.csv")
    frame = read_json("out.json")["frames"][0]
    assert frame["pairs"] and all(pair[0] in (2, 3) and pair[1] == 4 for pair in frame["pairs"])
    assert [face[:2] for face in frame["faces"]] == [[1, 2]] * len(frame["pairs"])
    assert '0,crossing,2,4,1,2,"component 1","component 2","quads","quads"\n' in Path("out.csv").read_text()


# ---- rules


@pytest.mark.parametrize("code, line", [
    (0, "check --fail-on crossing --frames :3"), (3, "check --fail-on crossing --frames :4"),
    (3, "check --fail-on touching --frames :4"), (0, "replay --fail-on contact --frames :3"),
    (3, "replay --fail-on contact --frames :4"), (3, "replay --fail-on crossing --frames :4"),
    (0, "check --fail-depth 0.85"), (3, "check --fail-depth 0.8"),
    (0, "replay --fail-depth 0.85"), (3, "replay --fail-depth 0.8"),
    (0, "check --max-faces 8"), (3, "check --max-faces 1"),
    (2, "check --fail-on contact"), (2, "check --fail-depth -1"), (2, "check --fail-depth '1 parsec'"), (2, "check --unit yard"),
    (1, "check --fail-depth 2mm"), (1, "replay --fail-depth 2mm"),
    (3, "check --fail-depth 8mm --unit cm"), (0, "check --fail-depth 8.5mm --unit cm"),
    (3, "replay --fail-depth 2ft --unit m"), (0, "replay --fail-depth 3ft --unit m"),
])
def test_rules_fail_the_run(code, line):
    run(line, "named.obj", "flight.pc2", code=code)


@pytest.mark.parametrize("code, line", [
    # The meshes of check --each fail by the same words.
    (0, "check --each touch.obj named.obj --fail-on crossing"), (3, "check --each touch.obj named.obj --fail-on touching"),
    (3, "check --each touch.obj named.obj --fail-on-touching"), (0, "check --each touch.obj --fail-depth 1"),
    # A body that stands in another one for all frames moves without a new contact: it fails as well.
    (0, "check touch.obj --fail-on crossing"), (3, "check touch.obj --fail-on touching"),
    (3, "check touch.obj --fail-on-contact"), (3, "replay touch.obj touch.obj touch.obj --fail-on contact"),
    (0, "replay touch.obj touch.obj touch.obj --fail-on crossing"),
])
def test_rules_tell_touching_from_crossing(code, line):
    Path("touch.obj").write_text(TOUCHING)
    run(line, code=code)


def test_standing_intersections_fail():
    answer = run("replay named.obj flight.pc2 --frames 4:5 --fail-on contact --ignore-parts Dart,Dart", code=3)
    said = f"cscd: failed: 2 of 2 frames, the first is frame 4: 3 pairs of triangles cross, worst: {WALL} x Dart\n"
    assert said in answer.error


def test_junit_has_a_case_for_each_frame():
    def cases(line, code):
        run(line, code=code)
        suite = ElementTree.parse("out.xml").getroot()
        suite = suite if suite.tag == "testsuite" else suite.find("testsuite")
        failed = {case.get("name"): case.find("failure").get("message") for case in suite.iter("testcase") if len(case)}
        assert len(list(suite.iter("testcase"))) == int(suite.get("tests")) == 8 and int(suite.get("failures")) == len(failed)
        return failed

    failed = cases("check named.obj flight.pc2 --junit out.xml", 0)
    assert list(failed) == [f"frame {k}" for k in range(4, 8)]
    assert failed["frame 4"] == f"3 pairs of triangles cross, worst: {WALL} x Dart"
    assert all(message.endswith(f" pairs of triangles cross, worst: {WALL} x Dart") for message in failed.values())
    failed = cases("replay named.obj flight.pc2 --junit out.xml --fail-depth 0.83 --quiet", 3)
    assert list(failed) == ["frame 6"] and failed["frame 6"].startswith("0.834 deep, worst: ")


def test_long_names_are_cut_between_characters():
    name = "x" + 80 * "Ä"
    Path("long.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv .2 .2 -1\nv .2 .2 1\nv .3 .3 1\n"
                                f"o {name}\nf 1 2 3\no B\nf 4 5 6\n", encoding="utf-8")
    assert f"worst: {name[:50]} x B" in run("check long.obj --fail-on crossing", code=3).error
    fails("check long.obj --only C", "Ä, B")


# ---- outputs


@pytest.mark.parametrize("line, says", [
    ("check named.obj --events named.obj", ["--events", "would overwrite"]),
    ("check named.obj --events e.json", ["--events", "ends in .csv"]),
    ("replay named.obj flight.pc2 --junit j.csv", ["--junit", "ends in .xml"]),
    ("check named.obj --json - --csv -", ["--csv", "standard output twice"]),
    ("replay named.obj flight.pc2 --contacts out.csv --events out.csv", ["--events", "would overwrite"]),
    ("check named.obj --json - --junit -", ["--junit", "standard output twice"]),
    ("check named.obj --events - --junit -", ["--junit", "standard output twice"]),
])
def test_outputs_are_not_inputs_nor_each_other(line, says):
    usage_error(line, *says)


def test_events_may_be_the_standard_output():
    fails("check named.obj --events /nowhere/e.csv", "nowhere", "cannot write")
    answer = run("check named.obj flight.pc2 --events -")
    assert answer.out.startswith("a,b,first") and answer.error.startswith("Frames 4 to 7 cross")
