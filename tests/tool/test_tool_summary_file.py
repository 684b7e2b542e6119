"""The summaries that the tool's report reads back: what is none of them is named."""
import os
from pathlib import Path

import pytest

from support.tool.recordings import tetrahedra
from support.tool.running import fails, run


@pytest.fixture
def summary():
    scene = tetrahedra(8)
    scene.write_mesh("model.obj")
    scene.write_cache("frames.pc2")
    run("replay model.obj frames.pc2 --json out.json")
    return Path("out.json").read_text()


@pytest.mark.parametrize("text, reasons", [
    (b"", ["other.json:1", "ends too early"]),
    (b'{"intervals":[\n{"frame":0', ["other.json:2", "ends too early"]),
    (b'{"intervals":[\n{"frame":zero}]}', ["other.json:2"]),
    (b'{"intervals":[],\n"a":"\xff"}', ["other.json:2", "utf-8"]),
    (b"[]", ["the file has no member 'intervals'", "cscd replay --json"]),
    (b'{"intervals":7}', ["the file: 'intervals' is not what cscd writes"]),
    (b'{"intervals":[{"frame":0}],"frames":[],"summary":{},"provenance":{}}', ["interval 0 of the file has no member 'vf'"]),
    (b'{"intervals":[],"frames":[],"summary":{},"provenance":{}}', ["the summary has no member"]),
    (b"{} {}", ["other.json:1", "unexpected character"]),
])
def test_what_is_no_summary_is_named(text, reasons):
    Path("other.json").write_bytes(text)
    fails("report other.json -o page.html", *reasons)
    assert not os.path.exists("page.html")


def test_a_missing_summary_is_named():
    fails("report nowhere.json -o page.html", "nowhere.json", "No such file")


def test_a_changed_summary_is_refused(summary):
    """A correct summary with one part of it replaced."""
    for part, instead, reason in (
        ('"frame":3', '"frame":2', "interval 3 of the file: 'frame'"),
        ('"frame":0', '"frame":-2147483649', "interval 0 of the file: 'frame'"),
        ('"frame":0', '"frame":1e300', "interval 0 of the file: 'frame'"),
        ('"frame":0', '"frame":2147483648', "interval 0 of the file: 'frame'"),
        ('"state":"clean"', '"state":"tidy"', "'state' is not what cscd writes there"),
        ('"processors"', '"possessors"', "the machine has no member 'processors'"),
        ('"release":', '"release":7,"was":', "the machine: 'release' is not"),
        ('"source"', '"sauce"', "the plan has no member 'source'"),
        ('"complete":true', '"complete":false', "the summary has no member 'stopped_by'"),
        ('"events":[', '"events":7,"were":[', "the file: 'events' is not what cscd writes there"),
        ('"unit":null', '"unit":7', "the file: 'unit' is not what cscd writes there"),
        ('"worst":', '"worst":1234', "event 0 of the file: its frames are not"),
        ('"worst":', '"worse":', "event 0 of the file has no member 'worst'"),
        ('"kinds":[', '"kinds":[7,', "event 0 of the file: its kinds are not"),
        ('"point":[', '"point":[1,', "event 0 of the file: the coordinates are not"),
        ('"point":[', '"point":[null,null,null],"place":[', "event 0 of the file: the coordinates are not"),
        ('"object":', '"object":7,"body":', "event 0 of the file: 'object' is not"),
        ('"count":', '"number":', "interval 0 of the file has no member 'count'"),
    ):
        assert part in summary
        Path("changed.json").write_text(summary.replace(part, instead, 1))
        fails("report changed.json -o page.html", reason)


@pytest.mark.parametrize("part, instead", [
    ('"events":', '"remark":'),  # an older version wrote a summary without events: the page says so
    ('"count":', '"component":'),  # version 1 wrote an object for each component, not for each group of them
])
def test_summaries_of_older_versions_are_read(summary, part, instead):
    assert part in summary
    Path("changed.json").write_text(summary.replace(part, instead, 1))
    run("report changed.json -o page.html")
    assert os.path.exists("page.html")
