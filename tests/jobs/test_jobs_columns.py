"""What the page and the XML of a night take from the line of a job: each number has its own column, and words stay words."""
from math import isnan
from pathlib import Path

import pytest

from support.tool.exported import read_doubles, read_texts
from support.tool.running import run, write_list

# A recording of which no two numbers are equal, one that failed, a mesh, and a reason that begins with another name.
JOBS = [
    {"result": "crossing", "found": True, "name": "<a> & 'b'", "error": None, "answer": '<i> & "2" cross', "frames": 120,
     "frames_checked": 110, "frames_crossing": 12, "crossing_pairs": 15, "depth": 14.5, "events": 13},
    {"result": "failed", "found": False, "name": "b.obj", "error": 'b.obj: <no> & "file"', "answer": None, "frames": None,
     "depth": None},
    {"result": "clean", "found": False, "file": "c.obj", "crossing": 21, "read_ms": 1250, "check_ms": 250},
    {"result": "failed", "found": False, "name": "d", "error": "d.obj: it took longer than 3 s", "answer": "d"},
]


@pytest.fixture(autouse=True)
def night(own_folder):
    write_list("a&b.jsonl", *({"list": "0123456789abcdef", "jobs": 4, "job": i, **job} for i, job in enumerate(JOBS, 1)))
    run("report 'a&b.jsonl' -o night.html --junit night.xml --quiet", code=1)


@pytest.mark.parametrize("name, expected", [
    ("crossing_frames", [12, None, None, None]), ("frames", [110, None, None, None]), ("events", [13, None, None, None]),
    ("depth", [14.5, None, None, None]), ("pairs", [15, None, 21, None]), ("seconds", [None, None, 1.5, None]),
])
def test_each_number_has_its_column(name, expected):
    assert [None if isnan(number) else number for number in read_doubles("night.html", name)] == expected


def test_words_are_as_the_line_has_them():
    """A reason does not begin with the name that stands beside it."""
    assert read_texts("night.html", "names") == ["<a> & 'b'", "b.obj", "c.obj", "d"]
    assert read_texts("night.html", "answers") == ['<i> & "2" cross', '<no> & "file"', "", "d.obj: it took longer than 3 s"]


def test_the_xml_escapes_all_words():
    assert Path("night.xml").read_text().endswith(
        'a&#38;b.jsonl" tests="4" failures="1" errors="2">\n'
        '    <testcase classname="cscd" name="&#60;a&#62; &#38; \'b\'">\n'
        '      <failure message="&#60;i&#62; &#38; &#34;2&#34; cross"/>\n    </testcase>\n'
        '    <testcase classname="cscd" name="b.obj">\n'
        '      <error message="b.obj: &#60;no&#62; &#38; &#34;file&#34;"/>\n    </testcase>\n'
        '    <testcase classname="cscd" name="c.obj"/>\n'
        '    <testcase classname="cscd" name="d">\n'
        '      <error message="d.obj: it took longer than 3 s"/>\n    </testcase>\n'
        '  </testsuite>\n</testsuites>\n')
