"""Writes the archive of the sources, which builds without git: the same bytes for the same sources."""
from __future__ import annotations

import gzip
import io
import os
import subprocess
import tarfile
from pathlib import Path
from typing import IO, Iterator, List, cast

from .project import Project, source_time
from .wheel import whole_file

# Files that the build, the tests and editors leave in a tree; and pictures, which take as much space as all else and serve
# readers only.
LEFT_OUT = {".git", "build", "dist", "node_modules", "__pycache__", ".mypy_cache", ".pytest_cache", "PKG-INFO"}
PICTURES = "docs/images/"


def source_files(root: Path) -> List[str]:
    """The paths of the files that go into the archive, in order: what git tracks, or all where it tracks nothing."""
    found = tracked_files(root) or list(walked_files(root))
    return sorted(path for path in found if not path.startswith(PICTURES) and (root / path).is_file())


def tracked_files(root: Path) -> List[str]:
    """The files that git tracks in the tree; nothing if there is no git, or the tree is a folder in somebody else's."""
    def ask(*words: str) -> str:
        return os.fsdecode(subprocess.run(["git", "-C", str(root), *words], check=True, capture_output=True).stdout)

    try:
        top = ask("rev-parse", "--show-toplevel").rstrip("\n")
        return [path for path in ask("ls-files", "-z").split("\0") if path] if os.path.samefile(top, root) else []
    except (OSError, subprocess.CalledProcessError):
        return []


def walked_files(root: Path) -> Iterator[str]:
    """All files of the tree but what builds leave there."""
    for folder, folders, files in os.walk(root):
        folders[:] = [name for name in folders if name not in LEFT_OUT and not is_environment(Path(folder, name))]
        for name in files:
            path = Path(folder, name).relative_to(root).as_posix()
            if name not in LEFT_OUT and path != "cscd" and not name.endswith((".pyc", ".whl", ".tar.gz")):
                yield path


def is_environment(folder: Path) -> bool:
    """Whether a folder is a virtual environment, such as the one that README makes in the tree."""
    return (folder / "pyvenv.cfg").exists()


def write_sdist(project: Project, root: Path, folder: str) -> str:
    """Writes the archive into a folder, and returns its file name."""
    name = f"{project.stem}.tar.gz"
    with whole_file(Path(folder, name)) as out:
        with gzip.GzipFile(filename="", mode="wb", fileobj=out, mtime=source_time()) as packed:
            with tarfile.open(mode="w", fileobj=cast(IO[bytes], packed), format=tarfile.PAX_FORMAT) as archive:
                add_file(archive, f"{project.stem}/PKG-INFO", project.metadata.encode(), False)
                for name_of in source_files(root):
                    path = root / name_of
                    add_file(archive, f"{project.stem}/{name_of}", path.read_bytes(), os.access(path, os.X_OK))
    return name


def add_file(archive: tarfile.TarFile, path: str, contents: bytes, executable: bool) -> None:
    """Adds a file whose time, owner and mode are not those of the machine."""
    entry = tarfile.TarInfo(path)
    entry.size = len(contents)
    entry.mtime = source_time()
    entry.mode = 0o755 if executable else 0o644
    archive.addfile(entry, io.BytesIO(contents))
