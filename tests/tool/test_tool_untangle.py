"""`cscd untangle`: what it says, what it writes, and that what it writes is what it says, by `cscd check`."""
import os
import struct
from math import dist
from pathlib import Path

import pytest

from support.tool import mesh_files
from support.tool.reading import json_of, read_json
from support.tool.recordings import Recording, ball, balls
from support.tool.running import fails, run, usage_error

COUNT = len(ball(0.0)[0])
NAMES = ["o Left"] + [""] * (len(ball(0.0)[1]) - 1) + ["o Right"] + [""] * (len(ball(0.0)[1]) - 1)

# Clean, then in each other, and out again.
DISTANCES = (2.3, 2.1, 1.9, 1.7, 1.5, 1.7, 2.1)


@pytest.fixture(autouse=True)
def files(own_folder):
    balls(1.6).write_mesh("balls.obj", records=NAMES)
    balls(*DISTANCES).write_cache("balls.pc2")


def checked(line):
    return run(f"check {line}").first_line


def points_of(path):
    return [line.split()[1:4] for line in Path(path).read_text().splitlines() if line.startswith("v ")]


def frames_of(path):
    """The number of the first frame, and all frames, a tuple of floats each."""
    data = Path(path).read_bytes()
    count, first, samples = *struct.unpack("<if", data[16:24]), struct.unpack("<i", data[28:32])[0]
    assert len(data) == 32 + samples * count * 12
    return first, [struct.unpack(f"<{3 * count}f", data[32 + k * count * 12:][:count * 12]) for k in range(samples)]


# ---- one mesh


def test_a_mesh_becomes_clean():
    answer = run("untangle balls.obj -o clean.obj --unit m --json out.json")
    frame = read_json("out.json")["frames"][0]
    assert frame["pairs_before"] > 50 and frame["clean"] and frame["pairs_after"] == 0 and frame["start"] == "pushed"
    assert answer.first_line.startswith(f"Clean: {frame['pairs_before']} pairs before, none after; "
                                        f"{frame['moved_vertices']} vertices moved, at most 2")
    assert " mm (the parts were 3" in answer.first_line and answer.out.endswith("\nwritten: clean.obj\n") and answer.error == ""
    assert 0.19 < frame["displacement"] < 0.4 and 0.3 < frame["thickness"] < 0.41
    assert checked("clean.obj") == "Clean: no two triangles cross or touch."
    moved = [v for v, (before, after) in enumerate(zip(points_of("balls.obj"), points_of("clean.obj"))) if before != after]
    assert len(moved) == frame["moved_vertices"] and frame["farthest"] in moved


def test_a_rest_shape_and_bending_change_the_way():
    ways = {}
    for name, options in (("plain", ""), ("bent", "--bending 0.5m"), ("rest", "--rest-shape rest.obj")):
        balls(2.5).write_mesh("rest.obj")
        assert run(f"untangle balls.obj -o {name}.obj --unit m {options}").first_line.startswith("Clean: ")
        assert checked(f"{name}.obj") == "Clean: no two triangles cross or touch."
        ways[name] = points_of(f"{name}.obj")
    assert ways["bent"] != ways["plain"]
    numbers = [[float(x) for point in ways[name] for x in point] for name in ("plain", "rest")]
    assert dist(*numbers) < 1e-5  # the same balls, elsewhere


def test_a_rest_shape_has_the_same_faces():
    Path("other.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    fails("untangle balls.obj -o clean.obj --rest-shape other.obj",
          "--rest-shape: other.obj has 3 vertices and 1 triangles, and ")
    fails("untangle balls.obj -o clean.obj --rest-shape none.obj", "--rest-shape: ", "none.obj")


def test_a_clean_mesh_stays_as_it_is():
    balls(2.5).write_mesh("apart.obj")
    assert run("untangle apart.obj -o out.obj").first_line == "Clean: no two triangles cross or touch; nothing was moved."
    assert Path("out.obj").read_bytes() == Path("apart.obj").read_bytes()


def test_all_but_the_places_of_vertices_is_kept():
    """Names, materials, texture coordinates, quads and comments of an OBJ, and what stands behind a vertex."""
    text = ("# two boxes\nmtllib skin.mtl\n" + mesh_files.box((0, 0, 0), (1, 1, 1), "Left") + "vt 0.5 0.5\nusemtl skin\n"
            + mesh_files.box((0.9, 0.3, 0.2), (1.4, 0.8, 0.7), "Right") + "# the end")
    Path("boxes.obj").write_text(text)
    run("untangle boxes.obj -o clean.obj")
    assert checked("clean.obj").startswith("Clean:")
    before, after = text.split("\n"), Path("clean.obj").read_text().split("\n")
    assert len(before) == len(after)
    assert all(a == b or (a.startswith("v ") and b.startswith("v ")) for a, b in zip(before, after)) and before != after


