"""Mesh files as frames: patterns, folders and lists, what frames are called, which one is missing, and when the model is one."""
import os
import re
import struct
from itertools import permutations
from pathlib import Path

import pytest

from support.tool.exported import read_ply
from support.tool.reading import read_json
from support.tool.recordings import Recording
from support.tool.running import fails, run

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


def write_frame(name, content):
    """Writes a frame, in the format of its name, which is known by the height at which it lies."""
    points = [(x, y, content) for x, y, _ in CORNERS]
    os.makedirs(os.path.dirname(name) or ".", exist_ok=True)
    if name.lower().endswith(".off"):
        Path(name).write_text("OFF\n4 1 0\n" + "".join(f"{x} {y} {z}\n" for x, y, z in points) + "3 0 1 2\n")
    else:
        Recording([(0, 1, 2)], [points]).write_mesh(name)


@pytest.fixture(autouse=True)
def model(own_folder):
    """A model that is no frame of any series."""
    write_frame("model/rest.off", 0)


def write_frames(names, folder="."):
    """Frames with the contents 1, 2, ..."""
    for content, name in enumerate(names, 1):
        write_frame(f"{folder}/{name}", content)


def frames_of(*paths, model="model/rest.off", options=""):
    """What the frames hold, what they are called, and what is said about them."""
    for path in Path().glob("out_*.ply"):
        path.unlink()
    error = run(f"check {options} --no-depths --ply out --json out.json --", model, *paths).error
    numbers = [frame["frame"] for frame in read_json("out.json")["frames"]]
    files = {int(re.findall(r"-?\d+", path.name)[-1]): path for path in Path().glob("out_*.ply")}
    return [int(read_ply(files[number]).points[0][2]) for number in numbers], numbers, error


def refused(path, *says, model="model/rest.off"):
    """The frames of a path are refused by an error that names it."""
    fails(f"check {model} '{path}'", os.path.dirname(path), *says)


# ---- patterns

@pytest.mark.parametrize("pattern, contents, others", [
    ("f_%d.obj", {"f_9.obj": 9, "f_11.obj": 11, "f_10.obj": 10, "f_8.obj": 8},
     ["f_008.obj", "f_x-1.obj", "f_99999999999.obj", "g_12.obj", "f_12.ply", "f_12_.obj"]),
    ("f_%03d.ply", {"f_098.ply": 98, "f_099.ply": 99, "f_100.ply": 100}, ["f_98.ply", "f_0098.ply"]),
    ("f%01d.off", {"f9.off": 9, "f10.off": 10}, []),  # outgrows its width
    ("10%%s%d_3.obj", {"10%s8_3.obj": 8, "10%s10_3.obj": 10, "10%s9_3.obj": 9}, []),
])
@pytest.mark.parametrize("folder", ["", "a/"])
def test_patterns_take_the_numbers_in_order(pattern, contents, others, folder):
    """Other names are no frames, however alike they are."""
    for name, content in [*contents.items(), *((name, 1000) for name in others)]:
        write_frame(folder + name, content)
    expected = sorted(contents.values())
    assert frames_of(folder + pattern)[:2] == (expected, expected)


def test_an_existing_name_is_no_pattern():
    write_frames(["f_1.obj", "f_%d.obj"])
    assert frames_of("f_%d.obj")[0] == [0, 2]  # behind the model, as words are no series


@pytest.mark.parametrize("pattern, says", [
    *((f"f_{conversion}", ["bad pattern: another conversion", "expected one %d or %0Nd"]) for conversion in (
        "%s.obj", "%n.obj", "%5d.obj", "%0d.obj", "%00d.obj", "%033d.obj", "%-3d.obj", "%ld.obj", "%.obj", "%", "%0", "%04",
        "%*d.obj", "% d.obj", "%018446744073709551617d.obj")),
    ("f_%d_%04d.obj", ["bad pattern: a second number"]),
    ("f_%%d.obj", ["bad pattern: no number"]),
    ("%d/f.obj", ["bad pattern: a number in the folder"]),
    ("f_%d.txt", ["unknown extension", ".obj, .ply, .off"]),
    ("f_%d", ["unknown extension"]),
    ("f_%d.obj", ["no file matches"]),
    ("none/f_%d.obj", ["cannot open the folder", "No such file"]),
])
def test_bad_patterns_are_refused(pattern, says):
    refused(pattern, *says)


