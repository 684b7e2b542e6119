"""The tool on a figure of which it is known which parts meet, and when.

Its events, by name and frame, in each of the forms in which animations come, and with each of the options that leave parts out.
"""
import subprocess
from pathlib import Path
from typing import NamedTuple, Optional

import pytest

from support.tool.reading import read_json
from support.tool.running import model_program, run

PARTS = ("Trunk", "Head", "Eye.L", "Eye.R", "Teeth", "Belt", "Arm.L", "Arm.R", "Leg.L", "Leg.R")


class Known(NamedTuple):
    """An event; worst: None if all frames are about as bad; depth: at the worst frame, 0: anything above 0."""

    a: str
    b: str
    first: int
    last: int
    worst: Optional[int] = None
    depth: float = 0.0


LEFT_ARM, RIGHT_ARM = Known("Trunk", "Arm.L", 17, 31, 24, 0.13), Known("Trunk", "Arm.R", 36, 44, 40)
ALWAYS = [Known("Head", part, 0, 47) for part in ("Eye.L", "Eye.R", "Teeth")] + [Known("Trunk", "Belt", 0, 47)]


@pytest.fixture(scope="module")
def figure(tmp_path_factory):
    folder = tmp_path_factory.mktemp("figure")
    subprocess.run(model_program("mannequin", folder, "cache", "skin", "frames", "objects"), check=True, capture_output=True)
    return folder


@pytest.fixture(autouse=True)
def stand_in_figure(figure, own_folder, monkeypatch):
    monkeypatch.chdir(figure)


def events_of(line):
    """The events between different parts. Nothing crosses itself."""
    run(f"{line} --quiet --json found.json")
    events = read_json("found.json")["events"]
    assert not any({"crossing", "touching"} & set(event["kinds"]) for event in events if event["a"] == event["b"])
    return [event for event in events if event["a"] != event["b"]]


def finds(line, *known):
    """Runs check or replay, which must find these events, and no others."""
    found = {frozenset((event["a"], event["b"])): event for event in events_of(line)}
    assert set(found) == {frozenset((event.a, event.b)) for event in known}
    for event in known:
        answer = found[frozenset((event.a, event.b))]
        assert (answer["first"], answer["last"]) == (event.first, event.last) and "crossing" in answer["kinds"]
        if "--no-depths" not in line:
            assert answer["depth"] > 0 and event.worst in (None, answer["worst"])
            # The mesh lies within its capsules, by up to a hundredth of their radii.
            assert event.depth == 0 or event.depth - 0.003 < answer["depth"] < event.depth + 1e-6


@pytest.mark.parametrize("line", [
    "check mannequin.obj mannequin.pc2 --ignore-rest=parts",
    "check mannequin.glb mannequin.glb --ignore-rest=parts --no-depths",
    "check mannequin.obj frame-%02d.obj --ignore-rest=parts --no-depths",
])
def test_all_forms_have_the_same_events(line):
    finds(line, LEFT_ARM, RIGHT_ARM)


def test_objects_have_the_same_events():
    """A file and a cache for each part."""
    others = " ".join(f"--object {part}={part}.obj --frames-of {part}={part}.pc2" for part in PARTS[1:])
    finds(f"check {PARTS[0]}.obj {PARTS[0]}.pc2 {others} --no-depths", LEFT_ARM, RIGHT_ARM, *ALWAYS)


def test_triangles_that_meet_at_rest_are_not_enough():
    """An eye turns, so other triangles of it meet the head; as a part it rests."""
    events = events_of("check mannequin.obj mannequin.pc2 --ignore-rest --frames 0:8 --no-depths")
    crossing = [{event["a"], event["b"]} for event in events if "crossing" in event["kinds"]]
    assert {"Head", "Eye.L"} in crossing and {"Trunk", "Belt"} not in crossing


def test_replay_has_the_same_events():
    """Between two frames arms touch the trunk already, and still: an interval counts for the frame at its end."""
    finds("replay mannequin.glb --ignore-rest=parts --frames 15:34 --method none", LEFT_ARM._replace(last=32))


# From the frame 30 to 38, where the left arm goes and the right one comes.
LEFT_GOES, RIGHT_COMES = Known("Trunk", "Arm.L", 30, 31), Known("Trunk", "Arm.R", 36, 38)
EYE_STAYS, TEETH_STAY = Known("Head", "Eye.L", 30, 38), Known("Head", "Teeth", 30, 38)
BODY, SKIN = "mannequin.obj mannequin.pc2", "mannequin.glb mannequin.glb"


@pytest.mark.parametrize("files, options, known", [
    (BODY, "--only Arm.L", [LEFT_GOES]),
    (BODY, "--only Arm.L,Arm.R --only Head,Belt", []),
    (SKIN, "--only Arm.L,Trunk --only Head,Eye.L", [EYE_STAYS, LEFT_GOES]),
    (BODY, "--ignore-parts Arm.L --ignore-parts Head,Eye.L --ignore-parts Eye.R,Head --ignore-parts Belt",
     [RIGHT_COMES, TEETH_STAY]),
    (BODY, "--ignore-rest=parts --ignore-parts Trunk,Arm.L", [RIGHT_COMES]),
])
def test_chosen_parts_have_their_events(files, options, known):
    finds(f"check {files} --frames 30:38 --no-depths {options}", *known)


def test_a_table_names_other_parts():
    """A table puts both arms into one part, and all else but the eyes into another."""
    rows, part, face = ["face,name"], None, 0
    for line in Path("mannequin.obj").read_text().splitlines():
        if line.startswith("o "):
            part = line[2:]
        elif line.startswith("f "):
            if not part.startswith("Eye"):
                rows.append(f"{face},{'Arms' if part.startswith('Arm') else 'Body'}")
            face += 1
    Path("table.csv").write_text("\n".join(rows) + "\n")
    events = events_of("check mannequin.obj mannequin.pc2 --parts table.csv --frames 30:38 --no-depths --only Arms,Body")
    assert [({event["a"], event["b"]}, event["first"], event["last"]) for event in events] == \
        [({"Arms", "Body"}, 30, 31), ({"Arms", "Body"}, 36, 38)]


@pytest.mark.parametrize("words, code, text", [
    ([], 2, "expected a folder"), ([".", "film"], 2, "'film' is not cache"), (["/no/folder"], 1, "No such file"),
])
def test_the_program_refuses_what_it_does_not_know(words, code, text):
    ended = subprocess.run(model_program("mannequin", *words), capture_output=True, text=True, check=False)
    assert ended.returncode == code and ended.stdout == "" and text in ended.stderr
    assert ended.stderr.startswith("mannequin: ") and ended.stderr.count("\n") == 1
