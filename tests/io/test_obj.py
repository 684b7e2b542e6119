"""OBJ meshes: every form of record and index, and each error with its line."""
import pytest

from support.tool.read_back import errors_of, expect_errors, expect_mesh, expect_parts, expect_squares, frames_read, info_of

NAME = "mesh.obj"
V = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def test_reads_all_index_forms():
    expect_squares([V + faces for faces in [
        "f 1 2 3\nf 1 3 4\n",
        "vt 0 0\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\n",
        "vn 0 0 1\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n",
        "f 1/1/1 2/2/2 3/3/3\nf 1/1/1 3/3/3 4/4/4\n",
        "f -4 -3 -2\nf -4/-4/-4 -2//-2 -1/-1\n",
        "f 1/ 2// 3\nf 1 +3 4\n",
        "f 1 2 3 4\n",
    ]] + ["f 1 2 3\nf 1 3 4\n" + V], NAME)


def test_reads_polygons_as_fans():
    points = [(0, 0, 0), (2, 0, 0), (3, 1, 0), (2, 2, 0), (0, 2, 0)]
    expect_mesh("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 5 1 2 3 4\n", points, [(4, 0, 1), (4, 1, 2), (4, 2, 3)], NAME)


def test_reads_negative_indices_from_where_the_face_is():
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (5, 0, 0), (6, 0, 0), (5, 1, 0)]
    expect_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n", points,
                [(0, 1, 2), (3, 4, 5)], NAME)


def test_reads_layouts():
    """A comment that ends in a backslash does not go on; another record does."""
    expect_squares([
        "# a square\r\n\r\nv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n",
        "v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4",
        f"\ufeff{V}f 1 2 3 4",
        "\t v\t0  0 0 \n v 1 0 0 # one\n v 1 1 0 # two\nv 0 1 0\nf 1 2 3 4 # five\n",
        "v 0 0 \\\n0\nv \\\r\n1 0 0\nv 1 1 0\nv 0 1\\\n 0\nf 1 2 \\\n  3 \\\n4\n",
        "# in C:\\meshes\\\nv 0 0 0\nvn 1 2 \\\nv 9 9 9\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n",
        "mtllib a.mtl\no square\nv 0 0 0 1\nv 1 0 0 0.5\nv 1 1 0 0.2 0.3 0.4\nv 0 1 0 1 1 1\nvp 1 2\nvt 1\nvn 0 0 1\ng all\n"
        "usemtl red\ns off\nl 1 2\np 1\nf 1 2 3 4\nfoo\n",
    ], NAME)


def test_refuses_bad_vertices():
    expect_errors([
        ("v 0 0 0\nv 1 0\nv 0 1 0\n", "2: ", "the line ends", "coordinate z of the vertex"),
        ("v 0 0 0\n\n# c\nv", "4: ", "the file ends", "coordinate x of the vertex"),
        ("v 0 0,5 0\n", "1: ", "found '0,5'", "coordinate y"),
        ("v 0 0 0x10\n", "1: ", "found '0x10'", "coordinate z"),
        ("v 0 1e 0\n", "1: ", "found '1e'", "coordinate y"),
        ("v 0 1\0002 0\n", "1: ", "found '1?2'", "coordinate y"),
        ("v 0 0 0\r\nv 0 nan 0\r\n", "2: ", "coordinate y of vertex 2 is nan", "finite"),
        ("v 0 0 -inf\n", "1: ", "coordinate z of vertex 1 is -inf", "finite"),
        ("v 1e309 0 0\n", "1: ", "coordinate x of vertex 1 is inf", "finite"),
        ("v 0 \\\n 0 \\\n q\n", "3: ", "found 'q'", "coordinate z"),
        ("v 0 0 0123456789012345678901234567890123456789012345678901234567890123456789x\n", "1: ",
         "found '01234567890123456789012345678901234567890123...'", "coordinate z"),
    ], name=NAME)


def test_refuses_bad_faces():
    expect_errors([(V + faces, *says) for faces, *says in [
        *((faces, " no faces found", "expected a triangle mesh")
          for faces in ("f 1 2\n", "f 1\n", "f", "f 1 2 1 3\n", "f 1 2 2\n")),
        *((f"f 1 2 {corner}\n", "5: ", f"found '{corner}'", "v/vt/vn") for corner in ("x", "3/4/5/6", "3.5", "/3", "-")),
        ("f 1 2 0\n", "5: ", "face index 0 is out of range", "the first vertex is 1"),
        ("f 1 2 3\nf 1 2 5\nf 1 2 3\n", "6: ", "face index 5 is out of range", "the file has 4 vertices"),
        ("f 1 2 -5\nv 0 0 0\n", "5: ", "face index -5 is out of range", "the file has 4 vertices before it"),
        ("f 1 2 2147483648\n", "5: ", "face index 2147483648 is out of range", "at most 2147483647 vertices"),
        ("f 1 2 99999999999999999999\n", "5: ", "found '99999999999999999999'", "face corner"),
    ]] + [("f 1 2 7\n" + V, "1: ", "face index 7 is out of range", "the file has 4 vertices")], name=NAME)


