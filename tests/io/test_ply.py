"""PLY meshes in text and binary: headers, every type in both byte orders, and each error with its line or byte."""
import math
import struct

import pytest

from support.tool.read_back import SQUARE, expect_errors, expect_mesh, expect_parts, expect_squares

NAME = "mesh.ply"
START, END = "ply\nformat ascii 1.0\n", "end_header\n"
XYZ = "property float x\nproperty float y\nproperty float z\n"
CORNERS = "property list uchar int vertex_indices\n"
SQUARE_LINES = f"element vertex 4\n{XYZ}element face 2\n{CORNERS}"
HEADER = f"{START}{SQUARE_LINES}{END}"  # lines 1 to 9
V, F = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n", "3 0 1 2\n3 0 2 3\n"


# ---- text

def test_reads_text():
    one_face = f"{START}element vertex 4\n{XYZ}element face 1\n{CORNERS}{END}{V}4 0 1 2 3"
    expect_squares([HEADER + V + F, f"{HEADER}\n{V}\n\n3 0 1 2\n 3\t0  2 3 \n\n", one_face,
                    *(one_face.replace("\n", end).replace("indices", "index") for end in ("\r\n", "\r"))], NAME)
    for name in ("mesh.obj", "mesh"):
        expect_squares([HEADER + V + F], name)


def test_reads_all_type_names():
    types = "char int8 uchar uint8 short int16 ushort uint16 int int32 uint uint32 float float32 double".split()
    header = (f"{START}comment all types\nobj_info of PLY\nelement vertex 4\n"
              + "".join(f"property {kind} {name}\n" for kind, name in zip(types, "abcdefghijklmno"))
              + "property float64 x\nproperty double y\ncomment z is an integer\nproperty int8 z\nelement face 1\n"
              "property list uint32 double vertex_index\n" + END)
    rows = "".join(f"1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 {row}\n" for row in V.splitlines())
    expect_squares([f"{header}{rows}4 0 1 2 3\n"], NAME)


def test_skips_what_is_not_the_mesh():
    expect_squares([
        f"{START}element camera 2\nproperty list uchar float m\nproperty double far\nelement nothing 1000000000000\n"
        f"element face 2\nproperty uchar red\n{CORNERS}property list int float uv\n"
        "element edge 1\nproperty int vertex1\nproperty list char int vertex_indices\n"
        "element vertex 4\nproperty float quality\nproperty float z\nproperty list uchar int ring\n"
        f"property double y\nproperty float x\nproperty uchar red\nelement material 1\nproperty int kind\n{END}"
        "3 1 2 nan 1e9\n0 7\n255 3 0 1 2 2 0.5 0.5\n0 3 0 2 3 0\n9 2 8 7\n"
        "1 0 2 5 6 0 0 9\n1 0 0 0 1 9\nx 0 1 4 1 1 9\n1 0 0 1 0 9\n4\n"], NAME)


