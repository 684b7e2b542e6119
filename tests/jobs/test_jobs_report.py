"""`cscd report` of results of jobs: what the page holds is read back, and a night that is not done has its page, too."""
import os
import shutil
import xml.etree.ElementTree as ElementTree
from math import isnan
from pathlib import Path

import pytest

from support.tool.exported import read_array, read_doubles, read_page, read_texts
from support.tool.recordings import fold
from support.tool.running import CLEAN, CROSSING, fails, run, usage_error, write_list

# What the page calls the outcomes.
IS_CLEAN, CROSSES, FAILED, MISSING = 0, 1, 5, 6
NIGHT = "report shard-1.jsonl shard-2.jsonl -o night.html"


@pytest.fixture(scope="module")
def night(tmp_path_factory):
    """Jobs 1, 4 and 7 are clean, 2 and 5 cross, 3 and 6 fail; two shards of them, and the summary of a replay."""
    folder, before = tmp_path_factory.mktemp("night"), os.getcwd()
    os.chdir(folder)
    Path("clean.obj").write_text(CLEAN)
    Path("crossing.obj").write_text(CROSSING)
    models = ("clean.obj", "crossing.obj", "none.obj")
    write_list("jobs.jsonl", *({"model": models[i % 3], "name": f"</script> '{i + 1}"} for i in range(7)))
    for i in (1, 2):
        run(f"check --list jobs.jsonl --results shard-{i}.jsonl --shard {i}/2 --fail-on crossing --quiet", code=1)
    scene = fold(8, 6, 3)
    scene.write_mesh("fold.obj")
    scene.write_cache("fold.pc2")
    run("replay fold.obj fold.pc2 --json fold.json --quiet")
    os.chdir(before)
    return folder


@pytest.fixture(autouse=True)
def files(own_folder, night):
    for path in night.iterdir():
        shutil.copy(path, own_folder)


def names(*missing):
    return [f"job {i}" if i in missing else f"</script> '{i}" for i in range(1, 8)]


# ---- a whole night


def test_the_page_has_every_job():
    answer = run(NIGHT, code=1)
    assert "7 jobs: 3 clean, 2 with intersections, 2 failed\nwritten: " in answer.out
    assert answer.error == "cscd: 2 of 7 jobs have failed\n"
    root = read_page("night.html")
    assert (root["kind"], root["title"], root["missing"]) == ("jobs", "Jobs", "")
    assert list(read_array("night.html", "outcome")) == [IS_CLEAN, CROSSES, FAILED, IS_CLEAN, CROSSES, FAILED, IS_CLEAN]
    assert list(read_array("night.html", "found")) == [0, 1, 0, 0, 1, 0, 0]
    assert read_texts("night.html", "names") == names()
    answers = read_texts("night.html", "answers")
    assert all(word in answer for word, answer in zip(3 * ("Clean", "cross", "none.obj: cannot open"), answers))
    pairs = read_doubles("night.html", "pairs")
    assert len(answers) == len(pairs) == 7 and pairs[:2] == [0, 1] and isnan(pairs[2])
    assert read_array("night.html", "seconds") is None


@pytest.mark.parametrize("second, code", [("clean.obj", 0), ("crossing.obj", 3)])
def test_exit_codes_are_those_of_the_night(second, code):
    """As those of merge."""
    write_list("few.jsonl", {"model": "clean.obj"}, {"model": second})
    run("check --list few.jsonl --results results.jsonl --fail-on crossing --quiet", code=code)
    run("report results.jsonl -o night.html", code=code)


def test_meshes_have_times():
    """Lines of --each have other members: times, and no sentence."""
    run("check --each clean.obj crossing.obj --results each.jsonl --quiet")
    run("report each.jsonl -o night.html --title Meshes")
    assert read_page("night.html")["title"] == "Meshes" and read_texts("night.html", "names") == ["clean.obj", "crossing.obj"]
    for name, there in (("seconds", True), ("pairs", True), ("depth", True), ("events", False), ("crossing_frames", False)):
        assert (read_array("night.html", name) is not None) == there


# ---- a night that is not done


