"""Makes the archives without pip: `PYTHONPATH=python python3 -m build_backend wheel FOLDER [HOST LIBRARIES]`, or `sdist FOLDER`.

The wheel is the one to give away: it has no libcscd-baselines.so. This ends with status 1 if its library needs one that a bare
system lacks. With HOST, such as aarch64-linux-gnu, it is for that platform; CC names the cross compiler, and LIBRARIES the folder
with the libraries of that platform.
"""
from __future__ import annotations

import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import List

from . import build_sdist, build_wheel_for, requirements
from .project import Failure
from .target import Target
from .wheel import whole_file


def libraries_of(wheel: Path, target: Target) -> List[str]:
    """The shared libraries that the native library of a wheel needs."""
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(wheel) as archive:
        command = [f"{target.platform.tools}objdump", "-p", archive.extract(f"cscd/{target.library}", folder)]
        printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return [line.split()[-1] for line in printed.splitlines() if line.split()[:1] == ["NEEDED"] or "DLL Name:" in line]


def give_away(made: Path, target: Target, folder: Path) -> int:
    """Puts a wheel that needs nothing else into the folder, and prints its path."""
    foreign = [library for library in libraries_of(made, target) if not library.startswith(target.platform.everywhere)]
    if foreign:
        print(f"cscd: the wheel would need {' and '.join(foreign)} wherever it is installed, because this machine has "
              "no archives of them that link into a shared library; `pip install .` works all the same",
              file=sys.stderr)
        return 1
    with whole_file(folder / made.name) as out:
        out.write(made.read_bytes())
    print(folder / made.name)
    return 0


def main(words: List[str]) -> int:
    """Runs one command, and prints the path of what it has made."""
    if (words[:1], len(words)) not in ((["wheel"], 2), (["wheel"], 4), (["sdist"], 2)):
        print(__doc__, file=sys.stderr)
        return 2
    command, folder = words[:2]
    if command == "sdist":
        print(Path(folder, build_sdist(folder)))
        return 0
    try:
        target = Target(*words[2:])
        requirements.check(False, whole=True, target=target)
        with tempfile.TemporaryDirectory() as place:
            return give_away(Path(place, build_wheel_for(target, place, False)), target, Path(folder))
    except Failure as failure:
        print(f"cscd: {failure}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
