"""The back end that builds the package: what it reads, what it says when something is missing, what it leaves alone."""
from __future__ import annotations

import os
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

import package_rig as rig
from build_backend import native, project, sdist, wheel

EXAMPLE = """
# A comment.
[project]
name = "cscd" # and one behind a value
list = [
    "a",

    "b # no comment",
]
[tool.other]
number = 3
[project.scripts]
x = "y:z"
"""


def test_tables_are_read_as_toml() -> None:
    read = project.read_tables(EXAMPLE)
    assert read == {"project": {"name": "cscd", "list": ["a", "b # no comment"]}, "project.scripts": {"x": "y:z"}}
    with pytest.raises(ValueError, match="number"):
        project.read_tables("[project]\nnumber = 3\n")


if sys.version_info >= (3, 11):

    def test_pyproject_is_what_the_standard_library_reads() -> None:
        import tomllib

        text = (rig.ROOT / "pyproject.toml").read_text(encoding="utf-8")
        whole = tomllib.loads(text)
        read = project.read_tables(text)
        flat = {key: value for key, value in whole["project"].items() if not isinstance(value, dict)}
        assert read["project"] == flat
        assert read["project.scripts"] == whole["project"]["scripts"]
        assert read["project.license"] == whole["project"]["license"]
        assert read["build-system"] == whole["build-system"] and whole["build-system"]["requires"] == []


def test_settings_are_checked() -> None:
    assert native.baselines_setting(None) is None and native.baselines_setting({"baselines": "1"}) is True
    assert native.baselines_setting({"baselines": "0"}) is False
    for wrong in ({"baselines": "yes"}, {"other": "1"}):
        with pytest.raises(project.Failure, match="baselines=0"):
            native.baselines_setting(wrong)


def test_archive_of_sources_is_what_git_tracks() -> None:
    names = sdist.source_files(rig.ROOT)
    assert {"pyproject.toml", "Makefile", "include/cscd/cscd.h", "python/build_backend/native.py"} <= set(names)
    assert not [name for name in names if name.startswith(("build/", ".git/", "docs/images/"))]


def test_archive_of_an_archive_is_the_same(tmp_path: Path) -> None:
    name = f"cscd-{project.Project.read(rig.ROOT).version}"
    rig.make_archive("sdist", rig.ROOT, tmp_path)
    with tarfile.open(tmp_path / f"{name}.tar.gz") as archive:
        assert {entry.name.split("/")[0] for entry in archive.getmembers()} == {name}
        archive.extractall(tmp_path)
    (tmp_path / name / "build").mkdir()
    (tmp_path / name / "build" / "rest").write_text("of a build")
    (tmp_path / name / "v").mkdir()
    (tmp_path / name / "v" / "pyvenv.cfg").write_text("of README's environment")
    rig.make_archive("sdist", tmp_path / name, tmp_path / "again")
    assert (tmp_path / "again" / f"{name}.tar.gz").read_bytes() == (tmp_path / f"{name}.tar.gz").read_bytes()


def test_tree_inside_somebody_elses_is_not_theirs(tmp_path: Path) -> None:
    rig.run("git", "init", "-q", cwd=tmp_path)
    author = ("-c", "user.name=a", "-c", "user.email=a@b")
    rig.run("git", *author, "commit", "-q", "--allow-empty", "-m", "theirs", cwd=tmp_path)
    inner = tmp_path / "inner"
    inner.mkdir()
    for name in ("mine.c", "theirs.c"):
        (inner / name).write_text("")
    rig.run("git", "add", "inner/theirs.c", cwd=tmp_path)
    assert sdist.source_files(inner) == ["mine.c", "theirs.c"] and native.commit_of(inner) == "unknown"


def test_missing_compiler_and_make_are_named(tmp_path: Path) -> None:
    for number, missing in enumerate(("gcc", "make")):
        path = rig.tools_without(tmp_path / f"tools{number}", missing)
        said = rig.make_archive("wheel", rig.ROOT, tmp_path / "out", status=1, PATH=path, CC="gcc")
        assert said.startswith(f"cscd: the build needs {missing}, not found on this machine. Nothing has been built.\n")
        assert "apt-get install -y --no-install-recommends build-essential\n" in said
    assert not (tmp_path / "out").exists()


def compiler_without(folder: Path, *headers: str) -> str:
    """A compiler that does not find these headers."""
    lines = "".join(f"    *'<{header}>'*) echo 'fatal error: {header}' >&2; exit 1 ;;\n" for header in headers)
    path = folder / "compiler"
    path.write_text(f'#!/bin/sh\ncase " $* " in\n*" - "*)\n    text=$(cat)\n    case $text in\n{lines}    esac\n'
                    '    printf "%s\\n" "$text" | gcc "$@"\n    ;;\n*) exec gcc "$@" ;;\nesac\n')
    path.chmod(0o755)
    return str(path)


def test_missing_headers_are_named(tmp_path: Path) -> None:
    compiler = compiler_without(tmp_path, "json-c/json.h", "png.h")
    said = rig.make_archive("wheel", rig.ROOT, tmp_path / "out", status=1, CC=compiler)
    assert said.startswith("cscd: the build needs libpng (png.h) and json-c (json-c/json.h), not found on this ")
    assert " libpng-dev libjson-c-dev\n" in said and "Traceback" not in said and "fatal error" not in said


def test_baselines_are_built_where_their_libraries_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert native.requirements.check(None).baselines
    monkeypatch.setenv("CC", compiler_without(tmp_path, "lapacke.h"))
    assert not native.requirements.check(None).baselines
    assert "without LAPACKE, OpenBLAS and GSL" in capsys.readouterr().out
    with pytest.raises(project.Failure, match=r"needs LAPACKE \(lapacke.h\), not found"):
        native.requirements.check(True)


def test_failing_make_is_said_in_a_sentence(tmp_path: Path) -> None:
    tree = tmp_path / "tree"
    tree.mkdir()
    (tree / "Makefile").write_text("python:\n\t@echo wall; exit 3\n")
    with pytest.raises(project.Failure, match="make ended with status 2; what it said stands above"):
        native.build_in_place(tree, False)


def test_tree_that_cannot_be_written_to_is_copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with native.writable_tree(rig.ROOT) as tree:
        assert tree == rig.ROOT
    monkeypatch.setattr(os, "access", lambda path, mode: mode != os.W_OK)
    with native.writable_tree(rig.ROOT) as tree:
        assert tree != rig.ROOT
        assert sdist.source_files(tree) == sdist.source_files(rig.ROOT)
    assert not tree.exists()


def test_archive_is_whole_or_not_there(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), wheel.whole_file(tmp_path / "x.whl") as out:
        out.write(b"half")
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []


def test_build_of_make_is_not_this_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MAKEFLAGS", "CONFIG=sanitize")
    monkeypatch.setenv("BUILD_ROOT", "elsewhere")
    printed = subprocess.run(["env"], env=native.environment(), capture_output=True, text=True).stdout
    assert "sanitize" not in printed and "elsewhere" not in printed and "PATH=" in printed
