"""The tool leaves out what the user names: parts of objects, of tables, and those that meet at rest."""
from pathlib import Path

import pytest

from support.tool.reading import read_contacts, read_json
from support.tool.recordings import Recording, tetrahedra
from support.tool.running import fails, run, usage_error


@pytest.fixture(autouse=True)
def files(own_folder):
    """The wall; of the dart the tip's three triangles are Dart/Tip, and its base is Dart."""
    both = tetrahedra(8)
    dart = ["o Dart\ng Tip" if 4 in corners else "o Dart" for corners in both.triangles[4:]]
    both.write_mesh("named.obj", records=["o Wall"] * 4 + dart)
    both.write_mesh("plain.obj")
    both.write_cache("both.pc2")


def test_parts_are_left_out():
    def contacts(options):
        run(f"replay named.obj both.pc2 --quiet --contacts out.csv --method none {options}")
        return len(read_contacts("out.csv"))

    everything = contacts("")
    assert everything > 0
    for options in ("--ignore-parts Wall,Dart", "--ignore-parts Dart,Wall", "--ignore-parts Wall", "--only Dart,Dart",
                    "--only Wall --ignore-parts Dart"):
        assert contacts(options) == 0, options
    for options in ("--ignore-parts Wall,Wall", "--ignore-parts Dart/Tip,Dart/Tip --ignore-parts Dart,Dart", "--only Wall,Dart",
                    "--only Dart", "--only Dart,Dart --only Wall,Dart/Tip"):
        assert contacts(options) == everything, options


def test_checks_know_the_same_parts():
    def pairs(options, model="named.obj"):
        run(f"check {model} both.pc2 --quiet --json out.json {options}")
        return sum(len(frame["pairs"]) for frame in read_json("out.json")["frames"])

    everything, tip = pairs(""), pairs("--only Wall,Dart/Tip")
    assert everything > 0 and tip > 0
    assert pairs("--only Wall,Dart") == everything
    assert pairs("--ignore-parts Wall,Dart/Tip") == everything - tip
    assert pairs("--ignore-parts Wall") == 0
    assert pairs("", "plain.obj") > 0 and pairs("--ignore-parts 'component 0,component 1'", "plain.obj") == 0


@pytest.mark.parametrize("table", [
    "triangle,name\n0,Wall\n1,Wall\n2,Wall\n3,Wall\n4,Dart\n5,Dart\n6,Dart\n7,Dart\n",
    "face,name\n# a comment\n0,\"Wall\"\n1,Wall\n2,Wall\n3, Wall\n\n4;Dart\n5\tDart\n6,Dart\n7,Dart\n",
    "vertex,name\r\n0,Wall\r\n1,Wall\r\n2,Wall\r\n3,Wall\r\n4,Dart\r\n5,Dart\r\n6,Dart\r\n7,Dart\r\n",
])
def test_tables_name_parts(table):
    Path("parts.csv").write_bytes(table.encode())
    line = "check plain.obj both.pc2 --quiet --fail-on-contact --parts parts.csv"
    run(f"{line} --ignore-parts Wall,Dart")
    run(f"{line} --only Wall,Dart", code=3)


@pytest.mark.parametrize("faces, table, parts", [
    ("f 1 2 3 4\nf 5 6 7 8", "face,name\n0,A\n1,B\n", "A,B"),
    ("f 1 2 3\nf 5 6 7", "vertex,name\n0,A\n1,B\n2,B\n4,C\n5,D\n6,E\n", "B,C"),
])
def test_tables_of_faces_and_vertices_name_triangles(faces, table, parts):
    """Both triangles of a quadrilateral; and the part of most corners, or of the first. What crosses is 0 1 2 3 and 4 5 6 7."""
    corners = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (3, 2.5, -1), (1, 2.5, -1), (1, 0.5, 1), (3, 0.5, 1)]
    Path("crossing.obj").write_text("".join("v {} {} {}\n".format(*x) for x in corners) + faces + "\n", encoding="utf-8")
    Path("parts.csv").write_text(table, encoding="utf-8")
    line = "check crossing.obj --quiet --fail-on-contact --parts parts.csv"
    run(f"{line} --ignore-parts {parts}")
    run(f"{line} --only {parts}", code=3)


