"""The benchmarks of methods and of bounding volumes, on a small recording: their rows, their guarantees, their error messages."""
import functools
import os
import subprocess
from math import cos, dist, inf, sin
from pathlib import Path

import pytest

from support.tool.reading import read_json
from support.tool.recordings import Recording
from support.tool.running import model_program, run

FRAMES = 6
KINDS = ("sphere", "box", "14-DOP", "18-DOP", "26-DOP")
# Axes, diagonals of the cube, diagonals of its faces; and how many of them each kind has.
AXES = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
CUBE = [(1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)]
FACES = [(1, 1, 0), (1, 0, 1), (0, 1, 1), (1, -1, 0), (1, 0, -1), (0, 1, -1)]
DIRECTIONS = {"box": AXES, "14-DOP": AXES + CUBE, "18-DOP": AXES + FACES, "26-DOP": AXES + CUBE + FACES}


@functools.lru_cache(maxsize=None)
def dumbbell():
    """Two balls on a rod that bends until they are in each other."""
    subprocess.run(model_program("shape", "dumbbell", "--triangles", 300, "made.obj"), check=True, capture_output=True)
    lines = [line.split() for line in Path("made.obj").read_text().splitlines()]
    points = [tuple(map(float, words[1:])) for words in lines if words[0] == "v"]

    def bent(x, y, z, frame):
        angle = 0.28 * frame * min(max(z, -0.6), 0.6) / 0.6
        return x * cos(angle) + abs(z) * sin(abs(angle)), y, z * cos(angle) - x * sin(angle)

    return Recording([[int(word) - 1 for word in words[1:]] for words in lines if words[0] == "f"],
                     [[bent(*point, frame) for point in points] for frame in range(FRAMES)])


@pytest.fixture(autouse=True)
def files(own_folder):
    dumbbell().write_mesh("tiny.obj")
    dumbbell().write_cache("tiny.pc2")


@pytest.fixture(name="program")
def fixture_program(request, monkeypatch):
    """Puts a benchmark in the place of the tool."""
    # In full, because tests/mutants/tree.py looks for these words.
    monkeypatch.setenv("CSCD_TOOL", os.environ[{"methods": "CSCD_METHODS", "volumes": "CSCD_VOLUMES"}[request.param]])
    monkeypatch.delenv("CSCD_DATA", raising=False)
    return request.param


METHODS, VOLUMES = (pytest.mark.parametrize("program", [name], indirect=True) for name in ("methods", "volumes"))


def rows_of_run():
    run("tiny --data . --cache . --json rows.json")
    found = read_json("rows.json")
    assert all(found["provenance"][key] for key in ("commit", "compiler", "flags", "date"))
    return found["rows"]


@METHODS
def test_methods_keep_their_guarantees(program):
    rows = rows_of_run()
    contacts = rows[0]["contacts"]
    assert rows[0]["method"] == "none" and contacts > 0
    assert {row["method"] for row in rows} >= {"iccd", "charge"} and {row["mode"] for row in rows} == {"all", "earliest"}
    assert {row["volume"] for row in rows} == {"box", "kdop14"} and {row["scene"] for row in rows} == {"tiny"}
    numbers = "threads triangles ttcd_ms bvh_ms orient_ms cnc_ms traverse_ms contact_ms pcp tests earliest_lost lost".split()
    assert all(row[number] >= 0 for row in rows for number in numbers)
    kept = [row for row in rows if "published" not in row["method"]]
    assert all(row["earliest_lost"] == 0 for row in kept)
    assert {row["contacts"] for row in kept if row["mode"] == "all"} == {contacts}
    # If all runs of k-means had one seed, the mean of their pairs would be that of the first run.
    sums = [row["pcp"] * (FRAMES - 1) for row in rows if row["method"].startswith("kmeans")]
    assert any(abs(pairs - round(pairs)) > 1e-6 for pairs in sums)


