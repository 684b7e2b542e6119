"""Welding joins what lies together in all frames, and the tool says where open edges all but lie on each other."""
import re
import struct
from math import cos, pi, sin
from pathlib import Path

import pytest

from support.tool.mesh_files import UNSIGNED_SHORT, write_glb
from support.tool.reading import read_json
from support.tool.recordings import Recording, cube
from support.tool.running import fails, run

# ---- vertices that part


@pytest.fixture
def parting():
    """A cube whose sides have vertices of their own, one of which leaves its corner in frame 2."""
    parting = cube(True)
    x, y, z = parting.frames[2][5]
    parting.frames[2][5] = (x, y + 0.25, z)
    return parting


@pytest.mark.parametrize("cache", ["parting.pc2", "parting.mdd"])
def test_vertices_that_part_stay_apart(parting, cache):
    parting.write_mesh("split.obj")
    parting.write_cache(cache)
    error = run(f"replay split.obj {cache} --weld exact").error
    assert "1 vertex lies on others in the first frame alone, as where something is hidden" in error
    assert re.search(r"stays apart in all, as they should \(the first is vertex .* in frame 2\)", error)
    # Within a quarter they are joined in all frames.
    assert "come apart" not in run(f"replay split.obj {cache} --weld 0.25").error


def test_in_a_series_they_are_an_error(parting):
    """Frames in files of their own are read once."""
    parting.write_sequence("f_%d.obj")
    fails("replay f_0.obj f_%d.obj --weld exact --json out.json", "frame 2", "0.25", "welded")
    root = read_json("out.json")
    assert len(root["intervals"]) == 1 and "frame 2" in root["summary"]["stopped_by"]
    run("replay f_0.obj f_%d.obj --weld 0.5")


def count_welded(triangles, frames, weld):
    scene = Recording(triangles, frames)
    scene.write_mesh("scene.obj")
    scene.write_cache("scene.pc2")
    run(f"replay scene.obj scene.pc2 --quiet --weld {weld} --json out.json")
    return read_json("out.json")["summary"]["vertices"]


def test_only_what_lies_together_in_all_frames_is_joined():
    """Vertex v of 12 is at a place by v % 4 in each of four frames, so that only those of the same v % 4 lie together in all."""
    places = ((0, 0, 0, 0), (1, 1, 2, 2), (1, 2, 1, 2), (3, 3, 3, 3))
    frames = [[[place[k] * (1 + k) if axis == k % 3 else 0.25 for axis in range(3)] for k in range(4)] * 3 for place in places]
    assert count_welded([(t, t + 1, t + 2) for t in range(0, 12, 3)], frames, "exact") == 4


def test_whoever_stands_for_others_is_near_them_in_all_frames():
    """Within 1, vertex 0 stands for 3 and 6 in frame 0, which lie 1.8 apart.

    In frame 1 it leaves them, so that 3 stands for 6, and that must hold in frame 0, too.
    """
    frames = [[point for i, x in enumerate(corners) for point in ((x, 0, 0), (20 * i, 20, 0), (20 * i, 0, 20))]
              for corners in ((0, 0.9, -0.9), (10, 0, 0))]
    assert count_welded([(0, 1, 2), (3, 4, 5), (6, 7, 8)], frames, "1") == 9


@pytest.mark.parametrize("weld, noted", [("--weld exact", True), ("--weld none", False), ("--weld 1e-4", True), ("", True)])
def test_hidden_things_keep_their_vertices(weld, noted):
    """Box 1 is hidden by a scale of 0 in the first and the last of four frames; between them it stands half in box 0."""
    corners = (0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1)
    sides = (0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7)
    write_glb("hidden.glb", [("VEC3", corners), ("SCALAR", sides, UNSIGNED_SHORT), ("SCALAR", [0, 0.125, 0.25, 0.375]),
                             ("VEC3", [0, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0, 0])],
              nodes=[{"name": "Prop", "mesh": 0}, {"name": "Appears", "mesh": 0, "translation": [0.5, 0.25, 0.25]}],
              meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
              animations=[{"samplers": [{"input": 2, "output": 3, "interpolation": "STEP"}],
                           "channels": [{"sampler": 0, "target": {"node": 1, "path": "scale"}}]}])
    answer = run(f"check hidden.glb hidden.glb --fps 8 {weld}")
    assert "Frames 1 to 2 cross (2 of 4)" in answer.out and "1 event, Prop x Appears, " in answer.out
    assert ("7 vertices lie on others in the first frame alone, as where something is hidden" in answer.error) == noted


