"""The tool's reports: what the page contains, what is refused, and what remains when a report cannot be written."""
import json
import os
import signal
import struct
import time
from pathlib import Path

import pytest

from support.tool.exported import read_page
from support.tool.reading import read_json
from support.tool.recordings import fold, tetrahedra
from support.tool.running import fails, finish, limited_to, run, start, usage_error


@pytest.fixture(autouse=True)
def files(own_folder):
    scene = tetrahedra(8)
    scene.write_mesh("model.obj")
    scene.write_cache("frames.pc2")


def same(a, b):
    """The same names and values in the same order."""
    return json.dumps(a) == json.dumps(b)


def test_the_page_of_a_replay_has_its_summary():
    run("replay model.obj frames.pc2 --json out.json --report page.html --up y")
    root, own = read_page("page.html"), read_json("out.json")
    scene, total = root["scene"], own["summary"]
    assert (root["kind"], root["title"], scene["up"]) == ("replay", "model.obj", "y")
    assert same(root["summaries"][0]["summary"], own)
    assert [scene[key] for key in ("vertices", "triangles", "first", "last")] == [8, 8, 0, 7]
    assert len(scene["frames"]) == 8 and scene["relative_error"] < 1e-4
    assert scene["contacts"]["found"] == total["vf"] + total["ee"] > 0


def test_the_page_of_a_plan_has_charge_and_timings():
    assert "page.html" in run("preprocess model.obj -o page.plan.ply --report page.html").out
    root = read_page("page.html")
    assert root["kind"] == "preprocess" and root["scene"]["plan"]["method"] == "charge"
    assert len(root["scene"]["plan"]["capacitances"]) == 2
    assert root["preprocess"]["timings"]["total_ms"] > 0 and len(root["preprocess"]["provenance"]["arguments"]) == 6


def test_summaries_stand_side_by_side():
    run("replay model.obj frames.pc2 --json out.json")
    run("replay model.obj frames.pc2 --json other.json --method none")
    run("report out.json other.json -o page.html")
    root = read_page("page.html")
    assert root["kind"] == "compare" and [each["name"] for each in root["summaries"]] == ["out.json", "other.json"]
    assert same(root["summaries"][1]["summary"], read_json("other.json")) and root["scene"] is None


@pytest.mark.parametrize("line, says", [
    ("replay model.obj frames.pc2 --scenery model.obj", "--report OUT.html"),
    ("replay model.obj frames.pc2 --report page.html --scenery-frames frames.pc2", "--scenery MODEL"),
    ("replay model.obj frames.pc2 --up x", "--up cannot be 'x'"),
    ("replay model.obj frames.pc2 --report model.obj", "would overwrite"),
    ("replay model.obj frames.pc2 --report page.html --json page.html", "would overwrite"),
    ("preprocess model.obj --report page.ply", "named like a mesh"),
    ("report -o page.html", "no summary"),
    ("report out.json", "no -o OUT.html"),
    ("report out.json -o out.json", "would overwrite"),
])
def test_options_that_do_not_fit_are_refused(line, says):
    usage_error(line, says)


def test_an_unwritable_report_loses_nothing_else():
    Path("full.html").symlink_to("/dev/full")
    answer = run("replay model.obj frames.pc2 --contacts out.csv --json out.json --report full.html", code=1)
    assert "no report was written" in answer.error and "No space left" in answer.error and "contacts: " in answer.out
    assert read_json("out.json")["summary"]["complete"] is True and os.path.exists("out.csv")
    fails("replay model.obj frames.pc2 --contacts new.csv --report nowhere/page.html", "nowhere/page.html", "No such file")
    Path("loop.html").symlink_to("loop.html")
    fails("replay model.obj frames.pc2 --contacts new.csv --report loop.html", "loop.html", "Too many levels")
    os.mkdir("folder.html")
    fails("replay model.obj frames.pc2 --contacts new.csv --report folder.html", "folder.html", "Is a directory")
    assert not os.path.exists("new.csv")  # refused before anything is opened


