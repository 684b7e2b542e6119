"""GIFTI surfaces: all encodings, and each error with its line."""
import struct
from pathlib import Path

import pytest

from support.tool.mesh_files import ASCII, BASE64, HALVES, SQUARE, ZIPPED, square_gifti
from support.tool.read_back import expect_errors, expect_mesh, frames_read, shown, whole
from support.tool.running import run

NAME = "lh.surf.gii"


@pytest.mark.parametrize("kind", ["FLOAT32", "FLOAT64"])
@pytest.mark.parametrize("column_major", [False, True])
@pytest.mark.parametrize("big_endian", [False, True])
@pytest.mark.parametrize("encoding, style", [(ASCII, {}), (BASE64, {}), (ZIPPED, {}), (ZIPPED, {"gzip_header": True})])
def test_reads_all_styles(encoding, style, big_endian, column_major, kind):
    content = square_gifti(encoding, kind, big_endian=big_endian, column_major=column_major, **style)
    expect_mesh(content, SQUARE, HALVES, NAME)


ARRAY = ("<DataArray Intent='NIFTI_INTENT_{}' DataType='NIFTI_TYPE_{}' ArrayIndexingOrder='RowMajorOrder' Dimensionality='2' "
         "Dim0='{}' Dim1='3' Encoding='ASCII'><Data>{}</Data></DataArray>")


@pytest.mark.parametrize("bits, form", [(32, "f"), (64, "d")])
def test_rounds_text_to_its_type(bits, form):
    """Numbers of a file are its floats; as text they are rounded to the type that the file names."""
    content = "<GIFTI>{}{}</GIFTI>".format(ARRAY.format("TRIANGLE", "INT32", 1, "0 1 2"),
                                           ARRAY.format("POINTSET", f"FLOAT{bits}", 3, "0.1 -2.5e3 1e-3\n0 0 0\t1 1 1"))
    expect_mesh(content, [struct.unpack(f"3{form}", struct.pack(f"3{form}", 0.1, -2500, 1e-3)), (0, 0, 0), (1, 1, 1)],
                [(0, 1, 2)], "brain.xml")


def test_reads_files_of_several_megabytes():
    """The parser takes a megabyte at a time: no byte is lost or read twice between two."""
    points = [(1000000.125 + i, 0.5, i + 0.75) for i in range(90000)]
    text = "\n".join("%r %r %r" % point for point in points)
    content = "<GIFTI>{}{}</GIFTI>".format(ARRAY.format("POINTSET", "FLOAT64", len(points), text),
                                           ARRAY.format("TRIANGLE", "INT32", 1, "0 1 89999"))
    assert len(content) > 2 << 20
    (mesh,) = frames_read(content, "lh.gii")
    assert mesh.points == points


def replaced(text, by, encoding=ASCII):
    """The file with one part of its text replaced, the first one."""
    content = square_gifti(encoding)
    assert text in content, text
    return content.replace(text, by, 1)


def test_refuses_what_is_no_surface():
    external = 'ASCII" Endian="LittleEndian" ExternalFileName=""'
    dim0, order = 'Dim0="4" Dim1', '"RowMajorOrder" Dimensionality="2"'
    expect_errors([(replaced(text, by), *says) for text, by, *says in [
        ("NIFTI_INTENT_TRIANGLE", "NIFTI_INTENT_SHAPE", " no data array of NIFTI_INTENT_TRIANGLE", "points and triangles"),
        (external, 'ExternalFileBinary" Endian="LittleEndian" ExternalFileName="lh.dat"', "7: ", "another file, 'lh.dat'",
         "save the surface with its data inside"),
        ("NIFTI_TYPE_FLOAT32", "NIFTI_TYPE_UINT8", "7: ", "DataType is 'NIFTI_TYPE_UINT8'",
         "NIFTI_TYPE_FLOAT32 or NIFTI_TYPE_FLOAT64"),
        ('Dim1="3"', 'Dim1="2"', "7: ", "Dim1 is '2'", "of 3"),
        ('Dimensionality="2"', 'Dimensionality="3"', "7: ", "expected two dimensions"),
        (dim0, 'Dim0="-4" Dim1', "7: ", "Dim0 is '-4'", "1 to 2147483647"),
        (dim0, 'Dim0="4e9" Dim1', "7: ", "Dim0 is '4e9'", "1 to 2147483647"),
        (dim0, 'Dim0="2147483647" Dim1', "10: ", "characters", "6442450941 numbers"),
        (order, '"Diagonal" Dimensionality="2"', "7: ", "ArrayIndexingOrder is 'Diagonal'", "RowMajorOrder or ColumnMajorOrder"),
        ("</GIFTI>", "</GIFTY>", "no valid XML: mismatched tag"),
    ]] + [
        (replaced('LittleEndian" Ex', 'MiddleEndian" Ex', BASE64), "7: ", "Endian is 'MiddleEndian'",
         "LittleEndian or BigEndian"),
        ("<surface/>", " no element GIFTI"),
        ("\n<GIFTI>", "2: no valid XML"),
    ], name=NAME)


