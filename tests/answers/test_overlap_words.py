"""What check says of parts that share space, or only meet, and what a gate makes of it."""
from pathlib import Path

import pytest

from support.tool.mesh_files import box
from support.tool.reading import read_csv, read_json
from support.tool.running import fails, run

UNIT = ((0, 0, 0), (1, 1, 1))


@pytest.mark.parametrize("a, b, cut, line, word, code", [
    (((0, 0, 0), (4, 1, 3)), ((3.75, 0, 0), (8, 1, 3)), 0, "1 pair of parts overlaps; ", "a x b  overlap ", 3),
    (UNIT, ((0, 0.75, 0), (1, 1, 1)), 0, "1 pair of parts overlaps; ", "a x b  overlap ", 3),
    (UNIT, ((0.25, 0.25, 0.25), (0.75, 0.75, 0.75)), 0, "1 part lies inside another; ", "a x b  inside ", 3),
    (UNIT, UNIT, 0, "1 pair of parts is two copies of one solid; ", "a x b  copies ", 3),
    (UNIT, UNIT, 1, "1 pair of parts is two copies of one solid; ", "a x b  copies ", 3),
    (((0, 0, 0), (4, 1, 3)), ((4, 0, 0), (8, 1, 3)), 0, "62 pairs of triangles touch, none cross. ", "a x b  touch ", 0),
    (((-4, -4, -1), (4, 4, 0)), ((-1, -1, 0), (1, 1, 2)), 0, "", "a x b  touch ", 0),
    (UNIT, ((0.5, 0.5, 0.5), (1.5, 1.5, 1.5)), 0, "", "a x b  cross ", 3),
])
def test_words_say_who_shares_space(a, b, cut, line, word, code):
    """In one file and in two. cut: the sides of the second box have their other diagonals."""
    first, second = box(*a, "a", cut=0), box(*b, "b", cut=cut)
    Path("both.obj").write_text(first + second)
    Path("a.obj").write_text(first)
    Path("b.obj").write_text(second)
    for files in ("both.obj", "a.obj --object b=b.obj"):
        out = run(f"check {files}").out
        assert out.startswith(line) and word in out
        run(f"check {files} --quiet --fail-on crossing", code=code)
        run(f"check {files} --quiet --fail-depth 0.1", code=code)


def test_tables_say_that_parts_are_copies():
    """As the file for programs does."""
    Path("both.obj").write_text(box(*UNIT, "a", cut=0) + box(*UNIT, "b", cut=0))
    run("check both.obj --events out.csv --json out.json")
    kinds = read_json("out.json")["events"][0]["kinds"]
    assert "same_solid" in kinds and [row["kinds"] for row in read_csv("out.csv")] == [" ".join(kinds)]


@pytest.mark.parametrize("shift", [0, 1, 2])
def test_what_lies_in_itself_is_not_the_worst(shift):
    """A part with a second shell in it, which meets nothing, comes after parts that cross, whatever their order is."""
    parts = [box((0, 0, 0), (4, 4, 4), "shells", cut=0) + box((1, 1, 1), (3, 3, 3), cut=0),
             box((10, 0, 0), (11, 1, 1), "b", cut=0), box((10.75, 0.5, 0.5), (12, 2, 2), "c", cut=0)]
    Path("three.obj").write_text("".join(parts[(shift + i) % 3] for i in range(3)))
    error = run("check three.obj --fail-on crossing", code=3).error
    assert ", worst: b x c" in error or ", worst: c x b" in error


# ---- how many lie inside


def write_nest(halves, shifts, axis=1, scale=1.0):
    """Cubes a, b, c, d around places along an axis, by half their sides."""
    text = ""
    for name, half, shift in zip("abcd", halves, shifts):
        middles = [shift if k == axis else 0 for k in range(3)]
        text += box(*([scale * (middle + side * half) for middle in middles] for side in (-1, 1)), name, cut=0)
    Path("nest.obj").write_text(text)