def test_refuses_bad_headers():
    expect_errors([
        ("plywood\n", "1: ", "found 'plywood'", "expected ply"),
        ("\nply\n", "1: ", "the line ends", "expected ply"),
        (b"\xff\xfe\0\1garbage", "1: ", "found '????garbage'", "expected ply"),
        ("ply ply\n", "1: ", "found 'ply'", "end of the line"),
        ("ply\n", "2: ", "file ends inside the header", "end_header"),
        ("ply\nfromat ascii 1.0\n", "2: ", "found 'fromat'", "format, comment"),
        ("ply\nformat binary 1.0\n", "2: ", "found 'binary'", "ascii, binary_little_endian"),
        ("ply\nformat\n", "2: ", "the line ends", "ascii, binary_little_endian"),
        ("ply\nformat ascii 2.0\n", "2: ", "found '2.0'", "version 1.0"),
        ("ply\nend_header\n", "2: ", "the header ends", "a format line"),
        *((START + lines, *says) for lines, *says in [
            ("format ascii 1.0\n", "3: ", "a second format", "expected one"),
            ("element\n", "3: ", "the line ends", "an element name"),
            ("element vertex\n", "3: ", "the line ends", "the number of elements"),
            ("element vertex many\n", "3: ", "found 'many'", "the number of elements"),
            ("element vertex 4 4\n", "3: ", "found '4'", "end of the line"),
            ("element vertex 1\nelement vertex 1\n", "4: ", "a second element 'vertex'", "one"),
            (END, "3: ", "the header ends", "an element 'vertex'"),
            (f"element vertex 4\n{XYZ}{END}", "7: ", "the header ends", "an element 'face'"),
            ("property float x\n", "3: ", "a property before any element"),
            ("element a 1\nproperty real x\n", "4: ", "found 'real'", "a type: char"),
            ("element a 1\nproperty list float int x\n", "4: ", "found 'float'", "an integer type for the length"),
            ("element a 1\nproperty list uchar\n", "4: ", "the line ends", "a type: char"),
            ("element a 1\nproperty int\n", "4: ", "the line ends", "a property name"),
            ("element vertex 1\nproperty list uchar float x\n", "4: ", "property 'x' is a list", "expected one number"),
            ("element face 1\nproperty int vertex_indices\n", "4: ", "property 'vertex_indices' is no list", "expected a list"),
            (f"element vertex 1\n{XYZ}property double y\n", "7: ", "a second property 'y'", "expected one"),
            (f"element vertex 1\nproperty float x\nproperty float z\n{END}", "6: ", "element 'vertex' lacks", "property 'y'"),
            (f"element vertex 1\n{XYZ}element face 1\n{END}", "8: ", "element 'face' lacks", "property 'vertex_indices'"),
            ("element vertex -4\n", "3: ", "-4 elements 'vertex'", "0 to 2147483647"),
            ("element face 2147483648\n", "3: ", "2147483648 elements 'face'", "2147483647"),
            ("element edge 9999999999999999999\n", "3: ", "found '9999999999999999999'", "the number of elements"),
        ]),
    ], name=NAME)


def test_refuses_bad_rows():
    expect_errors([(HEADER + rows, *says) for rows, *says in [
        ("0 0 0\n1 0\n1 1 0\n", "11: ", "the line ends inside vertex 2 of 4", "expected its property 'z'"),
        ("0 0 0 0\n", "10: ", "found '0'", "the end of the line"),
        ("0 0 0\n1 o 0\n", "11: ", "found 'o'", "a number for property 'y'"),
        ("0 0 0\n1 0 nan\n", "11: ", "coordinate z of vertex 1 is nan", "finite"),
        ("1e999 0 0\n", "10: ", "coordinate x of vertex 0 is inf", "finite"),
        (f"{V}3 0 1\n", "14: ", "the line ends inside face 1 of 2", "property 'vertex_indices'"),
        (f"{V}3 0 1 2.5\n", "14: ", "found '2.5'", "an integer"),
        (f"{V}2 0 1\n1 0\n", "no faces found", "expected a triangle mesh"),
        (f"{V}0\n0\n", "no faces found", "expected a triangle mesh"),
        (f"{V}-1\n", "14: ", "'vertex_indices' has -1 entries", "0 or more"),
        (f"{V}3 0 1 4\n", "14: ", "face index 4 is out of range", "the file has 4 vertices"),
        (f"{V}3 0 1 -1\n", "14: ", "face index -1 is out of range", "the file has 4 vertices"),
        (f"{V}{F}3 0 1 2\n", "16: ", "found '3' after the last element", "the end of the file"),
        ("0 0 0\n1 0 0\n", "12: ", "file ends inside vertex 3 of 4"),
        ("0 0 0\n1 0", "11: ", "file ends inside vertex 2 of 4"),
        (f"{V}3 0 1 2\n", "15: ", "file ends inside face 2 of 2"),
    ]] + [
        (f"{START}element vertex 4\n{XYZ}element face 1\nproperty list int float vertex_index\n{END}{V}3 0 1 1.5\n",
         "14: ", "face index 1.5", "expected an integer"),
        (f"{START}element vertex 2000000000\n{XYZ}element face 2\n{CORNERS}{END}{V}", "14: ",
         "file ends inside vertex 5 of 2000000000"),
        (f"{START}element vertex 0\n{XYZ}element face 0\n{CORNERS}{END}", "no vertices", "expected a triangle mesh"),
        (f"{START}element vertex 4\n{XYZ}element face 0\n{CORNERS}{END}{V}", "no faces found for the 4 vertices",
         "expected a triangle mesh"),
    ], name=NAME)


