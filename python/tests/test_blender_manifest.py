"""The manifest of the Blender extension, by the schema 1.0.0 of Blender's documentation, which Blender 4.2 reads."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
import tomllib
import zipfile

import pytest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
EXTENSION = os.path.join(ROOT, "blender", "cscd_blender")
REQUIRED = {"schema_version", "id", "version", "name", "tagline", "maintainer", "type", "blender_version_min", "license"}
OPTIONAL = {"website", "copyright", "tags", "platforms", "permissions", "wheels", "blender_version_max", "build"}
PLATFORMS = {"windows-x64", "windows-arm64", "macos-arm64", "macos-x64", "linux-x64", "linux-arm64"}
TAGS = {"3D View", "Add Curve", "Add Mesh", "Animation", "Bake", "Camera", "Compositing", "Development", "Game Engine",
        "Geometry Nodes", "Grease Pencil", "Import-Export", "Lighting", "Material", "Mesh", "Modeling", "Node", "Object",
        "Paint", "Physics", "Pipeline", "Render", "Rigging", "Scene", "Sculpt", "Sequencer", "System", "Text Editor",
        "Tracking", "User Interface", "UV"}


@pytest.fixture(scope="module")
def manifest():
    with open(os.path.join(EXTENSION, "blender_manifest.toml"), "rb") as file:
        return tomllib.load(file)


def version_of_library():
    with open(os.path.join(ROOT, "include", "cscd", "cscd.h"), encoding="utf-8") as file:
        return ".".join(re.findall(r"#define CSCD_VERSION_\w+ (\d+)", file.read()))


def test_keys_are_those_of_the_schema(manifest):
    assert REQUIRED <= set(manifest) <= REQUIRED | OPTIONAL
    assert manifest["schema_version"] == "1.0.0"
    assert manifest["type"] == "add-on"
    assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", manifest["id"])
    assert manifest["id"] == os.path.basename(EXTENSION)
    assert set(manifest["tags"]) <= TAGS and set(manifest["platforms"]) <= PLATFORMS
    assert all(licence.startswith("SPDX:") for licence in manifest["license"])


def test_lines_are_short_and_have_no_period(manifest):
    for line in (manifest["tagline"], *manifest["permissions"].values()):
        assert 0 < len(line) <= 64 and line[-1].isalnum()
    assert set(manifest["permissions"]) <= {"files", "network", "clipboard", "camera", "microphone"}


def test_versions_are_those_of_the_library(manifest):
    version = version_of_library()
    assert manifest["version"] == version
    with open(os.path.join(EXTENSION, "__init__.py"), encoding="utf-8") as file:
        tree = ast.parse(file.read())
    info = next(ast.literal_eval(node.value) for node in tree.body
                if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info")
    assert info["version"] == tuple(int(part) for part in version.split("."))
    assert tuple(int(part) for part in manifest["blender_version_min"].split(".")) >= (4, 2, 0)
    assert info["blender"] == (3, 4, 0)


def test_wheels_are_those_that_are_packed(manifest):
    tags = ("linux_x86_64", "linux_aarch64", "win_amd64")
    assert manifest["wheels"] == [f"./wheels/cscd-{version_of_library()}-py3-none-{tag}.whl" for tag in tags]
    assert manifest["platforms"] == ["linux-x64", "linux-arm64", "windows-x64"]


def packed(folder, *tags):
    """Packs wheels of a few bytes; returns the archive's members, and its manifest."""
    wheels = [folder / f"cscd-{version_of_library()}-py3-none-{tag}.whl" for tag in tags]
    for wheel in wheels:
        wheel.write_text(wheel.name)
    done = subprocess.run([sys.executable, os.path.join(ROOT, "blender", "pack.py"), str(folder / "out"), *map(str, wheels)],
                          text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if done.returncode != 0:
        return done.stderr, None
    with zipfile.ZipFile(done.stdout.strip()) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    return members, tomllib.loads(members["cscd_blender/blender_manifest.toml"].decode())


def test_archive_names_the_platforms_of_its_wheels_alone(manifest, tmp_path):
    members, whole = packed(tmp_path, "linux_x86_64", "linux_aarch64", "win_amd64")
    assert whole == manifest
    assert {f"cscd_blender/{name[2:]}" for name in whole["wheels"]} < set(members)
    members, one = packed(tmp_path, "linux_aarch64")
    assert one == {**manifest, "platforms": ["linux-arm64"], "wheels": manifest["wheels"][1:2]}
    assert [name for name in members if name.endswith(".whl")] == [f"cscd_blender/{manifest['wheels'][1][2:]}"]


def test_archive_of_an_unknown_wheel_is_refused(tmp_path):
    said, nothing = packed(tmp_path, "linux_x86_64", "macosx_11_0_arm64")
    assert nothing is None and "names no wheel cscd-" in said and "macosx_11_0_arm64.whl" in said
    assert not (tmp_path / "out").exists()
