"""`cscd sense`: its warnings, the comparison with the detector, its outputs, and what it refuses."""
from math import dist
from pathlib import Path

import pytest

from support.tool.exported import png_size
from support.tool.reading import read_csv, read_json
from support.tool.recordings import Recording, tetrahedra
from support.tool.running import fails, run, usage_error

SENSE = "sense flight.obj flight.pc2"


@pytest.fixture(autouse=True)
def flight(own_folder):
    flight = tetrahedra(8)
    flight.write_mesh("flight.obj")
    flight.write_cache("flight.pc2")
    return flight


def test_confirms_the_contacts_and_no_others(flight):
    """The scene was built to have warnings in intervals 3 and 5."""
    run(f"{SENSE} --csv out.csv")
    rows = read_csv("out.csv")
    assert list(rows[0]) == "frame part_a part_b object_a object_b vertex_a vertex_b distance time contact toi".split()
    for row in rows:
        frame, a, b, time = int(row["frame"]), int(row["vertex_a"]), int(row["vertex_b"]), float(row["time"])
        assert [row[key] for key in ("part_a", "part_b", "object_a", "object_b")] == ["0", "1", "0", "1"]
        assert a < 4 <= b < 8 and time in (0, 1)
        points = flight.frames[frame + int(time)]
        assert float(row["distance"]) == pytest.approx(dist(points[a], points[b]), abs=1e-12, rel=0)
        assert row["contact"] == str(int(frame in (3, 5))) and (row["toi"] == "") == (row["contact"] == "0")
    assert [float(row["toi"]) for row in rows if row["toi"]] == pytest.approx([0.5, 0.5], abs=1e-12)


def test_compares_with_the_detector():
    out = run(f"{SENSE} --compare --json out.json").out
    assert "pairs of objects in contact: 2 in 2 intervals; found 2, missed 0" in out
    assert "recall 1.0000" in out and "confirmed: recall 1.0000\n" in out
    root = read_json("out.json")
    total, intervals = root["summary"], root["intervals"]
    assert [interval["frame"] for interval in intervals] == list(range(7))
    for interval in intervals:
        pairs, touching = interval["object_pairs"], int(interval["frame"] in (3, 5))
        assert [pairs[key] for key in ("touching", "found", "missed", "confirmed")] == [touching, touching, 0, touching]
        assert pairs["false"] == pairs["warned"] - touching
    warned = sum(interval["object_pairs"]["warned"] for interval in intervals)
    assert total["complete"] is True and (total["objects"], total["recall"], total["warned_pairs"]) == (2, 1, warned)
    assert total["intervals_warned"] == sum(interval["warnings"] > 0 for interval in intervals) > 1
    assert total["precision"] == 2 / warned and len(root["provenance"]["inputs"]) == 2


def test_says_what_it_has_missed():
    """No two vertices come within the chosen distance."""
    answer = run(f"{SENSE} --compare --mu 0.001 --reff 10")
    assert "warning: frame 1: part 0 has an edge longer than --mu" in answer.error
    assert answer.error.count("warning: ") == 1  # once, though each frame has it
    assert "has new cells" not in answer.out and "found 0, missed 2, false 0\n" in answer.out
    assert "recall 0.0000, precision 1.0000" in answer.out
    assert "pairs were missed in the intervals from frame 3, 5\n" in answer.out


def test_without_the_check_nothing_is_confirmed():
    run(f"{SENSE} --no-exact --csv out.csv")
    assert {(row["contact"], row["toi"]) for row in read_csv("out.csv")} == {("", "")}


@pytest.mark.parametrize("method", ["cells", "random"])
def test_same_bytes_for_any_number_of_threads(method):
    tables = []
    for threads in ("", "--threads 4"):
        run(f"{SENSE} --method {method} --csv out.csv {threads}")
        tables.append(Path("out.csv").read_text())
    assert tables[0] == tables[1] and tables[0].count("\n") > 1


def test_renews_what_has_grown_and_says_so(flight):
    """Areas grow by a factor of 7.6: they double at frame 2, where they are 2.25, and again at frame 5."""
    frames = [[[x * (1 + k / 4) for x in point] for point in flight.frames[0]] for k in range(8)]
    Recording(flight.triangles, frames).write_cache("growing.pc2")
    out = run("sense flight.obj growing.pc2 --json out.json").out
    assert [line for line in out.split("\n") if "new cells" in line] == \
        [f"frame {frame}: part {part} has new cells, 1 now (area)" for frame in (2, 5) for part in (0, 1)]
    assert read_json("out.json")["summary"]["renewals"] == 4


def test_draws_a_picture():
    for frame in (0, 4):
        run(f"{SENSE} --picture out.png --frame {frame} --size 160x120 --view 30,20 --up y")
        assert png_size("out.png") == (160, 120) and Path("out.png").stat().st_size > 500
    fails(f"{SENSE} --picture out.png --frame 5 --frames 1:4", "--frame 5: there are the frames 1 to 4")


def test_quiet_is_quiet():
    assert run(f"{SENSE} --quiet --frames 2:4 --json out.json").out == ""
    assert len(read_json("out.json")["intervals"]) == 2


@pytest.mark.parametrize("option, values", [
    ("--mu", ["-1", "nan", "1mm"]), ("--reff", ["1e301"]), ("--cells", ["x"]), ("--particles", ["0"]), ("--seed", ["-1"]),
    ("--method", ["lbg"]), ("--size", ["1"]), ("--view", ["3"]), ("--up", ["x"]), ("--threads", ["257"]), ("--frame", ["-"]),
    ("--frames", ["a:b"]),
])
def test_unfit_values_are_refused(option, values):
    for value in values:
        usage_error(f"{SENSE} {option} {value}", f"{option} cannot be '{value}'")


@pytest.mark.parametrize("options, says", [
    ("--mu 2 --reff 1", ["--reff 1 is below --mu 2"]),
    ("--particles 3", ["--particles is of --method random"]),
    ("--seed 3", ["--seed is of --method random"]),
    ("--method random --cells 3", ["--cells is of --method cells"]),
    ("--method random --within", ["--within is of --method cells"]),
    ("--view 3,3", ["--view is of a picture"]),
    ("--frames 0:6:2", ["step of 2"]),
    ("--csv flight.pc2", ["--csv", "would overwrite"]),
    ("--csv out.csv --json out.csv", ["--json", "would overwrite"]),
])
def test_options_that_do_not_go_together_are_refused(options, says):
    usage_error(f"{SENSE} {options}", *says)


def test_frames_are_needed():
    usage_error("sense flight.obj", "no FRAMES given")
    fails(f"{SENSE} --frames 3:3", "an interval needs two frames")
