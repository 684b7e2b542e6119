"""Methods, modes and starts of a replay: the contacts are the same, or the first ones, and the outputs say which."""
import os
from pathlib import Path

import pytest

from support.tool.reading import read_json
from support.tool.recordings import fold, spindle
from support.tool.running import run

FRAMES = 16
# The first interval with a contact.
TOUCHING = 13


@pytest.fixture(autouse=True)
def files(own_folder):
    scene = spindle(24, 10, FRAMES)
    scene.write_mesh("spindle.obj")
    scene.write_cache("spindle.pc2")


def replay(options):
    """The summary of a replay, whose contacts are in out.csv."""
    run(f"replay spindle.obj spindle.pc2 --quiet --contacts out.csv --json out.json {options}")
    return read_json("out.json")


def guarantee(interval):
    """The mode and the reason of the only component."""
    (only,) = interval["guarantee"]
    return only["mode"], only["reason"]


def first_contact(root):
    return next(k for k, interval in enumerate(root["intervals"]) if interval["earliest_toi"] is not None)


def test_methods_agree_in_mode_all():
    assert first_contact(replay("--method none")) == TOUCHING
    expected = Path("out.csv").read_text()
    for options in ("--method charge", "--method single --threads 3", "--method kmeans:4", "--method brute",
                    "--method single --no-check", "--method kmeans:7 --start unknown", "--start unknown --no-check"):
        replay(options)
        assert Path("out.csv").read_text() == expected, options


def test_earliest_finds_the_first_contact():
    """Nothing is lost before the first contact, which is there at its time."""
    toi = replay("--method none")["intervals"][TOUCHING]["earliest_toi"]
    for method in ("charge", "single", "kmeans:4"):
        root = replay(f"--method {method} --mode earliest")
        total, intervals = root["summary"], root["intervals"]
        assert total["mode"] == "earliest" and total["contradictions"] == 0
        assert first_contact(root) == TOUCHING and intervals[TOUCHING]["earliest_toi"] == toi
        for k, interval in enumerate(intervals):
            mode, reason = guarantee(interval)
            if interval["earliest_toi"] is None:
                assert mode == "all" and ("no contact" if k < TOUCHING else "at the start") in reason
            else:
                assert mode == "earliest" and "later contacts may be missing" in reason
        assert total["intervals_complete"] == sum(interval["earliest_toi"] is None for interval in intervals)


def test_counters_tell_that_culling_is_on():
    none, single = replay("--method none"), replay("--method single --mode earliest")
    for without, culled in zip(none["intervals"][:TOUCHING], single["intervals"]):
        assert without["plus"] == without["minus"] == 0 and guarantee(without)[0] == "all"
        assert culled["plus"] > 240 and culled["plus"] + culled["minus"] <= 480 and culled["ms"]["orientation"] > 0
    pairs = [sum(interval["pcp"] for interval in root["intervals"][:TOUCHING]) for root in (none, single)]
    assert pairs[1] * 4 < pairs[0]
    assert single["summary"]["plus"]["mean"] > 0


@pytest.mark.parametrize("start, check, static_checks, reason", [
    ("prove", "--quiet", 0, "no contact"),
    ("prove", "--no-check", 1, "no contact"),
    ("vouched", "--no-check", 0, "no contact"),
    ("unknown", "--quiet", 0, "no contact"),
    ("unknown", "--no-check", 0, "not known"),
])
def test_starts_are_proven_once(start, check, static_checks, reason):
    """The tool checks the frames anyway; without that, the detector proves its first start and needs no further proof."""
    root = replay(f"--method single --mode earliest --frames 0:{TOUCHING} --start {start} {check}")
    assert root["summary"]["static_checks"] == static_checks
    for interval in root["intervals"]:
        assert guarantee(interval)[0] == "all" and reason in guarantee(interval)[1]


def test_tables_have_a_column_for_orientation():
    out = run("replay spindle.obj spindle.pc2 --timings --method single --mode earliest").out
    assert "of 15 intervals later contacts" in out and "\nsingle " in out
    assert out.count(" X ") == 2  # for the contour, in both rows
    out = run("replay spindle.obj spindle.pc2 --timings --method none").out
    assert out.count(" X ") == 6 and "may be missing" not in out


def test_small_meshes_get_one_thread():
    """Starting them takes longer than the command on a small mesh, unless the user wants them."""
    def threads(root):
        return root["provenance"]["threads"]

    assert threads(replay("--method none")) == 1
    assert threads(replay("--method none --threads 0")) == 1
    assert threads(replay("--method none --threads 3")) == 3
    larger = fold(25, 20, 2)
    larger.write_mesh("larger.obj")
    larger.write_cache("larger.pc2")
    run("replay larger.obj larger.pc2 --quiet --method none --json out.json")
    assert threads(read_json("out.json")) == os.cpu_count()


def test_guarantees_are_written_by_exception():
    """What holds for most components is said once, so that a file does not grow with their number.

    These are tetrahedra apart from each other, some of which lack a face.
    """
    opened = [0, 7, 299]
    text = "".join(f"v {i} 0 0\nv {i}.5 0 0\nv {i} 0.5 0\nv {i} 0 0.5\nf -4 -2 -3\nf -4 -3 -1\nf -3 -2 -1\n"
                   + ("" if i in opened else "f -4 -1 -2\n") for i in range(300))
    for name in ("many.obj", "frame_1.obj", "frame_2.obj"):
        Path(name).write_text(text)
    run("replay many.obj frame_1.obj frame_2.obj --method single --quiet --json out.json")
    most, others = read_json("out.json")["intervals"][0]["guarantee"]
    assert "embedded at the start" in most["reason"] and most["count"] == 297 and "components" not in most
    assert "open" in others["reason"] and others["count"] == 3 and others["components"] == opened
