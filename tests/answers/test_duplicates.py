"""A triangle that is there twice is said first, and nothing with one is called clean."""
from pathlib import Path

import pytest

from support.tool.reading import read_csv, read_json
from support.tool.running import run

TWICE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 2 3 1\n"


@pytest.mark.parametrize("text, sentence", [
    (TWICE, "One triangle is there twice; no two others cross or touch."),
    ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\nf 3 1 2\n",
     "3 pairs of triangles are the same triangle twice; no two others cross or touch."),
    ("o A\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nf 1 2 3\no B\nv 1 1 -1\nv 2 1 -1\nv 1 1 1\nf 4 5 6\n",
     "One triangle is there twice. 2 pairs of triangles cross, with 3 of 3 triangles (100 %). 1 place, A x B, crossing along 1."),
])
def test_the_sentence_begins_with_them(text, sentence):
    Path("one.obj").write_text(text)
    assert run("check one.obj").first_line == sentence


def test_lists_of_pairs_leave_them_out():
    """They are no pairs that cross or touch: lists have two others, each with its kind."""
    Path("one.obj").write_text("v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nf 1 2 3\nv 1 1 -1\nv 2 1 -1\nv 1 1 1\nf 4 5 6\n")
    run("check one.obj --json out.json --csv out.csv --quiet")
    frame = read_json("out.json")["frames"][0]
    assert [pair[1] for pair in frame["pairs"]] == [2, 2] and frame["kinds"] == ["crossing", "crossing"]
    assert [row["kind"] for row in read_csv("out.csv")] == ["crossing", "crossing"]


def test_frames_with_them_are_not_clean():
    for name in ("d_1.obj", "d_2.obj"):
        Path(name).write_text(TWICE)
    sentence = "One triangle is there twice. No frame crosses or touches (2 checked)."
    answer = run("check d_1.obj d_2.obj --timings")
    assert answer.first_line == sentence and "0 of 2 frames are clean" in answer.out
    assert run("replay d_1.obj d_2.obj").first_line == sentence


def test_among_many_they_are_an_outcome():
    Path("one.obj").write_text(TWICE)
    out = run("check --each one.obj").out
    assert "one.obj: One triangle is there twice; no two others cross or touch." in out
    assert "1 mesh: 0 clean, 1 only with duplicates" in out
    run("check one.obj --fail-on crossing")
    assert "failed: 1 triangle is there twice" in run("check one.obj --fail-on touching", code=3).error
    run("check --each one.obj --fail-on touching", code=3)