# ---- folders

def test_folders_are_in_natural_order():
    write_frames(["f1.obj", "f2.obj", "f10.obj", "f0100.obj", "f99999999999999999999999.obj"], "a")
    assert frames_of("a")[0] == [1, 2, 3, 4, 5]


def test_folders_have_other_files_too():
    write_frames(["take2_f2_v3.OFF", "take2_f10_v3.OFF", "._take2_f11_v3.OFF"], "a")
    for name in ("readme.txt", "f1.mtl", "take2_f2_v3.plan.ply", "obj"):
        Path("a", name).write_text("x")
    os.mkdir("a/take2_f12_v3.OFF")
    assert frames_of("a")[0] == frames_of("a/")[0] == frames_of("a/.")[0] == [1, 2]


def test_a_folder_with_one_file_is_one_frame():
    write_frames(["pose.ply"], "a")
    assert frames_of("a")[0] == [1]


def test_folders_without_frames_are_refused():
    os.mkdir("a")
    refused("a", "no frames in this folder", ".obj, .ply, .off")
    Path("a/readme.txt").write_text("x")
    refused("a", "no frames in this folder")


@pytest.mark.parametrize("names, says", [
    *((names, ["holds both", *names]) for names in (
        ["f1.obj", "g2.obj"], ["f1.obj", "f2b.obj"], ["f.obj", "f1.obj"], ["f1_1.obj", "f2_2.obj"], ["f01.obj", "f1.obj"],
        ["f1.obj", "f2.ply"], ["f1.obj", "f2.OBJ"])),
    (["f1_1.obj", "f1_2.obj", "f2_1.obj"], ["differ in one number only", "f1_1.obj", "f2_1.obj"]),
    (["f1.obj", "f01.obj"], ["the same frame", "f1.obj", "f01.obj"]),
    (["f1.obj", "f2.ply"], ["one extension", "f1.obj", "f2.ply"]),
    (["f_-0.obj", "f_0.obj"], ["the same frame", "f_-0.obj", "f_0.obj"]),
    # As numbers without their point, 15 and 225, they would lie in steps of 210.
    (["f_1.5.obj", "f_2.25.obj"], ["f_1.5.obj and f_2.25.obj", "differ in one number only"]),
])
def test_a_folder_must_hold_one_series(names, says):
    write_frames(names, "a")
    refused("a", *says)


# ---- lists

def test_words_and_other_formats_keep_the_order_given():
    write_frames(["b.obj", "a.ply", "%d.off"])
    assert frames_of("b.obj", "a.ply", "%d.off", "b.obj")[0] == [0, 1, 2, 3, 1]


@pytest.mark.parametrize("name, content, says", [
    *((name, b"POINTCACHE2\0" + struct.pack("<iiffi12f", 1, 4, 1, 0.5, 1, *[0] * 12), "a point cache among several")
      for name in ("cache.pc2", "hidden.obj")),
    ("cache.mdd", struct.pack(">iif12f", 1, 4, 0, *[0] * 12), "a point cache among several"),
    ("missing.obj", None, "cannot open: No such file"),
    ("f_%d.obj", None, "cannot open: No such file"),
    ("a.txt", b"x", "unknown extension"),
    ("a.abc", b"x", "this is an Alembic archive"),
    ("model", None, "a folder must be the only path"),
])
def test_a_list_with_a_stranger_is_refused(name, content, says):
    write_frame("first.obj", 1)
    if content is not None:
        Path(name).write_bytes(content)
    fails(f"check model/rest.off first.obj {name}", name, says)


