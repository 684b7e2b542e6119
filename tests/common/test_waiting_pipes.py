"""Pipes whose other side does not come: the first signal ends the wait of every command, whatever it waits for."""
import itertools
import os
import re
import shlex
import signal
import subprocess
import threading
import time
from pathlib import Path

import pytest

from support.tool.reading import read_json
from support.tool.recordings import tetrahedra
from support.tool.running import command, finish, start, wait_until, write_list

SECONDS = 60


def by_one_signal_after_the_other(*lines):
    """A case for each line."""
    return pytest.mark.parametrize("number, line", zip(itertools.cycle([signal.SIGHUP, signal.SIGINT, signal.SIGTERM]), lines))


@pytest.fixture(autouse=True)
def files(own_folder):
    scene = tetrahedra(8)
    scene.write_mesh("model.obj")
    scene.write_cache("frames.pc2")
    scene.write_sequence("walk_%03d.obj")
    os.mkfifo("pipe.obj")


def is_asleep(pid):
    """Are all threads of a process asleep that is the tool already? One that waits for another sleeps too, but that one does not.

    An emulator has its own name.
    """
    try:
        threads = [path.read_text() for path in Path(f"/proc/{pid}/task").glob("*/stat")]
    except FileNotFoundError:
        return False
    return threads != [] and all(re.search(r"\((cscd|qemu-.*)\) S ", text) for text in threads)


def catches(pid, number):
    """Has it a handler of its own for a signal?"""
    caught = re.search(r"SigCgt:\s*(\w+)", Path(f"/proc/{pid}/status").read_text())
    return bool(int(caught.group(1), 16) >> (number - 1) & 1)


def waits(process):
    """Waits until it has slept for some moments on end, as it does nowhere but at the pipe: all else takes a few milliseconds."""
    moments = 0

    def has_slept():
        nonlocal moments
        moments = moments + 1 if is_asleep(process.pid) else 0
        return moments >= 6

    wait_until(has_slept, process, SECONDS)


def is_ended(line, number, at_work=False):
    """A signal ends the tool, once it waits. at_work: with a handler of its own, to keep what it has found."""
    process = start(line)
    if at_work:
        wait_until(lambda: catches(process.pid, number), process, SECONDS)
    waits(process)
    process.send_signal(number)
    answer = finish(process, 128 + number)
    assert list(Path().glob(".cscd-output-*")) == []
    return answer


@by_one_signal_after_the_other(
    "check pipe.obj", "check model.obj frames.pc2 --parts pipe.obj", "check model.obj frames.pc2 --ignore pipe.obj",
    "check --list pipe.obj", "check --list list.jsonl", "check --each pipe.obj", "replay pipe.obj frames.pc2",
    "sense pipe.obj frames.pc2", "preprocess pipe.obj", "info pipe.obj", "render pipe.obj -o picture.png", "merge pipe.obj",
    "report pipe.obj -o page.html",
)
def test_a_signal_ends_the_wait_for_a_writer(number, line):
    write_list("list.jsonl", {"model": "pipe.obj"})
    is_ended(line, number)


@by_one_signal_after_the_other(
    "check model.obj frames.pc2 --events kept.csv --json pipe.json",
    "replay model.obj frames.pc2 --contacts kept.csv --json pipe.json",
    "replay model.obj frames.pc2 --json out.json --report pipe.html",
    "sense model.obj frames.pc2 --json out.json --csv pipe.csv",
    "preprocess model.obj -o plan.ply --report pipe.html",
    "info model.obj --json pipe.json",
    "check --each model.obj --json pipe.jsonl",
)
def test_a_signal_ends_the_wait_for_a_reader(number, line):
    os.mkfifo(line.split()[-1])
    is_ended(line, number)


def test_a_signal_ends_a_read():
    """The writer is there, and has not written all: the mesh that the pipe holds so far must not be taken for the whole."""
    writer = os.open("pipe.obj", os.O_RDWR | os.O_CLOEXEC)  # so that opening waits for nobody
    os.write(writer, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert "pipe.obj: cannot read: Interrupted" in is_ended("preprocess pipe.obj", signal.SIGTERM).error
    os.close(writer)


def test_late_bytes_are_read():
    """Whoever waits long for a writer, and for its bytes, reads all of them."""
    def write_late():
        text = Path("model.obj").read_text()
        time.sleep(0.2)
        with open("pipe.obj", "w") as pipe:
            pipe.write(text[:40])
            pipe.flush()
            time.sleep(0.2)
            pipe.write(text[40:])

    writer = threading.Thread(target=write_late)
    writer.start()
    assert "8 vertices, 8 triangles" in finish(start("preprocess pipe.obj -o late.ply --method single")).out
    writer.join()


@pytest.mark.parametrize("command_name, kept", [("check", "after 5 of 8 frames"), ("replay", "after 4 of 7 intervals")])
def test_frames_before_a_pipe_are_kept(command_name, kept):
    """What was found before the frame that did not come is kept.

    An emulator catches every signal, so that nobody sees whether the tool is at work.
    """
    os.unlink("walk_005.obj")
    os.mkfifo("walk_005.obj")
    line = f"{command_name} model.obj walk_%03d.obj --json out.json"
    error = is_ended(line, signal.SIGHUP, at_work="CSCD_EMULATED" not in os.environ).error
    assert f"interrupted {kept}" in error and len(read_json("out.json")["frames"]) == 5


def test_no_moment_is_too_early():
    """A signal may come just before a call that waits. Whenever it comes, it is heard."""
    for milliseconds in range(12):
        process = start("preprocess pipe.obj")
        time.sleep(0.001 * milliseconds)
        process.terminate()
        assert process.wait(SECONDS) == -signal.SIGTERM or process.returncode == 128 + signal.SIGTERM
        process.communicate()


@pytest.mark.parametrize("name", ["HUP", "INT", "TERM"])
def test_what_is_ignored_stays_ignored(name):
    """As nohup has it with SIGHUP, and a shell with SIGINT of what runs in its background."""
    line = shlex.join(command("preprocess pipe.obj -o kept.ply --method single"))
    process = subprocess.Popen(["sh", "-c", f"trap '' {name}; exec {line}"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    waits(process)
    for _ in range(5):
        process.send_signal(getattr(signal, f"SIG{name}"))
        time.sleep(0.02)
    subprocess.run(["timeout", "30", "sh", "-c", "cat model.obj >pipe.obj"], check=True)
    assert "8 vertices, 8 triangles" in finish(process).out
