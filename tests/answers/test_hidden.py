"""Parts that are hidden by a scale of 0 are named once, with their frames: sentence and JSON of check and replay."""
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from support.tool.mesh_files import box
from support.tool.reading import read_json
from support.tool.running import read_results, run, write_list

BOTH = pytest.mark.parametrize("command", ["check", "replay"])


def flat_box(x, size, name, flatness=1.0):
    return box((x, 0, 0), (x + size, size * flatness, size * flatness), name)


def write_scene(path, size, rock):
    """Writes the parts Puff, of this size, or a line if that is below 0, at 0; and Rock, so far away, or without a size."""
    puff = flat_box(0.0, 1.0, "Puff", 0.0) if size < 0 else flat_box(0.0, size, "Puff")
    # Apart from that by a little, so that no two sides are in one plane.
    rock_text = box((rock, 0.25, 0.25), (rock + (rock > 0), 0.25 + (rock > 0), 0.25 + (rock > 0)), "Rock")
    Path(path).write_text(puff + rock_text)


@BOTH
def test_hidden_parts_are_named(command):
    """Hidden in frames 2, 3 and 5, where it becomes a line; the last frame crosses."""
    write_scene("model.obj", 1.0, 5.0)
    for i, size in enumerate((1.0, 0.0, 0.0, 1.0, -1.0, 1.0), 1):
        write_scene(f"f_{i}.obj", size, 0.5 if i == 6 else 5.0)
    out = run(f"{command} model.obj f_1.obj f_2.obj f_3.obj f_4.obj f_5.obj f_6.obj --json out.json").out
    assert "Frame 6 crosses (1 of 6)" in out and "may be missing" not in out
    assert " Puff has no surface in frames 2 to 3, 5 (all its triangles have no area), and was not looked at there.\n" in out
    (hidden,) = read_json("out.json")["collapsed"]
    assert (hidden["part"], hidden["whole"], hidden["partly"]) == ("Puff", [[2, 3], [5, 5]], [])


def test_a_single_mesh_names_no_frames():
    write_scene("single.obj", 0.0, 5.0)
    hidden = "Puff has no surface (all its triangles have no area), and was not looked at.\n"
    assert f"Clean: no two triangles cross or touch. {hidden}" in run("check single.obj").out


def test_pieces_without_a_surface_are_named():
    """A part of which one piece alone has no surface."""
    Path("pieces.obj").write_text(flat_box(0.0, 1.0, "Puff") + flat_box(3.0, 0.0, "") + flat_box(6.0, 1.0, "Rock"))
    assert "cross or touch. Some pieces of Puff have no surface (all their triangles have no area), and were not looked at.\n" \
        in run("check pieces.obj --json out.json").out
    (hidden,) = read_json("out.json")["collapsed"]
    assert (hidden["whole"], hidden["partly"]) == ([], [[0, 0]])


def test_nothing_to_look_at_is_not_clean():
    """A mesh without any area is not clean: nothing was looked at."""
    write_scene("zeros.obj", 0.0, 0.0)
    out = run("check zeros.obj --json out.json").out
    assert out.startswith("No triangle has an area.") and "Clean" not in out
    assert read_json("out.json")["frames"][0]["clean"] is False


# ---- frames in which nothing has a surface


def write_frames(crossing):
    """All is there, then nothing, then only the rock, then all, which crosses if that is asked for."""
    for i, (size, rock) in enumerate(((1.0, 5.0), (0.0, 0.0), (0.0, 5.0), (1.0, 0.5 if crossing else 5.0)), 1):
        write_scene(f"g_{i}.obj", size, rock)
    return "g_1.obj g_1.obj g_2.obj g_3.obj g_4.obj"


