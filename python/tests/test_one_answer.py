"""What is found is the same wherever it is read: the first line, tables, JSON, events, JUnit, gates, --each, the page, Python.

Each scene has its answer by hand: what the parts A and B do, and how deep. The scenes are boxes along the axes, for which the
depth is the greatest distance of a point of one box's surface within the other from that one's surface.
"""

from __future__ import annotations

import csv
import itertools
import json
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Tuple

import pytest

import cscd

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests" / "report"))

from report_file import Report  # noqa: E402

Box = Tuple[Tuple[float, ...], Tuple[float, ...]]


class Scene(NamedTuple):
    """Two boxes, by their least and greatest corners, and what is right of them."""

    a: Box
    b: Box
    #: "cross", "overlap", "inside", "copies", "touch" or "" for nothing.
    word: str
    depth: float
    #: B's faces look inwards.
    inverted: bool = False


UNIT: Box = ((0, 0, 0), (1, 1, 1))

SCENES: Dict[str, Scene] = {
    "apart": Scene(UNIT, ((2, 0, 0), (3, 1, 1)), "", 0.0),
    # B's end, and A's face within B, are 0.125 from the other's surface.
    "crossing": Scene(UNIT, ((0.875, 0.25, 0.25), (2, 0.75, 0.75)), "cross", 0.125),
    # The rod's end is 0.4375 from the side that it came in by.
    "rod enters": Scene(UNIT, ((-1, 0.4375, 0.4375), (0.4375, 0.5625, 0.5625)), "cross", 0.4375),
    # Half-way each side of the rod is 0.4375 from the side of A that it looks to.
    "rod through": Scene(UNIT, ((-1, 0.4375, 0.4375), (2, 0.5625, 0.5625)), "cross", 0.4375),
    "inverted": Scene(UNIT, ((0.875, 0.25, 0.25), (2, 0.75, 0.75)), "cross", 0.125, True),
    # Walls of 0.25 that share a corner of 0.25 by 0.25, flush on four sides; the triangles of two sides cross.
    "walls": Scene(((0, 0, 0), (4, 0.25, 3)), ((3.75, 0, 0), (4, 4, 3)), "cross", 0.125),
    "flush": Scene(((0, 0, 0), (2, 1, 1)), ((1.5, 0, 0), (3, 1, 1)), "overlap", 0.5),
    # The corner (2, 2, 2) of B is 2 from A's far and near faces.
    "inside": Scene(((0, 0, 0), (4, 4, 4)), ((1, 1, 1), (2, 2, 2)), "inside", 2.0),
    "inverted inside": Scene(((0, 0, 0), (4, 4, 4)), ((1, 1, 1), (2, 2, 2)), "inside", 2.0, True),
    "copies": Scene(UNIT, UNIT, "copies", 0.0),
    "side by side": Scene(UNIT, ((1, 0, 0), (2, 1, 1)), "touch", 0.0),
    "stands on it": Scene(UNIT, ((0.25, 0.25, 1), (0.75, 0.75, 2)), "touch", 0.0),
}


def corners(box: Box) -> List[Tuple[float, ...]]:
    """The corners of a box, x first."""
    return [(x, y, z) for z, y, x in itertools.product(*((box[0][k], box[1][k]) for k in (2, 1, 0)))]


def faces(inverted: bool) -> List[Tuple[int, ...]]:
    """The faces of a box, outwards or inwards."""
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return [quad[::-1] if inverted else quad for quad in quads]


def write(path: Path, boxes: List[Tuple[str, Box, bool]], named: bool = True) -> str:
    """An OBJ with an object for each box, or with all boxes in one."""
    lines = []
    for number, (name, box, inverted) in enumerate(boxes):
        lines += [f"o {name}"] * named
        lines += ["v %.17g %.17g %.17g" % corner for corner in corners(box)]
        lines += ["f " + " ".join(str(8 * number + corner + 1) for corner in face) for face in faces(inverted)]
    path.write_text("\n".join(lines) + "\n")
    return path.name


