"""The file of `--results`: whatever it is, and whatever happens to it, nothing that was computed is lost without a word."""
import os
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

from support.tool.running import CLEAN, DAMAGED, command, fails, finish, run, start, usage_error, wait_until, write_list

RUN = "check --list jobs.jsonl --results results.jsonl"
RESULTS = Path("results.jsonl")


@pytest.fixture(autouse=True)
def files(own_folder):
    """Names fill the buffer of the standard output, so that some of it is printed before the end."""
    Path("clean.obj").write_text(CLEAN)
    Path("damaged.obj").write_text(DAMAGED)
    write_list("jobs.jsonl", {"model": "clean.obj", "name": f"{1:03000}"}, {"model": "damaged.obj"},
               {"model": "clean.obj", "name": f"{3:03000}"})


@pytest.fixture
def results(files):
    run(f"{RUN} --quiet --threads 1", code=1)
    return RESULTS.read_bytes()


# ---- what is there before


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&-", "<&- >&- 2>&-"])
def test_nothing_is_printed_into_the_results(results, closed):
    """The number of a closed standard file is that of the next file that is opened."""
    RESULTS.unlink()
    ended = subprocess.run(f"{shlex.join(command(RUN))} --threads 1 {closed}", shell=True, capture_output=True, check=False)
    assert ended.returncode == 1 and RESULTS.read_bytes() == results


def test_a_closed_output_is_an_error():
    line = f"{shlex.join(command('check --each clean.obj --json -'))} >&-"
    ended = subprocess.run(line, shell=True, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (4, "cscd: standard output: cannot write: Bad file descriptor\n")


def test_results_are_kept_in_a_file():
    os.mkfifo("pipe.jsonl")
    fails("check --list jobs.jsonl --results pipe.jsonl", "pipe.jsonl: is a pipe", code=4)
    fails("check --list jobs.jsonl --results pipe.jsonl --resume", "pipe.jsonl: is a pipe", code=4)
    fails("check --list jobs.jsonl --results .", "Is a directory", code=4)
    usage_error("check --list jobs.jsonl --results -", "--results -: results are kept in a file")
    run("check --list jobs.jsonl --results /dev/null --resume --quiet", code=1)


@pytest.mark.parametrize("text", ['{"model": "precious.obj"}', "notes", '{"list":"0000'])
def test_a_torn_line_of_something_else_stays(text):
    """Only what these results may have been torn from is cut off."""
    RESULTS.write_text(text)
    fails(f"{RUN} --resume", "results.jsonl:1: this line has no end, and is none of these results", code=4)
    assert RESULTS.read_text() == text


def test_a_torn_line_behind_results_stays(results):
    RESULTS.write_bytes(results + b"notes")
    fails(f"{RUN} --resume", "results.jsonl:4: this line has no end", code=4)


def test_zeros_at_the_end_are_cut_off(results):
    """A power cut may leave characters 0 where the last blocks of a file should be."""
    for kept in range(len(results) - 2, len(results) - 200, -39):
        RESULTS.write_bytes(results[:kept] + bytes(5000))
        run(f"{RUN} --resume --quiet", code=1)
        assert RESULTS.read_bytes() == results


def test_a_damaged_line_is_named(results):
    lines = results.splitlines(keepends=True)
    RESULTS.write_bytes(lines[0] + lines[1].replace(b"jobs", b"jibs", 1) + lines[2])
    fails(f"{RUN} --resume", "results.jsonl:2: this is no line of results", "delete the line if it is damaged", code=4)
    RESULTS.write_bytes(lines[0] + lines[2])
    run(f"{RUN} --resume", code=1)
    run("merge results.jsonl", code=1)


def test_json_of_a_part_is_refused():
    """Its lines would be those of the other meshes only."""
    usage_error("check --each clean.obj --results results.jsonl --resume --json all.jsonl",
                "--json would lack the meshes that --resume passes over", "cscd merge", "all.jsonl")


# ---- what happens to it while the jobs run


def replace():
    shutil.copy(RESULTS, "new")
    os.replace("new", RESULTS)


def append():
    with RESULTS.open("a") as file:
        file.write("\n")


@pytest.mark.parametrize("change, says", [
    (RESULTS.unlink, "removed or replaced"), (lambda: RESULTS.rename("old.jsonl"), "removed or replaced"),
    (replace, "removed or replaced"), (lambda: RESULTS.write_text(""), "changed by another process"),
    (append, "changed by another process"),
])
def test_a_file_that_is_changed_is_noticed(change, says):
    """The second job waits for a pipe meanwhile."""
    os.mkfifo("waits.obj")
    write_list("waiting.jsonl", {"model": "clean.obj"}, {"model": "waits.obj"}, {"model": "clean.obj"})
    process = start("check --list waiting.jsonl --results results.jsonl --threads 1 --quiet")
    wait_until(lambda: RESULTS.exists() and RESULTS.stat().st_size >= 100, process)
    change()
    Path("waits.obj").write_text(CLEAN)
    assert f"results.jsonl: was {says} while it was written" in finish(process, code=4).error
    assert change != RESULTS.unlink or not RESULTS.exists()


# ---- times


@pytest.mark.parametrize("inputs, outputs", [(1, 4102444800), (4102444800, 1)])
def test_times_of_files_decide_nothing(results, inputs, outputs):
    """Lines and answers are the same, whichever file is older: one is of 1970, and one of 2100."""
    def touch(time, *names):
        for name in names:
            os.utime(name, (time, time))

    RESULTS.write_bytes(b"".join(results.splitlines(keepends=True)[:2]))
    Path("merged.jsonl").write_text("old\n")
    touch(inputs, "clean.obj", "damaged.obj", "jobs.jsonl")
    touch(outputs, "results.jsonl", "merged.jsonl")
    assert "cscd: 2 of them were done before\n" in run(f"{RUN} --resume", code=1).error
    assert RESULTS.read_bytes() == results
    touch(outputs, "results.jsonl")
    run("merge results.jsonl -o merged.jsonl", code=1)
    assert Path("merged.jsonl").read_bytes() == results
