"""`cscd merge`: shards together give what one run gives, and whatever is missing, there twice or foreign is named."""
import json
import os
import random
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from support.tool.reading import lines_of
from support.tool.recordings import fold
from support.tool.running import CLEAN, CROSSING, fails, limited_to, run, usage_error, write_list


@pytest.fixture(autouse=True)
def files(own_folder):
    """Jobs of several sizes and kinds, a few without a size; none fails."""
    Path("clean.obj").write_text(CLEAN)
    fold(8, 6, 6).write_mesh("open.obj")
    fold(8, 6, 6).write_mesh("closed.obj", 5)
    write_list("jobs.jsonl", *({"model": ("clean.obj", "open.obj", "closed.obj")[i % 3], "name": f"job {i + 1}",
                                **({"size": i * 37 % 50} if i % 3 else {})} for i in range(40)))


def shard(index):
    return Path(f"shard-{index}.jsonl")


def run_shards(count, options="", code=0):
    for i in range(1, count + 1):
        shard(i).unlink(missing_ok=True)
        run(f"check --list jobs.jsonl --results {shard(i)} --shard {i}/{count} --quiet {options}", code=code)


def merge(count, options="-o merged.jsonl", code=0):
    return run(f"merge {options}", *map(shard, range(1, count + 1)), code=code)


@pytest.fixture
def whole():
    """The lines of one run, in the order of the jobs."""
    run("check --list jobs.jsonl --results whole.jsonl --quiet --threads 1")
    return Path("whole.jsonl").read_text()


# ---- what merges


@pytest.mark.parametrize("count", [1, 3, 5, 7])
def test_shards_give_what_one_run_gives(whole, count):
    run_shards(count)
    merge(count)
    assert Path("merged.jsonl").read_text() == whole


def test_the_order_of_lines_does_not_matter(whole):
    run_shards(3)
    for i in (1, 2, 3):
        lines = shard(i).read_text().splitlines(keepends=True)
        shard(i).write_text("".join(random.Random(i).sample(lines, len(lines))))
    merge(3)
    assert Path("merged.jsonl").read_text() == whole


def test_exit_codes_are_those_of_one_run():
    run_shards(2, "--fail-on crossing", code=3)
    merge(2, code=3)
    os.unlink("merged.jsonl")
    assert merge(2, "", code=3).out == "40 jobs: 27 clean, 13 with intersections\n"
    assert not os.path.exists("merged.jsonl")


def test_a_dash_is_the_standard_output(whole):
    run_shards(1)
    assert merge(1, "-o -").out == whole


def test_junit_has_a_case_for_each_job():
    """A job that fails itself is an error, one that found something a failure."""
    Path("crossing.obj").write_text(CROSSING)
    write_list("few.jsonl", *({"model": f"{name}.obj", "name": f"<{i}>"} for i, name in enumerate(("clean", "crossing", "none"))))
    run("check --list few.jsonl --results results.jsonl --fail-on crossing --quiet", code=1)
    run("merge results.jsonl --junit night.xml", code=1)
    (suite,) = ElementTree.parse("night.xml").iter("testsuite")
    clean, crossing, failed = suite.iter("testcase")
    assert [suite.get(key) for key in ("tests", "failures", "errors")] == ["3", "1", "1"]
    assert [case.get("name") for case in (clean, crossing, failed)] == ["<0>", "<1>", "<2>"] and len(clean) == 0
    assert " cross" in crossing.find("failure").get("message")
    assert failed.find("error").get("message").endswith("none.obj: cannot open: No such file or directory")
    usage_error("merge results.jsonl --junit results.jsonl", "--junit", "would overwrite")
    usage_error("merge results.jsonl -o merged.jsonl --junit merged.jsonl", "--junit")


# ---- what does not


def refused(count, text):
    """Nothing is written, and what was there stays."""
    Path("merged.jsonl").write_text("old\n")
    answer = merge(count, code=1)
    assert answer.out == "" and text in answer.error
    assert Path("merged.jsonl").read_text() == "old\n"


def test_missing_jobs_are_named():
    run_shards(3)
    refused(2, "of 40 jobs are missing: ")
    for gone, text in (({10, 11, 12, 13}, "4 of 40 jobs are missing: 10 to 13; is a shard not named, or not done?"),
                       ({40}, "5 of 40 jobs are missing: 10 to 13, 40; ")):
        for i in (1, 2, 3):
            lines = shard(i).read_text().splitlines(keepends=True)
            shard(i).write_text("".join(line for line in lines if json.loads(line)["job"] not in gone))
        refused(3, text)
    shard(1).write_text("")
    refused(1, "there are no results")


def test_double_jobs_are_named():
    for source, target in ((2, 1), (2, 2)):
        run_shards(2)
        lines = lines_of(shard(source).read_text())
        with shard(target).open("a") as file:
            file.write(lines[0 if source != target else -1] + "\n")
        refused(2, f"{shard(target)} as well")
    fails("merge shard-1.jsonl shard-1.jsonl", "shard-1.jsonl is named twice")


def test_foreign_results_are_named():
    run_shards(2)
    os.unlink(shard(2))
    run("check --list jobs.jsonl --results shard-2.jsonl --shard 2/2 --quiet --ignore-rest")
    refused(2, "shard-2.jsonl:1: these are results of another list or of other options than those of ")
    shard(2).write_text('{"file": "a.obj"}\n')
    refused(2, "shard-2.jsonl:1: this is no line of results")
    fails("merge shard-1.jsonl /nowhere/x.jsonl", "/nowhere/x.jsonl: cannot open")
    usage_error("merge", "no results given")
    usage_error("merge shard-1.jsonl -o shard-1.jsonl", "-o", "would overwrite")


def test_damaged_lines_are_noticed():
    """Whatever byte of a line is missing or another, it is never taken for the whole: it is refused, or its job is missing."""
    run_shards(2)
    text = shard(2).read_bytes()
    last = text.rindex(b"\n", 0, -1) + 1  # where the last line begins
    for cut in [*range(len(text) - 1, last + 7, -7), *range(last + 7, last, -1)]:
        shard(2).write_bytes(text[:cut])
        refused(2, "1 of 40 jobs are missing: " if text[cut - 1 : cut] == b"\n" else "shard-2.jsonl:")
    shard(2).write_bytes(text.split(b"\n", 1)[1])
    refused(2, "1 of 40 jobs are missing: ")


def test_a_full_disk_leaves_nothing():
    run_shards(2)
    fails("merge shard-1.jsonl shard-2.jsonl -o /dev/full", "/dev/full", "No space left")
    Path("merged.jsonl").write_text("old\n")
    error = run("merge shard-1.jsonl shard-2.jsonl -o merged.jsonl", code=1, preexec_fn=limited_to(3000)).error
    assert "merged.jsonl: cannot write: File too large" in error
    assert Path("merged.jsonl").read_text() == "old\n" and list(Path().glob(".cscd-output*")) == []
