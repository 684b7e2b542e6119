"""What a replay reads, and when: of a large recording its own frames only, and files that come late."""
import os
import shlex
import signal
import struct
import subprocess
import threading
import time
from pathlib import Path

import pytest

from support.tool import page_cache
from support.tool.recordings import fold, tetrahedra
from support.tool.running import SANITIZED, command, fails, finish, peak_kib, run, start, wait_until

# ---- a large recording

CHUNK, HEADER = 32, 32
FRAME = 121 * 81 * 12
# A point cache of 100 GB that takes no room: all frames are holes but those of one shard of 32 intervals, in the middle.
CHUNKS = (100 * 1000**3 // FRAME - 1) // CHUNK
SHARD = f"--shard {CHUNKS // 2 + 1}/{CHUNKS}"
# What an allocator may keep, and what one run has more than another.
ROOM_KIB = 16 * 1024


@pytest.fixture(scope="module")
def large(tmp_path_factory):
    """A small recording, and its frames within a large one."""
    folder = tmp_path_factory.mktemp("large")
    scene = fold(120, 80, 3)
    scene.write_mesh(folder / "wide.obj")
    scene.write_cache(folder / "small.pc2", CHUNK + 1)
    small = (folder / "small.pc2").read_bytes()
    with open(folder / "large.pc2", "wb") as file:
        file.write(small[: HEADER - 4] + struct.pack("<i", CHUNKS * CHUNK + 1))
        file.seek(HEADER + CHUNKS // 2 * CHUNK * FRAME)
        file.write(small[HEADER:])
        file.truncate(HEADER + (CHUNKS * CHUNK + 1) * FRAME)
    return folder


def bytes_read(line):
    """The bytes that a command reads: Linux counts them, those of ended children too."""
    script = f"{shlex.join(command(line))} && sed -n 's/rchar: //p' /proc/$$/io"
    return int(subprocess.run(["sh", "-c", script], check=True, capture_output=True, text=True).stdout)


@pytest.mark.skipif(SANITIZED or not os.access("/proc/self/io", os.R_OK), reason="nobody counts here")
def test_a_shard_of_100_gb_reads_its_own_frames(large):
    files = sum(os.path.getsize(large / name) for name in ("wide.obj", "small.pc2"))
    least = bytes_read(f"replay {large}/wide.obj {large}/small.pc2 --quiet --no-depths --results small.shard")
    most = bytes_read(f"replay {large}/wide.obj {large}/large.pc2 --quiet --no-depths {SHARD} --results large.shard")
    assert files <= least <= files + 2 * FRAME  # each frame once
    assert (CHUNK + 1) * FRAME <= most <= least + FRAME // 2


@pytest.mark.skipif(SANITIZED, reason="nothing to measure")
def test_its_memory_is_that_of_an_interval(large):
    small = peak_kib(f"replay {large}/wide.obj {large}/small.pc2 --quiet --no-depths")
    numbers = CHUNKS * CHUNK * 4 // 1024  # a frame's number takes 4 bytes
    assert peak_kib(f"replay {large}/wide.obj {large}/large.pc2 --quiet --no-depths {SHARD} --results memory.shard") \
        <= small + numbers + ROOM_KIB


@pytest.mark.skipif(SANITIZED, reason="nothing to measure")
def test_frames_are_not_kept(large):
    """Eight times as many frames need no more memory: they would take half as much again as the room."""
    small = (large / "small.pc2").read_bytes()
    for name, count in (("few.pc2", CHUNK + 1), ("many.pc2", 8 * CHUNK + 1)):
        Path(name).write_bytes(small[: HEADER - 4] + struct.pack("<i", count) + count * small[HEADER : HEADER + FRAME])
    few, many = (peak_kib(f"replay {large}/wide.obj {name} --quiet --no-check") for name in ("few.pc2", "many.pc2"))
    assert many <= few + ROOM_KIB


# ---- a cold disk


def test_the_disk_brings_the_next_frame():
    """Stops at a frame that is no mesh: the one behind it was asked of the disk before."""
    fold(60, 40, 6).write_sequence("cold_%04d.obj")
    Path("cold_0003.obj").write_text("nothing\n")
    dropped = page_cache.drop("cold_0004.obj")
    fails("replay cold_0000.obj cold_%04d.obj --quiet", "cold_0003.obj")
    if dropped:
        page_cache.expect_cached("cold_0004.obj")


def test_the_disk_brings_no_frame_of_others():
    """No frame is brought that this machine does not need."""
    fold(60, 40, 6).write_sequence("own_%04d.obj")
    dropped = page_cache.drop("own_0004.obj")
    run("replay own_0000.obj own_%04d.obj --quiet --frames 0:3")
    if dropped:
        assert page_cache.cached_pages("own_0004.obj")[0] == 0


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
