"""What the page of `cscd untangle --report` holds, decoded by other code, is the input, what was written, and what was said."""
from math import dist

import pytest

from report_file import Report
from support.tool.reading import read_json
from support.tool.recordings import Recording, ball, balls
from support.tool.running import run, usage_error

COUNT = len(ball(0.0)[0])
DISTANCES = (2.3, 1.9, 1.6, 1.9, 2.3)


@pytest.fixture(autouse=True)
def files(own_folder):
    sides = len(ball(0.0)[1])
    balls(1.6).write_mesh("balls.obj", records=["o Left"] + [""] * (sides - 1) + ["o Right"] + [""] * (sides - 1))
    balls(*DISTANCES).write_cache("balls.pc2")


def shown(report):
    """The points of each frame, before and after, in the files' unit."""
    points = [[tuple(report.scene["unit"] * x for x in point) for point in zip(*axes)] for axes in report.frames()]
    return points[0::2], points[1::2]


def expect_near(shown_points, points, off):
    assert len(shown_points) == len(points)
    assert max(dist(a, b) for a, b in zip(shown_points, points)) <= 2 * off


def test_a_mesh_is_there_before_and_after():
    out = run("untangle balls.obj -o clean.obj --report page.html --json out.json")
    report, found = Report("page.html"), read_json("out.json")
    assert report.document["kind"] == "untangled" and report.document["summaries"] == []
    assert report.document["untangled"] == found and found["answer"] == out.first_line
    before, after = shown(report)
    assert len(before) == len(after) == len(report.scene["frames"]) == 1
    for points, path in ((before[0], "balls.obj"), (after[0], "clean.obj")):
        with open(path, encoding="utf-8") as file:
            expect_near(points, [tuple(map(float, line.split()[1:4])) for line in file if line.startswith("v ")],
                        report.scene["max_error"])
    moved = [dist(a, b) for a, b in zip(before[0], after[0])]
    assert max(moved) == pytest.approx(found["frames"][0]["displacement"], abs=4 * report.scene["max_error"])


def test_what_crosses_is_there_before_and_after():
    run("untangle balls.obj -o clean.obj --report page.html --json out.json")
    report, frame = Report("page.html"), read_json("out.json")["frames"][0]
    assert list(report.arrays["answer_frame"]) == [0]
    crossing, touching, triangles, points, depths = report.arrays["answer_counts"]
    assert crossing + touching == frame["pairs_before"] and triangles > 20 and points > 20 and depths > 2
    run("untangle balls.obj -o clean.obj --time 1e-9 --report page.html", code=3)
    report = Report("page.html")
    counts = report.arrays["answer_counts"]
    assert list(report.arrays["answer_frame"]) == [0, 1] and counts[:5] == counts[5:]
    assert report.document["untangled"]["frames"][0]["left"][0]["reason"] == "time"


def test_frames_of_a_recording_are_in_their_order():
    """The first clean frame is not the first of all, so that some are done backwards."""
    balls(1.6, 1.9, 2.3, 1.9, 1.6).write_cache("late.pc2")
    run("untangle balls.obj late.pc2 -o clean.pc2 --frames 0:4:2 --report page.html --json out.json")
    report = Report("page.html")
    assert report.scene["numbers"] == report.scene["frames"] == [0, 2, 4]
    before, after = shown(report)
    for points, distance in zip(before, (1.6, 2.3, 1.6)):
        expect_near(points, balls(distance).frames[0], report.scene["max_error"])
    for frame, old, new in zip(read_json("out.json")["frames"], before, after):
        most = max(dist(a, b) for a, b in zip(old, new))
        assert most == pytest.approx(frame["displacement"], abs=4 * report.scene["max_error"])
    assert [place // 2 for place in report.arrays["answer_frame"]] == [0, 2]


def test_obstacles_are_shown_where_they_are():
    points, triangles = ball(0.0)
    Recording(triangles, [points]).write_mesh("one.obj")
    Recording(triangles, [ball(1.7)[0]]).write_mesh("other.obj")
    run("untangle one.obj --obstacle other=other.obj -o clean.obj --report page.html")
    before, after = shown(Report("page.html"))
    moved = [dist(a, b) for a, b in zip(before[0], after[0])]
    assert len(moved) == 2 * COUNT and max(moved[COUNT:]) < 1e-6 < 0.1 < max(moved[:COUNT])


def test_a_page_is_no_positions():
    usage_error("untangle balls.obj -o clean.obj --report clean.obj")
    usage_error("untangle balls.obj -o clean.obj --report balls.obj")
