"""The commands that look at single frames: check and info."""
import pytest

from support.tool.reading import read_json
from support.tool.recordings import Recording, bow_tie, cube, fold, tetrahedra, torus
from support.tool.running import fails, run, usage_error


@pytest.fixture(autouse=True)
def files(own_folder):
    flight = tetrahedra(8)
    flight.write_mesh("flight.obj")
    flight.write_cache("flight.pc2")


def test_check_lists_crossing_frames():
    answer = run("check flight.obj flight.pc2")
    found = "Frames 4 to 7 cross (4 of 8). 1 event, component 0 x component 1, frames 4 to 7"
    assert answer.out.startswith(found) and answer.error == ""
    assert run("check flight.obj flight.pc2 --frames 1::3").out.startswith("Frames 4 to 7 cross (2 of 3). ")
    assert run("check flight.obj flight.pc2 --quiet").out == ""


@pytest.mark.parametrize("code, line", [
    (3, "flight.obj flight.pc2"), (0, "flight.obj flight.pc2 --frames :3"), (3, "flight.obj flight.pc2 --frames 4"),
    (0, "flight.obj"),
])
def test_check_fails_when_asked(code, line):
    run(f"check --fail-on-contact {line}", code=code)


def test_wrong_frames_are_refused():
    for value in (":", "1:2:", "1:2:0", "1:2:x", "1:2:3:4", "5:2", "::", ""):
        usage_error(f"check flight.obj flight.pc2 --frames '{value}'", f"--frames cannot be '{value}'")
    fails("check flight.obj flight.pc2 --frames 3:8:5", "no frame 8", "frames 0 to 7")
    usage_error("replay flight.obj flight.pc2 --frames 0:4:2", "a step of 2", "replay takes A:B only")


def test_check_writes_every_frame():
    """Each pair joins a triangle of one tetrahedron to one of the other."""
    run("check flight.obj flight.pc2 --json check.json")
    root = read_json("check.json")
    assert root["complete"] is True and [frame["frame"] for frame in root["frames"]] == list(range(8))
    for k, frame in enumerate(root["frames"]):
        assert frame["crossing"] is bool(frame["pairs"]) is (k >= 4) and frame["zero_area_triangles"] == 0
        assert all(0 <= a < 4 <= b < 8 for a, b in frame["pairs"])


def test_check_keeps_what_precedes_a_bad_frame():
    tetrahedra(8).write_sequence("f_%02d.ply")
    cube(False).write_mesh("f_05.ply")
    answer = run("check flight.obj f_%02d.ply --json check.json", code=1)
    assert "f_05.ply" in answer.error and answer.out.startswith("Not finished: frame 5 could not be read: ")
    assert "5 of 8 frames checked. Frame 4 crosses (1 of 5). " in answer.out
    root = read_json("check.json")
    assert root["complete"] is False and "f_05.ply" in root["stopped_by"] and len(root["frames"]) == 5


def test_the_order_of_files_is_a_note():
    """That listed files are not taken as they were given is good to know, and no warning."""
    tetrahedra(3).write_sequence("listed_%d.obj", 9)
    error = run("check listed_10.obj listed_11.obj listed_9.obj").error
    assert error == "cscd: the frames are taken in the order of their numbers\n"


@pytest.mark.parametrize("scene, texts", [
    (tetrahedra(1), ["vertices    8\nedges       12\ntriangles   8\n", "components  2\n",
                     "bounds      (-4, 0, 0) to (7.5, 4, 4)\n",
                     "4 vertices, 6 edges, 4 triangles, Euler characteristic 2, closed, genus 0\n"]),
    (torus(12, 8), ["components  1\n", "96 vertices, 288 edges, 192 triangles, Euler characteristic 0, closed, genus 1\n",
                    "zero area   0 triangles\npairs       0 of triangles"]),
])
def test_info_describes_closed_meshes(scene, texts):
    scene.write_mesh("info.obj")
    answer = run("info info.obj")
    assert answer.error == ""
    for text in texts:
        assert text in answer.out


def turned_torus():
    """One of its triangles is the other way round."""
    whole = torus(12, 8)
    (a, b, c), *others = whole.triangles
    return Recording([(b, a, c), *others], whole.frames)


@pytest.mark.parametrize("scene, out, error", [
    (fold(8, 2, 1), "not a closed surface: 20 open edges, 0 non-manifold edges, 0 non-manifold vertices",
     "cscd: component 0 is an open surface, as cloth is (20 open edges, the first joins vertices 0 and 1): nothing is missed"),
    (bow_tie(), "components  1\n", "1 non-manifold vertices (the first is 0)"),
    (bow_tie(), "0 open edges, 0 non-manifold edges, 1 non-manifold vertices", ""),
    (turned_torus(), "3 inconsistently oriented edges", "3 inconsistently oriented edges"),
])
def test_info_describes_defects(scene, out, error):
    scene.write_mesh("info.obj")
    answer = run("info info.obj")
    assert out in answer.out and error in answer.error
