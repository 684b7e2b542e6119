"""The manifest of the Blender extension, by the schema 1.0.0 of Blender's documentation, which Blender 4.2 reads."""

from __future__ import annotations

import ast
import os
import re
import tomllib

import pytest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
EXTENSION = os.path.join(ROOT, "blender", "cscd_blender")
REQUIRED = {"schema_version", "id", "version", "name", "tagline", "maintainer", "type", "blender_version_min", "license"}
OPTIONAL = {"website", "copyright", "tags", "platforms", "permissions", "wheels", "blender_version_max", "build"}
PLATFORMS = {"windows-x64", "windows-arm64", "macos-arm64", "macos-x64", "linux-x64"}
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
    assert manifest["wheels"] == [f"./wheels/cscd-{version_of_library()}-py3-none-linux_x86_64.whl"]
