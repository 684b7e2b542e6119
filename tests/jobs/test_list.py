"""`check --list` and `replay --list`: each job is what its own command would be."""
from pathlib import Path

import pytest

from support.tool.reading import read_json
from support.tool.recordings import fold
from support.tool.running import CLEAN, DAMAGED, SLOW_MACHINE, fails, read_results, run, usage_error, write_list

FOLD = {"model": "fold.obj", "frames": "fold.pc2"}


@pytest.fixture(autouse=True)
def files(own_folder):
    scene = fold(8, 6, 6)
    scene.write_mesh("fold.obj")
    scene.write_cache("fold.pc2", 12)
    Path("clean.obj").write_text(CLEAN)
    Path("damaged.obj").write_text(DAMAGED)


# ---- what jobs are


def test_a_replay_of_a_list_is_a_replay():
    write_list("jobs.jsonl", {**FOLD, "name": "all", "outputs": {"contacts": "all.csv", "events": "all-events.csv"}},
               {**FOLD, "options": {"frames": "0:2"}})
    many = run("replay --list jobs.jsonl --results results.jsonl --fail-on contact", code=3)
    one = run("replay fold.obj fold.pc2 --contacts one.csv --events one-events.csv --fail-on contact", code=3)
    for listed, own in (("all.csv", "one.csv"), ("all-events.csv", "one-events.csv")):
        assert Path(listed).read_bytes() == Path(own).read_bytes()
    results = read_results("results.jsonl")
    assert [results[job]["frames"] for job in (1, 2)] == [12, 3] and len(results) == 2
    assert results[1]["name"] == "all" and results[1]["contacts"] > 0
    assert results[1]["answer"] == one.first_line and one.first_line in many.out


def test_a_job_that_fails_stops_no_other():
    write_list("jobs.jsonl", {"model": "damaged.obj"}, {"model": "clean.obj"}, {"model": "none.obj"},
               {"model": "clean.obj", "options": {"only": "Arm"}}, FOLD)
    answer = run("check --list jobs.jsonl --results results.jsonl --fail-on crossing", code=1)
    assert answer.error == "cscd: 3 of 5 recordings could not be checked\n"
    results = read_results("results.jsonl")
    assert [results[job]["result"] for job in range(1, 6)] == ["failed", "clean", "failed", "failed", "crossing"]
    for job, error in ((1, "face index 9 is out of range"), (3, "none.obj: cannot open"), (4, "there is no part 'Arm'")):
        assert error in results[job]["error"]
    assert results[5]["found"] is True and results[1]["frames"] is None


def test_a_check_of_a_list_is_a_check():
    """Its numbers are those that its own --json has."""
    write_list("jobs.jsonl", {**FOLD, "outputs": {"json": "pairs.json"}})
    run("check --list jobs.jsonl --results results.jsonl --quiet")
    run("check fold.obj fold.pc2 --json own.json")
    assert Path("own.json").read_bytes() == Path("pairs.json").read_bytes()
    root, line = read_json("own.json"), read_results("results.jsonl")[1]
    frames = root["frames"]
    assert len(frames) == 12 and line["crossing_pairs"] > 0 and line["events"] == len(root["events"])
    for key in ("crossing_pairs", "touching_pairs"):
        assert line[key] == sum(frame[key] for frame in frames)
    for key in ("crossing_faces", "depth"):
        assert line[key] == max(frame[key] or 0 for frame in frames)


@pytest.mark.parametrize("jobs, says", [
    ([{}, {"options": {"wled": "exact"}}], "jobs.jsonl:2: 'wled' is no option of check"),
    ([{"options": {"weld": "so"}}], "jobs.jsonl:1: --weld cannot be 'so'"),
    ([{"options": {"threads": 3}}], "jobs.jsonl:1: --threads is for the whole list"),
    ([{"outputs": {"json": "-"}}], "jobs.jsonl:1: --json: a job among many has no standard output"),
    ([{"options": {"allow-gaps": 1}}], "jobs.jsonl:1: --allow-gaps takes no value"),
    ([{"options": {"weld": True}}], "jobs.jsonl:1: --weld needs a value"),
    ([{"outputs": {"json": "a.json"}}, {}, {"options": {"csv": "a.json"}}],
     "jobs.jsonl:3: 'a.json' is written by line 1 as well"),
    ([{"outputs": {"json": "a//b.json", "csv": "/tmp/x.csv"}}, {"outputs": {"json": "./a/./b.json", "csv": "tmp/x.csv"}}],
     "jobs.jsonl:2: 'a/b.json' is written by line 1 as well"),
    ([{}, {"outputs": {"events": "r.jsonl"}}], "jobs.jsonl:2: 'r.jsonl' is the list itself or its file of results"),
])
def test_wrong_lists_are_refused(jobs, says):
    write_list("jobs.jsonl", *({"model": "clean.obj", **job} for job in jobs))
    fails("check --list jobs.jsonl --results ./r.jsonl", says, code=4)


def test_empty_lines_of_a_list_count():
    job = '{"model": "clean.obj", "outputs": {"json": "a.json"}}\n'
    Path("jobs.jsonl").write_text(f"{job}\n{job}")
    fails("check --list jobs.jsonl", "jobs.jsonl:3: 'a.json' is written by line 1 as well", code=4)


@pytest.mark.parametrize("line, says", [
    ("--list jobs.jsonl --json a.json", ["--json names one file, and each job"]),
    ("--list jobs.jsonl clean.obj", ["is no input; the list has the models"]),
    ("--list jobs.jsonl --results jobs.jsonl", ["--results", "would overwrite"]),
    ("--list jobs.jsonl --resume", ["--resume needs --results"]),
    ("--list jobs.jsonl --shard 4/3", ["--shard cannot be '4/3'"]),
    ("clean.obj --shard 1/3", ["--shard is for --list"]),
    ("clean.obj --results a.jsonl", ["--results is for --list"]),
])
def test_wrong_options_are_refused(line, says):
    write_list("jobs.jsonl", {"model": "clean.obj"})
    usage_error(f"check {line}", *says)


def test_results_need_a_place():
    write_list("jobs.jsonl", {"model": "clean.obj"})
    fails("check --list jobs.jsonl --results /nowhere/r.jsonl", "/nowhere/r.jsonl: cannot write", code=4)


def test_a_job_has_a_time_limit():
    """An interval of the sheet takes far less than the limit, and all of them far longer."""
    side = 20 if SLOW_MACHINE else 40
    scene = fold(side, side - 10, 2)
    scene.write_mesh("sheet.obj")
    scene.write_cache("sheet.pc2", 5000)
    write_list("jobs.jsonl", {"model": "sheet.obj", "frames": "sheet.pc2", "outputs": {"json": "part.json"}}, FOLD)
    run("replay --list jobs.jsonl --results results.jsonl --method brute --job-timeout 2 --threads 2", code=1)
    results = read_results("results.jsonl")
    assert results[1]["error"] == "it took longer than 2 s, which is its time limit" and results[2]["error"] is None
    root = read_json("part.json")  # what it had found until then is in its own file
    assert root["intervals"] != [] and root["summary"]["complete"] is False
