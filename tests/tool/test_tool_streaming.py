"""When a replay reads its frames: before they are needed, and files that come late."""
import os
import signal
import threading
import time
from pathlib import Path

import pytest

from support.tool.recordings import fold, tetrahedra
from support.tool.running import cached_pages, drop_from_cache, expect_cached, fails, finish, run, start, wait_until

# ---- a cold disk


def test_the_disk_brings_the_next_frame():
    """Stops at a frame that is no mesh: the one behind it was asked of the disk before."""
    fold(60, 40, 6).write_sequence("cold_%04d.obj")
    Path("cold_0003.obj").write_text("nothing\n")
    dropped = drop_from_cache("cold_0004.obj")
    fails("replay cold_0000.obj cold_%04d.obj --quiet", "cold_0003.obj")
    if dropped:
        expect_cached("cold_0004.obj")


def test_the_disk_brings_no_frame_of_others():
    """No frame is brought that this machine does not need."""
    fold(60, 40, 6).write_sequence("own_%04d.obj")
    dropped = drop_from_cache("own_0004.obj")
    run("replay own_0000.obj own_%04d.obj --quiet --frames 0:3")
    if dropped:
        assert cached_pages("own_0004.obj")[0] == 0


# ---- late files


@pytest.fixture
def series():
    tetrahedra(6).write_sequence("late_%04d.obj")
    return "late_0000.obj late_%04d.obj"


def comes_late(name, seconds):
    """Takes a file away, and brings it back later."""
    os.rename(name, "hidden")
    threading.Timer(seconds, os.rename, ("hidden", name)).start()


def test_a_frame_that_comes_late_is_waited_for(series):
    expected = run(f"replay {series} --quiet --contacts -").out
    comes_late("late_0003.obj", 1.0)
    assert run(f"replay {series} --quiet --contacts - --wait-for-files 60").out == expected


def test_a_model_that_comes_late_is_waited_for(series):
    comes_late("late_0000.obj", 0.7)
    run("check late_0000.obj --quiet --wait-for-files 60")


def test_what_is_there_is_not_waited_for(series):
    """Waiting for each of the files would take an hour."""
    began = time.monotonic()
    run(f"replay {series} --quiet --wait-for-files 600")
    assert time.monotonic() - began < 60


def test_frames_are_read_on_a_thread_of_their_own(series):
    """While the main thread waits for the frame, whose file is still empty, another one tries to read it."""
    text = Path("late_0003.obj").read_text()
    Path("late_0003.obj").write_text("")
    process = start(f"replay {series} --quiet --threads 1 --wait-for-files 60")
    tasks = f"/proc/{process.pid}/task"
    if os.path.isdir(tasks):
        wait_until(lambda: len(os.listdir(tasks)) >= 2, process, seconds=20)
    Path("late_0003.obj").write_text(text)
    finish(process)


@pytest.mark.parametrize("options", ["", "--wait-for-files 0.3"])
def test_without_waiting_it_is_an_error(series, options):
    os.rename("late_0003.obj", "hidden")
    assert "late_0003" in run(f"replay {series} --quiet --contacts - {options}", code=1).error


@pytest.mark.parametrize("command_name, text", [
    ("replay", "interrupted after 2 of 5 intervals"), ("check", "interrupted after 3 of 6 frames"),
])
def test_an_interrupt_ends_the_wait(series, command_name, text):
    """Signals ever later, until the program has come so far that it waits. One that comes before it catches signals ends it."""
    Path("late_0003.obj").write_text("")  # it is there, and its content comes late
    for wait in (0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2, 6.4):
        process = start(f"{command_name} {series} --wait-for-files 60")
        time.sleep(wait)
        process.send_signal(signal.SIGINT)
        error = finish(process, code=130).error
        if text in error:
            break
    assert text in error
