"""Results of a list survive whatever ends the program, and the next run goes on with them."""
import os
import time
from pathlib import Path

import pytest

from support.tool.running import (
    CLEAN, CROSSING, DAMAGED, fails, finish, limited_to, read_results, run, start, wait_until, write_list,
)

RUN = "check --list small.jsonl --results results.jsonl"
RESULTS = Path("results.jsonl")


@pytest.fixture(autouse=True)
def files(own_folder):
    """A list of twelve jobs, two of which fail."""
    Path("clean.obj").write_text(CLEAN)
    Path("damaged.obj").write_text(DAMAGED)
    models = ["damaged.obj" if i in (4, 8) else "clean.obj" for i in range(1, 13)]
    write_list("small.jsonl", *({"model": model, "name": f"job {i}"} for i, model in enumerate(models, 1)))


def results_are_whole():
    results = read_results(RESULTS)
    assert sorted(results) == list(range(1, 13))
    for job, line in results.items():
        assert (line["name"], line["result"]) == (f"job {job}", "failed" if job in (4, 8) else "clean")


def is_resumed():
    assert "12 recordings: 10 clean, 2 failed\n" in run(f"{RUN} --resume", code=1).out
    results_are_whole()


def test_a_program_that_is_killed_is_resumed():
    """It leaves what it has written, which may end in the middle of a line, at any byte."""
    run(f"{RUN} --quiet", code=1)
    whole = RESULTS.read_bytes()
    assert len(whole) > 2500
    for size in [*range(0, 600, 41), *range(600, 2500, 307)]:
        RESULTS.write_bytes(whole[:size])
        is_resumed()


@pytest.mark.parametrize("size", [*range(0, 600, 83), *range(600, 2500, 511)])
def test_a_limit_of_sizes_keeps_whole_lines(size):
    error = run(f"{RUN} --quiet", code=4, preexec_fn=limited_to(size)).error
    assert "results.jsonl: cannot write: File too large: a limit" in error
    left = RESULTS.read_bytes()
    assert len(left) <= size and (left == b"" or left.endswith(b"\n"))
    is_resumed()


def test_kills_at_any_time_lose_nothing():
    """Each run is killed later than the one before, and each goes on with what is there."""
    for i in range(30):
        process = start(f"{RUN} --resume --threads 2")
        time.sleep(0.0004 * i)
        process.kill()
        process.communicate()
    is_resumed()


def test_results_are_not_overwritten():
    run(RUN, code=1)
    fails(RUN, "results.jsonl: holds results already; --resume", code=4)
    fails(f"{RUN} --resume --fail-on crossing", "results.jsonl:1:", "results of another list or of other options", code=4)
    fails("replay --list small.jsonl --results results.jsonl --resume", "results.jsonl:1:", "another list", code=4)
    write_list("other.jsonl", {"model": "clean.obj"})
    fails("check --list other.jsonl --results results.jsonl --resume", "results.jsonl:1:", "has the list been edited?", code=4)
    results_are_whole()
    Path("notes.jsonl").write_text("my notes\n")
    fails("check --list small.jsonl --results notes.jsonl --resume", "notes.jsonl:1: this is no line of results", code=4)
    assert Path("notes.jsonl").read_text() == "my notes\n"


def test_what_was_found_is_remembered():
    """A rule that a job has failed before fails the run that goes on, too."""
    Path("crossing.obj").write_text(CROSSING)
    write_list("jobs.jsonl", {"model": "crossing.obj"})
    line = "check --list jobs.jsonl --results results.jsonl --fail-on crossing"
    run(line, code=3)
    run(f"{line} --resume", code=3)


def test_failed_jobs_run_again():
    """Only those that failed, and their last lines count."""
    run(RUN, code=1)
    Path("damaged.obj").write_text(CLEAN)
    run(f"{RUN} --resume", code=1)
    run(f"{RUN} --resume=failed")
    run(f"{RUN} --resume=failed")
    run("merge results.jsonl -o merged.jsonl")
    assert '"failed"' not in Path("merged.jsonl").read_text()


def test_two_processes_do_not_share_a_file():
    os.mkfifo("waits.obj")
    write_list("jobs.jsonl", {"model": "waits.obj"})
    line = "check --list jobs.jsonl --results results.jsonl"
    first = start(line)
    wait_until(RESULTS.exists, first)
    time.sleep(0.1)  # for the lock, which comes next
    fails(f"{line} --resume --job-timeout 5", "results.jsonl: another process writes its results here", code=4)
    Path("waits.obj").write_text(CLEAN)
    finish(first)
