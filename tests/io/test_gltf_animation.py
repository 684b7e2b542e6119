"""Animations of glTF files: which frames there are, and where vertices are in them, with numbers by hand."""
from math import atan, cos, hypot, sin

import pytest

from support.tool.mesh_files import UNSIGNED_BYTE, Gltf
from support.tool.read_back import expect_errors, frames_read, write_file
from support.tool.reading import read_json
from support.tool.running import fails, run, usage_error

TRIANGLE = [0, 0, 0, 1, 0, 0, 0, 1, 0]
MESHES = [{"primitives": [{"attributes": {"POSITION": 0}}]}]
IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def channel_file(path, kind, times, values, interpolation="LINEAR"):
    """One channel moves a triangle, which has targets that move vertex 1 along y, and vertex 2 along z."""
    file = Gltf(("VEC3", TRIANGLE), ("SCALAR", times), (kind, values), ("VEC3", [0, 0, 0, 0, 1, 0, 0, 0, 0]),
                ("VEC3", [0, 0, 0, 0, 0, 0, 0, 0, 1]))
    mesh = {"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 3}, {"POSITION": 4}]}]}
    animation = {"name": "Walk", "samplers": [{"input": 1, "output": 2, "interpolation": interpolation}],
                 "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}]}
    return file.glb(nodes=[{"mesh": 0}], meshes=[mesh], animations=[animation])


def expect_frames(content, expected, options="", tolerance=2e-15):
    """expected: nine coordinates for each frame."""
    found = [[number for point in mesh.points for number in point] for mesh in frames_read(content, options=options)]
    assert len(found) == len(expected)
    for frame, numbers in zip(found, expected):
        assert frame == pytest.approx(numbers, abs=tolerance, rel=0)


def moved(x, y, z):
    return [number + (x, y, z)[i % 3] for i, number in enumerate(TRIANGLE)]


def numbers_of_frames():
    return [frame["frame"] for frame in read_json("out.json")["frames"]]


def test_moves_along_lines():
    places = [(0.5 * i, i, 1.5 * i) for i in range(4)] + [(2, 4 - 0.5 * i, 6) for i in range(9)]
    expect_frames(channel_file("translation", "VEC3", [0, 1, 3], [0, 0, 0, 2, 4, 6, 2, 0, 6]),
                  [moved(*place) for place in places], "--fps 4")


def test_moves_along_splines():
    """Half of a tangent is the slope there: by the polynomials of the format, 0.25 + 1 - 0.75 at the middle.

    A quarter behind the start it is 0.84375 * 0 + 0.140625 * 2 * 1 + 0.15625 * 2 - 0.046875 * 2 * 3, a quarter before the end
    0.046875 * 2 * 1 + 0.84375 * 2 - 0.140625 * 2 * 3.
    """
    values = [9, 9, 9, 0, 1, 5, 1, 0, 0, 3, 0, 0, 2, 1, 5, 9, 9, 9]
    expect_frames(channel_file("translation", "VEC3", [1, 3], values, "CUBICSPLINE"),
                  [moved(x, 1, 5) for x in (0, 0.3125, 0.5, 0.9375, 2)], "--fps 2")
    assert numbers_of_frames() == [2, 3, 4, 5, 6]


@pytest.mark.parametrize("z, w", [(1, 1), (-1, -1), (1.75, -1), (1e-6, 1), (0, -1)])
def test_turns_the_shorter_way(z, w):
    """From rest to a quaternion around z of either sign, at constant speed.

    To 90 degrees, to 90 by the opposite quaternion, to 240, which is -120, to a small angle, and to none.
    """
    length = hypot(z, w)
    angles = [2 * atan(z / w) * frame / 6 for frame in range(7)]
    expect_frames(channel_file("rotation", "VEC4", [0, 1], [0, 0, 0, 1, 0, 0, z / length, w / length]),
                  [[0, 0, 0, cos(a), sin(a), 0, -sin(a), cos(a), 0] for a in angles], "--fps 6", tolerance=1e-7)


def test_changes_weights():
    """Of a spline in, value and out of two weights each; the middle is 0.5 * p0 + 0.125 * 2 * out + 0.5 * p1 - 0.125 * 2 * in."""
    expect_frames(channel_file("weights", "SCALAR", [0, 2], [0, 1, 1, -1]),
                  [[0, 0, 0, 1, 0.25 * i, 0, 0, 1, 1 - 0.5 * i] for i in range(5)], "--fps 2")
    expect_frames(channel_file("weights", "SCALAR", [0, 2], [8, 8, 0, 1, 2, 4, 6, -2, 1, -1, 8, 8], "CUBICSPLINE"),
                  [[0, 0, 0, 1, y, 0, 0, 1, z] for y, z in ((0, 1), (0.5 - 1.0, 0.5 + 1 - 0.5 + 0.5), (1, -1))], "--fps 1")


def test_steps_at_the_frame_of_the_key():
    """Many triangles, each of which jumps in a frame of its own. Keys are floats, a third of them past their frame."""
    frames = range(1, 100, 3)
    file = Gltf(("VEC3", TRIANGLE), ("VEC3", [0, 0, 0, 7, 0, 0]))
    samplers = [{"input": file.add("SCALAR", [0, n / 24.0]), "output": 1, "interpolation": "STEP"} for n in frames]
    channels = [{"sampler": i, "target": {"node": i, "path": "translation"}} for i in range(len(frames))]
    read = frames_read(file.glb(nodes=[{"mesh": 0}] * len(frames), meshes=MESHES,
                                animations=[{"samplers": samplers, "channels": channels}]))
    assert len(read) == max(frames) + 1  # 24 frames a second when none are given
    for frame, mesh in enumerate(read):
        assert [x for x, _, _ in mesh.points[::3]] == [7 if frame >= n else 0 for n in frames]


@pytest.mark.parametrize("start, end, fps, count, first", [
    (0, 0, 24, 1, 0),
    (0.5, 1.5, 24, 25, 12),
    (1 / 24, 47 / 24, 24, 47, 1),
    (0, 1.05, 10, 11, 0),
    (0, 1.0999, 10, 11, 0),
    (0, 1.1, 10, 12, 0),
    (1000 + 1 / 24, 1000 + 250 / 24, 24, 250, 24001),
    (1, 2, 29.97, 30, 30),
    (-1, 1, 5, 11, -5),
])
def test_counts_frames_from_the_start_to_the_end(start, end, fps, count, first):
    content = channel_file("translation", "VEC3", [start, end], [0, 0, 0, 1, 0, 0])
    run(f"check {write_file('mesh.glb', content)} --fps {fps} --no-depths --json out.json --quiet")
    assert numbers_of_frames() == list(range(first, first + count))


# ---- several channels and animations

MOVE_NODE_1 = {"sampler": 0, "target": {"node": 1, "path": "translation"}}
SCALE_NODE_0 = {"sampler": 1, "target": {"node": 0, "path": "scale"}}


def two_animations(*channels, samplers=None):
    """Node 1 is 5 up and has node 0, the triangle; node 2 has a matrix. Animation A has these channels; B moves node 0."""
    file = Gltf(("VEC3", TRIANGLE), ("SCALAR", [0, 2]), ("SCALAR", [0.5, 1]), ("VEC3", [0, 0, 0, 8, 0, 0]),
                ("VEC3", [1, 1, 1, 3, 3, 3]))
    nodes = [{"mesh": 0}, {"children": [0], "translation": [0, 5, 0]}, {"matrix": IDENTITY}]
    a = {"name": "A", "samplers": samplers or [{"input": 1, "output": 3}, {"input": 2, "output": 4}], "channels": list(channels)}
    b = {"name": "B", "samplers": [{"input": 2, "output": 3}],
         "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}
    return file.glb(nodes=nodes, meshes=MESHES, animations=[a, b])


def test_plays_channels_together():
    """The third channel is of an extension, the fourth of no node."""
    scales = [1, 1, 1, 2, 3, 3, 3, 3, 3]
    expect_frames(two_animations(MOVE_NODE_1, SCALE_NODE_0, {"sampler": 9, "target": {"path": "pointer"}},
                                 {"sampler": 0, "target": {"path": "scale"}}),
                  [[x, 0, 0, x + scale, 0, 0, x, scale, 0] for x, scale in enumerate(scales)], "--fps 4")


def test_chooses_animations_by_name():
    content = two_animations(MOVE_NODE_1)
    expect_frames(content, [[x, 5, 0, x + 1, 5, 0, x, 6, 0] for x in (0, 4, 8)], "--fps 4 --animation B")
    assert numbers_of_frames() == [2, 3, 4]
    assert "the first of 2 animations is played: A, B" in run("check mesh.glb --no-depths").error
    assert "is played" not in run("check mesh.glb --no-depths --animation B").error


def test_moves_skins():
    """Joint 1 stands on joint 0 and turns around z by 180 degrees in two seconds; the triangle's vertex 1 follows it."""
    file = Gltf(("VEC3", TRIANGLE), ("VEC4", [0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0], UNSIGNED_BYTE), ("VEC4", [1, 0, 0, 0] * 3),
                ("MAT4", IDENTITY + IDENTITY[:12] + [-0.5, 0, 0, 1]), ("SCALAR", [0, 1, 2]),
                ("VEC4", [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]))
    nodes = [{"mesh": 0, "skin": 0}, {"children": [2], "translation": [0, 0, 3]}, {"translation": [0.5, 0, 0]}]
    primitive = {"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}
    channel = {"sampler": 0, "target": {"node": 2, "path": "rotation"}}
    content = file.glb(nodes=nodes, skins=[{"joints": [1, 2], "inverseBindMatrices": 3}], meshes=[{"primitives": [primitive]}],
                       animations=[{"samplers": [{"input": 4, "output": 5}], "channels": [channel]}])
    expect_frames(content, [[0, 0, 3, x, y, 3, 0, 1, 3] for x, y in ((1, 0), (0.5, 0.5), (0, 0))], "--fps 1")


# ---- what is refused

def test_refuses_wrong_channels():
    scale = {"sampler": 0, "target": {"node": 1, "path": "scale"}}

    def of_node(node, path="scale"):
        return [{"sampler": 0, "target": {"node": node, "path": path}}]

    expect_errors([(two_animations(*channels), found, expected) for channels, found, expected in [
        (of_node(3), "animation 0, channel 0: node is 3", "3 nodes"),
        (of_node(2), "moves node 2, which has a matrix", "translation"),
        ([{**scale, "sampler": 2}], "channel 0: sampler is 2", "2 samplers"),
        ([{"target": scale["target"]}], "channel 0: sampler is missing", ""),
        ([{"sampler": 0, "target": {"node": 1}}], "target.path is missing", ""),
        ([{"sampler": 0}], "target is missing", ""),
        (of_node(1, "rotation"), "accessor 3: type is VEC3", "VEC4 for output"),
        (of_node(0, "weights"), "animation 0: moves no node", "no frames"),
        ([], "animation 0: moves no node", ""),
    ]] + [(two_animations(scale, samplers=[sampler]), found, expected) for sampler, found, expected in [
        ({"input": 1, "output": 3, "interpolation": "SINE"}, "sampler 0: interpolation is SINE", "LINEAR, STEP or CUBICSPLINE"),
        ({"input": 1, "output": 3, "interpolation": "CUBICSPLINE"}, "has 2 times and 2 values", "expected 6 values"),
        ({"input": 1}, "output is missing", ""),
    ]] + [(channel_file("scale", "VEC3", times, [0, 0, 0, 1, 0, 0]), found, expected) for times, found, expected in [
        ([1, 0.5], "sampler 0: the time of key 1 is 0.5, after 1", "rising"),
        ([0, 1e30], "frames in 1e+30 seconds", "at most"),
    ]])


def test_refuses_what_has_no_frames():
    write_file("mesh.glb", two_animations(MOVE_NODE_1))
    write_file("model.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    write_file("still.glb", Gltf(("VEC3", TRIANGLE)).glb(nodes=[{"mesh": 0}], meshes=MESHES))
    fails("check mesh.glb --animation Run", "mesh.glb: ", "no animation Run", "A, B")
    fails("check model.obj mesh.glb", "mesh.glb: ", "holds 3 vertices, the model has 4", "another mesh")
    fails("check mesh.glb still.glb", "still.glb: ", "holds no animation", "export it with its animations")
    for fps in ("-1", "nan"):
        usage_error(f"check mesh.glb --fps {fps}", "--fps")