def test_refuses_incomplete_meshes():
    expect_errors([
        ("# nothing\n", "no vertices", "expected a triangle mesh"),
        ("f 1 2 3\n", "no vertices", "expected a triangle mesh"),
        (V, "no faces found for the 4 vertices", "expected a triangle mesh"),
        (b"\x01\x02\xff\xfe garbage \0\0\0", "no vertices", "expected a triangle mesh"),
    ], name=NAME)


@pytest.mark.parametrize("faces, triangles, polygons, repairs", [
    ("f 1 2 3 3\nf 1 2 2\nf 3 -2 4\nf 1 2 3 3 4 4 1 1\n", [(0, 1, 2), (0, 1, 2), (0, 2, 3)], [0, 3, 3],
     {"shortened": (2, 0), "dropped": (2, 1), "fanned": (0, None)}),
    # Fewer than three corners, and three that leave no triangle, since the way goes to the third and back.
    ("f\nf 1 2\nf 1 2 3 4\nf 1 2 1 3\n", [(0, 1, 2), (0, 2, 3)], [2, 2], {"shortened": (0, None), "dropped": (3, 0)}),
])
def test_repairs_faces(faces, triangles, polygons, repairs):
    """Faces that name a vertex twice are shortened, and dropped when they have two corners left; others keep their numbers."""
    (mesh,) = frames_read(V + faces, NAME)
    assert mesh.triangles == triangles and mesh.faces("polygon") == polygons
    own = info_of(V + faces, NAME)
    assert own["file_faces"] == 4 and {kind: tuple(own["repairs"][kind].values()) for kind in repairs} == repairs


# ---- parts

F = "f 1 2 3\n"


def test_finds_many_names_again():
    """Each of many names is one part, wherever it comes again."""
    numbers = [*range(3000), *reversed(range(3000))]
    points = "".join(f"v {i} 0 0\nv {i} 1 0\nv {i} 0 1\n" for i in range(3000))
    text = "".join(f"o n{i}\nf {3 * i + 1} {3 * i + 2} {3 * i + 3}\n" for i in numbers)
    expect_parts(points + text, [f"n{i}" for i in numbers], NAME)


@pytest.mark.parametrize("text, names", [
    (F, [None]),
    (f"g default\n{F}g off\n{F}", [None, None]),
    (f"{F}o Body\nf 1 2 3 4\no Hat\n{F}o Body\nf 1 3 4\n", [None, "Body", "Body", "Hat", "Body"]),
    (f"g Arm.L deform\n{F}g\n{F}", ["Arm.L deform", None]),
    (f"o Body\ng Arm\n{F}g (null)\n{F}o Hat\n{F}", ["Body/Arm", "Body", "Hat"]),
    (f"o Empty\ng None\no Body\n{F}o End\n", ["Body"]),
    # Names keep blanks and hashes.
    (f"o  Left Arm \t\n{F}o Part#1\r\n{F}g Sleeve # 2 of 3\n{F}g # 4\n{F}o a\\\nb\n{F}o\n{F}",
     ["Left Arm", "Part#1", "Part#1/Sleeve # 2 of 3", "Part#1/# 4", "a", None]),
])
def test_names_parts(text, names):
    expect_parts(V + text, names, NAME)


MIXED = (f"{F}usemtl  Brushed Steel #2 \n{F}o Body\n{F}g Arm L\n{F}usemtl default\nf 1 2 3 4\no Hat\nusemtl Unused\n"
         f"usemtl Brushed Steel #2\n{F}usemtl (null)\ng Arm L\n{F}")


@pytest.mark.parametrize("parts_by, names", [
    ("object", [None, None, "Body", "Body", "Body", "Body", "Hat", "Hat"]),
    ("group", [None, None, None, "Arm L", "Arm L", "Arm L", None, "Arm L"]),
    ("material", [None, *["Brushed Steel #2"] * 3, "default", "default", "Brushed Steel #2", None]),
    (None, [None, None, "Body", *["Body/Arm L"] * 3, "Hat", "Hat/Arm L"]),
])
def test_names_parts_by_what_is_asked_for(parts_by, names):
    """Objects, groups and materials that begin and end at different faces."""
    expect_parts(V + MIXED, names, NAME, parts_by)


def test_has_no_parts_of_another_kind():
    expect_parts(f"{V}usemtl Stone\n{F}", ["Stone"], NAME, "material")
    for text, parts_by in ((f"g A\n{F}", "object"), (f"o A\n{F}", "group"), (f"o A\n{F}usemtl Late\n", "material"),
                           (f"usemtl (null)\n{F}", "material")):
        (error,) = errors_of([V + text], name=NAME, options={"parts-by": parts_by})
        assert f"--parts-by {parts_by} finds no parts" in error