class Tool:
    """Runs of the tool in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __call__(self, *words: str, code: int = 0) -> str:
        """What a run prints that must end with this code."""
        program = os.path.join(os.path.dirname(cscd.__file__), "__main__.py")  # `-m cscd` loads numpy each time
        done = subprocess.run([sys.executable, "-I", program, *words], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE)
        assert done.returncode == code, f"{words}: {done.returncode}\n{done.stdout}{done.stderr}"
        return done.stdout

    def json(self, name: str) -> Dict[str, Any]:
        """A file of JSON."""
        found: Dict[str, Any] = json.loads((self.folder / name).read_text())
        return found


#: What the first line says of each word, and JSON by counts of parts.
SAID = {"": r"^Clean: no two triangles cross or touch\.$",
        "cross": r"^\d+ pairs of triangles cross, with \d+ of 24 triangles ",
        "overlap": r"^1 pair of parts overlaps; \d+ pairs of triangles touch, none cross\. ",
        "inside": r"^1 part lies inside another; no two triangles cross or touch\. ",
        "copies": r"^1 pair of parts is two copies of one solid; \d+ pairs of triangles touch, none cross\. ",
        "touch": r"^\d+ pairs? of triangles touch(es)?, none cross\. "}
#: The same of two such frames.
PLAYED = {"": "No frame crosses or touches (2 checked).", "cross": "All 2 frames cross. ", "overlap": "All 2 frames overlap. ",
          "inside": "All 2 frames have one part inside another. ", "copies": "All 2 frames have two copies of one solid. ",
          "touch": "No frame crosses; frames 0 to 1 touch (2 of 2). "}
COUNTED = {"overlap": "overlapping_parts", "inside": "inside_parts", "copies": "same_solids"}
OUTCOME = {"": "1 clean", "cross": "1 with intersections", "touch": "1 only touching"}


def expect_depth(found: float, scene: Scene) -> None:
    """It is never above the right one, and at most 1 % below."""
    assert 0.99 * scene.depth <= found <= scene.depth * (1.0 + 1e-12), (found, scene)


def expect_printed(text: str, scene: Scene) -> None:
    """The same in three digits; "-" or nothing for 0."""
    assert abs(float(text.replace("-", "0")) - scene.depth) <= 0.015 * scene.depth, (text, scene)


def expect_text(text: str, scene: Scene, pair: str = "A x B") -> None:
    """The first line, and the row of the table."""
    first = text.splitlines()[0]
    assert re.search(SAID[scene.word], first), first
    deep = re.search(r"([\d.]+) deep", first)
    expect_printed(deep.group(1) if deep else "-", scene)
    rows = [line for line in text.splitlines() if line.startswith(pair + " ")]
    assert len(rows) == (scene.word != ""), text
    for row in rows:
        word, depth = row[len(pair) + 1:].split()[:2]
        assert word == scene.word, row
        expect_printed(depth, scene)


def expect_frame(frame: Dict[str, Any], scene: Scene) -> None:
    """A frame of JSON."""
    assert (frame["crossing"], frame["clean"]) == (scene.word == "cross", scene.word == ""), frame
    for word, member in COUNTED.items():
        assert frame[member] == (scene.word == word), (member, frame)
    assert (frame["crossing_pairs"] > 0) == (scene.word == "cross")
    expect_depth(frame["depth"], scene)


def expect_events(events: List[Dict[str, Any]], scene: Scene, pair: str = "A x B") -> None:
    """Events of JSON or of the page: one, if any."""
    assert len(events) == (scene.word != "")
    for event in events:
        assert f"{event['a']} x {event['b']}" == pair
        assert ("crossing" in event["kinds"]) == (scene.word == "cross")
        assert ("same_solid" in event["kinds"]) == (scene.word == "copies")
        expect_depth(event["depth"] or 0.0, scene)


@pytest.fixture(params=SCENES)
def scene(request: Any, tmp_path: Path) -> Tuple[Scene, Tool]:
    """A scene, in one file and in two."""
    made = SCENES[request.param]
    write(tmp_path / "scene.obj", [("A", made.a, False), ("B", made.b, made.inverted)])
    write(tmp_path / "unnamed.obj", [("A", made.a, False), ("B", made.b, made.inverted)], named=False)
    write(tmp_path / "A.obj", [("A", made.a, False)])
    write(tmp_path / "B.obj", [("B", made.b, made.inverted)])
    return made, Tool(tmp_path)


def test_check(scene: Tuple[Scene, Tool]) -> None:
    """Sentence, table, JSON, events and JUnit of one file, and of a file for each part."""
    made, tool = scene
    for words in (["scene.obj"], ["--object", "A=A.obj", "--object", "B=B.obj"]):
        meets = made.word not in ("", "touch")
        text = tool("check", *words, "--json", "found.json", "--events", "events.csv", "--junit", "found.xml",
                    "--fail-on", "crossing", code=3 if meets else 0)
        expect_text(text, made)
        found = tool.json("found.json")
        assert found["complete"] is True
        expect_frame(found["frames"][0], made)
        expect_events(found["events"], made)
        assert [entry["part"] for entry in found["inside_out"]] == (["B"] if made.inverted else [])
        with open(tool.folder / "events.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        assert [(row["a"], row["b"]) for row in rows] == [("A", "B")] * (made.word != "")
        for row, event in zip(rows, found["events"]):
            assert float(row["depth"]) == (event["depth"] or 0.0)
        suite = ElementTree.parse(tool.folder / "found.xml").getroot().find("testsuite")
        assert suite is not None
        assert (suite.attrib["failures"], suite.attrib["errors"]) == (str(int(meets)), "0")


def test_without_names(scene: Tuple[Scene, Tool]) -> None:
    """Both boxes in one file that names none of them, or both alike: its components are bodies, in Python without labels, too."""
    made, tool = scene
    if made.inverted and made.word == "inside":  # a cavity, which only names tell from a body
        made = made._replace(word="", depth=0.0)
    pair, meets = "component 0 x component 1", made.word not in ("", "touch")
    text = tool("check", "unnamed.obj", "--json", "found.json", "--fail-on", "crossing", code=3 if meets else 0)
    expect_text(text, made, pair)
    found = tool.json("found.json")
    expect_frame(found["frames"][0], made)
    expect_events(found["events"], made, pair)
    (tool.folder / "one.obj").write_text("o All\n" + (tool.folder / "unnamed.obj").read_text())
    tool("check", "one.obj", "--json", "one.json", "--fail-on", "crossing", code=3 if meets else 0)
    expect_frame(tool.json("one.json")["frames"][0], made)
    expect_events(tool.json("one.json")["events"], made, "All x All")
    recording = cscd.read(tool.folder / "unnamed.obj")
    plain = cscd.self_intersections(recording.vertices, recording.mesh.triangles)
    expect_depth(plain.max_depth, made)
    parts = plain.by_parts(recording.part_labels, bodies=recording.body_labels)
    assert [bool(part.same_solid) for part in parts] == [made.word == "copies"] * (made.word != "")


def test_gates(scene: Tuple[Scene, Tool]) -> None:
    """Half of the depth is too deep, twice as much is not; of many meshes, each alone, as of one."""
    made, tool = scene
    for each in ([], ["--each"]):
        for share in (0.5, 0.98, 1.02, 2.0):
            limit = f"{(made.depth or 0.001) * share:.17g}"
            fails = made.word == "copies" or (made.depth > 0.0 and share < 1.0)  # how deep copies are nobody knows
            tool("check", *each, "scene.obj", "--fail-depth", limit, code=3 if fails else 0)
    meets = made.word not in ("", "touch")
    text = tool("check", "--each", "scene.obj", "--json", "each.jsonl", "--fail-on", "crossing", code=3 if meets else 0)
    line, sums = text.splitlines()
    assert line.startswith("scene.obj: ") and line[len("scene.obj: "):] == tool("check", "scene.obj").splitlines()[0]
    assert OUTCOME.get(made.word, "1 with parts that share space") in sums
    expect_depth(tool.json("each.jsonl")["depth"], made)


def test_replay_and_page(scene: Tuple[Scene, Tool]) -> None:
    """Two frames that are the same: the summary, and the page that it writes."""
    made, tool = scene
    text = tool("replay", "scene.obj", "scene.obj", "scene.obj", "--json", "found.json", "--report", "page.html")
    assert text.startswith(PLAYED[made.word]), text
    found = tool.json("found.json")
    assert len(found["frames"]) == 2
    for frame in found["frames"]:
        expect_frame(frame, made)
    expect_events(found["events"], made)
    expect_events(Report(tool.folder / "page.html").scene["answers"]["events"], made)


def test_python(scene: Tuple[Scene, Tool]) -> None:
    """What is read from the file, in one moment and as frames."""
    made, tool = scene
    recording = cscd.read(tool.folder / "scene.obj")
    run = cscd.replay([recording.vertices], recording.mesh, parts=recording.part_labels)
    frame = next(run)
    assert next(run, None) is None
    expect_depth(frame.intersections.max_depth, made)
    assert (frame.intersections.count("crossing") > 0) == (made.word == "cross")
    assert len(run.events) == (made.word != "")
    assert run.events.worst_first().tolist() == list(range(len(run.events)))
    for event, kinds in zip(run.events, run.events.kind_names()):
        expect_depth(event.depth, made)
        assert ("same_solid" in kinds) == (made.word == "copies")


def test_nested(tmp_path: Path) -> None:
    """Of three nested boxes two lie inside others, in three pairs; what is left out is said, and the rest is counted."""
    boxes: Dict[str, Box] = {"B": ((-3, -3, -3), (3, 3, 3)), "A": ((-4, -4, -4), (4, 4, 4)), "C": ((-2, -2, -2), (2, 2, 2))}
    write(tmp_path / "nested.obj", [(name, box, False) for name, box in boxes.items()])
    tool = Tool(tmp_path)
    for words, count, pairs, left, said in (
            ([], 2, 3, 0, ""),
            (["--ignore-parts", "A,B"], 1, 2, 1, " As asked, 1 of 6 pairs of parts was not looked at."),
            (["--only", "A"], 2, 2, 3, " As asked, 3 of 6 pairs of parts were not looked at.")):
        first = tool("check", "nested.obj", "--json", "found.json", *words).splitlines()[0]
        assert first.startswith("2 parts lie inside others; " if count == 2 else "1 part lies inside another; "), first
        assert first.endswith(f" deep.{said}"), first
        assert tool("check", "--each", "nested.obj", *words).splitlines()[0] == f"nested.obj: {first}"
        tool("replay", "nested.obj", "nested.obj", "nested.obj", "--json", "played.json", *words)
        for found in (tool.json("found.json"), tool.json("played.json")):
            assert all(frame["inside_parts"] == count for frame in found["frames"])
            assert len(found["events"]) == pairs
            assert found["left_out"] == {"part_pairs": left, "of_part_pairs": 6, "component_pairs": 0, "triangle_pairs": 0}


def test_the_worst_is_the_worst(tmp_path: Path) -> None:
    """The tool and Python have one order: what is within another part, by depth and length, then what touches."""
    boxes: Dict[str, Box] = {"A": UNIT, "B": ((0.875, 0.25, 0.25), (2, 0.75, 0.75)), "C": ((2, 0, 0), (4, 3, 3)),
                             "D": ((3, 1, 1), (3.5, 1.5, 1.5))}
    write(tmp_path / "many.obj", [(name, box, False) for name, box in boxes.items()])
    tool = Tool(tmp_path)
    text = tool("check", "many.obj")
    rows = [line.split()[:3] for line in text.splitlines() if re.match(r"[A-D] x [A-D] ", line)]
    recording = cscd.read(tmp_path / "many.obj")
    run = cscd.replay([recording.vertices], recording.mesh, parts=recording.part_labels)
    assert len(list(run)) == 1
    names = recording.part_names
    ours = [[names[event.a], "x", names[event.b]] for event in run.events[run.events.worst_first()]]
    assert ours == rows == [["C", "x", "D"], ["A", "x", "B"], ["B", "x", "C"]]
    assert "worst: C x D" in text.splitlines()[0]