def write_float_ply(path, scene):
    """The first frame, with floats."""
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(scene.frames[0])}",
              *(f"property float {axis}" for axis in "xyz"), f"element face {len(scene.triangles)}",
              "property list uchar int vertex_indices", "end_header\n"]
    Path(path).write_bytes("\n".join(header).encode() + b"".join(struct.pack("<3f", *point) for point in scene.frames[0])
                           + b"".join(struct.pack("<B3i", 3, *triangle) for triangle in scene.triangles))


def test_other_formats():
    """A PLY stays a PLY, of doubles or floats; what cannot be copied becomes an OBJ of its triangles."""
    scene = balls(1.6)
    scene.write_mesh("text.ply")
    write_float_ply("floats.ply", scene)
    for path in ("text.ply", "floats.ply"):
        run(f"untangle {path} -o clean-{path} --quiet")
        assert checked(f"clean-{path}").startswith("Clean:")
    assert os.path.getsize("clean-floats.ply") == os.path.getsize("floats.ply")
    corners = ["".join("vertex %r %r %r\n" % scene.frames[0][v] for v in triangle) for triangle in scene.triangles]
    facets = (f"facet normal 0 0 0\nouter loop\n{three}endloop\nendfacet\n" for three in corners)
    Path("balls.stl").write_text(f"solid\n{''.join(facets)}endsolid\n")
    run("untangle balls.stl -o clean.stl --quiet")
    assert checked("clean.stl").startswith("Clean:")
    arrays = [("VEC3", [x for point in scene.frames[0] for x in point]),
              ("SCALAR", [corner for three in scene.triangles for corner in three], mesh_files.UNSIGNED_SHORT)]
    mesh_files.write_glb("balls.glb", arrays, nodes=[{"mesh": 0}],
                         meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}])
    run("untangle balls.glb -o clean.obj --quiet")
    assert checked("clean.obj").startswith("Clean:") and len(points_of("clean.obj")) == 2 * COUNT


@pytest.mark.parametrize("gap", ["2mm", "0.002"])
def test_the_result_keeps_a_gap(gap):
    answer = run(f"untangle balls.obj -o clean.obj --unit m --gap {gap}")
    assert " nearer than 2 mm before, none after" in answer.first_line or " pairs before, none after" in answer.first_line
    again = run("untangle clean.obj -o again.obj --unit m --gap 1.99mm")
    assert again.first_line == "Clean: no two triangles cross, touch or are nearer than 1.99 mm; nothing was moved."


def nearest_points(path):
    """How near the points of the two balls are to each other."""
    points = [tuple(map(float, point)) for point in points_of(path)]
    return min(dist(a, b) for a in points[:COUNT] for b in points[COUNT:])


def test_a_gap_is_as_large_as_it_says():
    run("untangle balls.obj -o near.obj")
    warning = run("untangle balls.obj -o far.obj --gap 0.1").error
    assert nearest_points("near.obj") < 0.1 <= nearest_points("far.obj") and warning == ""
    warning = run("untangle balls.obj -o far.obj --gap 0.2").error
    assert warning == "cscd: warning: 56 of 756 edges are shorter than the gap of 0.2, so what lies around them has to grow\n"


def test_pinned_parts_stay_where_they_are():
    run("untangle balls.obj -o clean.obj --pin Left")
    before, after = points_of("balls.obj"), points_of("clean.obj")
    assert before[:COUNT] == after[:COUNT] and before[COUNT:] != after[COUNT:] and checked("clean.obj").startswith("Clean:")
    fails("untangle balls.obj -o clean.obj --pin Left,Right", "--pin: every vertex of balls is pinned, so nothing could be moved")
    fails("untangle balls.obj -o clean.obj --pin Middle", "--pin: there is no part 'Middle'; the parts are Left, Right")


def test_other_objects_stay_where_they_are():
    points, triangles = ball(0.0)
    Recording(triangles, [points]).write_mesh("one.obj")
    Recording(triangles, [ball(1.7)[0]]).write_mesh("other.obj")
    for kind in ("obstacle", "object"):
        answer = run(f"untangle one.obj --{kind} other=other.obj -o clean.obj")
        assert answer.first_line.startswith("Clean: ") and "nothing was moved" not in answer.first_line
        assert checked(f"clean.obj --{kind} other=other.obj").startswith("Clean:")
        assert not checked(f"one.obj --{kind} other=other.obj").startswith("Clean:")


def test_what_is_left_out_is_said():
    answer = run("untangle balls.obj -o out.obj --ignore-parts Left,Right")
    assert "nothing was moved. As asked, 1 of 3 pairs of parts was not looked at." in answer.first_line


# ---- not clean