@pytest.mark.parametrize("axis, scale", [(0, 1.0), (2, 0.001)])
@pytest.mark.parametrize("halves, shifts, inside, pairs", [
    ((4, 3, 2), (0, 0, 0), 2, 3),  # dolls,
    ((2, 4, 3), (0, 0, 0), 2, 3),  # in another order,
    ((1, 2, 3, 4), (0.5, 0, 0.25, 0), 3, 6),  # and four of them
    ((8, 1, 1), (0, -3, 3), 2, 2),  # two in one that are apart,
    ((1, 8, 1, 1), (-3, 0, 0, 3), 3, 3),  # and three
    ((2, 1, 2, 1), (-3, -3, 3, 3), 2, 2),  # one in each of two
    ((2, 1, 2), (-3, -3, 3), 1, 1),  # in one of two
])
def test_parts_inside_count_once(halves, shifts, inside, pairs, axis, scale):
    """A doll in two others is one part, though it makes two events."""
    write_nest(halves, shifts, axis, scale)
    lie = "parts lie inside others" if inside > 1 else "part lies inside another"
    line = f"{inside} {lie}; no two triangles cross or touch. {pairs} place"
    assert run("check nest.obj --json nest.json").out.startswith(line)
    assert read_json("nest.json")["frames"][0]["inside_parts"] == inside
    assert line in run("check --each nest.obj").out
    fails("check nest.obj --quiet --fail-on crossing",
          f"failed: {'a ' * (inside == 1)}{lie}, though no triangles cross, worst: ", code=3)


def test_parts_inside_what_is_left_out():
    write_nest((4, 3, 2), (0, 0, 0))
    assert run("check nest.obj --ignore-parts a,b --ignore-parts a,c").out.startswith("1 part lies inside another; ")


# ---- what is left out


@pytest.fixture
def three_boxes():
    """Of which two cross, so that there are six pairs of parts: a x b, a x c, b x c and the three with themselves."""
    Path("left.obj").write_text(box(*UNIT, "a", cut=0) + box((0.5, 0.5, 0.5), (1.5, 1.5, 1.5), "b", cut=0)
                                + box((5, 0, 0), (6, 1, 1), "c", cut=0))
    Path("list.txt").write_text("components 1 0\ncomponents 0 1\n0 13\n3 30\n13 0\n")


@pytest.mark.parametrize("options, said, parts, components, triangles", [
    ("--ignore-parts b", " As asked, 3 of 6 pairs of parts were not looked at.\n", 3, 0, 0),
    ("--ignore-parts a,b", " As asked, 1 of 6 pairs of parts was not looked at.\n", 1, 0, 0),
    ("--ignore-parts a,b --ignore-parts b,a", " 1 of 6 pairs of parts was not ", 1, 0, 0),
    ("--only a,c", " As asked, 5 of 6 pairs of parts were not looked at.\n", 5, 0, 0),
    ("--only a --ignore-parts a,b", " 4 of 6 pairs of parts were not looked at.\n", 4, 0, 0),
    ("--ignore list.txt", " As asked, 1 pair of components and 2 pairs of triangles were not looked at.\n", 0, 1, 2),
    ("--ignore list.txt --only a", " As asked, 3 of 6 pairs of parts, 1 pair of components and 2 pairs of ", 3, 1, 2),
    ("--ignore-rest=parts", " As asked, 1 of 6 pairs of parts was not looked at.\n", 1, 0, 0),
])
def test_what_is_left_out_is_said(three_boxes, options, said, parts, components, triangles):
    out = run(f"check left.obj --json left.json {options}").out
    assert said in out and "As asked" in out
    left_out = read_json("left.json")["left_out"]
    assert (left_out["part_pairs"], left_out["of_part_pairs"]) == (parts, 6)
    assert (left_out["component_pairs"], left_out["triangle_pairs"]) == (components, triangles)


def test_clean_but_for_what_is_left_out(three_boxes):
    """And nothing of that where nothing is."""
    assert "Clean: no two triangles cross or touch. As asked, " in run("check --each left.obj --ignore-parts a,b").out
    out = run("replay left.obj left.obj left.obj --ignore-rest").out
    assert out.startswith("No frame crosses or touches (2 checked). As asked, ")
    assert "As asked" not in run("check left.obj").out


