"""Makes the archives without pip: `PYTHONPATH=python python3 -m build_backend wheel FOLDER`, or `sdist FOLDER`.

The wheel is the one to give away: it has no charge. This ends with status 1 if its library needs one that a bare system
lacks.
"""
from __future__ import annotations

import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import List

from . import build_sdist, build_wheel, requirements
from .project import Failure
from .wheel import whole_file

# The C library and its loader.
EVERYWHERE = ("libc.so.", "libm.so.", "libdl.so.", "libpthread.so.", "ld-linux")


def libraries_of(wheel: Path) -> List[str]:
    """The shared libraries that the native library of a wheel needs."""
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(wheel) as archive:
        native = archive.extract("cscd/libcscd-python.so", folder)
        printed = subprocess.run(["readelf", "-d", native], check=True, capture_output=True, text=True).stdout
    return [line.split("[")[1].rstrip("]") for line in printed.splitlines() if "(NEEDED)" in line]


def main(words: List[str]) -> int:
    """Runs one command, and prints the path of what it has made."""
    if len(words) != 2 or words[0] not in ("wheel", "sdist"):
        print(__doc__, file=sys.stderr)
        return 2
    command, folder = words
    if command == "sdist":
        print(Path(folder, build_sdist(folder)))
        return 0
    try:
        requirements.check(False, whole=True)
    except Failure as failure:
        print(f"cscd: {failure}", file=sys.stderr)
        return 1
    with tempfile.TemporaryDirectory() as place:
        made = Path(place, build_wheel(place, {"charge": "0"}))
        foreign = [library for library in libraries_of(made) if not library.startswith(EVERYWHERE)]
        if foreign:
            print(f"cscd: the wheel would need {' and '.join(foreign)} wherever it is installed, because this machine has "
                  "no archives of them that link into a shared library; `pip install .` works all the same",
                  file=sys.stderr)
            return 1
        target = Path(folder, made.name)
        with whole_file(target) as out:
            out.write(made.read_bytes())
    print(target)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