@pytest.mark.parametrize("table, reason", [
    (b"", "the file is empty"),
    (b"polygon,name\n", ":1: expected 'triangle,name'"),
    (b"\xef\xbb\xbftriangle,name\n# none\n", ": no part is named below the first line"),
    (b"triangle,name\n0,A\n8,A\n", ":3: expected a number of the model file"),
    (b"vertex,name\nx,A\n", ":2: expected a number"),
    (b"vertex,name\n3\n", ":2: expected a number"),
])
def test_bad_tables_are_told(table, reason):
    Path("bad.csv").write_bytes(table)
    fails("check plain.obj --parts bad.csv", "bad.csv", reason)


def test_bad_names_are_told():
    fails("check named.obj --ignore-parts Wall,Hat", "--ignore-parts: there is no part 'Hat'",
          "the parts are Wall, Dart, Dart/Tip")
    fails("check named.obj --only Dar", "--only: there is no part 'Dar'")
    usage_error("check named.obj --only ''", "--only cannot be ''")
    usage_error("check named.obj --ignore-rest=pairs", "--ignore-rest cannot be 'pairs'")


def test_parts_that_meet_at_rest_are_left_out():
    """The frames from the fourth on: the dart has stuck in the wall since before, and moves on with other triangles."""
    both = tetrahedra(8)
    Recording(both.triangles, both.frames[4:7]).write_cache("later.pc2")
    run("replay named.obj later.pc2 --quiet --contacts some.csv --ignore-rest")
    run("replay named.obj later.pc2 --quiet --contacts none.csv --ignore-rest=parts --only Wall,Dart")
    assert len(read_contacts("none.csv")) < len(read_contacts("some.csv"))  # of triangles that did not meet at rest
    out = run("replay plain.obj later.pc2 --ignore-rest=parts").out
    assert "are left out, with all pairs of parts that they are in" in out and "contacts: 0 VF and 0 EE" in out


@pytest.mark.parametrize("eye", [
    "v 1 1 0.8\nv 0.7 0.7 -0.5\nv 1.6 0.8 -0.5\nv 0.8 1.6 -0.5\n",  # with its tip in the head
    "v 0.9 0.9 -1\nv 0.7 0.8 0.5\nv 0.8 1.6 0.5\nv 1.6 0.7 0.5\n",  # with all but its tip
])
def test_nothing_is_inside_of_what_is_left_out(eye):
    """Where the curve between two objects is left out, the library may find all of one inside of the other."""
    Path("eye.obj").write_text("v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\no Head\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
                               f"{eye}o Eye\nf 6 8 7\nf 6 7 5\nf 7 8 5\nf 8 6 5\n")
    Path("list.txt").write_text("components 0 1\n")
    assert "Head x Eye  cross" in run("check eye.obj").out
    for options in ("--ignore-rest=parts", "--ignore-rest", "--ignore-parts Eye", "--ignore-parts Head,Eye", "--only Eye,Eye",
                    "--ignore list.txt"):
        answer = run(f"check eye.obj --fail-depth 0.01 {options}")
        assert answer.out.startswith("Clean: no two triangles cross or touch. As asked, "), options


def test_too_many_parts_are_told():
    """Tables of pairs of parts have a limit, of which every option that needs one speaks."""
    def write_row(count):
        """So many triangles in a row, each a part of its own. The first two cross, and all others are apart."""
        row = "".join(f"v {x} 0 0\nv {x + 4} 0 0\nv {x} 4 0\no P{x // 9 + 1}\nf -3 -2 -1\n" for x in range(0, 9 * (count - 1), 9))
        Path("row.obj").write_text(f"v 1 1 -1\nv 2 1 -1\nv 1 1 1\no P0\nf 1 2 3\n{row}")

    write_row(8193)
    limit = "at most 8192 parts, and there are 8193"
    fails("check row.obj --ignore-rest=parts", "--ignore-rest=parts takes", limit)
    fails("check row.obj --only P0", "--ignore-parts and --only take", limit)
    write_row(8192)
    run("check row.obj --ignore-rest=parts --fail-on crossing")


def test_objects_are_not_named_twice():
    Path("Head.obj").write_text("v 0 0 0\nv 4 0 0\nv 0 4 0\no Head\nf 1 2 3\n")
    Path("nose.obj").write_text("v 1 1 -1\nv 1 1 1\nv 2 1 0\no Nose\nf 1 2 3\n")
    assert "\nHead x Face/Nose  cross" in run("check Head.obj --object Face=nose.obj").out