def test_what_is_not_clean_is_not_written():
    Path("out.obj").write_text("older")
    answer = run("untangle balls.obj -o out.obj --time 1e-9 --json out.json", code=3)
    pairs = read_json("out.json")["frames"][0]["pairs_after"]
    assert answer.first_line == (f"Not clean: {pairs} pairs before and after; nothing better was found, so nothing was moved. "
                                 "The time was up (--time 1e-09).")
    assert answer.out.endswith(f"\n\n    pairs  parts, and why they are left\n{pairs:9}  Left x Right: the time was up\n")
    assert answer.error == "cscd: out.obj was not written, since not all is clean; --partial writes the best that was found\n"
    assert Path("out.obj").read_text() == "older"
    root = read_json("out.json")
    assert root["clean"] is False and root["complete"] and root["written"] is None
    left = [{"part_a": "Left", "part_b": "Right", "pairs": pairs, "reason": "time"}]
    assert root["frames"][0]["left"] == left and root["frames"][0]["stopped"] and root["answer"] == answer.first_line


def test_why_pairs_are_left():
    """Two parts that are pinned, and flat ones that lie on each other: the one beside them is led out all the same."""
    points, triangles = ball(0.0)
    third, _ = ball(3.2)
    names = [text for name in ("Left", "Right", "Free") for text in ["o " + name] + [""] * (len(triangles) - 1)]
    shifted = [tuple(corner + 2 * COUNT for corner in triangle) for triangle in triangles]
    both = balls(1.6)
    Recording([*both.triangles, *shifted], [[*both.frames[0], *third]]).write_mesh("three.obj", records=names)
    answer = run("untangle three.obj -o out.obj --pin Left,Right --partial --json out.json", code=3)
    frame = read_json("out.json")["frames"][0]
    assert frame["left"] == [{"part_a": "Left", "part_b": "Right", "pairs": frame["pairs_after"], "reason": "immobile"}]
    table = answer.out.split("\n\n")[1].splitlines()
    assert table[:2] == ["    pairs  parts, and why they are left", f"{frame['pairs_after']:9}  Left x Right: neither may move"]
    assert frame["pairs_after"] < frame["pairs_before"] and not frame["stopped"]


def test_partial_writes_it():
    answer = run("untangle balls.obj -o out.obj --time 1e-9 --partial", code=3)
    assert answer.out.endswith("written: out.obj\n") and Path("out.obj").read_bytes() == Path("balls.obj").read_bytes()


# ---- recordings


def test_every_frame_becomes_clean():
    answer = run("untangle balls.obj balls.pc2 -o clean.pc2 --json out.json")
    assert answer.first_line.startswith("Clean: all 4 frames that crossed or touched, of frames 0 to 6; up to ")
    assert " vertices moved in a frame, at most 0.2" in answer.first_line and "(frame 4; the parts were 0.4" in answer.first_line
    frames = read_json("out.json")["frames"]
    assert [frame["start"] for frame in frames] == ["none", "none", *["neighbour"] * 4, "none"]
    assert checked("balls.obj clean.pc2") == "No frame crosses or touches (7 checked)."
    (_, before), (_, after) = frames_of("balls.pc2"), frames_of("clean.pc2")
    assert [a == b for a, b in zip(before, after)] == [True, True, False, False, False, False, True]
    for frame, old, new in zip(frames, before, after):  # of the floats that are stored
        moves = [dist(old[i:i + 3], new[i:i + 3]) for i in range(0, len(old), 3)]
        assert abs(frame["displacement"] - max(moves)) < 1e-12 and frame["moved_vertices"] == sum(move > 0.0 for move in moves)


def test_frames_before_the_first_clean_one_are_followed_backwards():
    balls(1.5, 1.7, 1.9, 2.3, 1.9).write_cache("late.pc2")
    run("untangle balls.obj late.pc2 -o clean.pc2 --json out.json")
    frames = read_json("out.json")["frames"]
    starts = ["neighbour", "neighbour", "neighbour", "none", "neighbour"]
    assert [(frame["frame"], frame["start"]) for frame in frames] == list(enumerate(starts))
    assert checked("balls.obj clean.pc2") == "No frame crosses or touches (5 checked)."


def test_without_a_clean_frame_the_first_is_untangled_by_itself():
    balls(1.5, 1.6, 1.7).write_cache("never.pc2")
    run("untangle balls.obj never.pc2 -o clean.mdd --json out.json")
    assert [frame["start"] for frame in read_json("out.json")["frames"]] == ["pushed", "neighbour", "neighbour"]
    assert checked("balls.obj clean.mdd") == "No frame crosses or touches (3 checked)."


def test_chosen_frames_keep_their_numbers():
    answer = run("untangle balls.obj balls.pc2 -o clean.pc2 --first-frame 58 --frames 60:64:2")
    assert answer.first_line.startswith("Clean: all 2 frames that crossed or touched, of frames 60 to 64 in steps of 2; ")
    assert checked("balls.obj clean.pc2 --frames 60:64") == "No frame crosses or touches (3 checked)."
    assert frames_of("clean.pc2")[0] == 60
    run("untangle balls.obj balls.pc2 -o one.obj --first-frame 58 --frames 62")
    assert checked("one.obj").startswith("Clean:")


