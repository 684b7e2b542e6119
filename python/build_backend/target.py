"""The platform that a wheel is for: that of the interpreter which builds it, or one that a cross compiler builds for."""
from __future__ import annotations

import sysconfig
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, NamedTuple, Tuple

from .project import Failure


class Platform(NamedTuple):
    """The name of a platform in wheels, the prefix of its compiler's tools, the ending of the library that Python loads, the
    libraries that every machine has (the C library, its loader, or what Windows consists of), and the
    places of the licences of libraries that the compiler links in."""

    tag: str
    tools: str
    ending: str
    everywhere: Tuple[str, ...]
    licences: Dict[str, str]


HERE = Platform(sysconfig.get_platform().replace("-", "_").replace(".", "_"), "", "so",
                ("libc.so.", "libm.so.", "libdl.so.", "libpthread.so.", "ld-linux"), {})
OTHERS = {
    "aarch64-linux-gnu": HERE._replace(tag="linux_aarch64", tools="aarch64-linux-gnu-"),
    "x86_64-w64-mingw32": Platform("win_amd64", "x86_64-w64-mingw32-", "dll", ("ADVAPI32.dll", "KERNEL32.dll", "msvcrt.dll"), {
        "mingw-w64.txt": "/usr/share/doc/mingw-w64-x86-64-dev/copyright",
        "gcc.txt": "/usr/share/doc/gcc-mingw-w64-x86-64-posix-runtime/copyright",
    }),
}


@dataclass(frozen=True)
class Target:
    """`host` is the name of a cross compiler's platform, as in HOST of the Makefile, and empty for a wheel of this
    machine; `libraries` is the folder with the libraries of that platform: SYSROOT, or what libraries.sh has built."""

    host: str = ""
    libraries: str = ""

    def __post_init__(self) -> None:
        if self.host and self.host not in OTHERS:
            raise Failure(f"no wheels are made for {self.host}, only for {' and '.join(sorted(OTHERS))}")

    @property
    def platform(self) -> Platform:
        """The facts about it."""
        return OTHERS[self.host] if self.host else HERE

    @property
    def library(self) -> str:
        """The file name of the library that Python loads."""
        return f"libcscd-python.{self.platform.ending}"

    @property
    def settings(self) -> List[str]:
        """The arguments of make."""
        sysroot = [] if self.platform.ending == "dll" else [f"SYSROOT={self.libraries}"]
        return [f"HOST={self.host}", *sysroot] if self.host else []

    def flags(self) -> List[str]:
        """The flags of a compiler that does not know the folder of the libraries."""
        return [f"-I{self.libraries}/include", f"-L{self.libraries}/lib"] if self.platform.ending == "dll" else []

    def licences(self) -> Dict[str, bytes]:
        """Texts that belong into the wheel in addition to those of the project, by their names in it."""
        missing = [path for path in self.platform.licences.values() if not Path(path).exists()]
        if missing:
            raise Failure(f"a wheel for {self.host} carries the licences {' and '.join(missing)}, not found on this machine")
        return {name: Path(path).read_bytes() for name, path in self.platform.licences.items()}