# ---- open edges that all but lie on others


def float32(x, steps=0):
    """The nearest float32, and so many units in the last place from there upwards."""
    (bits,) = struct.unpack("<i", struct.pack("<f", x))
    ordered = bits if bits >= 0 else -(bits & 0x7FFFFFFF)
    ordered += steps
    bits = ordered if ordered >= 0 else -ordered | 0x80000000
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def write_ball(path, radius, centre, off):
    """A ball of triangles that each bring corners of their own, which are moved by 0 to off units in the last place, in turn."""
    rings, segments, lines, use = 8, 12, [], 0
    stl = path.endswith(".stl")
    for ring in range(rings):
        for segment in range(segments):
            for half, places in enumerate((((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1)))):
                if (ring, half) in ((0, 1), (rings - 1, 0)):  # at a pole
                    continue
                lines += ["facet normal 0 0 0\nouter loop"] if stl else []
                for down, along in places:
                    turn, height = 2 * pi * ((segment + along) % segments) / segments, pi * (ring + down) / rings
                    pole = 0 if (ring + down) % rings == 0 else sin(height)
                    unit = (pole * cos(turn), pole * sin(turn), cos(height))
                    steps = [(7 * use + axis) % (off + 1) for axis in range(3)]
                    point = [float32(c + radius * x, k) for c, x, k in zip(centre, unit, steps)]
                    lines.append("{} {!r} {!r} {!r}".format("vertex" if stl else "v", *point))
                    use += 1
                lines += ["endloop\nendfacet"] if stl else ["f -3 -2 -1"]
    Path(path).write_text("\n".join(["solid ball", *lines, "endsolid ball"] if stl else lines) + "\n")


@pytest.mark.parametrize("path, radius, centre, off", [
    ("unit.stl", 1, (0, 0, 0), 1), ("far.stl", 40, (100, 50, 0), 1), ("small.stl", 1e-6, (0, 2e-6, 0), 3),
    ("large.stl", 3e8, (0, 0, 1e9), 2), ("unit.obj", 1, (0, 0, 0), 1), ("far.obj", 40, (-100, 50, 10), 2),
])
def test_the_hint_joins_rounded_corners(path, radius, centre, off):
    write_ball(path, radius, centre, off)
    warning = r"cscd: warning: (\d+) of (\d+) open edges lie on others but for .*; --weld (\S+)"
    hint = re.search(warning, run(f"info {path}").error)
    assert hint and int(hint.group(1)) == int(hint.group(2)) > 100
    answer = run(f"info {path} --weld {hint.group(3)}")
    assert "closed, genus 0" in answer.out and "lie on others" not in answer.error
    assert "Clean: " in run(f"check {path} --weld {hint.group(3)}").out


@pytest.mark.parametrize("gap, hint", [("1", False), ("0.001", False), ("0.0001", False), ("0.000015", True), ("0.000001", True)])
def test_other_open_edges_have_no_hint(gap, hint):
    """Two sheets with a gap between their borders."""
    Path("sheets.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
                                  f"v 1 0 {gap}\nv 2 0 {gap}\nv 2 1 {gap}\nv 1 1 {gap}\nf 5 6 7\nf 5 7 8\n")
    assert ("2 of 8 open edges lie on others but for" in run("check sheets.obj").error) == hint


def test_edges_that_lie_on_others_are_joined_exactly():
    Path("same.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 4 5 6\n")
    assert "2 of 6 open edges lie on others; --weld exact joins them" in run("check same.obj").error
