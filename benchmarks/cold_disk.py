#!/usr/bin/env python3
"""The speed at which a replay reads from a cold disk, compared with dd: prints a table for docs/about/measurements.md. Linux, as root.

Usage: python3 benchmarks/cold_disk.py [CSCD]

A recording is read by dd and replayed, each with nothing of it in memory, at the speed of the disk and held down to several speeds.
Frames are read and parsed on a thread of their own. So a replay should take as long as the longer one of two things: reading as dd does,
and the same replay with all frames in memory; that is `bound` in the table.
"""
import contextlib
import math
import os
import struct
import subprocess
import sys
import tempfile
import time

CSCD = os.path.realpath(sys.argv[1] if len(sys.argv) > 1 else "cscd")
FRAMES = 120
RINGS, SEGMENTS = 300, 150
SPEEDS = (None, 100, 50, 25)  # MB/s; None: what the disk gives


def torus(frame):
    """Returns the vertices of a torus that turns, and breathes in waves."""
    points = []
    for i in range(RINGS):
        a = 2.0 * math.pi * i / RINGS + 0.01 * frame
        for k in range(SEGMENTS):
            b = 2.0 * math.pi * k / SEGMENTS
            r = 0.3 + 0.02 * math.sin(5.0 * a + 0.1 * frame)
            points.append(((1.0 + r * math.cos(b)) * math.cos(a), (1.0 + r * math.cos(b)) * math.sin(a), r * math.sin(b)))
    return points


def faces():
    for i in range(RINGS):
        for k in range(SEGMENTS):
            a, b, n = i * SEGMENTS, (i + 1) % RINGS * SEGMENTS, (k + 1) % SEGMENTS
            yield f"f {a + k + 1} {b + k + 1} {b + n + 1} {a + n + 1}\n"


def write_mesh(path, points):
    with open(path, "w", encoding="ascii") as out:
        out.writelines("v %.9g %.9g %.9g\n" % point for point in points)
        out.writelines(faces())


def write_recordings(folder):
    """Writes the same frames as a point cache and as a mesh each; returns {name: (words for the tool, files)}."""
    cache, pattern = os.path.join(folder, "torus.pc2"), os.path.join(folder, "torus_%03d.obj")
    with open(cache, "wb") as out:
        out.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, RINGS * SEGMENTS, 0.0, 1.0, FRAMES))
        for frame in range(FRAMES):
            points = torus(frame)
            out.write(struct.pack(f"<{3 * len(points)}f", *(x for point in points for x in point)))
            write_mesh(pattern % frame, points)
    meshes = [pattern % frame for frame in range(FRAMES)]
    return {"one PC2 file": ([meshes[0], cache], [meshes[0], cache]), "an OBJ file a frame": ([meshes[0], pattern], meshes)}


@contextlib.contextmanager
def disk_speed(folder, speed):
    """Makes a control group whose processes read this number of MB/s from the disk of the folder; yields its list of tasks."""
    if speed is None:
        yield None
        return
    group = tempfile.mkdtemp(prefix="cscd-blkio-")
    subprocess.run(["mount", "-t", "cgroup", "-o", "blkio", "none", group], check=True)
    own = os.path.join(group, "cscd_cold_disk")
    try:
        os.makedirs(own, exist_ok=True)
        device = os.stat(folder).st_dev
        with open(os.path.join(own, "blkio.throttle.read_bps_device"), "w", encoding="ascii") as out:
            out.write(f"{os.major(device)}:{os.minor(device)} {speed * 1_000_000}\n")
        yield os.path.join(own, "tasks")
    finally:
        os.rmdir(own)
        subprocess.run(["umount", group], check=True)
        os.rmdir(group)


def seconds(commands, tasks, cold):
    """Runs commands one after the other, and returns how long they take."""
    if cold:
        os.sync()
        with open("/proc/sys/vm/drop_caches", "w", encoding="ascii") as out:
            out.write("3\n")
    subprocess.run([CSCD, "--version"], stdout=subprocess.DEVNULL, check=True)  # the program itself is not what is measured

    def enter():
        if tasks is not None:
            with open(tasks, "w", encoding="ascii") as out:
                out.write(str(os.getpid()))

    begin = time.perf_counter()
    for command in commands:
        subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True, preexec_fn=enter)
    return time.perf_counter() - begin


def main():
    with tempfile.TemporaryDirectory(dir=os.path.dirname(CSCD)) as folder:
        for name, (words, files) in write_recordings(folder).items():
            size = sum(os.path.getsize(path) for path in files) / 1e6
            replay = [[CSCD, "replay", *words, "--method", "none", "--no-check", "--quiet", "--threads", "1"]]
            dd = [["sh", "-c", 'for file; do dd if="$file" of=/dev/null bs=1M; done', "sh", *files]]
            warm = min(seconds(replay, None, False) for _ in range(3))
            print(f"\n{name}: {FRAMES} frames, {size:.0f} MB; in memory the replay takes {warm:.2f} s\n")
            print("    disk, MB/s       dd, s    replay, s     bound, s    over the bound")
            for speed in SPEEDS:
                with disk_speed(folder, speed) as tasks:
                    read = min(seconds(dd, tasks, True) for _ in range(2))
                    cold = min(seconds(replay, tasks, True) for _ in range(2))
                bound = max(read, warm)
                print(f"    {speed or 'its own':>10}    {read:8.2f}     {cold:8.2f}     {bound:8.2f}     {100 * (cold / bound - 1):8.0f} %",
                      flush=True)


if __name__ == "__main__":
    main()