def labelled(before, behind, faces):
    return f"{START}element vertex 4\n{XYZ}element face 4\n{before}{CORNERS}{behind}{END}{V}{faces}"


@pytest.mark.parametrize("before, behind, faces, named", [
    ("property uchar label\n", "", "3 3 0 1 2\n-7 4 0 1 2 3\n-7 3 0 1 2\n3 3 0 2 3\n", True),
    ("", "property int part\n", "3 0 1 2 3\n4 0 1 2 3 -7\n3 0 1 2 -7\n3 0 2 3 3\n", True),
    ("property int part\n", "property int label\n", "3 3 0 1 2 3\n-7 4 0 1 2 3 9\n-7 3 0 1 2 9\n3 3 0 2 3 9\n", True),
    ("property float label\n", "", "3 3 0 1 2\n1 4 0 1 2 3\n1 3 0 1 2\n3 3 0 2 3\n", False),
    ("property list uchar int part\n", "", "0 3 0 1 2\n0 4 0 1 2 3\n0 3 0 1 2\n0 3 0 2 3\n", False),
])
def test_names_parts(before, behind, faces, named):
    """A face's integer part or label, before its corners or behind them, names its part."""
    expect_parts(labelled(before, behind, faces), ["3", "-7", "-7", "-7", "3"] if named else [None] * 5, NAME)


def test_refuses_properties_of_faces_that_are_no_numbers():
    """Which faces have which stiffness is in tests/io/test_mesh_damage.c."""
    expect_errors([(labelled("", "property int part\n", "3 0 1 2 x\n"), "15: ", "found 'x'", "an integer"),
                   (labelled("", "property float stiffness\n", "3 0 1 2 x\n"), "15: ", "found 'x'", "a number")], name=NAME)


# ---- binary

def binary(order, lines, *data):
    """data: (format of struct without its order, numbers)."""
    packed = b"".join(struct.pack(("<" if order == "little" else ">") + form, *numbers) for form, *numbers in data)
    return f"ply\nformat binary_{order}_endian 1.0\n{lines}{END}".encode() + packed


POINTS = ("12f", *[number for point in SQUARE for number in point])
FACES = ("B3iB3i", 3, 0, 1, 2, 3, 0, 2, 3)


@pytest.mark.parametrize("order", ["little", "big"])
def test_reads_both_byte_orders(order):
    content = binary(order, SQUARE_LINES, POINTS, FACES)
    expect_squares([content, content + b"\0\n"], NAME)  # padding


@pytest.mark.parametrize("order", ["little", "big"])
@pytest.mark.parametrize("kind, form", [
    ("char", "b"), ("uint8", "B"), ("short", "h"), ("ushort", "H"), ("int", "i"), ("uint32", "I"), ("float", "f"),
    ("double", "d")])
def test_reads_all_types(order, kind, form):
    """Of indices, and floats, doubles, bytes, shorts and integers as coordinates."""
    for lines, coordinates, numbers in [
        ("float x\nproperty double y\nproperty char z", "fdb",
         [0.10000000149011612, 0.1, -128, 255, -1.0 / 3, 127, 1, 65535, -1]),
        ("short x\nproperty ushort y\nproperty uint z", "hHI", [-32768, 65535, 4294967295, 32767, 1, 2147483648, -1, 0, 3]),
    ]:
        header = f"element vertex 3\nproperty {lines}\nelement face 1\nproperty list int {kind} vertex_index\n"
        content = binary(order, header, (3 * coordinates, *numbers), ("i", 3), (f"3{form}", 2, 1, 0))
        expect_mesh(content, zip(*[iter(numbers)] * 3), [(2, 1, 0)], NAME)


