"""What was not looked at is said first, and nothing calls it clean: sentence, JSON, JUnit and exit code of check and replay."""
from pathlib import Path

import pytest

from support.tool.mesh_files import box, cube
from support.tool.reading import read_json
from support.tool.running import fails, run, usage_error

REASONS = {
    "v 5 5 5\n": "holds 17 vertices, the model has 16 vertices", "f 1 2 3\n": "has other faces than", "v nan 0 0\n": "nan",
    "f 1 2 99\n": "99",
}
EXTRA_VERTEX, OTHER_FACES, NO_NUMBER, NO_VERTEX = REASONS


def write_boxes(path, gap, spoilt=""):
    """Two boxes of side 1, so far apart along x; spoilt: what is wrong with the file."""
    Path(path).write_text(cube(0, 1, "A") + box((1 + gap, 0.25, 0.25), (2 + gap, 1.25, 1.25), "B") + spoilt)
    return path


# ---- a frame that cannot be read


@pytest.mark.parametrize("command, spoilt, bad, crossing", [
    ("check", EXTRA_VERTEX, 2, 0), ("replay", EXTRA_VERTEX, 3, 0), ("check", OTHER_FACES, 3, 0), ("replay", OTHER_FACES, 4, 0),
    ("check", NO_NUMBER, 4, 0), ("replay", NO_NUMBER, 2, 0), ("check", NO_VERTEX, 2, 0), ("replay", NO_VERTEX, 3, 0),
    ("check", EXTRA_VERTEX, 1, 0), ("replay", EXTRA_VERTEX, 1, 0), ("check", EXTRA_VERTEX, 4, 2), ("replay", EXTRA_VERTEX, 3, 1),
    ("check", EXTRA_VERTEX, 2, 3),
])
def test_a_frame_that_cannot_be_read_comes_first(command, spoilt, bad, crossing):
    """bad: which of four frames, from 1 on, cannot be read; crossing: which one crosses, 0: none."""
    frames = [write_boxes(f"f_{i}.obj", -0.5 if i == crossing else 1.0 + i, spoilt if i == bad else "") for i in range(1, 5)]
    line = f"{command} {write_boxes('model.obj', 1.0)} {' '.join(frames)}"
    reason, crosses = REASONS[spoilt], 0 < crossing < bad
    answer = run(f"{line} --json out.json --junit out.xml", code=1)
    first = answer.first_line
    assert first.startswith(f"Not finished: frame {bad} could not be read: ") and reason in first and "Clean" not in answer.out
    assert f". {bad - 1} of 4 frames checked{'.' if bad == 1 or crosses else ', clean so far.'}" in first
    assert (". Frame " in first) == crosses and reason in answer.error
    root = read_json("out.json")
    place = root["summary"] if command == "replay" else root
    assert place["complete"] is False and reason in place["stopped_by"]
    xml = Path("out.xml").read_text()
    assert f'tests="{bad}" failures="{int(crosses)}" errors="1"' in xml and reason in xml
    assert 'name="all was looked at" time="0">\n      <error message="Not finished: frame ' in xml
    error = run(f"{line} --fail-on crossing", code=3 if crosses else 1).error  # what fails, fails, whatever could not be read
    assert reason in error and (not crosses or "failed: " in error)


@pytest.mark.parametrize("name, hint", [
    ("frame-*.obj", "no file matches it"), ("frame-?.obj", "no file matches it"), ("frame-[0-9].obj", "no file matches it"),
    ("frame-####.obj", "is written %04d"), ("frame-$F4.obj", "is written %04d"), ("frame-<UDIM>.obj", "is written %04d"),
])
def test_a_pattern_of_nothing_has_a_hint(name, hint):
    """Patterns that no shell has filled in, and what other programs call the number of a frame, come with what to do."""
    write_boxes("m_1.obj", 1.0)
    for line in (f"check m_1.obj '{name}'", f"replay m_1.obj '{name}' m_1.obj", f"check '{name}'"):
        fails(line, name, "cannot open", hint, "frame_%04d.obj")


def test_a_plain_name_has_no_hint():
    write_boxes("m_1.obj", 1.0)
    assert "%04d" not in run("check m_1.obj none.obj", code=1).error


