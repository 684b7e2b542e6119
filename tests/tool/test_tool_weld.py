"""The tool welds split seams and ignores given pairs."""
from pathlib import Path

import pytest

from support.tool.mesh_files import write_glb, write_soft_bar
from support.tool.reading import read_contacts
from support.tool.recordings import Recording, cube, tetrahedra
from support.tool.running import fails, run

CLOSED = "8 vertices, 18 edges, 12 triangles, Euler characteristic 2, closed, genus 0"


@pytest.fixture(autouse=True)
def files(own_folder):
    for name, scene in (("clean", cube(False)), ("split", cube(True))):
        scene.write_mesh(f"{name}.obj")
        scene.write_cache(f"{name}.pc2")


def contacts_of(files, options=""):
    run(f"replay {files} --contacts out.csv --quiet {options}")
    return read_contacts("out.csv")


def places(contacts):
    """Kinds, times and places; vertices and the order of equal contacts may differ."""
    return sorted((each.frame, each.kind, *(round(x, 8) + 0.0 for x in (*each.point, each.toi))) for each in contacts)


def all_in_triangles(contacts, scene):
    """The corners of each contact are corners of some triangle of the file."""
    return all(any(set(corners) <= set(triangle) for triangle in scene.triangles)
               for contact in contacts for corners in (contact.a, contact.b))


# ---- welding


def test_welding_finds_what_the_clean_export_has():
    expected, welded = contacts_of("clean.obj clean.pc2"), contacts_of("split.obj split.pc2", "--weld exact")
    kinds = [contact.kind for contact in expected]
    assert len(expected) >= 10 and kinds.count("vf") > 1 and kinds.count("ee") > 1
    assert all_in_triangles(welded, cube(True)) and places(welded) == places(expected)


def write_stl(path, points):
    vertices = ["vertex {!r} {!r} {!r}\n".format(*point) for point in points]
    facets = ("".join(vertices[i : i + 3]) for i in range(0, len(vertices), 3))
    lines = "".join(f"facet normal 0 0 0\nouter loop\n{facet}endloop\nendfacet\n" for facet in facets)
    Path(path).write_text(f"solid recorded\n{lines}endsolid recorded\n")


def test_stl_files_are_welded_unless_one_says_no():
    """Their triangles have three vertices each."""
    clean = cube(False)
    corners = [corner for triangle in clean.triangles for corner in triangle]
    triangles = [range(v, v + 3) for v in range(0, len(corners), 3)]
    soup = Recording(triangles, [[frame[c] for c in corners] for frame in clean.frames])
    for i, frame in enumerate(soup.frames, 1):
        write_stl(f"f{i}.stl", frame)
    expected, welded = contacts_of("clean.obj clean.pc2"), contacts_of("f1.stl f2.stl f3.stl")
    assert all_in_triangles(welded, soup)
    assert places(welded) == places(contact._replace(frame=contact.frame + 1) for contact in expected)  # f1.stl is frame 1
    answer = run("info f1.stl")
    assert "the 48 vertices of the STL file are joined to 12; --weld none keeps them apart" in answer.error
    assert "components  2" in answer.out
    answer = run("info f1.stl --weld none")
    assert "components  16" in answer.out and "--weld exact would close the mesh" in answer.error


@pytest.mark.parametrize("options, components", [("", 2), ("--weld none", 4), ("--weld exact", 1)])
def test_gltf_files_are_welded_within_their_parts(options, components):
    """Two squares that share an edge, each a part of two triangles with vertices of their own."""
    write_glb("squares.glb", [("VEC3", [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0])],
              nodes=[{"mesh": 0}, {"mesh": 0, "translation": [1, 0, 0]}],
              meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}])
    answer = run(f"info squares.glb {options}")
    assert f"components  {components}\n" in answer.out
    assert options or "the 12 vertices of the glTF file are joined to 8; --weld none keeps" in answer.error


def test_welding_closes_the_mesh():
    out = run("info split.obj").out
    assert "components  7" in out and "4 open edges" in out
    out = run("info split.obj --weld exact").out
    assert "components  2" in out and CLOSED in out
    assert CLOSED in run("info split.obj --weld 1e-6").out
    error = run("replay split.obj split.pc2").error
    assert "cscd: warning: " in error and "--weld exact would close the mesh" in error
    assert run("replay split.obj split.pc2 --weld exact").error == ""


def moved(move):
    """The split cube, with vertex v moved along x by move(v)."""
    scene = cube(True)
    return Recording(scene.triangles, [[(x + move(v), y, z) for v, (x, y, z) in enumerate(frame)] for frame in scene.frames])


