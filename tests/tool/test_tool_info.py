"""`info`: the parts that a file names, and everything as JSON."""
from pathlib import Path

import pytest

from support.tool.reading import json_of, read_json
from support.tool.recordings import torus
from support.tool.running import fails, run, usage_error

# A tetrahedron of two parts and a square in none, with a vertex that nothing uses and faces to repair.
NAMED = ("v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nv 9 0 0\nv 10 0 0\nv 10 1 0\nv 9 1 0\nv -1 -2 -3\nf 5 6 7 8\n"
         "o Body\ng Base\nf 1 3 2\ng Top\nf 1 2 4\nf 2 3 3 4\nf 3 3 1\nf 3 1 4\nf 1 2\n")


@pytest.fixture(autouse=True)
def files(own_folder):
    Path("named.obj").write_text(NAMED)


def test_parts_are_listed():
    out = run("info named.obj").out
    assert "parts       2: Body/Base (1 triangle), Body/Top (3 triangles); 2 in none\n" in out
    assert "vertices    9 (1 of them in no triangle)\n" in out
    assert "bounds      (-1, -2, -3) to (10, 4, 4)\n" in out


def test_many_parts_are_cut_short():
    parts = "".join(f"o P{i}\nv {3 * i} 0 1\nv {3 * i} 1 1\nv {3 * i} 0 2\nf -3 -2 -1\n" for i in range(23))
    Path("many.obj").write_text(f"v 0 0 0\nv 1 0 0\nv 0 1 0\n{parts}")
    out = run("info many.obj").out
    assert "parts       23: P0 (1 triangle), P1 (1 triangle), " in out and "P19 (1 triangle), and 3 more\n" in out
    torus(12, 8).write_mesh("plain.obj")
    assert "parts       the file names none\n" in run("info plain.obj").out


def component(vertices, edges, triangles, closed):
    return {"vertices": vertices, "edges": edges, "triangles": triangles, "euler_characteristic": vertices - edges + triangles,
            "closed": closed, "genus": 0 if closed else None, "open_edges": 0 if closed else 4, "non_manifold_edges": 0,
            "non_manifold_vertices": 0, "inconsistent_edges": 0}


def test_everything_is_in_the_json():
    """Faces 3, 4 and 6, counted from 0, are shortened, left without three corners, and too short."""
    run("info named.obj --json info.json")
    root = read_json("info.json")
    expected = {"file": "named.obj", "file_vertices": 9, "file_faces": 7, "vertices": 9, "unused_vertices": 1, "edges": 6 + 5,
                "triangles": 6, "zero_area_triangles": 0, "pairs": 0, "low": [-1, -2, -3], "high": [10, 4, 4]}
    assert {key: root[key] for key in expected} == expected
    repairs = root["repairs"]
    for what, faces, first in (("shortened", 1, 3), ("dropped", 2, 4), ("fanned", 0, None)):
        assert repairs[what] == {"faces": faces, "first": first}
    assert repairs["skipped_primitives"] == 0
    assert [(part["name"], part["triangles"]) for part in root["parts"]] == [("Body/Base", 1), ("Body/Top", 3)]
    found = sorted(root["components"], key=lambda each: each["closed"])
    for one, expected in zip(found, (component(4, 5, 2, False), component(4, 6, 4, True))):
        assert {key: one[key] for key in expected} == expected
    assert len(found) == 2


def test_intersections_and_flat_triangles_are_counted():
    Path("crossed.obj").write_text("v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 2 1 1\nv 9 9 9\nv 8 8 8\n"
                                   "v 7 7 7\nf 1 2 3\nf 4 5 6\nf 7 8 9\n")
    run("info crossed.obj --json info.json")
    root = read_json("info.json")
    assert (root["pairs"], root["zero_area_triangles"], root["parts"]) == (1, 1, [])


@pytest.mark.parametrize("name", ["scan.stl", "scan.dat", "scan.obj"])
def test_stl_files_are_welded_by_what_is_in_them(name):
    """Corners of STL files in one place are one vertex, whatever ending the file has."""
    facets = (("0 0 0", "0 4 0", "4 0 0"), ("0 0 0", "4 0 0", "0 0 4"), ("0 0 0", "0 0 4", "0 4 0"), ("4 0 0", "0 4 0", "0 0 4"))
    lines = "".join("facet normal 0 0 0\nouter loop\nvertex {}\nvertex {}\nvertex {}\nendloop\nendfacet\n".format(*facet)
                    for facet in facets)
    Path(name).write_text(f"solid scan\n{lines}endsolid scan\n")
    assert "the 12 vertices of the STL file are joined to 4" in run(f"info {name} --json info.json").error
    assert read_json("info.json")["file_vertices"] == 12 and read_json("info.json")["vertices"] == 4


def test_outputs_are_as_everywhere():
    answer = run("info named.obj --json -")
    assert json_of(answer.out) and "parts       2: Body/Base" in answer.error
    usage_error("info named.obj --json named.obj", "--json", "would overwrite")
    usage_error("info named.obj --json x.csv", "--json", "ends in .json")
    fails("info named.obj --json /nowhere/x.json", "/nowhere/x.json", "cannot write")
    assert "/dev/full: cannot write: No space left on device" in run("info named.obj --json /dev/full", code=1).error