@pytest.mark.parametrize("names, numbers, says", [
    (["f_1.obj", "f_10.obj", "f_11.obj", "f_2.obj"], [1, 10, 11, 2], "in the order of their numbers"),
    (["f_09.obj", "f_10.obj", "f_11.obj"], [9, 10, 11], None),
    (["f1003.obj", "f1001.obj", "f1005.obj"], [1003, 1001, 1005], "in the order of their numbers"),  # steps are no gaps
])
def test_lists_are_taken_in_the_order_of_their_numbers(names, numbers, says):
    write_frames(names)
    contents, found, error = frames_of(*names, options="--allow-gaps")
    assert found == sorted(numbers) and contents == [numbers.index(number) + 1 for number in found]
    assert says in error if says else "order" not in error


def test_names_that_differ_in_two_numbers_stay_as_given():
    names = ["s2_f1.obj", "s1_f2.obj", "s1_f1.obj"]
    write_frames(names)
    contents, numbers, error = frames_of(*names)
    assert contents == numbers == [0, 1, 2, 3] and "in the order given" in error


# ---- gaps

@pytest.mark.parametrize("names, says", [
    (["a1.obj", "a2.obj", "a4.obj"], "a3.obj: missing, expected all frames from"),
    (["b0008.obj", "b0009.obj", "b0011.obj"], "b0010.obj: missing"),
    (["c1.obj", "c3.obj", "c7.obj", "c9.obj"], "c5.obj: missing"),
    (["d98.obj", "d99.obj", "d101.obj"], "d100.obj: missing"),
    (["e07_v2.obj", "e08_v2.obj", "e10_v2.obj"], "e09_v2.obj: missing"),
    (["f1.obj", "f3.obj", "f7.obj"], "in steps of 2"),
    (["g.-0003.obj", "g.-0001.obj", "g.0000.obj"], "g.-0002.obj: missing"),
])
def test_missing_members_are_named(names, says):
    write_frames(names)
    files = " ".join(names)
    fails(f"check model/rest.off {files}", says, "--allow-gaps")
    assert frames_of(*names, options="--allow-gaps")[0] == list(range(1, len(names) + 1))


@pytest.mark.parametrize("names, pattern, numbers, says", [
    (["g_0101.obj", "g_0103.obj", "g_0104.obj"], "g_%04d.obj", [101, 103, 104], "a/g_0102.obj: missing"),
    (["f_0001.obj", "f_0002.obj", "f_0005.obj"], "f_%04d.obj", [1, 2, 5], 
     "a/f_0003.obj: missing, expected all frames from f_0001.obj to f_0005.obj"),
    (["f.-0003.obj", "f.-0001.obj", "f.0000.obj"], "f.%04d.obj", [-3, -1, 0], "f.-0002.obj: missing"),
    (["p-03.obj", "p-01.obj", "p000.obj"], "p%03d.obj", [-3, -1, 0], "p-02.obj: missing"),
    (["10%s2_3.obj", "10%s8_3.obj", "10%s9_3.obj"], "10%%s%d_3.obj", [2, 8, 9], "10%s3_3.obj: missing"),
])
def test_folders_and_patterns_have_gaps_and_numbers_too(names, pattern, numbers, says):
    write_frames(names, "a")
    refused(f"a/{pattern}", says)
    assert frames_of(f"a/{pattern}", options="--allow-gaps")[:2] == ([1, 2, 3], numbers)
    if numbers == [101, 103, 104]:
        refused("a", says)
        assert frames_of("a", options="--allow-gaps")[:2] == ([1, 2, 3], numbers)


# ---- negative numbers