# ---- recordings

# What the second box does to the first one.
SECOND = {
    "crosses": ((0.5, 0.5, 0.5), (1.5, 1.5, 1.5)), "overlaps": ((0, 0, 0.75), (1, 1, 1)),
    "inside": ((0.25, 0.25, 0.25), (0.75, 0.75, 0.75)), "same": UNIT, "touches": ((1, 0, 0), (2, 1, 1)),
    "nothing": ((3, 0, 0), (4, 1, 1)),
}


def write_frames(kinds):
    """By the first letters of what the boxes do."""
    names = []
    for k, letter in enumerate(kinds):
        (second,) = (bounds for kind, bounds in SECOND.items() if kind[0] == letter)
        Path(f"{k}.obj").write_text(box(*UNIT, "a", cut=0) + box(*second, "b", cut=0))
        names.append(f"{k}.obj")
    return " ".join(names)


@pytest.mark.parametrize("kinds, line", [
    ("cc", "All 2 frames cross. "),
    ("iii", "All 3 frames have one part inside another. "),
    ("nin", "Frame 1 has one part inside another (1 of 3). "),
    ("oo", "All 2 frames overlap. "),
    ("ont", "Frame 0 overlaps (1 of 3), frame 2 touches (1 of 3). "),
    ("snn", "Frame 0 has two copies of one solid (1 of 3). "),
    ("cin", "Frames 0 to 1 cross or have one part inside another (2 of 3). "),
    ("ons", "Frames 0, 2 overlap or have two copies of one solid (2 of 3). "),
    ("coist", "Frames 0 to 3 cross, overlap, have one part inside another or have two copies of one solid (4 of 5), "
              "frame 4 touches (1 of 5). "),
    ("tnt", "No frame crosses; frames 0, 2 touch (2 of 3). "),
])
def test_recordings_say_what_there_is(kinds, line):
    """No frame is said to cross in which nothing does."""
    assert run(f"check {write_frames(kinds)}").out.startswith(line)


@pytest.mark.parametrize("kinds, worst", [("cnc", 0), ("ini", 0), ("oco", 1), ("tnt", 0), ("ntc", 2)])
def test_check_and_replay_name_the_same_frame(kinds, worst):
    """The way to a frame is no part of it: of two that are equally deep the first is the worst, with contacts or without."""
    frames = write_frames(kinds)
    for command in ("check", "replay"):
        run(f"{command} 0.obj {frames} --json worst.json")
        assert read_json("worst.json")["events"][0]["worst"] == worst


# ---- rounding


def prism(name, triangle, low, high):
    """A triangle of x and y, from one z to another."""
    points = "".join(f"v {x!r} {y!r} {z!r}\n" for z in (low, high) for x, y in triangle)
    sides = "".join(f"f {a - 6} {b - 6} {b - 3} {a - 3}\n" for a, b in ((0, 1), (1, 2), (2, 0)))
    return f"o {name}\n{points}f -4 -5 -6\nf -3 -2 -1\n{sides}"


@pytest.mark.parametrize("scale", [0.125, 1024.0])
@pytest.mark.parametrize("begin, end", [(0.5, 2), (1, 3), (0.5, 3.5), (3.25, 3.5)])  # along x
def test_rounded_distances_are_no_depth(begin, end, scale):
    """The second stands on the slanted side of the first, 3x + 4y = 12, exactly.

    But distances from that plane are rounded: they are some 1e-16, and no depth.
    """
    begin, end = scale * begin, scale * end
    second = [(end, 3 * scale - 0.75 * end), (4 * scale, 5 * scale), (begin, 3 * scale - 0.75 * begin)]
    Path("prisms.obj").write_text(prism("a", [(0.0, 0.0), (4 * scale, 0.0), (0.0, 3 * scale)], 0.0, 7 * scale)
                                  + prism("b", second, scale, 5.375 * scale))
    assert "a x b  touch " in run("check prisms.obj --fail-on crossing").out
