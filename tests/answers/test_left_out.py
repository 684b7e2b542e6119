"""A recording of which a file lists its vertices in another order than the model: millions of pairs on a larger mesh.

What does not fit --max-memory is left out and said first, in every output, and the frames beside it are answered as ever.
"""
import random
import re
from pathlib import Path

import pytest

from support.tool.reading import lines_of, read_contacts, read_json
from support.tool.recordings import Recording, torus
from support.tool.running import run, usage_error

FRAMES = "good.obj good.obj shuffled.obj good.obj"


@pytest.fixture(autouse=True)
def files(own_folder):
    good = torus(12, 16)
    good.write_mesh("good.obj")
    points = list(good.frames[0])
    random.Random(4).shuffle(points)
    Recording(good.triangles, [points]).write_mesh("shuffled.obj")


def numbers_in(pattern, text):
    """The numbers that stand in the groups of a pattern."""
    found = re.search(pattern, text)
    assert found, text
    return [int(number) for number in found.groups()]


@pytest.fixture
def pair_count():
    """The pairs of the frame in disorder, those that cross and those that touch, from a run without a limit."""
    out = run("check shuffled.obj --no-depths").out
    count = sum(numbers_in(r"^(\d+) pairs.*%\); (\d+)", out))
    assert count > 5000 and "Not finished" not in out
    return count


@pytest.fixture
def contact_count():
    """Those of the interval between the two."""
    count = sum(numbers_in(r"contacts: (\d+) VF and (\d+)", run("replay good.obj good.obj shuffled.obj --no-check").out))
    assert count > 10000
    return count


@pytest.mark.parametrize("memory, left_out, threads", [
    ("100K", "and a list of them would", 1), ("2M", "and curves and depths would", 3), ("8M", "and depths would", 3),
])
def test_one_frame_of_three(pair_count, contact_count, memory, left_out, threads):
    for command in ("check", "replay"):
        out = run(f"{command} {FRAMES} --max-memory {memory} --threads {threads} --json out.json --junit out.xml", code=1).out
        assert "in another order than the model? 3 of 3 frames checked. Frame 1 crosses (1 of 3)." in out
        root, xml = read_json("out.json"), Path("out.xml").read_text()
        if command == "replay":  # the interval to the frame comes before it
            place, first = root["summary"], "Not finished: the interval from frame 0 has "
            assert numbers_in(f"{first}(\\d+)", out) == [contact_count]
            assert "contacts: 0 VF and 0 EE that are listed, and " in out
        else:
            place, first = root, "Not finished: frame 1 has "
            assert numbers_in(f"{first}(\\d+)", out) == [pair_count] and left_out in out
        assert place["complete"] is False and "in another order" in place["stopped_by"]
        assert 'tests="4" failures="1" errors="1"' in xml and f'<error message="{first}' in xml


def test_what_fails_fails():
    run(f"check {FRAMES} --max-memory 100K --fail-on crossing", code=3)


@pytest.mark.parametrize("options, counts, message", [
    ("--max-memory 8M --fail-depth 100", 'failures="0" errors="2"', '<error message="how deep it is, '),
    ("--max-memory 100K --fail-depth 100", 'failures="0" errors="2"', '<error message="how deep it is, '),
    ("--max-memory 100K --max-faces 9", 'failures="0" errors="2"', '<error message="how many triangles cross '),
    ("--max-memory 8M --max-faces 9", 'failures="1" errors="1"', "triangles cross others"),
    ("--max-memory 8M --fail-on crossing", 'failures="1" errors="1"', " pairs of triangles cross"),
    ("--max-memory 8M --max-faces 384", 'failures="0" errors="1"', 'name="frame 1"'),
])
def test_a_case_that_is_not_known(options, counts, message):
    """A frame whose depth is not known passes no rule that asks for it: it is an error of its own, beside that of the run."""
    run(f"check {FRAMES} {options} --junit out.xml", code=3 if 'failures="1"' in counts else 1)
    text = Path("out.xml").read_text()
    assert counts in text and message in text


@pytest.mark.parametrize("command", ["check", "replay"])
def test_depths_that_take_too_long(command):
    """They are said first, and a gate of depth does not pass them."""
    out = run(f"{command} {FRAMES} --max-work 1 --fail-depth 100 --junit out.xml --json out.json", code=1).out
    assert ", and depths would take more than --max-work allows (" in out
    assert 'failures="0" errors="2"' in Path("out.xml").read_text()
    assert read_json("out.json")["events"][0]["depth"] is None


def test_the_work_that_it_may_take_has_a_unit_that_suits():
    out = run(f"check {FRAMES} --max-work 1", code=1).out
    count, unit = re.search(r"more than --max-work allows \(some (\d+)([KM])\)", out).groups()
    assert 1 <= int(count) <= 1024 and unit == "M"


def nothing_of_contacts():
    """Of the first interval."""
    interval = read_json("out.json")["intervals"][0]
    assert [interval[key] for key in ("vf", "earliest_toi", "guarantee", "state")] == [None, None, [], "contact"]


def test_contacts_that_do_not_fit(contact_count):
    """Be it in one run or in shards that are merged: there are none in the file, nor numbers in the summary."""
    out = run(f"replay {FRAMES} --max-memory 2M --no-check --contacts out.csv --json out.json", code=1).out
    assert numbers_in(r"Not finished: the interval from frame 0 has (\d+)", out) == [contact_count]
    assert read_contacts("out.csv") == []
    nothing_of_contacts()
    for i, code in ((1, 0), (2, 1)):  # the first has no interval
        run(f"replay {FRAMES} --max-memory 2M --no-check --shard {i}/2 --results {i}.shard", code=code)
    run("merge 1.shard 2.shard --json out.json", code=1)
    nothing_of_contacts()


def test_with_room_for_them_all_contacts_are_there(contact_count):
    run(f"replay {FRAMES} --max-memory 200M --no-check --contacts out.csv")
    assert len(lines_of(Path("out.csv").read_text())) > 2 * contact_count - 100


def test_exports_of_what_is_left_out():
    assert "Not finished: frame 0 has " in run("check shuffled.obj --max-memory 2M --vtk vtk --ply out.ply", code=1).out
    run("check shuffled.obj --max-memory 1 --vtk vtk --ply out.ply", code=1)


def test_sizes_of_memory():
    run("check good.obj --max-memory 1.5G")
    run("check good.obj --max-memory 200000000")
    for value in ("0", "-1", "much", "5X", "5GB", "", "1e40", "nan", "0.5", "0x10", "0x10G", "1e", " 1G"):
        usage_error(f"check good.obj --max-memory '{value}'", "--max-memory")
    usage_error("check good.obj --fail-depth 0x1p-3mm", "--fail-depth cannot be '0x1p-3mm'")
    usage_error("check good.obj --fps 0x10", "--fps cannot be '0x10'")
