"""Finds where characters, cloth and props go through each other and themselves, frame by frame."""

from __future__ import annotations

import glob
import os
import sys
import sysconfig
import zipfile
from typing import Any, Tuple

bl_info = {
    "name": "cscd",
    "author": "the authors of cscd",
    "version": (2, 0, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > cscd",
    "description": "Finds where surfaces go through each other and themselves, frame by frame",
    "category": "Animation",
}


def _find_package() -> None:
    """Makes the Python package importable. Blender 4.2 installs the wheel of its platform; here older versions unpack it."""
    try:
        import cscd  # noqa: F401
        return
    except ImportError:
        folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "wheels")
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        wheels = glob.glob(os.path.join(folder, f"cscd-*-{platform}.whl"))
        if not wheels:
            packed = " and ".join(sorted(os.listdir(folder))) if os.path.isdir(folder) else "nothing"
            raise ImportError(f"cscd: this archive has no Python package for {platform}; it has {packed}") from None
    unpacked = os.path.join(folder, "unpacked")
    if not os.path.isdir(unpacked):
        beside = f"{unpacked}.{os.getpid()}"
        with zipfile.ZipFile(wheels[0]) as archive:
            archive.extractall(beside)
        os.rename(beside, unpacked)
    sys.path.append(unpacked)


def _modules() -> Tuple[Any, ...]:
    _find_package()
    from . import operators, panel, properties
    return properties, operators, panel


def register() -> None:
    """What Blender calls when the extension is switched on."""
    for module in _modules():
        module.register()


def unregister() -> None:
    """What Blender calls when the extension is switched off."""
    for module in reversed(_modules()):
        module.unregister()
