"""A shard of a recording of 100 GB reads its own frames alone, in the memory of an interval. Sanitizers have their own memory."""
import os
import shlex
import struct
import subprocess
from pathlib import Path

import pytest

from support.tool.recordings import fold
from support.tool.running import command, peak_kib

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


@pytest.mark.skipif(not os.access("/proc/self/io", os.R_OK), reason="nobody counts here")
def test_a_shard_of_100_gb_reads_its_own_frames(large):
    files = sum(os.path.getsize(large / name) for name in ("wide.obj", "small.pc2"))
    least = bytes_read(f"replay {large}/wide.obj {large}/small.pc2 --quiet --no-depths --results small.shard")
    most = bytes_read(f"replay {large}/wide.obj {large}/large.pc2 --quiet --no-depths {SHARD} --results large.shard")
    assert files <= least <= files + 2 * FRAME  # each frame once
    assert (CHUNK + 1) * FRAME <= most <= least + FRAME // 2


def test_its_memory_is_that_of_an_interval(large):
    small = peak_kib(f"replay {large}/wide.obj {large}/small.pc2 --quiet --no-depths")
    numbers = CHUNKS * CHUNK * 4 // 1024  # a frame's number takes 4 bytes
    assert peak_kib(f"replay {large}/wide.obj {large}/large.pc2 --quiet --no-depths {SHARD} --results memory.shard") \
        <= small + numbers + ROOM_KIB


def test_memory_does_not_grow_with_the_frames():
    """Ten times the frames need no more memory, up to what the measurement itself can tell."""
    scene = fold(70, 40, 16)
    scene.write_mesh("large.obj")
    scene.write_cache("short.pc2", 30)
    scene.write_cache("long.pc2", 300)
    at_30, at_300 = (min(peak_kib(f"replay large.obj {name} --quiet --contacts out.csv --json out.json") for _ in range(3))
                     for name in ("short.pc2", "long.pc2"))
    # The 270 further frames hold about 9,000 KiB, and the answers about them, which are kept, about 900. The system itself counts
    # up to 600 KiB more or less of the shared libraries from run to run.
    assert at_300 <= at_30 + at_30 / 50 + 1536
