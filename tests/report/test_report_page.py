"""What a page of --report holds, decoded by other code, is what the run wrote elsewhere, and the files that it was given."""
import math
import re
import struct
from itertools import groupby, islice
from pathlib import Path
from typing import NamedTuple

import pytest

from recording_file import heat, read_contacts
from replayed import report_of, write
from report_file import Report
from support.tool.exported import read_ply
from support.tool.mesh_files import SIDES, box, corners_of
from support.tool.reading import read_json
from support.tool.recordings import Recording, cube, fold, spindle, tetrahedra, torus
from support.tool.running import CLEAN, run, write_list

# ---- scene and plan

def as_float32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


def expect_plan(report, plan):
    """The page has the regions and the charges of a plan's file, and each charge's rank in its component."""
    faces, regions, arrays = plan["face"], plan["region"], report.arrays
    components = [regions[face["region"]]["component"] for face in faces]
    assert list(arrays["region"]) == [face["region"] for face in faces] and list(arrays["component"]) == components
    assert list(arrays["charge"]) == [as_float32(face["charge"]) for face in faces]
    groups = [[face["charge"] for face, own in zip(faces, components) if own == c] for c in range(max(components) + 1)]
    ranks = [sum(other < face["charge"] for other in groups[c]) / (len(groups[c]) - 1) for face, c in zip(faces, components)]
    assert list(arrays["equalized"]) == list(map(as_float32, ranks))
    own = report.scene["plan"]
    assert own["method"] == "charge" and own["capacitances"] == [each["capacitance"] for each in plan["component"]]
    assert own["regions"] == [{"component": each["component"], "triangles": each["triangle_count"], "area": each["area"],
                               "visible_share": each["visible_share"], "detector_point": [each[k] for k in "xyz"]}
                              for each in regions]


def expect_mesh(report, scene):
    assert list(report.arrays["triangles"]) == [corner for triangle in scene.triangles for corner in triangle]
    assert (report.scene["vertices"], report.scene["triangles"]) == (len(scene.frames[0]), len(scene.triangles))
    assert report.errors(scene.frames) == (report.scene["max_error"], report.scene["relative_error"])


def test_a_preprocess_has_one_frame():
    scene = write(torus(8, 6))
    run("preprocess model.obj -o model.plan.ply --report page.html")
    report = Report("page.html")
    assert report.document["kind"] == "preprocess" and report.document["summaries"] == []
    assert report.scene["contacts"] is None and report.scene["last"] == 0
    assert not {"heat", "orientation", "detector_points", "contact_interval", "contact_toi"} & set(report.arrays)
    expect_mesh(report, scene)
    expect_plan(report, read_ply("model.plan.ply").elements)


def test_scene_and_plan_come_back():
    scene = write(tetrahedra(7))
    run("preprocess model.obj -o model.plan.ply")
    report = report_of("--up z")
    assert [report.document[key] for key in ("format", "kind", "title", "preprocess")] == [1, "replay", "model.obj", None]
    own = {"components": 2, "unit": 1.0, "first": 0, "last": 6, "up": "z", "frames": list(range(7)), "scenery": None}
    assert {key: report.scene[key] for key in own} == own
    assert not {"scenery_triangles", "contact_file_vertices"} & set(report.arrays)
    expect_mesh(report, scene)
    expect_plan(report, read_ply("model.plan.ply").elements)


# ---- contacts and orientations

def sign_of(corners, point):
    """On which side of a triangle a point is: behind it (1), where its normal points to (-1), or neither (0)."""
    (a, b, c), p = corners, point
    u, v, w = ([q[k] - p[k] for k in range(3)] for q in (a, b, c))
    volume = sum(u[k] * (v[k - 2] * w[k - 1] - v[k - 1] * w[k - 2]) for k in range(3))
    return (volume > 1e-9) - (volume < -1e-9)


def between(a, b, t):
    return [x + t * (y - x) for x, y in zip(a, b)]


