"""Builds the Python package cscd for pip: the hooks of PEP 517, and those of PEP 660 for an editable installation.

Needs the standard library alone. pip calls these functions in the root of the source tree. `python -m build_backend`
with this folder's parent on PYTHONPATH makes the same files without pip.

Each hook takes `config_settings`, of which it knows one: baselines=0 leaves out libcscd-baselines.so, which has the dense solver
of plans by charge, baselines=1 insists on it, and without the setting it is built where LAPACKE, OpenBLAS and GSL are:
`pip install . --config-settings baselines=0`.
"""
from __future__ import annotations

from typing import Dict, List, Optional

from . import native, sdist, wheel
from .project import ROOT, Failure, Project
from .target import Target

Settings = Optional[Dict[str, object]]

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]


def get_requires_for_build_wheel(config_settings: Settings = None) -> List[str]:
    """Names no package: pip never needs the network for the build."""
    return []


get_requires_for_build_sdist = get_requires_for_build_wheel
get_requires_for_build_editable = get_requires_for_build_wheel


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: Settings = None) -> str:
    """Writes the folder cscd-VERSION.dist-info without building anything, and returns its name."""
    return wheel.write_metadata(Project.read(ROOT), metadata_directory)


prepare_metadata_for_build_editable = prepare_metadata_for_build_wheel


def build_wheel(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: Optional[str] = None
) -> str:
    """Builds the package and writes its wheel, and returns the wheel's file name.

    Ends the process with a sentence, not with a traceback, when something that the build needs is missing, or make
    fails.
    """
    try:
        return build_wheel_for(Target(), wheel_directory, native.baselines_setting(config_settings))
    except Failure as failure:
        raise SystemExit(f"cscd: {failure}") from None


def build_wheel_for(target: Target, wheel_directory: str, baselines: Optional[bool]) -> str:
    """The same for any platform, but a failure is raised."""
    with native.built_package(ROOT, baselines, target) as package:
        return wheel.write_wheel(Project.read(ROOT), package, wheel_directory, target)


def build_editable(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: Optional[str] = None
) -> str:
    """Builds the package in build/python and writes a wheel that points there, and returns the wheel's file name.

    After a change of the sources, C or Python, `make python` renews what the installation sees.
    """
    try:
        project = Project.read(ROOT)
        native.build_in_place(ROOT, native.baselines_setting(config_settings))
        return wheel.write_editable(project, ROOT / "build" / "python", wheel_directory)
    except Failure as failure:
        raise SystemExit(f"cscd: {failure}") from None


def build_sdist(sdist_directory: str, config_settings: Settings = None) -> str:
    """Writes the archive of the sources, and returns its file name."""
    return sdist.write_sdist(Project.read(ROOT), ROOT, sdist_directory)