@pytest.fixture
def four_frames():
    for i, gap in enumerate((1.0, 1.5, 2.0), 1):
        write_boxes(f"f_{i}.obj", gap)
    write_boxes("f_4.obj", 2.0, "v 1 2 3\n")
    return "f_1.obj f_2.obj f_3.obj f_4.obj"


@pytest.mark.parametrize("frames, sentence", [
    ("2:3", "No frame crosses or touches (2 checked). Only frames 2 to 3 of 1 to 4 were looked at.\n"),
    (":2", "No frame crosses or touches (2 checked). Only frames 1 to 2 of 1 to 4 were looked at.\n"),
    ("2", "Clean: no two triangles cross or touch. Only frame 2 of 1 to 4 was looked at.\n"),
    ("1:3:2", "No frame crosses or touches (2 checked). Only frames 1 to 3, in steps of 2, of 1 to 4 were looked at.\n"),
])
def test_a_range_is_complete_and_named(four_frames, frames, sentence):
    """What the range leaves out may be as bad as it likes: the sentence says which frames it was."""
    assert run(f"check {four_frames} --frames {frames} --json out.json").out == sentence
    assert read_json("out.json")["complete"] is True


def test_ranges_of_replays_are_named(four_frames):
    out = run(f"replay {four_frames} --frames 1:3").out
    assert out.startswith("No frame crosses or touches (3 checked). Only frames 1 to 3 of 1 to 4 were looked at.\n")
    out = run(f"check {four_frames} --frames 3:4", code=1).out
    assert out.startswith("Not finished: frame 4 could not be read: ") and " 1 of 2 frames checked, clean so far.\n" in out


# ---- what members of JSON mean


@pytest.mark.parametrize("text, crossing, touching, clean", [
    ("v 1 1 -1\nv 2 1 1\nv 1 2 1\nf 4 5 6\n", True, False, False),
    ("v 1 1 0\nv 2 1 1\nv 1 2 1\nf 4 5 6\n", False, True, False),
    ("v 1 1 0.5\nv 2 1 1\nv 1 2 1\nf 4 5 6\n", False, False, True),
    ("f 2 3 1\n", False, False, False),  # the same triangle twice
])
def test_crossing_means_crossing(text, crossing, touching, clean):
    Path("kind.obj").write_text(f"v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n{text}")
    run("check kind.obj --json out.json")
    frame = read_json("out.json")["frames"][0]
    assert (frame["crossing"], frame["clean"]) == (crossing, clean)
    run("replay kind.obj kind.obj kind.obj --json out.json")
    summary = read_json("out.json")["summary"]
    assert (summary["frames_crossing"], summary["frames_touching"]) == (2 * crossing, 2 * touching)


def test_what_lies_inside_is_not_clean():
    """Who does not look says so, and no rule passes it."""
    Path("inside.obj").write_text(cube(0, 1) + cube(0.25, 0.5))
    run("check inside.obj --json out.json")
    frame = read_json("out.json")["frames"][0]
    assert (frame["crossing"], frame["clean"], frame["depth"]) == (False, False, 0.25)
    out = run("check inside.obj --no-depths --json out.json").out
    assert out.startswith("Clean: no two triangles cross or touch. What lies inside was not looked at.\n")
    frame = read_json("out.json")["frames"][0]
    assert [frame[key] for key in ("clean", "depth", "overlapping_parts", "inside_parts", "same_solids")] == [None] * 5


@pytest.mark.parametrize("line, says", [
    *((f"{command} inside.obj inside.obj --no-depths {gate}", [gate.split()[0], "--no-depths"])
      for command in ("check", "replay") for gate in ("--fail-on crossing", "--fail-depth 0.1")),
    ("check inside.obj inside.obj --no-depths --fail-on touching", ["--no-depths"]),
    ("replay inside.obj inside.obj --no-check --fail-on touching", ["--no-check"]),
    ("check --each inside.obj --no-depths --fail-on crossing", ["--no-depths"]),
])
def test_no_rule_passes_what_is_not_looked_at(line, says):
    Path("inside.obj").write_text(cube(0, 1) + cube(0.25, 0.5))
    usage_error(line, *says)
