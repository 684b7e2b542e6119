"""OFF meshes: every form of header and row, and each error with its line."""
from support.tool.read_back import expect_errors, expect_mesh, expect_squares

NAME = "mesh.off"
V, F = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n", "3 0 1 2\n3 0 2 3\n"
WHOLE = "4 0 1 2 3\n"


def test_reads_headers():
    expect_squares([header + V + F for header in (
        "OFF\n4 2 5\n", "OFF 4 2 5\n", "OFF4 2 5\n", "OFF\n4 2\n", "4 2 0\n", "# first\n\n OFF # here\n# and\n\n4 2 0 # there\n",
        "NCOFF\n4\n2\n5\n", "off\n4\n2\n", "OFF\n4 2\n# edges\n0\n\n",  # over several lines
    )] + ["\ufeffOFF\r\n4 1 0\r\n0 0 0\r\n1 0 0\r\n1 1 0\r\n0 1 0\r\n4 0 1 2 3 # end\r\n",
          "OFF\r4 2 0\r0 0 0\r1 0 0\r1 1 0\r0 1 0\r3 0 1 2\r3 0 2 3\r"], NAME)
    for name in ("mesh.txt", "mesh.obj"):
        expect_squares([f"OFF\n4 2 5\n{V}{F}"], name)


def test_reads_extra_vertex_data():
    expect_squares([
        f"COFF\n4 1 0\n0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n1 1 0 0 0 0 0\n0 1 0 1 1 1 1\n{WHOLE}",
        f"CNOFF\n4 1 0\n0 0 0 0 0 1 1 0 0 1\n1 0 0 0 0 1 1 0 0 1\n1 1 0 0 0 1 1 0 0 1\n0 1 0 0 0 1 1 0 0 1\n{WHOLE}",
        f"NOFF\n4 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n{WHOLE}",
        f"STOFF\n4 1 0\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n{WHOLE}",
        f"STCNOFF 4 1 0\n{V}{WHOLE}",
    ], NAME)


def test_reads_other_dimensions():
    """Vertices of four coordinates are divided by the last one; n is followed by the number of dimensions."""
    expect_squares([
        f"4OFF\n4 1 0\n0 0 0 1\n2 0 0 2\n-.5 -.5 -0 -.5\n0 1 0 1\n{WHOLE}",
        f"C4OFF\n4 1 0\n0 0 0 1 255 0 0\n1 0 0 1 255 0 0\n1 1 0 1 0 0 0\n0 1 0 1\n{WHOLE}",
        f"nOFF 3\n4 2 0\n{V}{F}", f"nOFF\n3\n4 2 0\n{V}{F}",
        f"4nOFF\n3\n4 1 0\n0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\n{WHOLE}",
    ], NAME)


def test_reads_rows():
    expect_squares([
        f"OFF\n4 2 0\n\n# vertices\n{V}\n# faces\n3 0 1 2 255 0 0\n3 0 2 3 0.5 .5 1 1\n\n#\n",
        f"OFF\n4 1 0\n{V}4 0 1 2 3",
        f"OFF\n4 1 0\n{V}4\n0\n1\n2\n3",
        f"OFF\r\n4 2 0\r\n{V}3 0 1 # one more\r\n\r\n 2 255 0 0\r\n3 0 2\r\n3 0.5 0.5 1\r\n",
    ], NAME)
    expect_mesh("OFF\n5 2 0\n.1 -1e-5 3\n9 2 3\n4 5 3\n-3 8 3\n0 0 -0\n5 4 0 1 2 3\n3 0 1 2\n",
                [(0.1, -1e-5, 3), (9, 2, 3), (4, 5, 3), (-3, 8, 3), (0, 0, 0)],
                [(4, 0, 1), (4, 1, 2), (4, 2, 3), (0, 1, 2)], NAME)