def test_refuses_wrong_data():
    zipped = square_gifti(ZIPPED)
    end = zipped.index("</Data>", zipped.index("<Data>e"))
    dim0 = 'Dim0="4" Dim1'
    expect_errors([(replaced(text, by, encoding), *says) for encoding, text, by, *says in [
        (ASCII, "<Data>0 0 0", "<Data>0 0 x", "10: ", "found 'x'", "a number"),
        (ASCII, "<Data>0 1 2", "<Data>0 1 2.5", "found '2.5'", "a whole number"),
        (ASCII, "<Data>0 1 2", "<Data>0 1 4294967298", "found '4294967298'", "a whole number"),
        (ASCII, "<Data>0 1 2", "<Data>0 1 4", "triangle 0 names vertex 4", "there are 4"),
        (ASCII, "<Data>0 1 2", "<Data>0 1 -1", "triangle 0 names vertex -1", "there are 4"),
        (ASCII, "<Data>0 0 0", "<Data>0 0", "10: ", "have 11 numbers", "expected 12"),
        (ASCII, "<Data>0 0 0", "<Data>0 0 0 7", "10: ", "after the last of 12"),
        (ASCII, "<Data>0 0 0", "<Data>0 0 1e39", "coordinate z of vertex 0 is inf", "finite"),
        (BASE64, "<Data>AAAA", "<Data>AA*A", "10: ", "no base64 at character 2"),
        (BASE64, "<Data>AAAA", "<Data>AAAAA", "10: ", "no base64 at character 65"),
        (BASE64, "<Data>AAAA", "<Data>", "10: ", "the data have 45 bytes", "expected 48 for 4 rows"),
        (BASE64, "<Data>AAAA", "<Data>AAAAAAAA", "10: ", "the data have 51 bytes", "expected 48 for 4 rows"),
        (ZIPPED, dim0, 'Dim0="3" Dim1', "10: ", "the data have 37 bytes", "expected 36"),
        (ZIPPED, dim0, 'Dim0="5" Dim1', "10: ", "the data have 48 bytes", "expected 60"),
        (ZIPPED, dim0, 'Dim0="2147483647" Dim1', "10: ", "bytes", "25769803764"),
        (ZIPPED, "<Data>e", "<Data>f", "10: ", "cannot be unzipped", "damaged"),
    ]] + [  # all numbers are there, but not the sum that is to prove them
        (zipped[: end - 4] + zipped[end:], "10: ", "cannot be unzipped", "damaged or cut off"),
    ], name=NAME)


def test_refuses_elements_out_of_place():
    """In the data of each encoding, of every name that is known and of none."""
    starts = {ASCII: "<Data>0 0 0", BASE64: "<Data>AAAA", ZIPPED: "<Data>e"}
    inside = [(replaced(start, by, encoding), line, f"an element '{name}' inside Data", "numbers alone")
              for encoding, start in starts.items() for name in ("DataArray", "Data", "GIFTI", "MetaData", "b")
              for line, by in (("10: ", f"<Data><{name}/>0"),
                               ("11: ", f"<Data>0\n<{name} Intent='NIFTI_INTENT_TRIANGLE'>0</{name}>0"))]
    expect_errors(inside + [(replaced(text, by), *says) for text, by, *says in [
        ("<Data>0 0 0", "<DataArray/><Data>", "10: ", "'DataArray' inside a DataArray", "its data"),
        ("<Data>0 0 0", "<MetaData><DataArray/></MetaData><Data>", "10: ", "'DataArray' inside a DataArray", "its data"),
        ("<Data>0 0 0", "<Data/><Data>", "10: ", "a second element Data", "expected one"),
        ("<Data>0 0 0", "<Data>0</Data><Data>", "10: ", "a second element Data", "expected one"),
        ("<Data>1 2", "<Data><DataArray/>1 2", "6: ", "'DataArray' inside a DataArray"),
    ]], name=NAME)


def test_refuses_entities():
    """Text that grows a hundredfold, from the file or from another one, whether it is used or not."""
    expect_errors([(replaced(text, by), line, "the entity 'a'", "without any") for text, by, line in [
        ('.dtd">', ".dtd\" [<!ENTITY a '0 0 0 0 0 0 0 0'>\n<!ENTITY b '&a;&a;&a;&a;'>]>", "2: "),
        ('.dtd">', ".dtd\" [\n<!ENTITY a SYSTEM 'file:///etc/passwd'>]>", "3: "),
        ('.dtd">', ".dtd\" [\n<!ENTITY % a '0'>]>", "3: "),
        ("<Data>0 0 0", "<Data>&a;0 0 0", "10: "),
    ]], name=NAME)


def test_plays_files_as_frames():
    for frame, encoding in enumerate((ASCII, BASE64, ZIPPED)):
        Path(f"f{frame}.surf.gii").write_text(square_gifti(encoding))
    assert "(3 checked)" in run("check f0.surf.gii f%d.surf.gii --no-depths").out


def test_words_are_cut():
    """Long ones are shown up to a whole character."""
    external = 'ASCII" Endian="LittleEndian" ExternalFileName="'
    expect_errors([(square_gifti().replace(text, by, 1), f"{before}'{shown(most)}'{after}") for text, by, most, before, after in [
        ("NIFTI_TYPE_FLOAT32", whole(40), 40, "DataType is ", ", expected NIFTI_TYPE_FLOAT32"),
        ('Dim0="4" Dim1', f'Dim0="{whole(40)}" Dim1', 40, "Dim0 is ", ", expected 1 to"),
        ('Dim1="3"', f'Dim1="{whole(40)}"', 40, "Dim1 is ", ", expected two dimensions"),
        (external, f'ExternalFileBinary" Endian="LittleEndian" ExternalFileName="{whole(200)}', 200, "in another file, ",
         "; save the surface"),
    ]], name=NAME)
