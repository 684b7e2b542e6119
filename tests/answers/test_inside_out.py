"""Parts that are inside out: their depths are those of the parts turned around, and what was turned is named."""
from pathlib import Path

import pytest

from support.tool.mesh_files import box, cube
from support.tool.reading import read_json
from support.tool.running import run, usage_error


def depth_of(line):
    """The depth of the first frame, and the components that are called inside out."""
    run(f"check {line} --quiet --json out.json")
    root = read_json("out.json")
    return root["frames"][0]["depth"], [each["component"] for each in root["inside_out"]]


def near(depth, *turned):
    return pytest.approx(depth, abs=1e-12), list(turned)


EACH_WAY = pytest.mark.parametrize("first, second", [(False, False), (True, False), (False, True), (True, True)])


@EACH_WAY
@pytest.mark.parametrize("corner, size, depth", [(0.5, 1, 0.5), (0.25, 0.5, 0.25)])
def test_cubes_have_one_depth(corner, size, depth, first, second):
    box_text, crate = cube(0, 1, "box", inverted=first), cube(corner, size, "crate", inverted=second)
    Path("both.obj").write_text(box_text + crate)
    Path("box.obj").write_text(box_text)
    Path("crate.obj").write_text(crate)
    turned = [0] * first + [1] * second
    assert depth_of("both.obj") == depth_of("box.obj --object second=crate.obj") == near(depth, *turned)
    run("check both.obj --quiet --fail-depth 0.1", code=3)


def test_the_orientation_may_be_kept():
    Path("kept.obj").write_text(cube(0, 1, "box", inverted=True) + cube(0.5, 1, "crate", inverted=True))
    assert depth_of("kept.obj --orientation as-given") == near(0)
    assert depth_of("kept.obj --orientation found") == near(0.5, 0, 1)
    run("check --each kept.obj --quiet --fail-depth 0.4", code=3)
    run("check --each kept.obj --quiet --fail-depth 0.4 --orientation as-given")
    usage_error("check kept.obj --orientation outwards", "--orientation cannot be 'outwards'")


@EACH_WAY
def test_a_cavity_stays_one(first, second):
    """Without names, shells belong together: a hollow cube is one whichever way round. With names, they are bodies."""
    def shells(*names):
        Path("shells.obj").write_text(cube(0, 1, names[0], inverted=first) + cube(0.25, 0.5, names[1], inverted=second))
        return depth_of("shells.obj")

    one_body = near(0.0 if first != second else 0.25, *([0, 1] if first else []))
    assert shells("", "") == one_body and shells("one", "one") == one_body
    assert shells("one", "two") == near(0.25, *[0] * first + [1] * second)


@pytest.mark.parametrize("names, inverted, note", [
    ("wheel hub tyre nut", "1000", "part wheel is inside out; it was taken as turned around\n"),
    ("wheel hub tyre nut", "1010", "part wheel and part tyre are inside out; they were taken as turned around\n"),
    ("wheel hub tyre nut", "1111", "part wheel, part hub, part tyre and 1 more are inside out; they were taken as turned"),
    ("wheel hub hub hub", "0100", "1 of 3 components of part hub is inside out; it was taken as turned around\n"),
])
def test_what_was_turned_is_named(names, inverted, note):
    cubes = [cube(3 * i, 1, name, inverted=inverted[i] == "1") for i, name in enumerate(names.split())]
    Path("parts.obj").write_text("".join(cubes))
    assert note in run("check parts.obj").error


@pytest.fixture
def flipping():
    """A scale from 1 to -0.8 in five frames."""
    for k in range(5):
        scale = 1 - 0.45 * k
        card = box((-0.5 * scale, -0.5, -0.5), (0.5 * scale, 0.5, 0.5), "card")
        Path(f"flip_{k}.obj").write_text(card + cube(-0.25, 0.5, "post"))
    return "flip_0.obj flip_%d.obj"


def test_frames_are_turned_by_themselves(flipping):
    error = run(f"check {flipping} --json out.json").error
    assert "part card is inside out in 2 frames, from 3 to 4; it was taken as turned" in error
    assert len(read_json("out.json")["frames"]) == 5 and all(frame["depth"] > 0 for frame in read_json("out.json")["frames"])


def test_shards_tell_it_too(flipping):
    """As one run does."""
    for i in (1, 2):
        run(f"replay {flipping} --quiet --shard {i}/2 --results {i}.shard")
    run("merge 1.shard 2.shard --json out.json")
    (card,) = read_json("out.json")["inside_out"]
    assert (card["frames"], card["first"], card["last"]) == (2, 3, 4)


def test_info_says_it_of_each_component():
    Path("info.obj").write_text(cube(0, 1, "box", inverted=True) + cube(0.25, 0.5, "crate"))
    closed = "8 vertices, 18 edges, 12 triangles, Euler characteristic 2, closed, genus 0"
    out = run("info info.obj --json out.json").out
    assert f"  0    {closed}, inside out\n" in out and f"  1    {closed}\n" in out
    assert [component["inside_out"] for component in read_json("out.json")["components"]] == [True, False]
