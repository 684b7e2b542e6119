"""``python -m cscd`` is the tool ``cscd``: ``python -m cscd check FILE``."""

from __future__ import annotations

import ctypes
import os
import signal
import sys

from ._library import library


def main() -> int:
    """Runs the tool on the arguments of this process, and returns its exit code."""
    arguments = [b"cscd", *(os.fsencode(argument) for argument in sys.argv[1:])]
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # the tool has a handler of its own, and ends with 130
    sys.stdout.flush()
    values = (ctypes.c_char_p * (len(arguments) + 1))(*arguments, None)
    return int(library.cscdpy_run_tool(len(arguments), values))


if __name__ == "__main__":
    sys.exit(main())
