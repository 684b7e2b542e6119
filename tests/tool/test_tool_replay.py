"""The output of a replay: contacts, summary and table, on scenes whose contacts are known."""
from math import hypot
from pathlib import Path

import pytest

from support.tool.reading import read_contacts, read_json
from support.tool.recordings import fold, tetrahedra
from support.tool.running import run

STAGES = ("update", "orientation", "traversal", "contact", "proof", "check", "total")


@pytest.fixture(scope="module")
def sheet():
    return fold(24, 5, 16)


@pytest.fixture(autouse=True)
def files(own_folder, sheet):
    for name, scene in (("flight", tetrahedra(8)), ("fold", sheet)):
        scene.write_mesh(f"{name}.obj")
        scene.write_cache(f"{name}.pc2")


def near(value):
    return pytest.approx(value, abs=1e-12, rel=0)


def test_finds_the_contacts_that_the_scene_was_built_for():
    run("replay flight.obj flight.pc2 --contacts out.csv")
    entry, leave = read_contacts("out.csv")
    assert (entry.frame, entry.kind, entry.a, entry.b) == (3, "vf", (4,), (0, 1, 2))
    opposite = tetrahedra(1).triangles[2]  # of the wall, to vertex 0
    assert (leave.frame, leave.kind, leave.a, leave.b) == (5, "vf", (4,), opposite)
    assert entry.toi == near(0.5) and entry.point == near((0, 1, 1))
    assert leave.toi == near(0.5) and leave.point == near((-2, 1, 1))
    assert entry.u == near(0.25) and entry.v == near(0.25)
    assert entry.normal[0] == near(1)  # against the motion of the tip


def named_points(sheet, contact):
    """The points of the two features that u and v name at the TOI."""
    def place(vertex):
        ends = sheet.frames[contact.frame][vertex], sheet.frames[contact.frame + 1][vertex]
        return [(1.0 - contact.toi) * x0 + contact.toi * x1 for x0, x1 in zip(*ends)]

    def mean(vertices, weights):
        return [sum(weight * x for weight, x in zip(weights, coordinates)) for coordinates in zip(*map(place, vertices))]

    u, v = contact.u, contact.v
    if contact.kind == "vf":
        return place(contact.a[0]), mean(contact.b, (1.0 - u - v, u, v))
    return mean(contact.a, (1.0 - u, u)), mean(contact.b, (1.0 - v, v))


def test_rows_reproduce_their_points(sheet):
    run("replay fold.obj fold.pc2 --contacts out.csv")
    contacts = read_contacts("out.csv")
    for contact in contacts:
        a, b = named_points(sheet, contact)
        assert 0 <= contact.toi <= 1 and contact.frame < 15
        assert -1e-9 <= min(contact.u, contact.v) <= max(contact.u, contact.v) <= 1 + 1e-9
        assert a == pytest.approx(b, abs=1e-6) and contact.point == near(tuple((x + y) / 2 for x, y in zip(a, b)))
        assert hypot(*contact.normal) == pytest.approx(1, abs=1e-9)
    assert [(contact.frame, contact.toi) for contact in contacts] == sorted((contact.frame, contact.toi) for contact in contacts)
    assert all(sum(contact.kind == kind for contact in contacts) >= 5 for kind in ("vf", "ee"))


def test_json_lines_hold_what_the_csv_holds():
    for name in ("out.csv", "out.jsonl"):
        run(f"replay fold.obj fold.pc2 --contacts {name}")
    assert read_contacts("out.csv") == read_contacts("out.jsonl") != []


