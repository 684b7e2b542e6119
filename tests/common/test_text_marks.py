"""Every text that the tool reads may begin with the mark of UTF-8; one in UTF-16 is told."""
from pathlib import Path

import pytest

from support.tool.recordings import tetrahedra
from support.tool.running import fails, run

MARK = b"\xef\xbb\xbf"
JOBS = '{"model":"model.obj"}\r\n\r\n{"model":"model.obj","frames":"frames.pc2"}\r\n'
PARTS = "triangle,name\n0,Wall\n1,Wall\n2,Wall\n3,Wall\n4,Dart\n5,Dart\n6,Dart\n7,Dart\n"
PAIRS = "components 0 1\n"


@pytest.fixture(autouse=True)
def files(own_folder):
    scene = tetrahedra(8)
    scene.write_mesh("model.obj")
    scene.write_cache("frames.pc2")


def write_marked(path, text):
    Path(path).write_bytes(MARK + text.encode())


def write_wide(path, text):
    """In UTF-16, with the low byte first."""
    Path(path).write_bytes(b"\xff\xfe" + text.encode("utf-16-le"))


@pytest.mark.parametrize("name, text, line, says, code", [
    ("jobs.jsonl", JOBS, "check --list jobs.jsonl", "2 recordings: ", 4),
    ("parts.csv", PARTS, "check model.obj frames.pc2 --parts parts.csv", "Wall x Dart", 1),
    ("pairs.txt", PAIRS, "check model.obj frames.pc2 --ignore pairs.txt", "No frame crosses", 1),
])
def test_lists_and_tables_may_have_a_mark(name, text, line, says, code):
    Path(name).write_text(text, newline="")
    plain = run(line).out
    write_marked(name, text)
    assert run(line).out == plain and says in plain
    write_wide(name, text)
    fails(line, f"{name}: this is text in UTF-16", code=code)


def test_results_may_have_a_mark():
    Path("jobs.jsonl").write_text('{"model":"model.obj"}\n{"model":"model.obj"}\n')
    run("check --list jobs.jsonl --results results.jsonl --quiet")
    write_marked("marked.jsonl", Path("results.jsonl").read_text())
    merged = [run(f"merge {name} -o - --quiet").out for name in ("results.jsonl", "marked.jsonl")]
    assert merged[0] == merged[1] and merged[0].count("\n") == 2
    for name in ("results.jsonl", "marked.jsonl"):
        run(f"check --list jobs.jsonl --results {name} --resume --quiet")


def test_summaries_may_have_a_mark():
    run("replay model.obj frames.pc2 --json out.json --quiet")
    write_marked("marked.json", Path("out.json").read_text())
    run("report marked.json out.json -o page.html")
    write_wide("wide.json", '{"intervals": []}')
    fails("report wide.json -o page.html", "wide.json: this is text in UTF-16")