def swept_volumes(ends):
    """What triangles cover in an interval, relative to the mean of some vertices: (low, high) by direction, centre and radius."""
    moved = []
    for points in ends:
        samples = [points[s * len(points) // 64] for s in range(64)] if len(points) > 64 else points
        mean = [sum(point[k] for point in samples) / len(samples) for k in range(3)]
        moved.append([tuple(point[k] - mean[k] for k in range(3)) for point in points])
    volumes = []
    for triangle in dumbbell().triangles:
        corners = [points[v] for points in moved for v in triangle]
        spans = {}
        for direction in DIRECTIONS["26-DOP"]:
            places = [sum(a * b for a, b in zip(direction, corner)) for corner in corners]
            spans[direction] = (min(places), max(places))
        centre = [sum(spans[axis]) / 2 for axis in AXES]
        volumes.append((spans, centre, max(dist(corner, centre) for corner in corners)))
    return volumes


def overlap(kind, a, b, margin):
    if kind == "sphere":
        return dist(a[1], b[1]) <= a[2] + b[2] + margin
    return all(a[0][d][1] + margin >= b[0][d][0] and b[0][d][1] + margin >= a[0][d][0] for d in DIRECTIONS[kind])


@VOLUMES
def test_pairs_are_those_of_the_volumes(program):
    """Those that volumes written out here leave in an interval, up to rounding."""
    scene = Recording(dumbbell().triangles, dumbbell().frames[-2:])
    scene.write_mesh("tiny.obj")
    scene.write_cache("tiny.pc2")
    swept = list(zip(map(set, scene.triangles), swept_volumes(scene.frames)))
    pairs = [(a, b) for i, (v, a) in enumerate(swept) for w, b in swept[:i] if v.isdisjoint(w)]
    for kind, row in zip(KINDS, rows_of_run()):
        least, most = (sum(overlap(kind, a, b, margin) for a, b in pairs) for margin in (0.0, 1e-5))
        assert (row["method"], row["volume"]) == ("none", kind) and 0 < least <= row["pairs"] <= most < len(pairs)


@VOLUMES
def test_volumes_have_rows_of_all_methods(program):
    rows = rows_of_run()
    assert [(row["method"], row["volume"]) for row in rows] == [(m, kind) for m in ("none", "single", "charge") for kind in KINDS]
    for row, none in zip(rows, rows[: len(KINDS)] * 3):
        assert row["contacts"] == none["contacts"] > 0 and row["adjacent"] <= none["adjacent"] and row["tests"] <= none["tests"]
        assert all(0 < row[number] < inf for number in "tests pairs refit_ms search_ms filtered_ms direct_ms".split())


@METHODS
def test_what_is_wrong_is_said(program, monkeypatch):
    """A named folder must contain recordings; without a folder, scenes that the repository does not make cannot be found."""
    assert "no-such-scene.obj" in run("no-such-scene --data . --cache .", code=1).error
    answer = run("tiny --data . --cache . --json no-such-folder/rows.json", code=1)
    assert "no-such-folder/rows.json" in answer.error and "tiny" not in answer.out  # refused before anything is computed
    assert "neither --data nor CSCD_DATA names a folder" in run("tiny --cache .", code=1).error
    monkeypatch.setenv("CSCD_DATA", str(Path.cwd()))
    assert "/sequences has no recordings" in run("--cache .", code=1).error


@pytest.mark.parametrize("program, line, says", [
    *((program, "--no-such-option", "--no-such-option is no option") for program in ("methods", "volumes")),
    ("methods", "--json", "--json wants a value"),
    ("methods", "--json --quick", "--json wants a value"),
    ("methods", "--threads", "--threads wants a value"),
    ("methods", "--threads abc", "abc is no number of threads"),
    ("methods", "--threads 2x", "2x is no number of threads"),
    ("methods", "--threads 0", "0 is no number of threads"),
    ("volumes", "--threads 2", "--threads is no option"),
    ("volumes", "--simd", "--simd wants a value"),
    ("volumes", "--simd mmx", "mmx is no level of instructions"),
], indirect=["program"])
def test_wrong_arguments_are_named(program, line, says):
    error = run(line, code=2).error
    assert says in error and f"usage: {program}" in error
