"""STL meshes: binary and text told apart by their content, every form of both, and each error with its place."""
import math
import struct

import pytest

from support.tool.read_back import HALVES, SQUARE, expect_errors, expect_mesh, expect_parts

NAME = "mesh.stl"
CORNERS = [SQUARE[v] for half in HALVES for v in half]
TRIANGLES = [(0, 1, 2), (3, 4, 5)]


def facet(corners):
    vertices = "".join(f"  vertex {x} {y} {z}\n" for x, y, z in corners)
    return f"facet normal 0 0 1\n outer loop\n{vertices} endloop\nendfacet\n"


A, B = facet(CORNERS[:3]), facet(CORNERS[3:])


@pytest.mark.parametrize("content, name", [
    (f"solid square\n{A}{B}endsolid square\n", NAME),
    (f"solid\n{A}{B}endsolid", NAME),
    (f"\ufeffsolid a # b\n\n{A}\n\n{B}endsolid a # b\n\n", NAME),
    (f"  solid square\n{A}{B}endsolid square\n", "mesh.txt"),
    (f"SOLID S\n{A.upper()}{B}ENDSOLID S\n", "a.STL"),
    (f"solid\n{A}{B}endsolid\n".replace("\n", "\r\n").replace("vertex 1 0 0", "vertex 1.0e+00 0 0"), NAME),
    # Several solids, their names of any words, "facet" among them.
    (f"solid left facet\n{A}endsolid left facet\nsolid\n{B}endsolid\n", NAME),
    # A facet in one line, no normal, and one that is no number.
    ("solid s\nfacet outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 endloop endfacet\n"
     "facet normal nan nan nan outer loop vertex 0 0 0\nvertex 1\n1 0 vertex 0 1 0 endloop endfacet endsolid", NAME),
])
def test_reads_text(content, name):
    expect_mesh(content, CORNERS, TRIANGLES, name)


def test_reads_facets_of_four_corners():
    """Which some programs write."""
    expect_mesh(f"solid\n{facet(SQUARE)}endsolid\n", SQUARE, HALVES, NAME)


def test_names_parts():
    """Several solids are parts; one alone is none, since exporters write their own name there."""
    expect_parts(f"solid left  arm \r\n{A}endsolid left  arm\nsolid\n{B}endsolid\nsolid b\n{A}endsolid b\n"
                 f"solid left  arm\n{B}endsolid\n", ["left  arm", None, "b", "left  arm"], NAME)
    expect_parts(f"solid Exported from Blender\n{A}{B}endsolid\n", [None, None], NAME)


def test_refuses_bad_text():
    start = "solid s\nfacet normal 0 0 1\n"
    expect_errors([
        (f"solid s\n{A}", "9: ", "the file ends", "expected facet or endsolid"),
        ("solid s\nendsolid s\n", "no vertices found", "expected a triangle mesh"),
        (f"{start}outer lop\n", "3: ", "found 'lop'", "expected loop"),
        (f"{start}outer loop\nvertex 0 0\nvertex 1 0 0\n", "5: ", "found 'vertex'", "coordinate z"),
        (f"{start}outer loop\nvertex 0 0 zero\n", "4: ", "found 'zero'", "coordinate z"),
        (f"{start}outer loop\nvertex 0 0 inf\n", "4: ", "coordinate z of vertex 0 is inf", "finite"),
        (f"{start}outer loop\nvertex 0 0 1\nvertex 0 0 2\nendloop\nendfacet\nendsolid\n", "no faces found", "a triangle mesh"),
        (f"solid s\n{A}endsolid s\nfacet\n", "10: ", "found 'facet'", "expected solid"),
        (f"solid s\n{A}corner\n", "9: ", "found 'corner'", "expected facet or endsolid"),
        ("soiled\n", "1: ", "found 'soiled'", "expected solid"),
        ("\n\n", "3: ", "the file ends", "expected solid"),
    ], name=NAME)


# ---- binary

def binary(header=b"", count=2, corners=None):
    """Two facets, whose normals are no numbers, behind a header that begins with this text and goes on with blanks."""
    numbers = iter([number for corner in corners or CORNERS for number in corner])
    facets = b"".join(struct.pack("<12f2s", *[math.nan] * 3, *(next(numbers) for _ in range(9)), b"so") for _ in range(2))
    return header.ljust(80) + struct.pack("<I", count) + facets


@pytest.mark.parametrize("header", [
    b"", b"binary", b"solid square", b"solid\nfacet normal", b"COLOR=\xff\1\2\3", b"\xef\xbb\xbf", b"# comment", b"ply",
    b"OFF 4 2"])
def test_reads_binary(header):
    """Whatever text the header has. Bytes may follow, but where that text is of another format."""
    for name in (NAME, "mesh.bin"):
        expect_mesh(binary(header), CORNERS, TRIANGLES, name)
    if header not in (b"ply", b"OFF 4 2"):
        expect_mesh(binary(header) + b"\n", CORNERS, TRIANGLES, NAME)


def test_keeps_floats():
    """Coordinates are the file's floats, none of which is rounded."""
    first = struct.unpack("<3f", struct.pack("<3f", 0.1, 2.0**-149, 1 / 3))
    expect_mesh(binary(corners=[first, *CORNERS[1:]]), [first, *CORNERS[1:]], TRIANGLES, NAME)


def test_refuses_bad_binary():
    expect_errors([row for header in (b"", b"solid square") for row in [
        (binary(header, 3), " byte 184: ", "file ends inside triangle 3 of 3"),
        (binary(header, 1), " byte 134: ", "50 bytes follow the last triangle", "the end of the file"),
        (binary(header, 0)[:84], "no vertices found", "expected a triangle mesh"),
    ]] + [
        (b"   \0" + binary()[4:83], " byte 83: ", "file ends in the header", "84 bytes"),
        (binary(corners=[*CORNERS[:3], (0, math.inf, 0), *CORNERS[4:]]), " byte 146: ", "coordinate y of vertex 3 is inf",
         "finite"),
    ], name=NAME)