def expect_orientations(report, scene, plan):
    """Triangles have the side of their region's point that they have all the time, and none where that changes."""
    points, regions = report.arrays["detector_points"], report.arrays["region"]
    rows = [points[at : at + 3] for at in range(0, len(points), 3)]  # interval, region, start and end
    count, intervals = max(regions) + 1, read_json("out.json")["intervals"]
    for region in range(count):
        assert list(rows[2 * region]) == pytest.approx([plan["region"][region][k] for k in "xyz"], abs=1e-6)
    for i, orientation in report.orientations():
        assert (orientation.count(1), orientation.count(2)) == (intervals[i]["plus"], intervals[i]["minus"])
        for triangle, region, found in zip(scene.triangles, regions, orientation):
            start, end = rows[2 * (count * i + region) :][:2]
            assert i == 0 or list(start) == pytest.approx(rows[2 * (count * (i - 1) + region) + 1], abs=1e-12)
            signs = {sign_of([between(scene.frames[i][v], scene.frames[i + 1][v], t) for v in triangle], between(start, end, t))
                     for t in (0.0, 0.25, 0.5, 0.75, 1.0)}
            assert found in (0, *(side for sign, side in ((1, 1), (-1, 2)) if signs == {sign}))


@pytest.mark.parametrize("scene, method, seen", [
    (tetrahedra(7), "charge", 0.9), (cube(False), "single", 0.5), (fold(9, 3, 13), "kmeans:3", 0.0),
    (spindle(24, 8, 9), "charge", 0.5),
])
def test_contacts_and_orientations_come_back(scene, method, seen):
    """seen: the share of the triangles at least that have a side; of an open surface none has."""
    write(scene)
    run(f"preprocess model.obj -o model.plan.ply --method {method}")
    report = report_of("--contacts out.csv")
    contacts = read_contacts("out.csv")
    assert report.contacts() == contacts != []
    assert report.scene["contacts"]["found"] == report.scene["contacts"]["kept"] == len(contacts)
    assert list(report.arrays["heat"]) == heat(scene.triangles, contacts)
    expect_orientations(report, scene, read_ply("model.plan.ply").elements)
    sides = [side for _, orientation in report.orientations() for side in orientation]
    assert len(sides) == len(scene.triangles) * (len(scene.frames) - 1) and sides.count(0) <= (1 - seen) * len(sides)


def test_contacts_have_the_vertices_of_the_file():
    write(cube(True))
    report = report_of("--weld exact --contacts out.csv")
    own = list(report.arrays["contact_file_vertices"])
    contacts = read_contacts("out.csv")
    assert [tuple(own[at : at + 4]) for at in range(0, len(own), 4)] == [each[2] for each in contacts] != []
    assert [each[2] for each in report.contacts()] != [each[2] for each in contacts]


# ---- what is too much

INTERVALS, DARTS = 30, 1700


