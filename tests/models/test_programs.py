"""Runs the programs of models/ as a user does: what they write, their lists of scenes, and what they refuse."""
import os
import re
import signal
import struct
import subprocess
import time
from pathlib import Path

import pytest

from support.tool.reading import read_json
from support.tool.running import SLOW_MACHINE, run

SCENES = {
    "cloth": ["cloth-drape", "sleeve", "bag"],
    "record": ["pawn-drop", "pawn-drop-free", "dumbbell-stairs", "dumbbell-stairs-free", "figure-balls", "figure-balls-free"],
    "ipc": ["rings", "press"],
    "objects": ["t-pair", "w-pair", "two-spheres", "two-spheres-unequal", "three-spheres", "three-spheres-unequal", "v-shape",
                "u-pair", "u-three", "mixed", "tumble"],
}
# The cheapest scene, without contacts and without balls.
CHEAPEST = "dumbbell-stairs-free"


def path_of(name):
    return os.path.join(os.environ["CSCD_MODELS"], name)


def program(name, *words, code=0):
    """Runs models/NAME, and expects its exit code."""
    ended = subprocess.run([path_of(name), *map(str, words)], capture_output=True, text=True, check=False)
    assert ended.returncode == code, ended.stderr
    return ended


def refuses(code, text, name, *words):
    """One line says why, before anything is written."""
    before = sorted(os.listdir())
    ended = program(name, *words, code=code)
    assert ended.stdout == "" and text in ended.stderr
    assert ended.stderr.startswith(f"{name}: ") and ended.stderr.count("\n") == 1
    assert sorted(os.listdir()) == before


@pytest.mark.parametrize("name", SCENES)
def test_help_lists_the_scenes(name):
    """Each with a sentence."""
    said = program(name, "--help")
    listed = re.findall(r"^  ([a-z][a-z-]+) {2,}\S.*$", said.stdout, re.MULTILINE)
    assert listed == SCENES[name] and said.stderr == ""
    usage = program(name, code=2)
    assert (usage.stdout, usage.stderr) == ("", said.stdout)
    program(name, SCENES[name][0], code=2)


@pytest.mark.parametrize("code, text, line", [
    (2, "'sleeves'", "cloth sleeve sleeves ."),
    (2, "'11'", "cloth --resolution 11 sleeve ."),
    (2, "'12x'", "cloth --resolution 12x sleeve ."),
    (2, "'-20'", "cloth --resolution -20 sleeve ."),
    (1, "none", "cloth --resolution 12 sleeve none"),
    (2, "'ring'", "ipc ring ."),
    (2, "'pres'", "ipc rings pres ."),
    (1, "none", "ipc rings none"),
    (2, "'pawn'", "record pawn ."),
    (2, "'pawn-drop-fre'", f"record {CHEAPEST} pawn-drop-fre ."),
    (1, "none", f"record {CHEAPEST} none"),
    (2, "'two-cubes'", "objects two-cubes ."),
    (1, "none", "objects two-spheres none"),
    (2, "expected a folder", "folds"),
    (1, "No such file", "folds /no/folder"),
    (2, "where to", "shape pawn"),
    (2, "knight", "shape knight a.obj"),
    (2, "--triangle", "shape pawn a.obj --triangle 100"),
    (2, "too many", "shape pawn a.obj more.obj"),
    (2, "takes a number", "shape pawn a.obj --triangles"),
    *((2, "whole number", f"shape pawn a.obj --triangles {number}") for number in ("x", "12x", "0", "-4", "1.5", 10**11, 10**23)),
    (1, "5130 or 5132", "shape pawn a.obj --triangles 5131"),
    (1, "from 300 to", "shape pawn a.obj --triangles 2"),
    (1, "1200 or 1452", "shape cube a.obj --triangles 1300"),
    (1, "lost.obj", "shape sphere none/lost.obj"),
])
def test_what_makes_no_sense_is_refused(code, text, line):
    refuses(code, text, *line.split())


@pytest.mark.parametrize("line", [
    "cloth --resolution 20", "panels --frames", "panels --frames 0",
    "panels --side 1000", "panels --unknown 1", "shape",
])
def test_usage_is_checked(line):
    program(*line.split(), code=2)


@pytest.mark.parametrize("name, scene", [("ipc", "rings"), ("record", CHEAPEST)])
def test_what_cannot_be_written_is_an_error(name, scene):
    """It names the path, and no frames are left that could be taken for a recording."""
    Path(f"{scene}.pc2").mkdir()
    ended = program(name, scene, ".", code=1)
    assert f"{scene}.pc2" in ended.stderr and ended.stdout == "" and ended.stderr.count("\n") == 1
    assert list(Path(f"{scene}.pc2").iterdir()) == []


# ---- what they write


def read_points(path):
    return [tuple(map(float, line.split()[1:])) for line in Path(path).read_text().splitlines() if line.startswith("v ")]


def is_recording(name, frame_count):
    """The cache has as many frames as it says, and the first is the model."""
    points, data = read_points(f"{name}.obj"), Path(f"{name}.pc2").read_bytes()
    count, (vertices,), (frames,) = len(points), struct.unpack("<i", data[16:20]), struct.unpack("<i", data[28:32])
    assert (vertices, frames) == (count, frame_count) and len(data) == 32 + 12 * count * frames
    assert struct.pack(f"<{3 * count}f", *(x for point in points for x in point)) == data[32 : 32 + 12 * count]