@pytest.mark.parametrize("order", ["little", "big"])
def test_skips_what_is_not_the_binary_mesh(order):
    lines = ("element a 2\nproperty list short double l\nproperty short s\nelement b 99999999999\n"
             f"element face 1\nproperty double n\n{CORNERS}property list uchar char uv\nelement c 3\nproperty uchar v\n"
             f"element vertex 4\nproperty list int int ring\n{XYZ}property uchar red\n"
             "element d 1\nproperty list ushort float last\n")
    expect_squares([binary(order, lines, ("h2dhhh", 2, math.nan, 1, 7, 0, 8), ("dB4iB2b", math.inf, 4, 0, 1, 2, 3, 2, 9, 9),
                           ("3B", 1, 2, 3), ("3i3fB", 2, 5, 6, 0, 0, 0, 255), ("i3fB", 0, 1, 0, 0, 255),
                           ("i3fB", 0, 1, 1, 0, 255), ("2i3fB", 1, 9, 0, 1, 0, 255), ("H3f", 3, 1, 2, 3))], NAME)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_finds_the_first_byte_of_the_data(end):
    """Data may begin with bytes that look like line ends."""
    lines = ("element vertex 3\nproperty char x\nproperty char y\nproperty char z\n"
             "element face 1\nproperty list char char vertex_index\n")
    content = binary("little", lines).replace(b"\n", end.encode()) + bytes([10, 0, 0, 13, 0, 0, 0, 1, 0, 3, 0, 1, 2])
    expect_mesh(content, [(10, 0, 0), (13, 0, 0), (0, 1, 0)], [(0, 1, 2)], NAME)


def test_refuses_bad_binary():
    """Each error names a byte, from the first one of the data on."""
    floats = SQUARE_LINES.replace("uchar int", "char float")
    longest = SQUARE_LINES.replace("face 2", "face 1").replace("uchar int", "uint uint")
    table = [
        ("little", SQUARE_LINES, [("6f", 0, 0, 0, 1, math.nan, 0)], 12, "coordinate y of vertex 1 is nan", "finite"),
        ("big", SQUARE_LINES, [("3f", 0, 0, -math.inf)], 0, "coordinate z of vertex 0 is -inf", "finite"),
        ("little", SQUARE_LINES, [POINTS, ("B3iB2ih", 3, 0, 1, 2, 3, 0, 2, 3), ("B", 0)], 73, "file ends inside face 2 of 2"),
        ("little", SQUARE_LINES, [("7fh", *[0] * 8)], 30, "file ends inside vertex 3 of 4"),
        ("big", SQUARE_LINES, [POINTS, FACES, ("Bh", 1, 0)], 74, "3 bytes follow the last element", "end of the file"),
        ("little", SQUARE_LINES.replace("vertex 4", "vertex 2147483647"), [POINTS], 48,
         "file ends inside vertex 5 of 2147483647"),
        ("little", f"element a 1\nproperty list uint double l\n{SQUARE_LINES}", [("I3d", 4294967295, 1, 2, 3)], 28,
         "file ends inside a 1 of 1"),
        ("little", longest, [POINTS, ("4I", 4294967295, 1, 2, 3)], 64, "file ends inside face 1 of 1"),
    ]
    for order in ("little", "big"):
        table += [(order, lines, [POINTS, (form, *numbers)], 48 + offset, *says) for lines, form, numbers, offset, *says in [
            (SQUARE_LINES, "B3i", (3, 0, 1, 4), 9, "face index 4 is out of range", "has 4 vertices"),
            (SQUARE_LINES, "B3i", (3, 0, -1, 2), 5, "face index -1 is out of range", "has 4 vertices"),
            (floats, "b3f", (-3, 0, 1, 2), 0, "'vertex_indices' has -3 entries", "0 or more"),
            (floats, "b3f", (3, 0, 1.5, 2), 5, "face index 1.5", "an integer"),
            (floats, "b3f", (3, math.nan, 1, 2), 1, "face index nan is out of range", "has 4 vertices"),
        ]]
    expect_errors([(binary(order, lines, *data), f" byte {len(binary(order, lines)) + offset}: ", *says)
                   for order, lines, data, offset, *says in table], name=NAME)
