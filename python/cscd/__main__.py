"""``python -m cscd`` is the tool ``cscd``: ``python -m cscd check FILE``.

This file also runs by itself, without numpy, as ``python -I .../cscd/__main__.py``.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys


def main() -> int:
    """Runs the tool on the arguments of this process, and returns its exit code."""
    name = "libcscd-python.dll" if os.name == "nt" else "libcscd-python.so"
    library = ctypes.PyDLL(os.path.join(os.path.dirname(os.path.abspath(__file__)), name))
    arguments = [b"cscd", *(os.fsencode(argument) for argument in sys.argv[1:])]
    if signal.getsignal(signal.SIGINT) != signal.SIG_IGN:  # as a shell has it for what runs in its background
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # the tool has a handler of its own, and ends with 128 and its number
    sys.stdout.flush()
    values = (ctypes.c_char_p * (len(arguments) + 1))(*arguments, None)
    library.cscdpy_run_tool.restype = ctypes.c_int
    return int(library.cscdpy_run_tool(len(arguments), values))


if __name__ == "__main__":
    sys.exit(main())
