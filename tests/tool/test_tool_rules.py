"""Rules that fail a run hold exactly at their bounds, and answers have the numbers of the files."""
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from support.tool.reading import read_json
from support.tool.recordings import tetrahedra
from support.tool.running import run

# A box, and stones in it whose nearest vertices are 6 from one of its faces.
HEAD = ("v -10 -10 -10\nv 10 -10 -10\nv 10 10 -10\nv -10 10 -10\nv -10 -10 10\nv 10 -10 10\nv 10 10 10\nv -10 10 10\n"
        "o Head\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n")
TWO_STONES = (HEAD + "v 4 0 0\nv 5 -1 -1\nv 5 1 -1\nv 5 0 1\no Left\nf 9 11 10\nf 9 12 11\nf 9 10 12\nf 10 11 12\n"
              "v -4 0 0\nv -5 -1 -1\nv -5 1 -1\nv -5 0 1\no Right\nf 13 14 15\nf 13 15 16\nf 13 16 14\nf 14 16 15\n")
STONE_OF_TWO_PARTS = (HEAD + "v 5 0 0\nv 4 -1 -1\nv 4 1 -1\nv 4 0 1\no Side\nf 9 10 11\nf 9 11 12\nf 9 12 10\n"
                      "o Base\nf 10 12 11\n")


@pytest.fixture(autouse=True)
def files(own_folder):
    flight = tetrahedra(8)
    flight.write_mesh("flight.obj")
    flight.write_cache("flight.pc2")


def failures(path):
    """The frames that a file of JUnit calls failed, and what it says of them."""
    cases = ElementTree.parse(path).iter("testcase")
    return {case.get("name"): case.find("failure").get("message") for case in cases if len(case)}


def test_tables_and_lists_have_the_numbers_of_the_file():
    """Triangles 0 and 1 are one face, through the second of which goes a pin: the face is one part.

    The pin and that triangle are one pair, whichever of them a list names first.
    """
    Path("pinned.obj").write_text("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 3 -1\nv 1.1 3 -1\nv 1 3 1\nf 1 2 3 4\nf 5 6 7\n")
    Path("parts.csv").write_text("face,name\n0,Sheet\n1,Pin\n")
    Path("pairs.txt").write_text("1 2\n2 1\n")
    run("check pinned.obj --quiet --fail-on crossing --parts parts.csv", code=3)
    run("check pinned.obj --quiet --fail-on crossing --parts parts.csv --ignore-parts Sheet,Pin")
    out = run("check pinned.obj --fail-on crossing --ignore pairs.txt").out
    assert " As asked, 1 pair of triangles was not looked at." in out


def test_bounds_are_allowed():
    """As many as are allowed do not fail, and as deep as is allowed does not."""
    run("check flight.obj flight.pc2 --json out.json --quiet")
    faces, depth = (max(frame[key] or 0 for frame in read_json("out.json")["frames"]) for key in ("crossing_faces", "depth"))
    assert faces > 1 and depth > 0
    for code, option in ((0, f"--max-faces {faces}"), (3, f"--max-faces {faces - 1}"),
                         (0, f"--fail-depth {depth * 1.01!r}"), (3, f"--fail-depth {depth * (1 - 1e-12)!r}")):
        for command in ("check", "replay"):
            run(f"{command} flight.obj flight.pc2 --quiet {option}", code=code)


def test_contacts_count_for_the_end_of_their_interval():
    """The contacts of intervals 3 and 5 count for the frames at their ends, and for no other."""
    run("replay flight.obj flight.pc2 --quiet --no-check --fail-on contact --junit out.xml", code=3)
    assert list(failures("out.xml")) == ["frame 4", "frame 6"]
    assert [case.get("name") for case in ElementTree.parse("out.xml").iter("testcase")] == [f"frame {k}" for k in range(8)]


def test_the_share_is_of_crossings():
    """Triangles that only touch do not count for the share of those that cross."""
    Path("share.obj").write_text("v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 -1\nv 2 1 -1\nv 1 1 1\nf 4 5 6\n"
                                 "v 9 0 0\nv 13 0 0\nv 9 4 0\nf 7 8 9\nv 10 1 0\nv 11 1 1\nv 10 2 1\nf 10 11 12\n"
                                 "v 20 0 0\nv 21 0 0\nv 20 1 0\nf 13 14 15\n")
    run("check share.obj --json out.json --quiet")
    frame = read_json("out.json")["frames"][0]
    assert [frame[f"crossing_{what}"] for what in ("pairs", "faces", "share")] == [1, 2, 2 / 5] and frame["touching_pairs"] == 1


def test_places_are_of_the_files():
    """The place of an event is a triangle and a face as the object's own file numbers them, whatever comes before.

    Of the two quads the second, triangles 2 and 3, has a post through it.
    """
    Path("quads.obj").write_text("v 9 0 0\nv 10 0 0\nv 10 1 0\nv 9 1 0\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n"
                                 "f 1 2 3 4\nf 5 6 7 8\n")
    Path("post.obj").write_text("v 0.9 0.8 -1\nv 1.1 0.8 -1\nv 1 1.1 1\nf 1 2 3\n")
    run("check --object Far=flight.obj --object Quads=quads.obj --object Post=post.obj --only Quads,Post --json out.json --quiet")
    (event,) = read_json("out.json")["events"]
    assert event["object"] == "Quads" and event["triangle"] in (2, 3) and event["face"] == 1


@pytest.mark.parametrize("text, left_out, worst", [
    # Two stones in a head, as deep as each other: the one that is left out is not the worst.
    (TWO_STONES, "Left,Head", "worst: Head x Right"),
    (TWO_STONES, "Right,Head", "worst: Head x Left"),
    # The parts share the deepest vertices: these are left out with the one, and the surface of the other reaches them.
    (STONE_OF_TWO_PARTS, "Base,Head", "worst: Head x Side"),
])
def test_depths_are_of_what_is_not_left_out(text, left_out, worst):
    Path("head.obj").write_text(text)
    run(f"check head.obj --quiet --ignore-parts {left_out} --fail-depth 0.01 --json out.json --junit out.xml", code=3)
    assert read_json("out.json")["frames"][0]["depth"] == 6
    (message,) = failures("out.xml").values()
    assert worst in message