def test_missing_jobs_are_listed():
    answer = run("report shard-1.jsonl -o night.html", code=1)
    assert "7 jobs: 2 clean, 1 with intersections, 1 failed, 3 not done\n" in answer.out
    assert answer.error == "cscd: 3 of 7 jobs are not done: 2, 4, 6; is a shard not named, or still running?\n"
    assert read_page("night.html")["missing"] == "2, 4, 6" and read_texts("night.html", "names") == names(2, 4, 6)
    assert list(read_array("night.html", "outcome")) == [IS_CLEAN, MISSING, FAILED, MISSING, CROSSES, MISSING, IS_CLEAN]


def test_running_shards_are_no_fault():
    """A shard is in the middle of a line, another has not begun."""
    text = Path("shard-2.jsonl").read_bytes()
    for cut in range(1, 900, 83):
        Path("shard-2.jsonl").write_bytes(text[:-cut])
        assert " not done\n" in run(NIGHT, code=1).out
    Path("shard-2.jsonl").write_text("")
    assert "1 failed, 3 not done\n" in run(NIGHT, code=1).out
    fails("report shard-2.jsonl -o night.html", "shard-2.jsonl: there are no results")


def test_junit_has_the_missing_jobs():
    run("report shard-1.jsonl -o night.html --junit night.xml --quiet", code=1)
    (suite,) = ElementTree.parse("night.xml").iter("testsuite")
    assert [suite.get(key) for key in ("tests", "failures", "errors")] == ["7", "1", "4"]
    missing = {case.get("name") for case in suite.iter("testcase") if len(case) and case[0].get("message") == "not done"}
    assert missing == {"job 2", "job 4", "job 6"}
    usage_error("report shard-1.jsonl -o night.html --junit shard-1.jsonl", "--junit", "would overwrite")
    usage_error("report fold.json -o night.html --junit night.xml", "--junit")


# ---- what is refused


def test_double_and_foreign_jobs_are_named():
    Path("night.html").write_text("old")
    fails("report shard-1.jsonl shard-1.jsonl -o night.html", "is named twice")
    Path("other.jsonl").write_text(Path("shard-1.jsonl").read_text().splitlines()[0] + "\n")
    fails("report shard-1.jsonl other.jsonl -o night.html", "shard-1.jsonl as well")
    text = Path("shard-2.jsonl").read_text()
    own = text.split('"list":"')[1][:16]
    Path("other.jsonl").write_text(text.replace(own, own[1:] + ("1" if own[0] == "0" else "0")))
    fails("report shard-1.jsonl other.jsonl -o night.html", "other.jsonl:1: these are results of another list")
    Path("other.jsonl").write_text('{"a": 1}\n')
    fails("report shard-1.jsonl other.jsonl -o night.html", "other.jsonl:1: this is no line of results")
    assert Path("night.html").read_text() == "old"


def test_results_and_summaries_are_told_apart():
    """Content decides, and the name where there is none."""
    usage_error("report fold.json shard-1.jsonl -o night.html", "shard-1.jsonl' has results of jobs and '", "fold.json' has not")
    shutil.copy("shard-1.jsonl", "renamed.txt")
    usage_error("report renamed.txt fold.json -o night.html", "renamed.txt' has results of jobs")
    run("report renamed.txt shard-2.jsonl -o night.html", code=1)
    run("report fold.json -o night.html")
    run("replay fold.obj fold.pc2 --shard 1/1 --results fold.shard --quiet")
    usage_error("report fold.shard -o night.html", "fold.shard' is a shard of one recording")
    fails("report /nowhere/x.jsonl -o night.html", "/nowhere/x.jsonl: cannot open")


def test_a_full_disk_leaves_nothing():
    fails("report shard-1.jsonl shard-2.jsonl -o /dev/full", "/dev/full", "No space left")
    Path("night.html").write_text("old")
    fails(f"{NIGHT} --junit /dev/full", "/dev/full", "No space left")
    assert Path("night.html").read_text() == "old"
    fails("report shard-1.jsonl -o /nowhere/a.html", "/nowhere/a.html", "cannot write")


def test_jobs_name_their_pages():
    """A job that failed has no link."""
    Path("pages").mkdir()
    write_list("linked-jobs.jsonl", {"model": "fold.obj", "frames": "fold.pc2", "outputs": {"report": "pages/a b.html"}},
               {"model": "fold.obj", "frames": "none.pc2", "outputs": {"report": "b.html"}})
    run("replay --list linked-jobs.jsonl --results linked.jsonl --quiet", code=1)
    run("report linked.jsonl -o night.html", code=1)
    assert read_texts("night.html", "links") == ["pages/a b.html", ""]
