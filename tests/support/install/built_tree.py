"""The sources, the build whose files are installed, and shells that work in them as a user does."""
import os
import re
import shlex
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
BUILD = Path(os.environ["CSCD_TOOL"]).parent
CC = os.environ.get("CC", "cc")
_NUMBERS = dict(re.findall(r"define CSCD_VERSION_(\w+) +(\d+)", (ROOT / "include/cscd/cscd.h").read_text()))
MAJOR, MINOR, PATCH = (int(_NUMBERS[part]) for part in ("MAJOR", "MINOR", "PATCH"))
VERSION = f"{MAJOR}.{MINOR}.{PATCH}"
BASELINE_LIBRARY = f"libcscd-baselines.so.{MAJOR}"
# What make tells its children is not meant for the make of a test.
_OF_MAKE = ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "MAKEOVERRIDES")


def shell(line, *, code=0, cwd=ROOT, **variables):
    """Runs a line of sh, by default in the root of the sources, and expects its exit code; returns both outputs together."""
    environment = {**{key: value for key, value in os.environ.items() if key not in _OF_MAKE}, **variables}
    ended = subprocess.run(["sh", "-c", line], cwd=cwd, env=environment, text=True, errors="surrogateescape",
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    assert ended.returncode == code, f"exit code {ended.returncode}, not {code}: {line}\n{ended.stdout}"
    return ended.stdout


def make(target, place, *variables):
    """Runs make for the built tree; place: DESTDIR."""
    built = (f"BUILD_ROOT={BUILD.parent}", f"CONFIG={BUILD.name}")
    shell(shlex.join(["make", "-s", target, *built, f"DESTDIR={place}", *variables]))


def files_in(folder):
    """The paths of all that is no folder, from there on."""
    return sorted(str(path.relative_to(folder)) for path in Path(folder).rglob("*") if path.is_symlink() or not path.is_dir())


def needed_by(binary):
    """The names of the libraries that a program or library needs, without their versions."""
    return sorted(re.findall(r"NEEDED.*\[(lib[^.]*)\.so", shell(f"readelf -d '{binary}'")))


def symbols_of(header="*.h"):
    """The functions that public headers declare, as the library exports them."""
    text = " ".join(path.read_text() for path in sorted((ROOT / "include/cscd").glob(header)))
    return sorted(re.findall(r"CSCD_API [^;(]*?(cscd_[a-z_0-9]+)\(", text))


def functions_of(header="*.h"):
    """The functions that public headers declare, as callers know them."""
    return sorted(re.sub("_sized$", "", name) for name in symbols_of(header))