@pytest.mark.parametrize("names, numbers", [
    (["f.-0002.obj", "f.-0001.obj", "f.0000.obj", "f.0001.obj"], [-2, -1, 0, 1]),
    (["g_-2.ply", "g_-1.ply", "g_0.ply", "g_1.ply"], [-2, -1, 0, 1]),
    (["walk--020.obj", "walk--010.obj", "walk-000.obj", "walk-010.obj"], [-20, -10, 0, 10]),
    (["-4.obj", "-3.obj", "-2.obj", "-1.obj"], [-4, -3, -2, -1]),
    (["run-1.obj", "run-2.obj", "run-3.obj", "run-4.obj"], [1, 2, 3, 4]),
    (["2024-06-1.obj", "2024-06-2.obj", "2024-06-3.obj", "2024-06-4.obj"], [1, 2, 3, 4]),
])
def test_signs_count(names, numbers):
    """A sign stands behind a dot, an underscore or another '-'; elsewhere a '-' only separates. The model may be a frame."""
    write_frames(names)
    turned = names[2:] + names[:2]
    assert frames_of(*turned)[:2] == ([1, 2, 3, 4], numbers)
    for model in turned:
        listed = [name for name in turned if name != model]
        assert frames_of(*listed, model=model)[:2] == ([1, 2, 3, 4], numbers)


@pytest.mark.parametrize("names, sources, numbers", [
    (["f.-0002.obj", "f.-0001.obj", "f.0000.obj", "f.0001.obj"], ["a/f.%04d.obj", "a"], [-2, -1, 0, 1]),
    (["f.-002.obj", "f.-001.obj", "f.0000.obj", "f.0001.obj"], ["a/f.%04d.obj", "a"], [-2, -1, 0, 1]),
    # A pattern knows where its number is, whatever stands before the sign.
    (["h-10.obj", "h-5.obj", "h0.obj"], ["a/h%d.obj"], [-10, -5, 0]),
])
def test_folders_and_patterns_have_negative_numbers(names, sources, numbers):
    write_frames(names, "a")
    for source in sources:
        assert frames_of(source)[:2] == (list(range(1, len(names) + 1)), numbers)


def test_numbers_of_two_forms_are_refused():
    write_frames(["p-001.obj", "p-01.obj", "p-02.obj", "p000.obj"])
    refused("p%03d.obj", "both p-001.obj and p-01.obj are frame -1")


# ---- subframes

@pytest.mark.parametrize("names", [
    ["f.0001.00.obj", "f.0001.50.obj", "f.0002.00.obj", "f.0002.50.obj"],
    ["g_8.250.obj", "g_8.500.obj", "g_9.000.obj", "g_10.000.obj"],
    ["h.-0001.5.obj", "h.-0001.0.obj", "h.-0000.5.obj", "h.0000.0.obj"],
])
def test_subframes_are_taken_by_their_times(names):
    write_frames(names)
    turned = [names[(3 * k + 1) % 4] for k in range(4)]
    for model in ("model/rest.off", *turned):
        contents, numbers, error = frames_of(*(name for name in turned if name != model), model=model, options="--allow-gaps")
        assert (contents, numbers) == ([1, 2, 3, 4], [0, 1, 2, 3]) and "these have fractions" in error


def test_folders_have_subframes_and_gaps():
    write_frames(["f.0001.00.obj", "f.0001.50.obj", "f.0002.00.obj", "f.0002.50.obj"], "a")
    contents, numbers, error = frames_of("a")
    assert (contents, numbers) == ([1, 2, 3, 4], [0, 1, 2, 3]) and "these have fractions" in error
    os.remove("a/f.0002.00.obj")
    refused("a", "f.0001.50.obj: is not followed by the next frame but by f.0002.50.obj", "--allow-gaps")


# ---- the model

@pytest.mark.parametrize("names", [
    ["crouch.obj", "run.obj", "stand.obj", "walk.obj"], ["s2_f1.obj", "s1_f2.obj", "s1_f1.obj", "x.obj"], ["a.obj", "b.obj"]])
def test_a_model_among_words_is_the_first_frame(names):
    """Words are no series: what is named first is looked at first."""
    write_frames(names)
    contents, numbers, error = frames_of(*names[1:], model=names[0])
    assert contents == [number + 1 for number in numbers] == list(range(1, len(names) + 1))
    assert "in the order given, the model first" in error


def test_a_model_of_the_series_is_a_frame():
    """Once, be it listed or not."""
    names = ["f_1.obj", "f_2.obj", "f_10.obj"]
    write_frames(names)
    for model, *listed in permutations(names):
        for others in (listed, [*listed, model]):
            assert frames_of(*others, model=model, options="--allow-gaps")[:2] == ([1, 2, 3], [1, 2, 10])