def test_suggests_welding_where_it_would_close_the_first_frame():
    """The first frame decides, not the model file."""
    apart = moved(lambda v: 0.125 * (v == 0))
    apart.write_mesh("apart.obj")
    apart.write_cache("apart.pc2")
    assert "--weld exact would close the mesh" in run("replay apart.obj split.pc2").error
    error = run("replay split.obj apart.pc2").error
    assert "open surface" in error and "would close the mesh" not in error


def test_welds_within_a_distance():
    """Copies of one corner that lie a little apart are welded by a distance, not by equality."""
    loose = moved(lambda v: 2.0**-16 * (v % 3) if v < 24 else 0.0)
    loose.write_mesh("loose.obj")
    loose.write_cache("loose.pc2")
    assert CLOSED in run("info loose.obj --weld 0.001").out and CLOSED not in run("info loose.obj --weld exact").out
    contacts = contacts_of("loose.obj loose.pc2", "--weld 0.001")
    assert len(contacts) >= 10 and all_in_triangles(contacts, loose)
    fails("info loose.obj --weld 100", "--weld 100", "collapses every triangle")


def test_collapsed_triangles_are_dropped_and_counted():
    """The first triangle of the file becomes a sliver, so that later ones get other numbers."""
    scene = cube(True)
    copy = max(v for v in range(1, 24) if scene.frames[0][v] == scene.frames[0][0])
    sliver = Recording([(0, copy, scene.triangles[0][2]), *scene.triangles[1:]], scene.frames)
    sliver.write_mesh("sliver.obj")
    error = run("replay sliver.obj split.pc2 --weld exact --contacts out.csv").error
    assert "cscd: warning: welding collapsed 1 triangle" in error
    faces = [contact.b for contact in read_contacts("out.csv") if contact.kind == "vf"]
    assert faces and all(any(set(face) <= set(triangle) for triangle in sliver.triangles) for face in faces)


def test_faces_keep_their_stiffness():
    write_soft_bar("bar.ply", 0.25, split=True)
    out = run("preprocess bar.ply --weld exact").out
    assert ": 2 regions by method charge; " in out and "480 vertices, 956 triangles, 1 component\n" in out


# ---- lists of pairs


def count_ignoring(text):
    Path("ignore.txt").write_bytes(text.encode())
    return len(contacts_of("clean.obj clean.pc2", "--ignore ignore.txt"))


def test_ignores_the_pairs_of_a_list():
    everything = count_ignoring("# nothing\n\n   # still nothing\n")
    assert everything > 0
    assert count_ignoring("components 0 1\n") == 0
    assert count_ignoring("  components 1, 0 # whatever the order\r\n") == 0
    assert count_ignoring("components 0 0\ncomponents 1 1\n") == everything
    pairs = [(a, b) if a % 2 else (b, a) for a in range(12) for b in range(12, 16)]
    assert count_ignoring("".join(f"{a} {b}\n" for a, b in pairs)) == 0
    left = [count_ignoring(f"{a} 15\n{a} 12") for a in range(12)]
    assert min(left) < everything == max(left + [everything])


@pytest.mark.parametrize("text", [
    "0 1\n\n0\n", "0 1\n#\n0 1 2\n", "0 1\n#\n0 16\n", "\n\n-1 2\n", "\n\ntriangles 1 2", "\n\ncomponents 0 2", "\n\n0 1 more",
    "\n\n1 99999999999999999999\n",
])
def test_names_the_line_of_a_bad_list(text):
    Path("ignore.txt").write_text(text)
    fails("replay clean.obj clean.pc2 --ignore ignore.txt", "ignore.txt:3: ", "expected", "A B")


def test_a_list_means_the_triangles_of_the_file():
    """Whatever welding does to them."""
    Path("ignore.txt").write_text("components 1 0\n")
    assert contacts_of("split.obj split.pc2", "--weld exact") != []
    assert contacts_of("split.obj split.pc2", "--weld exact --ignore ignore.txt") == []


def test_ignores_what_meets_at_rest():
    """Replays from a frame with intersections, and ignores the pairs that intersect there."""
    tetrahedra(8).write_mesh("inside.obj", 4)
    tetrahedra(8).write_mesh("apart.obj", 3)
    line = "replay inside.obj inside.obj apart.obj --timings --fail-on-contact"
    run(line, code=3)
    out = run(f"{line} --ignore-rest").out
    assert "3 triangle pairs that intersect or touch in frame 0 are left out" in out
    assert "intervals: 1 clean, 0 with contact, 0 intersecting, 0 unknown" in out
    run("check inside.obj --fail-on-contact", code=3)
    run("check inside.obj --fail-on-contact --ignore-rest")
