#!/usr/bin/env python3
"""The cost of a list of jobs on one machine and, from that, on a farm: prints tables for docs/about/measurements.md.

Usage: python3 benchmarks/farm.py [CSCD]

It measures the start of a shard by the length of its list, the work and the bytes of a job, and the merge. A model of four numbers
made of these must foretell runs with one and two processes, and two shards side by side. Then it gives the times of many machines.
"""
import json
import math
import os
import resource
import subprocess
import sys
import tempfile
import time

CSCD = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "cscd")
JOBS = 400
LINES = 100_000
ROUNDS = 3


def torus(path, rings, segments):
    """Writes a wavy torus of 2 * rings * segments triangles."""
    with open(path, "w", encoding="ascii") as out:
        for i in range(rings):
            for k in range(segments):
                a, b = 2.0 * math.pi * i / rings, 2.0 * math.pi * k / segments
                r = 0.3 + 0.05 * math.sin(5.0 * a) * math.cos(3.0 * b)
                out.write(f"v {(1.0 + r * math.cos(b)) * math.cos(a)} {(1.0 + r * math.cos(b)) * math.sin(a)} {r * math.sin(b)}\n")
        for i in range(rings):
            for k in range(segments):
                a, b = i * segments, (i + 1) % rings * segments
                n = (k + 1) % segments
                out.write(f"f {a + k + 1} {b + k + 1} {b + n + 1} {a + n + 1}\n")


def run(*commands):
    """Runs commands side by side; returns (seconds, seconds of processors)."""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    children = [subprocess.Popen([CSCD, *command], stdout=subprocess.DEVNULL) for command in commands]
    for child in children:
        assert child.wait() in (0, 3), child.args
    wall, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def least(make, rounds=ROUNDS):
    """Returns the least seconds of several rounds, and the least of their processors."""
    found = [make() for _ in range(rounds)]
    return min(wall for wall, _ in found), min(cores for _, cores in found)


def write_list(path, mesh, count):
    with open(path, "w", encoding="ascii") as out:
        for i in range(count):
            out.write(json.dumps({"name": f"shot {i:06}", "model": mesh}) + "\n")


def fresh(*paths):
    for path in paths:
        if os.path.exists(path):
            os.remove(path)


def check(listed, results, *options):
    fresh(results)
    return ["check", "--list", listed, "--results", results, "--quiet", *options]


def measure(folder):
    tiny, body = os.path.join(folder, "tiny.obj"), os.path.join(folder, "body.obj")
    with open(tiny, "w", encoding="ascii") as out:
        out.write("v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n")
    torus(body, 50, 51)
    short, jobs, lines = (os.path.join(folder, name) for name in ("short.jsonl", "jobs.jsonl", "lines.jsonl"))
    write_list(short, tiny, 1)
    write_list(jobs, body, JOBS)
    write_list(lines, tiny, LINES)
    results = os.path.join(folder, "r.jsonl")
    start = least(lambda: run(check(short, results)))[0]
    long_start = least(lambda: run(check(lines, results, "--shard", f"1/{LINES}")))[0]
    one, work = least(lambda: run(check(jobs, results, "--threads", "1")))
    two = least(lambda: run(check(jobs, results, "--threads", "2")))[0]
    other = results + "2"
    shards = least(lambda: run(check(jobs, results, "--threads", "1", "--shard", "1/2"),
                               check(jobs, other, "--threads", "1", "--shard", "2/2")))[0]
    parts = [os.path.join(folder, f"part-{i:03}.jsonl") for i in range(100)]
    for i, part in enumerate(parts):
        run(check(lines, part, "--shard", f"{i + 1}/100"))
    merge = least(lambda: run(["merge", *parts, "-o", os.path.join(folder, "night.jsonl"), "--quiet"]))[0]
    return {"start": start, "line": (long_start - start) / LINES, "job": (work - start) / JOBS,
            "bytes": os.path.getsize(body), "line_bytes": os.path.getsize(lines) / LINES, "merge": merge / LINES, "one": one, "two": two, "shards": shards}


def print_parts(m):
    print("| | |\n| --- | --- |")
    print(f"| start of a shard | {m['start'] * 1e3:.1f} ms |")
    print(f"| each line of its list | {m['line'] * 1e6:.2f} us, {m['line_bytes']:.0f} bytes read |")
    print(f"| a job, a mesh of 5,100 triangles | {m['job'] * 1e3:.2f} ms of a processor, {m['bytes'] / 1e6:.2f} MB read |")
    print(f"| a line in the merge | {m['merge'] * 1e6:.2f} us |")


def print_check(m):
    print(f"\n| {JOBS} jobs | model | measured |\n| --- | --- | --- |")
    for name, cores, found in (("one process", 1, m["one"]), ("two processes", 2, m["two"]), ("two shards", 2, m["shards"])):
        print(f"| {name} | {m['start'] + JOBS * m['job'] / cores:.2f} s | {found:.2f} s |")


def farm(m, jobs, nodes, bandwidth, cores=32):
    """Returns the seconds of processors, disk and merge, each node having a shard."""
    work = jobs * m["job"] / min(nodes * cores, jobs)
    read = jobs * m["bytes"] + nodes * jobs * m["line_bytes"]  # every shard reads the whole list
    return m["start"] + jobs * m["line"], work, read / bandwidth, jobs * m["merge"]


def print_farm(m):
    print("\n| jobs | nodes of 32 cores | start | processors | disk, 2 GB/s in all | merge | whole |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for jobs in (10_000, 100_000, 1_000_000):
        for nodes in (1, 10, 100, 1000):
            start, work, disk, merge = farm(m, jobs, nodes, 2e9)
            print(f"| {jobs:,} | {nodes:,} | {start:.2f} s | {work:.2f} s | {disk:.1f} s | {merge:.2f} s | "
                  f"{start + max(work, disk) + merge:.1f} s |")


def main():
    with tempfile.TemporaryDirectory() as folder:
        measured = measure(folder)
    print_parts(measured)
    print_check(measured)
    print_farm(measured)


if __name__ == "__main__":
    main()