def test_of_many_contacts_each_interval_keeps_its_share():
    """1700 triangles, each a little above the one before, fly to and fro through a plate, after three intervals of rest.

    The first of the other intervals may use what these have left, and the last still has its share.
    """
    plate = [(-9, -9, 0), (99, -9, 0), (-9, 99, 0)]

    def darts(z):
        return [(i % 40 + x, i // 40 + y, z + (i + 0.5) / DARTS) for i in range(DARTS) for x, y in ((0, 0), (0.5, 0), (0, 0.5))]

    write(Recording([range(v, v + 3) for v in range(0, 3 * DARTS + 3, 3)],
                    [plate + darts(-1.0 if k > 3 and k % 2 == 0 else 0.0) for k in range(INTERVALS + 1)]))
    report = report_of("--no-check --method none")
    kept = zip(report.arrays["contact_interval"], report.arrays["contact_toi"])
    own = {interval: [toi for _, toi in contacts] for interval, contacts in groupby(kept, lambda each: each[0])}
    kept = [len(own.get(k, ())) for k in range(INTERVALS)]
    assert kept[:5] == [0, 0, 0, 4000, 4000] and min(kept[3:]) >= 100000 // INTERVALS and max(kept) == 4000
    found = 3 * DARTS * (INTERVALS - 3)
    assert report.scene["contacts"] == {"found": found, "kept": sum(kept), "interval_limit": 4000, "limit": 100000}
    assert sum(kept) == 100000 and report.arrays["heat"][0] == found
    for times in own.values():  # the earliest ones
        assert times == sorted(times) == pytest.approx([(i // 3 + 0.5) / DARTS for i in range(len(times))], abs=1e-6)
    assert not {"orientation", "detector_points"} & set(report.arrays)


# ---- what intersects

class Answer(NamedTuple):
    """What the page has of a frame: how many pairs cross, and touch, kinds of triangles, points of curves, depths of vertices."""

    frame: int
    crossing: int
    touching: int
    kinds: dict
    points: int
    depths: dict


def answers_of(report):
    """Those of all frames that were checked."""
    arrays, answers = report.arrays, []
    triangles, depths = zip(arrays["answer_triangle"], arrays["answer_kind"]), zip(arrays["depth_vertex"], arrays["depth"])
    counts = iter(arrays["answer_counts"])
    for frame, crossing, touching, *sizes in zip(arrays["answer_frame"], counts, counts, counts, counts, counts):
        kinds, deep = dict(islice(triangles, sizes[0])), dict(islice(depths, sizes[2]))
        answers.append(Answer(frame, crossing, touching, kinds, sizes[1], deep))
        assert (len(kinds), len(deep)) == (sizes[0], sizes[2])  # each once
    assert not [*triangles, *depths, *counts] and sum(each.points for each in answers) == len(arrays["curve_share"])
    return answers


def test_each_frame_has_the_kinds_and_depths_of_its_own():
    """Triangle 0 is crossed by triangle 1 in the first frame and the last, and 2 rests on it. The tip of 3 is in two boxes."""
    flat = [(0, 0, 0), (9, 0, 0), (0, 9, 0), (1, 1, -1), (1, 2, 1), (2, 1, 1), (3, 3, 0), (3, 4, 1), (4, 3, 1)]
    dart = [(15, 15, 15), (15, 15.5, 99), (15.5, 15, 99)]
    boxes = [corners_of((low, low, low), (high, high, high)) for low, high in ((10, 20), (12, 18))]
    sides = [[base + corner for corner in half] for base in (12, 20) for a, b, c, d in SIDES for half in ((a, b, c), (a, c, d))]
    points = [*flat, *dart, *boxes[0], *boxes[1]]
    apart = [(x, y, z + 2) if 3 <= v < 6 or 9 <= v < 12 else (x, y, z) for v, (x, y, z) in enumerate(points)]
    write(Recording([(0, 1, 2), (3, 4, 5), (6, 7, 8), (9, 10, 11), *sides], [points, apart, points]))
    answers, frames = answers_of(report_of()), read_json("out.json")["frames"]
    assert [each[:3] for each in answers] == [(f, row["crossing_pairs"], row["touching_pairs"]) for f, row in enumerate(frames)]
    assert [[each.kinds.get(t) for t in range(3)] for each in answers] == [[17, 1, 16], [16, None, 16], [17, 1, 16]]
    assert [each.depths[9] for each in answers] == [5.0, 3.0, 5.0]


SEGMENTS, CHECKED = 5050, 20


def test_answers_are_bounded_and_each_frame_keeps_its_share():
    """A ring is cut by a large triangle, along a closed curve. A page has no room for all of its points in so many frames."""
    turns, count = [2.0 * math.pi * i / SEGMENTS for i in range(SEGMENTS)], 2 * SEGMENTS
    ring = [(math.cos(turn), math.sin(turn), z) for turn in turns for z in (-1.0, 1.0)]
    sides = [[(v + k) % count for k in corners] for v in range(0, count, 2) for corners in ((0, 2, 1), (2, 3, 1))]
    plate = [(-9, -9, 0.25), (99, -9, 0.25), (-9, 99, 0.25)]
    write(Recording([*sides, range(count, count + 3)], [ring + plate])).write_cache("frames.pc2", CHECKED)
    report = report_of("--method none --max-work 1")
    assert [(each.frame, each.crossing, each.points) for each in answers_of(report)] == [
        (frame, count, 200000 // CHECKED) for frame in range(CHECKED)]
    answers = report.scene["answers"]
    assert (answers["points_found"], answers["points_kept"]) == (CHECKED * (count + 1), 200000)


def test_of_many_events_the_worst_are_kept():
    """The deep ones, in their order: 2500 triangles have a corner in a box, and every fifth of them is less deep."""
    lines = [box((0, 0, 0), (50, 50, 50), "floor", cut=0)]
    for i in range(2500):
        x, y, depth = i % 50 + 0.5, i // 50 + 0.5, 0.125 if i % 5 == 0 else 0.25
        lines.append(f"o {i}\nv {x} {y} {50 - depth}\nv {x + 0.25} {y} 51\nv {x} {y + 0.25} 51\nf -3 -2 -1\n")
    Path("model.obj").write_text("".join(lines))
    run("replay model.obj model.obj model.obj --report page.html --quiet")
    answers = Report("page.html").scene["answers"]
    assert answers["events_found"] == 2500
    assert [event["b"] for event in answers["events"]] == [str(i) for i in range(2500) if i % 5 != 0]


# ---- long summaries

def tables_of(*paths):
    """Which arrays of summaries the page has as columns; read back, all of them are what the files have."""
    report = Report("page.html")
    assert [each["summary"] for each in report.document["summaries"]] == [read_json(path) for path in paths]
    return set(re.findall(r"(intervals|frames)-0", " ".join(report.arrays)))


@pytest.mark.parametrize("intervals, tables", [(1000, {"intervals", "frames"}), (999, {"frames"}), (998, set())])
def test_long_summaries_become_columns(intervals, tables):
    """Of 1000 rows or more; some are texts, and some of their numbers null."""
    write(tetrahedra(8)).write_cache("frames.pc2", intervals + 1)
    report_of()
    assert tables_of("out.json") == tables


def test_rows_of_another_form_stay():
    """A row in the midst that differs from the others keeps all of them as they were, in pages of replays side by side."""
    write(tetrahedra(8)).write_cache("frames.pc2", 1001)
    report_of()
    run("report out.json -o page.html")
    assert tables_of("out.json") == {"intervals", "frames"}
    summary = read_json("out.json")
    for i, change in enumerate([
            lambda row: {**row, "more": 5},
            lambda row: {**row, "more": {"deep": {"deeper": 3}}},
            lambda row: dict(reversed(row.items())),
            lambda row: {{"passes": "more", "depth": "more"}.get(key, key): value for key, value in row.items()}]):
        odd = {name: [*summary[name][:500], change(summary[name][500]), *summary[name][501:]] for name in ("intervals", "frames")}
        write_list(f"odd{i}.json", {**summary, **odd})
    run("report odd0.json odd1.json odd2.json odd3.json -o page.html")
    assert tables_of("odd0.json", "odd1.json", "odd2.json", "odd3.json") == set()


# ---- the policy

def test_pages_load_send_and_move_nothing():
    """default-src says nothing about the base of links and the targets of forms. A policy holds for what stands behind it."""
    write(tetrahedra(3))
    report_of()
    Path("a.obj").write_text(CLEAN)
    write_list("jobs.jsonl", {"model": "a.obj"})
    run("check --list jobs.jsonl --results out.jsonl")
    run("report out.jsonl -o jobs.html")
    for page in ("page.html", "jobs.html"):
        head, policy = Path(page).read_text().split('<meta http-equiv="Content-Security-Policy" content="')
        assert {"default-src 'none'", "base-uri 'none'", "form-action 'none'"} <= set(policy.split('"')[0].split("; "))
        assert "<script" not in head
