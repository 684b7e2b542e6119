"""Signals to processes of a list: to one of them, to all at once, and where nobody learns how a process ended."""
import os
import shlex
import signal
import subprocess
import time
from pathlib import Path

import pytest

from support.tool.reading import read_json, read_json_lines
from support.tool.recordings import fold
from support.tool.running import CLEAN, command, finish, run, start, wait_until, write_list

RESULTS = Path("results.jsonl")


@pytest.fixture(autouse=True)
def files(own_folder):
    Path("clean.obj").write_text(CLEAN)


def has_results():
    return RESULTS.exists() and RESULTS.stat().st_size > 0


def workers(pid):
    """The processes that a process has started."""
    return [int(worker) for worker in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def is_running(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.parametrize("number, pause", [(signal.SIGTERM, 0), (signal.SIGHUP, 0), (signal.SIGTERM, 0.001)])
def test_a_signal_to_all_processes_closes_all_files(number, pause):
    """As `timeout`, Slurm and Ctrl-C do it: every process gets the signal, and a worker is told to stop as well.

    It closes its files all the same, with what was found until then. The replays take far longer than a signal.
    """
    scene = fold(40, 30, 2)
    scene.write_mesh("sheet.obj")
    scene.write_cache("sheet.pc2", 5000)
    sheet = {"model": "sheet.obj", "frames": "sheet.pc2"}
    write_list("long.jsonl", *({**sheet, "outputs": {"json": f"part-{i}.json"}} for i in range(6)))
    line = "replay --list long.jsonl --results results.jsonl --threads 2 --quiet --method brute"
    process = start(line, start_new_session=True)
    wait_until(lambda: sum(path.stat().st_size > 0 for path in Path().glob(".cscd-output-*")) >= 2, process)
    os.killpg(process.pid, number)
    time.sleep(pause)
    finish(process, code=128 + number)
    with pytest.raises(ProcessLookupError):
        os.killpg(process.pid, 0)
    assert list(Path().glob(".cscd-output-*")) == [] and RESULTS.read_text() == ""
    assert [read_json(path)["summary"]["complete"] for path in Path().glob("part-*.json")] == [False, False]


@pytest.fixture
def waiting_list():
    """The second job waits for a pipe."""
    os.mkfifo("waits.obj")
    write_list("waiting.jsonl", {"model": "clean.obj"}, {"model": "waits.obj"}, {"model": "clean.obj"})
    return "check --list waiting.jsonl --results results.jsonl --threads 1"


def test_a_worker_that_is_told_to_stop_fails_no_job(waiting_list):
    """From outside, and however often: it gives its job up, though a pipe lets it wait.

    Another goes on with it: if none did, nobody would read the pipe.
    """
    process = start(waiting_list)
    wait_until(has_results, process)
    (worker,) = workers(process.pid)
    for _ in range(3):
        if is_running(worker):
            os.kill(worker, signal.SIGTERM)
        time.sleep(0.05)
    wait_until(lambda: not is_running(worker), process, seconds=30)
    subprocess.run(["timeout", "30", "sh", "-c", "cat clean.obj >waits.obj"], check=True)
    assert "3 recordings: 3 clean\n" in finish(process).out


def test_a_process_that_dies_is_named_everywhere(waiting_list):
    """Some programs ignore SIGCHLD, and what they start inherits that."""
    line = f"trap '' CHLD; exec {shlex.join(command(waiting_list))} --quiet"
    process = subprocess.Popen(["sh", "-c", line], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    wait_until(has_results, process)

    def ends():
        """Kills the worker that waits for the pipe; one that dies before it has begun with that has a successor."""
        for worker in workers(process.pid) if process.poll() is None else []:
            os.kill(worker, signal.SIGKILL)
        time.sleep(0.05)
        return process.poll() is not None

    wait_until(ends, seconds=30)
    assert "its process was killed by signal 9" in finish(process, code=1).error


def test_odd_names_take_one_line():
    """One line for people each, whatever a name is; results have it as it is."""
    write_list("odd.jsonl", {"model": "clean.obj", "name": "a\nb\x1b[2J\x7f"})
    assert run("check --list odd.jsonl --results results.jsonl").out.startswith("a?b?[2J?: Clean")
    assert [line["name"] for line in read_json_lines(RESULTS)] == ["a\nb\x1b[2J\x7f"]