def finds_no_contact(name, interval_count):
    run(f"replay {name}.obj {name}.pc2 --method none --json summary.json --quiet")
    total = read_json("summary.json")["summary"]
    assert (total["complete"], total["intervals"]) == (True, interval_count)
    assert total["intervals_with_contact"] == total["frames_crossing"] == 0


def test_cloth_writes_garment_and_scenery():
    said = program("cloth", "--resolution", 12, "cloth-drape", ".")
    assert said.stderr == "" and "320 frames of 242 triangles" in said.stdout
    is_recording("cloth-drape", 320)
    is_recording("cloth-drape-scenery", 320)
    finds_no_contact("cloth-drape", 319)


def test_record_writes_body_and_scenery():
    """The scenery is ground and five steps, each a box, which do not move."""
    said = program("record", CHEAPEST, ".")
    assert said.stderr == "" and said.stdout.startswith(CHEAPEST) and "150 frames of 1710 triangles" in said.stdout
    assert "contacts in 0 of 149 intervals, intersections in 0 of 150 frames" in said.stdout
    assert sorted(os.listdir()) == [f"{CHEAPEST}-scenery.obj", f"{CHEAPEST}.obj", f"{CHEAPEST}.pc2"]
    is_recording(CHEAPEST, 150)
    finds_no_contact(CHEAPEST, 149)
    run(f"info {CHEAPEST}-scenery.obj --json info.json")
    assert [read_json("info.json")[key] for key in ("vertices", "triangles")] == [6 * 8, 6 * 12]


def test_what_is_cut_short_takes_no_place():
    """When it is killed in the middle of its frames, it leaves no cache, so that what was there before stays."""
    def unfinished():
        return sum(path.stat().st_size for path in Path().glob(".cscd-output-*"))

    process = subprocess.Popen([path_of("record"), CHEAPEST, "."], stdout=subprocess.PIPE)
    while process.poll() is None and not (os.path.exists(f"{CHEAPEST}.obj") and unfinished() >= 30000):
        time.sleep(0.002)
    process.kill()
    assert process.communicate()[0] == b"" and process.returncode == -signal.SIGKILL
    assert os.path.exists(f"{CHEAPEST}.obj") and not os.path.exists(f"{CHEAPEST}.pc2")


def test_folds_meet_in_the_middle_alone():
    """A closed sphere that meets itself in the middle of its motion, and not before."""
    program("folds", ".")
    is_recording("folds", 100)
    run("info folds.obj --json info.json")
    (sphere,) = read_json("info.json")["components"]
    assert [sphere[key] for key in ("vertices", "triangles", "closed", "euler_characteristic")] == [10242, 20480, True, 2]

    def crossing_at(frame):
        run(f"check folds.obj folds.pc2 --frames {frame} --no-depths --json check.json --quiet")
        (found,) = read_json("check.json")["frames"]
        assert set(found["kinds"]) <= {"crossing"}
        return found["crossing_pairs"]

    assert [crossing_at(frame) for frame in (0, 15, 99)] == [0, 0, 0]
    assert crossing_at(24) > 20 and crossing_at(49) > 4 * crossing_at(24)


def test_panels_run_through():
    """A caller in C++. The last line has a number for all positions, which is the same on any number of threads."""
    one, three = (program("panels", "--frames", 135, "--threads", threads) for threads in (1, 3))
    assert one.stderr == "" and "ran tasks of cscd" in three.stdout
    assert one.stdout.split("digest ")[1] == three.stdout.split("digest ")[1]
    for event in ("the seam is opened\n", "the right panel tears: 8 vertices more\n"):
        # In the row after it pairs wait, and in the one after that none.
        waiting = [int(row.split()[5]) for row in one.stdout.split(event)[1].splitlines()[:2]]
        assert waiting[0] > 0 == waiting[1]


def test_panels_see_what_goes_wrong():
    """Without certificates the ball goes through the cloth, and the program says so."""
    assert "panels: after " in program("panels", "--frames", 60, "--uncertified", code=1).stderr
    program("panels", "--help")


def is_shape(name, triangles, *options):
    said = program("shape", name, "body.obj", *options)
    assert said.stderr == "" and name in said.stdout
    run("info body.obj --json info.json")
    root = read_json("info.json")
    assert (root["triangles"], root["pairs"]) == (triangles, 0) and all(component["closed"] for component in root["components"])


def test_shapes_have_the_counts_of_the_help():
    said = program("shape", "--help")
    shapes = re.findall(r"^([a-z0-9-]+) +(\d+) +\d+   \S", said.stdout, re.MULTILINE)
    assert said.stderr == "" and len(shapes) == 18
    for name, triangles in shapes[::3] if SLOW_MACHINE else shapes:
        is_shape(name, int(triangles))


@pytest.mark.parametrize("name, triangles", [("pawn", 2500), ("figure", 1500)])
def test_shapes_have_the_counts_asked_for(name, triangles):
    is_shape(name, triangles, "--triangles", triangles)


def test_objects_write_model_and_frames():
    said = program("objects", "two-spheres-unequal", ".")
    assert said.stderr == "" and "90 frames of 2 objects, 1500 triangles" in said.stdout and "within objects in 0" in said.stdout
    is_recording("two-spheres-unequal", 90)