def test_json_csv_and_table_agree():
    """All of "summary" and "provenance" that the documentation names."""
    out = run("replay fold.obj fold.pc2 --timings --contacts out.csv --json out.json").out
    root, contacts = read_json("out.json"), read_contacts("out.csv")
    total, intervals, provenance = root["summary"], root["intervals"], root["provenance"]
    assert [interval["frame"] for interval in intervals] == list(range(15))
    for interval in intervals:
        own = [contact for contact in contacts if contact.frame == interval["frame"]]
        assert all(interval[kind] == sum(contact.kind == kind for contact in own) for kind in ("vf", "ee"))
        assert interval["earliest_toi"] == min((contact.toi for contact in own), default=None)
        assert interval["tests"] >= len(own) and interval["pcp"] >= 0
        assert all(interval["ms"][stage] >= 0 for stage in STAGES)
        (guarantee,) = interval["guarantee"]
        assert (guarantee["count"], guarantee["mode"]) == (1, "all") and guarantee["reason"]
    assert [frame["frame"] for frame in root["frames"]] == list(range(16))
    assert {type(frame["crossing"]) for frame in root["frames"]} == {bool}
    assert total["complete"] is True and (total["method"], total["mode"], total["intervals"]) == ("none", "all", 15)
    assert all(total[kind] == sum(interval[kind] for interval in intervals) for kind in ("vf", "ee"))
    assert total["vf"] + total["ee"] == len(contacts) and total["first_contact_frame"] == contacts[0].frame
    assert total["pcp"]["mean"] == pytest.approx(sum(interval["pcp"] for interval in intervals) / 15, abs=1e-9)
    assert provenance["version"] == "2.0.0" and provenance["commit"] and len(provenance["date"]) == 20
    assert isinstance(provenance["machine"], dict) and len(provenance["arguments"]) == 8 and len(provenance["inputs"]) == 2
    assert "contacts: {vf} VF and {ee} EE in {intervals_with_contact} of {intervals} intervals".format(**total) in out
    states = "intervals: {clean} clean, {contact} with contact, {penetrating} intersecting, {unknown} unknown"
    assert states.format(**total) in out
    for column in ("BVH update", "orientation", "traversal", "contact", "#PCPs", "total"):
        assert column in out


@pytest.mark.parametrize("options, states, crossing", [
    ("--quiet", 3 * ["clean"] + ["contact"] + 3 * ["penetrating"], 4 * [False] + 4 * [True]),
    ("--no-check", 3 * ["unknown"] + ["contact", "unknown", "contact", "unknown"], 8 * [None]),
    ("--frames 2:4", ["clean", "contact"], [False, False, True]),
    ("--frames 5:", 2 * ["penetrating"], 3 * [True]),
    ("--frames :1", ["clean"], 2 * [False]),
])
def test_says_in_what_state_each_interval_is(options, states, crossing):
    run(f"replay flight.obj flight.pc2 --json out.json {options}")
    root = read_json("out.json")
    assert [interval["state"] for interval in root["intervals"]] == states
    assert [frame["crossing"] for frame in root["frames"]] == crossing


def test_replays_the_frames_asked_for():
    run("replay flight.obj flight.pc2 --frames 3:4 --contacts out.csv")
    assert [contact.frame for contact in read_contacts("out.csv")] == [3]


def test_fails_on_contact_when_asked():
    run("replay flight.obj flight.pc2 --fail-on-contact", code=3)
    run("replay flight.obj flight.pc2 --fail-on-contact --frames 0:3")


def csv_of(frames, options="--threads 1"):
    run(f"replay fold.obj {frames} --contacts out.csv {options}")
    return Path("out.csv").read_text()


def test_same_bytes_whatever_the_way():
    expected = csv_of("fold.pc2")
    assert "vf" in expected
    for options in ("--threads 1", "--threads 4", "--method brute", "--method none", "--threads 0"):
        assert csv_of("fold.pc2", options) == expected


def test_same_contacts_from_every_format(sheet):
    expected = csv_of("fold.pc2")
    Path("meshes").mkdir()
    sheet.write_cache("fold.mdd")
    sheet.write_sequence("meshes/f_%04d.obj")
    sheet.write_sequence("f_%04d.ply")
    for frames in ("fold.mdd", "meshes/f_%04d.obj", "meshes", "f_%04d.ply"):
        assert csv_of(frames) == expected


def test_a_list_of_meshes_is_a_recording():
    tetrahedra(8).write_mesh("third.obj", 3)
    tetrahedra(8).write_mesh("fourth.ply", 4)
    run("replay flight.obj third.obj fourth.ply --fail-on-contact", code=3)
    run("replay flight.obj flight.obj third.obj --fail-on-contact")


def test_quiet_prints_nothing():
    assert run("replay fold.obj fold.pc2 --quiet --contacts out.csv") == (0, "", "")
    error = run("replay fold.obj fold.pc2").error
    assert "warning" not in error and "cscd: component 0 is an open surface, as cloth is" in error