def test_a_full_disk_leaves_the_older_file():
    """Whether there is room for nothing, for half of the page, or for all of it but a byte."""
    run("replay model.obj frames.pc2 --json out.json")
    run("report out.json -o page.html")
    whole = os.path.getsize("page.html")
    Path("older.html").write_text("older")
    before = set(os.listdir())
    for limit in (0, 1, whole // 2, whole - 1):
        for name in ("older.html", "newer.html"):
            fails(f"report out.json -o {name}", name, "cannot write: File too large", preexec_fn=limited_to(limit))
    assert Path("older.html").read_text() == "older" and set(os.listdir()) == before


def test_permissions_are_as_ever():
    """Those of a new file, and those that an older one had. A name as long as may be leaves no room for a longer one."""
    run("replay model.obj frames.pc2 --json out.json")
    name, before = "n" * 250 + ".html", set(os.listdir())
    for mode in (0o640, 0o604):
        run("report out.json -o", name, umask=0o027)
        assert os.stat(name).st_mode & 0o7777 == mode and read_page(name)["kind"] == "compare"
        os.chmod(name, 0o604)
    assert set(os.listdir()) == before | {name}


def test_outputs_are_where_links_lead(own_folder):
    """Links to files that do not exist yet, and to older ones, stay links, and the outputs are at their targets."""
    endings = ("html", "json", "csv")
    for ending, target in zip(endings, ("led.html", own_folder / "led.json", "led.csv")):
        Path(f"link.{ending}").symlink_to(target)
    for _ in range(2):
        run("replay model.obj frames.pc2 --report link.html --json link.json --contacts link.csv")
        for ending in endings:
            led = Path(f"led.{ending}")
            assert Path(f"link.{ending}").is_symlink() and not led.is_symlink() and led.stat().st_size > 5
            led.write_text("older")


def test_a_pipe_gets_the_page():
    """The reader of a pipe gets the whole page: nothing opens and closes the pipe before."""
    os.mkfifo("pipe.html")
    process = start("replay model.obj frames.pc2 --report pipe.html --quiet")
    page = Path("pipe.html").read_bytes()  # waits for the first writer
    if not page:
        process.kill()  # it would wait for another reader
    finish(process)
    Path("page.html").write_bytes(page)
    assert read_page("page.html")["kind"] == "replay"


def write_spoilt(frame):
    """Writes a recording whose first coordinate in a frame is infinite."""
    tetrahedra(8).write_cache("spoilt.pc2")
    with open("spoilt.pc2", "r+b") as file:
        file.seek(32 + frame * 8 * 12)
        file.write(struct.pack("<f", float("inf")))


def test_a_replay_that_stops_reports_what_it_has():
    write_spoilt(5)
    fails("replay model.obj spoilt.pc2 --report page.html", "frame 5")
    root = read_page("page.html")
    assert "frame 5" in root["summaries"][0]["summary"]["summary"]["stopped_by"]
    assert root["scene"]["last"] == 4 and len(root["scene"]["frames"]) == 5


def test_a_replay_without_an_interval_says_that_it_reports_nothing():
    write_spoilt(1)
    fails("replay model.obj spoilt.pc2 --report page.html", "frame 1", "; no report was written")
    assert not os.path.exists("page.html")


def test_an_interrupted_replay_reports_what_it_has(own_folder):
    sheet = fold(30, 20, 2)
    sheet.write_mesh("sheet.obj")
    sheet.write_cache("sheet.pc2", 5000)
    process = start("replay sheet.obj sheet.pc2 --method brute --json out.json --report page.html")
    # Until a file has some lines that lies beside its place until it is whole.
    while process.poll() is None and not any(path.stat().st_size >= 800 for path in own_folder.glob(".cscd-output-*")):
        time.sleep(0.002)
    process.send_signal(signal.SIGINT)
    finish(process, code=130)
    root = read_page("page.html")
    done = len(root["summaries"][0]["summary"]["intervals"])
    assert 1 <= done < 4999 and root["scene"]["last"] == done


def test_texts_are_never_markup():
    """Beside its blocks, whatever names and texts they hold, a page is the same as any other."""
    name, title = "a<img src=x onerror=alert(1)>&\"'<!--<script>.obj", "</script><img src=x><!--"
    run("replay model.obj frames.pc2 --report page.html --json out.json")
    ends = frame_of("page.html")
    tetrahedra(3).write_mesh(name)
    run("replay --frames 0:2 --report page.html", name, "frames.pc2")
    assert read_page("page.html")["title"] == name and frame_of("page.html") == ends
    summary = {**read_json("out.json"), "more": title}
    Path(name).write_text(json.dumps(summary))
    run("report -o page.html", name, "--title", title)
    root = read_page("page.html")
    assert root["title"] == title and root["summaries"] == [{"name": name, "summary": summary}]
    assert frame_of("page.html") == ends


def frame_of(path):
    """What stands before and behind the blocks of a page, none of which has markup."""
    before, *blocks, last = Path(path).read_text(encoding="utf-8").split('<script type="application/')
    *_, after = last.split("</script>\n", 1)
    assert all(block.count("<") == block.count("</script>") == 1 for block in blocks)
    return before, after
