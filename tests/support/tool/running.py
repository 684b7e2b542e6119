"""Runs the built tool as a user would: a command line in; the exit code and both outputs out."""
import os
import resource
import shlex
import signal
import subprocess
import time
from typing import NamedTuple

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
