"""Texts as strangers write them, in every text format: words for what is no number, decimal commas, UTF-8 and UTF-16."""
import pytest

from support.tool.read_back import errors_of, expect_errors, expect_squares

# A square in each format, in which one word stands for the 1 of vertex 1's x; where it stands, and what a message calls it.
FORMATS = {
    "mesh.obj": ("v 0 0 0\nv {} 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", "2: ", "x of vertex 2"),
    "mesh.off": ("OFF\n4 1 0\n0 0 0\n{} 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", "4: ", "x of vertex 1"),
    "mesh.ply": ("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                 "property list uchar int vertex_indices\nend_header\n0 0 0\n{} 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", "11: ",
                 "x of vertex 1"),
    "mesh.stl": ("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex {} 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\n"
                 "endfacet\nendsolid\n", "5: ", "x of vertex 1"),
}
# As Visual C writes them.
NAN = ("1.#QNAN", "-1.#IND", "1.#SNAN", "1.#R", "-1.#J", "-1.#IND000000")
INF = ("1.#INF", "-1.#INF00", "+1.#INF")
ALL_FORMATS = pytest.mark.parametrize("name", FORMATS)


@ALL_FORMATS
def test_words_that_are_no_number_are_refused(name):
    """A # within a word is of the word, so that such a word is no number. A comma may be meant as a decimal point."""
    text, place, vertex = FORMATS[name]
    found = ("1#", "1.#", "1.#1", "1.#inf", "1.#INF1", "2.#INF", "1#QNAN", "1.#QNAN.", "1.#-")
    advice = "this is a decimal comma: write numbers with a decimal point"
    expect_errors([(text.format(word), place, *says) for words, *says in [
        (NAN, vertex, "nan, expected a finite number"), (INF, vertex, "inf, expected a finite number")] for word in words]
        + [(text.format(word), place, f"found '{word}'", "expected") for word in found]
        + [(text.format(word), place, f"found '{word}'", advice) for word in ("1,0", "-1,25e-3", ",5")], name=name)


@ALL_FORMATS
def test_other_commas_are_not_told(name):
    """Numbers between commas are none with a comma in it."""
    errors = errors_of([FORMATS[name][0].format(word) for word in ("1,0,0", "1,", ",", "a,5", "1,-5", "1,x")], name=name)
    assert not any("decimal" in error for error in errors)


@ALL_FORMATS
def test_wide_texts_are_told(name):
    """Each character as two bytes, behind a mark or not."""
    text = FORMATS[name][0].format(1)
    expect_errors([(mark + text.encode(f"utf-16-{order}"), " this is text in UTF-16", "save it as UTF-8")
                   for order, bom in (("le", b"\xff\xfe"), ("be", b"\xfe\xff")) for mark in (b"", bom)], name=name)


@ALL_FORMATS
def test_marks_of_utf8_are_passed(name):
    text = FORMATS[name][0]
    comments = {"mesh.obj": ["1 0 0 # 2"], "mesh.off": ["1 0 0 #2"]}.get(name, [])
    expect_squares([text.format("1.0"), "\ufeff" + text.format(1), *map(text.format, comments)], name)
