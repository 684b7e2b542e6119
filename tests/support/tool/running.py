"""Runs the built tool as a user would: a command line in; the exit code and both outputs out. Lists of jobs."""
import ctypes
import json
import mmap
import os
import resource
import shlex
import signal
import subprocess
import time
from pathlib import Path
from typing import NamedTuple

from support.tool.reading import read_json_lines

# With sanitizers, or in an emulator, programs take many times as long: tests repeat less.
SLOW_MACHINE = "CSCD_RUNNER" in os.environ or os.path.basename(os.path.dirname(os.environ["CSCD_TOOL"])) in ("sanitize", "tsan")

# The tool runs on Windows, or under wine.
WINDOWS = os.environ["CSCD_TOOL"].endswith(".exe")

# Whoever runs the tests in the background, or by nohup, ignores some of these, and the tool would, too.
for interrupt in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    if signal.getsignal(interrupt) == signal.SIG_IGN:
        signal.signal(interrupt, signal.SIG_DFL)


class Run(NamedTuple):
    """What a run has left; code: 128 + its number when a signal ended it."""

    code: int
    out: str
    error: str

    @property
    def first_line(self):
        return self.out.split("\n")[0]


def model_program(name, *words):
    """The words that start a program of models/, which CSCD_RUNNER starts, too."""
    return [*shlex.split(os.environ.get("CSCD_RUNNER", "")), os.path.join(os.environ["CSCD_MODELS"], name), *map(str, words)]


def command(line, *words):
    """The words of a command line as in a shell, and words behind it.

    CSCD_TOOL names the tool, and CSCD_RUNNER what starts it, such as wine.
    """
    return [*shlex.split(os.environ.get("CSCD_RUNNER", "")), os.environ["CSCD_TOOL"], *shlex.split(line), *map(str, words)]


def start(line, *words, **options):
    """Starts the tool; options are those of Popen."""
    return subprocess.Popen(command(line, *words), **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options})


def finish(process, code=0):
    """Waits for a tool that has been started, and expects its exit code."""
    outputs = process.communicate(timeout=300)
    out, error = ((text or b"").decode("utf-8", "surrogateescape").replace("\r\n", "\n") for text in outputs)
    run_of = Run(process.returncode if process.returncode >= 0 else 128 - process.returncode, out, error)
    assert run_of.code == code, f"expected exit code {code}, but {run_of.code}\n{out}\n{error}"
    return run_of


def run(line, *words, code=0, **options):
    """Runs the tool to its end, and expects its exit code."""
    return finish(start(line, *words, **options), code)


def fails(line, *says, code=1, **options):
    """Runs the tool, which must fail by one line that begins with `cscd: ` and says all of this."""
    error = run(line, code=code, **options).error
    assert error.startswith("cscd: ") and error.count("\n") == (2 if code == 2 else 1), error
    assert code != 2 or "--help'" in error, error
    for part in says:
        assert str(part) in error


def usage_error(line, *says, **options):
    """Runs the tool, which must refuse its command line, say all of this, and point to --help."""
    fails(line, *says, code=2, **options)


def limited_to(size):
    """For preexec_fn: no file may have more bytes, as by ulimit -f. The signal of that must not end the tool."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def wait_until(condition, process=None, seconds=120):
    """Waits until something holds; the test fails when that takes too long, or the process that should bring it about ends."""
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit and (process is None or process.poll() is None), "what was waited for has not come"
        time.sleep(0.002)


def peak_kib(line):
    """Runs the tool quietly and returns the most memory that was resident.

    A process starts as a copy of the one that starts it, whose memory counts: that one is GNU time, smaller than any tool.
    """
    ended = subprocess.run(["/usr/bin/time", "--format=%M", *command(line)], capture_output=True, text=True, check=True)
    return int(ended.stderr)


# ---- lists of jobs, and their results

SQUARE = "v 0 0 0\nv 4 0 0\nv 0 4 0\n"
CLEAN = f"{SQUARE}f 1 2 3\n"
CROSSING = f"{SQUARE}v 1 1 -1\nv 1 1 1\nv 2 1 1\nf 1 2 3\nf 4 5 6\n"
DAMAGED = "v 0 0 0\nf 1 2 9\n"


def write_list(path, *jobs):
    """Writes a line for each job, as JSON."""
    Path(path).write_text("".join(json.dumps(job) + "\n" for job in jobs), encoding="utf-8")


def read_results(path):
    """The lines of a file of results by their jobs, none of which is there twice."""
    lines = read_json_lines(path)
    results = {line["job"]: line for line in lines}
    assert len(results) == len(lines)
    return results


# ---- which files the system has in memory


def cached_pages(path):
    """How many pages of a file are in memory, and how many it has."""
    pages = -(-os.path.getsize(path) // mmap.PAGESIZE)
    libc, found = ctypes.CDLL(None, use_errno=True), (ctypes.c_ubyte * pages)()
    with open(path, "r+b") as file, mmap.mmap(file.fileno(), 0) as memory:
        view = ctypes.c_char.from_buffer(memory)
        status = libc.mincore(ctypes.c_void_p(ctypes.addressof(view)), ctypes.c_size_t(len(memory)), found)
        del view
    assert status == 0, os.strerror(ctypes.get_errno())
    return sum(page & 1 for page in found), pages


def drop_from_cache(path):
    """Takes a file out of memory; returns whether the system did so."""
    with open(path, "rb") as file:
        os.fsync(file.fileno())
        os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)
    return cached_pages(path)[0] == 0


def expect_cached(path):
    """Waits until all of a file is in memory."""
    def is_there():
        found, pages = cached_pages(path)
        return found == pages

    wait_until(is_there, seconds=10)
