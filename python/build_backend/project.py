"""The facts of pyproject.toml and the public header about the package, and the texts that every archive of it carries."""
from __future__ import annotations

import ast
import os
import re
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Tuple

ROOT = Path(__file__).resolve().parent.parent.parent
# The oldest time that a zip archive can hold.
OLDEST_TIME = 315532800

Table = Dict[str, object]


class Failure(Exception):
    """Something that the reader can put right; its text says what and how."""


def read_tables(text: str) -> Dict[str, Table]:
    """Returns the tables of a TOML file whose values are strings and lists of strings, as ours is.

    The standard library has no TOML reader before Python 3.11. Strings and lists of this kind are also Python's; a
    value of another kind raises ValueError. Tables under [tool] are left to their tools.
    """
    tables: Dict[str, Table] = {}
    name, key, value = "", "", ""
    for line in text.splitlines():
        line = line.strip()
        if not key and (not line or line.startswith("#")):
            continue
        header = None if key else re.fullmatch(r"\[([\w.-]+)\]", line)
        if header:
            name = header[1]
            continue
        if name.split(".")[0] == "tool":
            continue
        if key:
            value += line
        else:
            key, _, value = (part.strip() for part in line.partition("="))
        if value.startswith("[") and not value.endswith("]"):
            continue
        read = ast.literal_eval(value)
        if not isinstance(read, (str, list)):
            raise ValueError(f"pyproject.toml: {key} is neither a string nor a list")
        tables.setdefault(name, {})[key] = read
        key = ""
    return tables


def read_version(header: str) -> str:
    """Returns MAJOR.MINOR.PATCH as include/cscd/cscd.h defines it."""
    numbers = dict(re.findall(r"^#define CSCD_VERSION_(MAJOR|MINOR|PATCH) (\d+)$", header, re.M))
    return f"{numbers['MAJOR']}.{numbers['MINOR']}.{numbers['PATCH']}"


def source_time() -> int:
    """The time, in seconds since 1970, that files in archives carry: SOURCE_DATE_EPOCH, else the same one always."""
    return max(int(os.environ.get("SOURCE_DATE_EPOCH") or OLDEST_TIME), OLDEST_TIME)


def zip_time() -> Tuple[int, int, int, int, int, int]:
    """The same as zip archives want it: year, month, day, hour, minute, second."""
    moment = time.gmtime(source_time())
    return (moment.tm_year, moment.tm_mon, moment.tm_mday, moment.tm_hour, moment.tm_min, moment.tm_sec)


def strings(table: Table, key: str) -> List[str]:
    """The list of strings that stands under a key; an empty one when there is none."""
    found = table.get(key, [])
    return [str(item) for item in found] if isinstance(found, list) else [str(found)]


@dataclass(frozen=True)
class Project:
    """The package's name, its version, and the texts of its metadata."""

    name: str
    version: str
    metadata: str
    entry_points: str
    licences: Dict[str, bytes]

    @property
    def stem(self) -> str:
        """The beginning of the names of its archives."""
        return f"{self.name}-{self.version}"

    @classmethod
    def read(cls, root: Path) -> Project:
        """Reads it from the source tree `root`."""
        tables = read_tables((root / "pyproject.toml").read_text(encoding="utf-8"))
        version = read_version((root / "include" / "cscd" / "cscd.h").read_text(encoding="utf-8"))
        project = tables["project"]
        scripts = "".join(f"{name} = {target}\n" for name, target in sorted(tables["project.scripts"].items()))
        licences = {"LICENSE": (root / "LICENSE").read_bytes()}
        for text in sorted((root / "python" / "licences").glob("*.txt")):
            licences[text.name] = text.read_bytes()
        return cls(
            name=str(project["name"]),
            version=version,
            metadata=metadata_text(root, project, str(tables["project.license"]["text"]), version),
            entry_points=f"[console_scripts]\n{scripts}",
            licences=licences,
        )


def metadata_text(root: Path, project: Table, licence: str, version: str) -> str:
    """The file METADATA of wheels, which is PKG-INFO of source archives."""
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {project['name']}",
        f"Version: {version}",
        f"Summary: {project['description']}",
        f"License: {licence}",
        f"Keywords: {','.join(strings(project, 'keywords'))}",
        *(f"Classifier: {classifier}" for classifier in strings(project, "classifiers")),
        f"Requires-Python: {project['requires-python']}",
        *(f"Requires-Dist: {dependency}" for dependency in strings(project, "dependencies")),
        "Description-Content-Type: text/markdown",
    ]
    description = (root / str(project["readme"])).read_text(encoding="utf-8")
    return "\n".join(lines) + "\n\n" + description
