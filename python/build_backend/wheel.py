"""Writes wheels: zip archives of the package and of what pip wants to know, the same bytes for the same contents."""
from __future__ import annotations

import base64
import hashlib
import os
import stat
import tempfile
import zipfile
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Dict, Iterator

from .project import Project, zip_time
from .target import Target


def wheel_name(project: Project, target: Target = Target()) -> str:
    """The file name of the wheel: it serves every Python 3, because nothing in it is compiled for one version."""
    return f"{project.stem}-py3-none-{target.platform.tag}.whl"


def information_files(project: Project, target: Target = Target()) -> Dict[str, bytes]:
    """The files of the dist-info folder, without RECORD, by their names in it."""
    wheel = f"Wheel-Version: 1.0\nGenerator: cscd {project.version}\nRoot-Is-Purelib: false\n"
    return {
        "METADATA": project.metadata.encode(),
        "WHEEL": f"{wheel}Tag: py3-none-{target.platform.tag}\n".encode(),
        "entry_points.txt": project.entry_points.encode(),
        **{f"licenses/{name}": text for name, text in {**project.licences, **target.licences()}.items()},
    }


def write_metadata(project: Project, folder: str) -> str:
    """Writes the dist-info folder into a folder, and returns its name."""
    name = f"{project.stem}.dist-info"
    for file, contents in information_files(project).items():
        path = Path(folder, name, file)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(contents)
    return name


def write_wheel(project: Project, package: Path, folder: str, target: Target = Target()) -> str:
    """Writes the wheel of a built package folder, and returns its file name."""
    files = {path.relative_to(package.parent).as_posix(): path.read_bytes() for path in package_files(package)}
    return write_archive(project, files, folder, target)


def write_editable(project: Project, parent: Path, folder: str) -> str:
    """Writes a wheel that lets Python find the package in the folder where it was built, and returns its file name."""
    return write_archive(project, {f"__editable__{project.name}.pth": f"{parent}\n".encode()}, folder)


def package_files(package: Path) -> Iterator[Path]:
    """The files of a package folder that belong into a wheel."""
    for path in package.rglob("*"):
        if path.is_file() and "__pycache__" not in path.parts:
            yield path


def write_archive(project: Project, files: Dict[str, bytes], folder: str, target: Target = Target()) -> str:
    """Writes a wheel of these files, by their paths in it, and of what pip wants to know, and returns its file name."""
    information = f"{project.stem}.dist-info"
    name = wheel_name(project, target)
    record = ""
    with whole_file(Path(folder, name)) as out, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        # As the specification advises, the information stands at the end.
        described = {f"{information}/{path}": contents for path, contents in information_files(project, target).items()}
        for path, contents in [*sorted(files.items()), *sorted(described.items())]:
            add_file(archive, path, contents)
            digest = base64.urlsafe_b64encode(hashlib.sha256(contents).digest()).rstrip(b"=").decode()
            record += f"{path},sha256={digest},{len(contents)}\n"
        add_file(archive, f"{information}/RECORD", f"{record}{information}/RECORD,,\n".encode())
    return name


def add_file(archive: zipfile.ZipFile, path: str, contents: bytes) -> None:
    """Adds a file whose time and mode are not those of the machine."""
    entry = zipfile.ZipInfo(path, zip_time())
    entry.compress_type = zipfile.ZIP_DEFLATED
    entry.create_system = 3  # Unix, wherever this runs
    mode = 0o755 if ".so" in Path(path).suffixes else 0o644
    entry.external_attr = (stat.S_IFREG | mode) << 16
    archive.writestr(entry, contents)


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """Opens a file to write that appears under its name when it is whole, and leaves nothing behind when it is not."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, part = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as out:
            yield out
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(part, 0o666 & ~umask)
        os.replace(part, path)
    except BaseException:
        os.unlink(part)
        raise
