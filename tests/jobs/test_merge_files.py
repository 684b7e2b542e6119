"""The files of `cscd merge`: pipes, more than the system opens at once, and a process that is killed at any moment."""
import os
import resource
import shlex
import signal
import subprocess
import time
from pathlib import Path

import pytest

from support.tool.running import command, fails, finish, run, start, write_list

SHARDS, JOBS = 60, 1200
FILES = [f"shard-{i:02}.jsonl" for i in range(SHARDS)]


@pytest.fixture(autouse=True)
def files(own_folder):
    """Shards as `check` writes them: job j is in shard j modulo their number."""
    for i, name in enumerate(FILES):
        write_list(name, *({"list": "0123456789abcdef", "jobs": JOBS, "job": job, "result": "clean", "found": False,
                            "name": f"job {job}", "error": None} for job in range(i + 1, JOBS + 1, SHARDS)))


@pytest.fixture
def whole(files):
    run("merge -o whole.jsonl", *FILES)
    return Path("whole.jsonl").read_text()


# ---- what is read


def test_more_files_than_may_be_open(whole):
    """Some files are closed and opened again when all of them are too many."""
    def limit():
        resource.setrlimit(resource.RLIMIT_NOFILE, (20, 20))

    run("merge -o merged.jsonl", *FILES, preexec_fn=limit)
    assert Path("merged.jsonl").read_text() == whole


def test_pipes_are_proven_and_not_written(whole):
    """The lines of a pipe are gone when they are to be written."""
    def merge_pipe(options):
        line = f"cat whole.jsonl | {shlex.join(command('merge /dev/stdin'))} {options}"
        ended = subprocess.run(line, shell=True, capture_output=True, text=True, check=False)
        return ended.returncode, ended.stdout, ended.stderr

    assert merge_pipe("") == (0, "1200 jobs: 1200 clean\n", "")
    assert merge_pipe("-o merged.jsonl") == (1, "", "cscd: /dev/stdin: is read twice, so it must be a file, and no pipe\n")
    assert not os.path.exists("merged.jsonl")


def test_a_damaged_count_is_no_line():
    """A list has ten million jobs at most; a damaged number asks for no memory."""
    line = Path(FILES[0]).read_text().splitlines()[0]
    Path("odd.jsonl").write_text(line.replace(f": {JOBS},", ": 4294967295,") + "\n")
    fails("merge odd.jsonl", "odd.jsonl:1: this is no line of results")


def test_foreign_results_are_compared_with_some():
    """The sentence names a file that has results."""
    Path("empty.jsonl").write_text("")
    Path("odd.jsonl").write_text(Path(FILES[1]).read_text().replace(f": {JOBS},", f": {JOBS + 1},"))
    fails(f"merge empty.jsonl {FILES[0]} odd.jsonl", "odd.jsonl:1: these are results of another list", "than those of", FILES[0])


# ---- what is written


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_a_merge_that_is_stopped_leaves_no_half(whole, number):
    """Whenever the signal comes, the output is whole or what it was before, and so says the sentence."""
    stopped = 0
    for i in range(20):
        Path("merged.jsonl").write_text("old\n")
        process = start("merge -o merged.jsonl", *FILES)
        time.sleep(0.0015 * i)
        process.send_signal(number)
        code = 128 + number if process.wait() != 0 else 0
        answer, found = finish(process, code), Path("merged.jsonl").read_text()
        stopped += code != 0
        assert found in ("old\n", whole)
        assert found == "old\n" or "interrupted; nothing was written" not in answer.error
    assert stopped > 0