@BOTH
@pytest.mark.parametrize("crossing", [False, True])
@pytest.mark.parametrize("gate, sees_crossings", [
    ("--fail-on crossing", True), ("--fail-on touching", True), ("--fail-depth 1000", False), ("--max-faces 99", False),
    ("--quiet --no-depths", None),
])
def test_a_gate_passes_nothing_unseen(command, crossing, gate, sees_crossings):
    """A gate cannot pass such a frame: the exit code is 1, unless another frame fails. JUnit has an error there."""
    code = 0 if sees_crossings is None else 3 if crossing and sees_crossings else 1
    error = run(f"{command} {write_frames(crossing)} {gate} --junit junit.xml --json out.json", code=code).error
    undecided = "not decided: in 1 of 4 frames, the first is frame 2, no triangle has an area, so there was nothing to look at; "
    assert code == 3 or (f"{undecided}--frames leaves frames out" in error) == (code == 1)
    (suite,) = ElementTree.parse("junit.xml").iter("testsuite")
    failures = int(crossing and sees_crossings is not False)
    assert [suite.get(key) for key in ("tests", "failures", "errors")] == ["4", str(failures), "1"]
    (second,) = (case for case in suite.iter("testcase") if case.get("name") == "frame 2")
    assert second.find("error").get("message").startswith("no triangle has an area")


@BOTH
def test_an_empty_frame_is_not_checked(command):
    """The sentence says it, the frame is no clean one and was not checked, and nothing hidden beside it is passed over."""
    out = run(f"{command} {write_frames(False)} --timings --json out.json").out
    assert ("No frame crosses or touches (3 checked). No triangle has an area in frame 2, which was not looked at. Puff has no "
            "surface in frames 2 to 3 (all its triangles have no area), and was not looked at there.\n") in out
    assert "3 of 3 frames are clean" in out
    root = read_json("out.json")
    assert [frame["clean"] for frame in root["frames"]] == [True, False, True, True]
    assert len(root["collapsed"]) == 2 and root["collapsed"][1]["whole"] == [[2, 2]]
    if command == "replay":
        assert [root["summary"][key] for key in ("frames_checked", "clean", "unknown")] == [3, 2, 1]


def test_meshes_without_a_surface_fail():
    """Of many files, one without a surface is no clean one, with a gate or without."""
    for name, size, rock in (("nothing", 0.0, 0.0), ("hidden", 0.0, 5.0), ("crossing", 1.0, 0.5)):
        write_scene(f"{name}.obj", size, rock)
    out = run("check --each nothing.obj hidden.obj crossing.obj", code=1).out
    assert "nothing.obj: No triangle has an area.\n" in out and "hidden.obj: Clean: no two triangles cross or touch." in out
    assert "3 meshes: 1 clean, 1 with intersections, 1 failed\n" in out


@pytest.mark.parametrize("crossing, gate, code", [
    (False, "", 1), (False, "--fail-on crossing", 1), (True, "", 0), (True, "--fail-on crossing", 3),
])
def test_recordings_with_an_empty_frame(crossing, gate, code):
    """A list of recordings: a frame without a surface, and another one that crosses or not."""
    write_frames(crossing)
    write_list("list.jsonl", {"name": "g", "model": "g_1.obj", "frames": "g_%d.obj"})
    run(f"check --list list.jsonl --results lines.jsonl {gate}", code=code)
    line = read_results("lines.jsonl")[1]
    assert line["result"] == ("crossing" if crossing else "failed")
    assert crossing or "No triangle has an area in frame 2, which was not looked at." in line["error"]


def test_what_appears_has_lost_no_contact():
    """What appears out of a point and crosses itself there is no contact that was lost."""
    turns = ((0, 0), (2, 2), (2, 0), (0, 2))
    strip = "".join(f"f {k} {k + 2} {k + 3}\nf {k} {k + 3} {k + 1}\n" for k in (9, 11, 13))
    for i, size in enumerate((0, 1, 0), 1):
        knot = "".join(f"v {x * size} {y * size} {z * size}\n" for x, y in turns for z in (0, 1))
        Path(f"a_{i}.obj").write_text(flat_box(9.0, 1.0, "Rock") + f"o Knot\n{knot}{strip}")
    answer = run("replay a_2.obj a_1.obj a_2.obj a_3.obj --json out.json")
    assert "Frame 2 crosses (1 of 3)." in answer.out and "was lost" not in answer.error
    assert read_json("out.json")["summary"]["contradictions"] == 0