def test_refuses_bad_headers():
    expect_errors([
        ("OFF", "1: ", "the file ends", "the number of vertices"),
        ("# only this\n", "2: ", "the file ends", "the number of vertices"),
        ("OFF\n4\n", "3: ", "the file ends", "the number of faces"),
        ("OFF\nfour 2 0\n", "2: ", "found 'four'", "the number of vertices"),
        ("OFF\n4 2 x\n", "2: ", "found 'x'", "the number of edges"),
        ("OFF\n4 2 0 0\n", "2: ", "found '0'", "the end of the line"),
        ("OFF\n-4 2 0\n", "2: ", "the number of vertices is -4", "expected 0 to 2147483647"),
        ("OFF\n4 2147483648 0\n", "2: ", "the number of faces is 2147483648", "0 to 2147483647"),
        ("nOFF\n4\n4 2 0\n", "2: ", "vertices of 4 dimensions", "expected 3"),
        ("nOFF\n", "2: ", "the file ends", "the number of dimensions"),
        ("4OFF\n4 2 0\n0 0 0\n", "3: ", "the line ends", "the fourth coordinate"),
        ("4OFF\n4 2 0\n1 0 0 0\n", "3: ", "coordinate x of vertex 0 is inf", "finite"),
        ("xOFF\n", "1: ", "found 'xOFF'", "the number of vertices"),
        ("OFF BINARY\n\0\0\0\4", "1: ", "binary OFF", "expected text"),
        ("OFFSET 1\n", "1: ", "found 'OFFSET'", "the number of vertices"),
        (b"\x01\x02\xff\xfe\0\0\0", "1: ", "found '????", "the number of vertices"),
    ], name=NAME)


def test_refuses_bad_rows():
    expect_errors([
        (f"OFF\n4 2 0\n0 0 0\n1 0\n1 1 0\n0 1 0\n{F}", "4: ", "the line ends", "coordinate z"),
        ("OFF\n4 2 0\n0 0 0\n1 zero 0\n", "4: ", "found 'zero'", "coordinate y"),
        ("OFF\n4 2 0\n0 0 0\n1 0 NaN\n", "4: ", "coordinate z of vertex 1 is nan", "finite"),
        ("OFF\n4 2 0\n-1e400 0 0\n", "3: ", "coordinate x of vertex 0 is -inf", "finite"),
        (f"OFF\n4 1 0\n{V}2 0 1\n", "no faces found", "expected a triangle mesh"),
        (f"OFF\n4 1 0\n{V}-3 0 1 2\n", "7: ", "a face of -3 corners", "3 or more"),
        (f"OFF\n4 1 0\n{V}4 0 1 2\n", "8: ", "the file ends", "a vertex index"),
        (f"OFF\n4 2 0\n{V}4 0 1 2\n3 0 2 3\n", "9: ", "file ends before face 2 of 2"),
        (f"OFF\n4 1 0\n{V}3 0 1.5 2\n", "7: ", "found '1.5'", "a vertex index"),
        (f"OFF\n4 1 0\n{V}3 0 1 4\n", "7: ", "face index 4 is out of range", "the file has 4 vertices"),
        (f"OFF\n4 1 0\n{V}3 0 1 -1\n", "7: ", "face index -1 is out of range", "the file has 4 vertices"),
    ], name=NAME)


def test_refuses_counts_that_do_not_fit():
    expect_errors([
        (f"OFF\n4 3 0\n{V}{F}", "9: ", "file ends before face 3 of 3"),
        (f"OFF\n4 2000000000 0\n{V}{F}", "9: ", "file ends before face 3 of 2000000000"),
        (f"OFF\n2000000000 2 0\n{V}", "7: ", "file ends before vertex 5 of 2000000000"),
        (f"OFF\n4 1 0\n{V}{F}", "8: ", "found '3' after the last face", "the end of the file"),
        (f"OFF\n4 1 0\n{V}2000000000 0 1 2\n", "8: ", "the file ends", "a vertex index"),
        ("OFF\n0 0 0\n", "no vertices", "expected a triangle mesh"),
        (f"OFF\n4 0 0\n{V}", "no faces found for the 4 vertices", "expected a triangle"),
    ], name=NAME)