@pytest.mark.parametrize("model", ["rest.obj", "f_1.off", "f_1_v2.obj", "g_1.obj"])
def test_other_models_are_no_frames(model):
    write_frames([model, "f_2.obj", "f_3.obj"])
    assert frames_of("f_2.obj", "f_3.obj", model=model)[:2] == ([2, 3], [2, 3])


# ---- what frames hold

def test_doubles_are_kept():
    points = [(0.1, 1e-90, -3.0000000000000004), (0, 0, 0), (1, 0, 0)]
    scene = Recording([(0, 1, 2)], [points])
    scene.frames = [points]  # not rounded
    for name in ("a.obj", "a.ply"):
        scene.write_mesh(name)
        run(f"check {name} {name} --no-depths --quiet --ply out")
        assert read_ply("out_0000.ply").points == points


def test_bad_frames_are_named():
    write_frames(["f0.obj", "f1.obj"], "a")
    for text, *says in [
        ("v 0 0 0\n" * 5 + "f 1 2 3\n", "f2.obj", "holds 5 vertices, the model has 4 vertices", "exported from another mesh"),
        ("v 0 0\n", "f2.obj:1: "),
        *((f"v 0 0 0\nv 1 {value} 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\n", "f2.obj:2: ") for value in ("nan", "inf", "-inf", "1e999")),
    ]:
        Path("a/f2.obj").write_text(text)
        error = run("check model/rest.off a", code=1).error
        assert all(part in error for part in says), error


QUAD, TURNED, SPLIT, OTHER = "f 1 2 3 4\n", "f 2 3 4 1\n", "f 1 2 3\nf 1 3 4\n", "f 1 2 4\nf 2 3 4\n"
FLAT = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
DART = "v 0 0 1\nv 0.9 0.8 1\nv 1 1 1\nv 0 1 1\n"  # in which the quad is concave: what shape it has plays no part


@pytest.mark.parametrize("faces, second, says", [
    ((QUAD, QUAD, QUAD), DART, None),
    ((SPLIT, QUAD, QUAD), DART, None),  # the model is triangulated, the frames are not
    ((QUAD, SPLIT, SPLIT), FLAT, None),
    ((QUAD, TURNED, TURNED), FLAT, "s1.obj: has other faces than the model, though as many"),
    ((QUAD, QUAD, SPLIT), FLAT, "s2.obj: has other faces than"),
    ((QUAD, SPLIT, OTHER), FLAT, "export without triangulating"),
    ((SPLIT, OTHER, OTHER), FLAT, "export without triangulating"),
])
def test_frames_have_the_faces_of_each_other(faces, second, says):
    """And of a model that has as many."""
    for name, points, own in zip(("model.obj", "s1.obj", "s2.obj"), (FLAT, FLAT, second), faces):
        Path(name).write_text(points + own)
    answer = run("check model.obj s1.obj s2.obj --no-depths", code=1 if says else 0)
    assert says is None or says in answer.error


# ---- point caches

@pytest.mark.parametrize("start, rate, numbers", [
    (1001, 1, [1001, 1002, 1003]), (-5, 2, [-5, -3, -1]), (1, 0.5, [0, 1, 2]), (0.25, 1, [0, 1, 2]), (3, 0, [0, 1, 2]),
    (-3e9, 1, [0, 1, 2]), (0, 2e9, [0, 1, 2]), (float("nan"), 1, [0, 1, 2]),
])
def test_headers_of_pc2_say_what_frames_are_called(start, rate, numbers):
    """Whole numbers that are in range."""
    points = [number for content in range(3) for x, y, _ in CORNERS for number in (x, y, content)]
    Path("cache.pc2").write_bytes(b"POINTCACHE2\0" + struct.pack("<iiffi36f", 1, 4, start, rate, 3, *points))
    assert frames_of("cache.pc2")[:2] == ([0, 1, 2], numbers)