def test_steady_is_for_recordings():
    run("untangle balls.obj balls.pc2 -o clean.pc2 --steady 0")
    run("untangle balls.obj balls.pc2 -o steady.pc2 --steady 0.9")
    assert checked("balls.obj steady.pc2") == "No frame crosses or touches (7 checked)."
    assert Path("clean.pc2").read_bytes() != Path("steady.pc2").read_bytes()


def test_frames_that_are_not_clean_are_listed():
    balls(1.5, 1.6, 1.7).write_cache("never.pc2")
    answer = run("untangle balls.obj never.pc2 -o clean.pc2 --time 1e-9", code=3)
    assert answer.first_line == ("Not clean: 3 of 3 frames that crossed or touched, of frames 0 to 2; nothing was moved. "
                                 "In 3 frames the time was up (--time 1e-09).")
    table = answer.out.split("\n\n")[1].splitlines()
    assert table[0].split() == ["frame", "before", "after", "moved", "by", "most", "of", "them,", "and", "why"]
    assert [row.split()[0] for row in table[1:]] == ["0", "1", "2"] and table[1].endswith("-  Left x Right: the time was up")
    assert not os.path.exists("clean.pc2")
    run("untangle balls.obj never.pc2 -o clean.pc2 --time 1e-9 --partial", code=3)
    assert Path("clean.pc2").read_bytes() == Path("never.pc2").read_bytes()


def test_time_ends_a_frame_that_is_clean():
    """From a clean frame every stop is clean."""
    answer = run("untangle balls.obj balls.pc2 -o clean.pc2 --time 1e-9")
    assert answer.first_line.endswith(" In 4 frames the time was up (--time 1e-09).")
    assert checked("balls.obj clean.pc2") == "No frame crosses or touches (7 checked)."


def test_threads_make_no_difference():
    for threads in (1, 2, 3):
        run(f"untangle balls.obj balls.pc2 -o clean{threads}.pc2 --threads {threads} --quiet")
    assert Path("clean1.pc2").read_bytes() == Path("clean2.pc2").read_bytes() == Path("clean3.pc2").read_bytes()


def test_a_bad_frame_keeps_those_before():
    with open("balls.pc2", "r+b") as file:
        file.seek(32 + 3 * 2 * COUNT * 12)
        file.write(struct.pack("<f", float("nan")))
    answer = run("untangle balls.obj balls.pc2 -o clean.pc2", code=1)
    assert answer.first_line.startswith("Not finished: frame 3 could not be read: ")
    assert " 3 of 7 frames done. Clean: the one frame" in answer.first_line and "frame 3 could not be read" in answer.error
    assert checked("balls.obj clean.pc2") == "No frame crosses or touches (3 checked)."


# ---- files


def test_names_of_outputs():
    usage_error("untangle balls.obj", "no -o OUT given")
    usage_error("untangle -o out.obj", "no MODEL given")
    usage_error("untangle balls.obj -o out.glb", "-o out.glb: expected a name that ends in .pc2, .mdd or .obj")
    fails("untangle balls.obj -o out.ply", "-o out.ply: expected a name that ends in .pc2, .mdd or .obj, or in that of MODEL")
    fails("untangle balls.obj balls.pc2 -o out.obj", "-o out.obj: a mesh file has one frame, and these are 7", "--frames N")
    fails("untangle balls.obj -o no/out.obj", "no/out.obj: cannot write: No such file or directory")
    fails("untangle balls.obj balls.pc2 -o no/out.pc2", "no/out.pc2: cannot create: No such file or directory")
    usage_error("untangle balls.obj -o out.obj --json out.obj", "--json 'out.obj'")
    usage_error("untangle balls.obj -o out.obj --steady 1", "--steady")
    fails("untangle balls.obj -o out.obj --gap 1mm", "--gap 1 mm: the files do not say what one unit of them is")


def test_the_standard_output():
    """- is the mesh, and the text for people goes to the standard error."""
    answer = run("untangle balls.obj -o -")
    assert answer.out.count("\nv ") + 1 == 2 * COUNT and answer.error.startswith("Clean: ") and "written" not in answer.error
    assert json_of(run("untangle balls.obj -o out.obj --json -").out)["clean"] is True


def test_quiet_says_nothing():
    answer = run("untangle balls.obj -o clean.obj --quiet")
    assert (answer.out, answer.error) == ("", "")
    answer = run("untangle balls.obj -o clean.obj --quiet --time 1e-9", code=3)
    assert answer.out == "" and answer.error.startswith("cscd: clean.obj was not written")
