"""`check --each`: many different meshes, a line for each, in their order, whatever happens to one of them."""
import signal
from collections import Counter
from pathlib import Path

import pytest

from support.tool.reading import json_of, lines_of, read_csv, read_json_lines
from support.tool.recordings import cube, fold, tetrahedra
from support.tool.running import CROSSING, SQUARE, fails, finish, run, start, usage_error, wait_until

KINDS = ("crossing", "coplanar", "folded", "duplicate", "touching")
SMALL = {
    "clean": f"{SQUARE}v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\nf 4 5 6\n",
    "touching": f"{SQUARE}v 1 1 0\nv 2 1 5\nv 1 2 5\nf 1 2 3\nf 4 5 6\n",
    "plane": f"{SQUARE}v 1 1 0\nv 3 1 0\nv 1 3 0\nf 1 2 3\nf 4 5 6\n",
    "twice": f"{SQUARE}f 1 2 3\nf 2 3 1\n",
    "folded": f"{SQUARE}v 3 3 0\nv 1 1 0\nf 1 2 3\nf 1 2 5\n",
    "mixed": f"{SQUARE}v 1 1 -1\nv 1 1 1\nv 2 1 1\nv 1 2 0\nv 2 2 9\nv 1 3 9\nf 1 2 3\nf 4 5 6\nf 7 8 9\n",
}
# Large ones come first, so that whoever checks the others has to wait.
MESHES = ["fold.obj", "open.ply", *(f"flight_{k}.obj" for k in range(8)), *(f"{name}.obj" for name in SMALL)]


@pytest.fixture(autouse=True, scope="module")
def meshes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("meshes")
    fold(60, 40, 6).write_mesh(folder / "fold.obj", 5)
    fold(60, 40, 6).write_mesh(folder / "open.ply")
    tetrahedra(8).write_sequence(f"{folder}/flight_%d.obj")
    for name, text in {**SMALL, "damaged": f"{SQUARE}f 1 2 9\n",
                       "named": CROSSING.replace("f 1", "o Sheet\nf 1").replace("f 4", "o Blade\nf 4")}.items():
        (folder / f"{name}.obj").write_text(text)
    return folder


@pytest.fixture(autouse=True)
def stand_there(own_folder, meshes):
    for path in meshes.iterdir():
        Path(path.name).symlink_to(path)


def check_all(options):
    return run(f"check --each {options}", *MESHES)


# ---- answers


def test_every_mesh_has_its_answer():
    """That of `check` alone, whose table lists the pairs; and, by hand, those of the small ones."""
    assert check_all("--json out.jsonl").error == ""
    lines = {line["file"]: line for line in read_json_lines("out.jsonl")}
    assert list(lines) == MESHES
    for name, line in lines.items():
        run(f"check {name} --csv pairs.csv --quiet")
        rows = read_csv("pairs.csv")
        kinds, crossing = Counter(row["kind"] for row in rows), [row for row in rows if row["kind"] == "crossing"]
        assert all(line[kind] == kinds[kind] for kind in KINDS if kind != "duplicate")
        assert line["crossing_faces"] == len({row[side] for row in crossing for side in "ab"})
        assert line["crossing_share"] == line["crossing_faces"] / line["triangles"]
        assert line["error"] is None and line["read_ms"] > 0 and line["check_ms"] > 0
    assert (lines["fold.obj"]["triangles"], lines["fold.obj"]["vertices"]) == (4800, 41 * 61)
    assert {name: [lines[f"{name}.obj"][kind] for kind in KINDS] for name in SMALL} == {
        "clean": [0, 0, 0, 0, 0], "touching": [0, 0, 0, 0, 1], "plane": [0, 1, 0, 0, 0], "twice": [0, 0, 0, 1, 0],
        "folded": [0, 0, 1, 0, 0], "mixed": [1, 0, 0, 0, 1]}


def test_lines_say_it_for_people():
    touch = "1 pair of triangles touches, none cross. 1 place, {}. What lies inside was not looked at."
    chosen = "flight_4.obj flight_0.obj touching.obj plane.obj twice.obj folded.obj mixed.obj"
    assert run(f"check --each {chosen} --no-depths").out == (
        "flight_4.obj: 3 pairs of triangles cross, with 4 of 8 triangles (50 %). 1 place, component 0 x component 1.\n"
        "flight_0.obj: Clean: no two triangles cross or touch. What lies inside was not looked at.\n"
        f"touching.obj: {touch.format('component 0 x component 1')}\n"
        f"plane.obj: {touch.format('component 0 x component 1')}\n"
        "twice.obj: One triangle is there twice; no two others cross or touch. What lies inside was not looked at.\n"
        f"folded.obj: {touch.format('folded x itself')}\n"
        "mixed.obj: 1 pair of triangles crosses, with 2 of 3 triangles (66.7 %); 1 touches. 2 places, worst: component 0 x "
        "component 1.\n"
        "7 meshes: 1 clean, 2 with intersections, 3 only touching, 1 only with duplicates\n")


def test_any_number_of_threads_says_the_same():
    answers = []
    for threads in (1, 2, 3, 7, 64, 0):
        out = check_all(f"--json out.jsonl --threads {threads}").out
        lines = [{key: value for key, value in line.items() if not key.endswith("_ms")} for line in read_json_lines("out.jsonl")]
        answers.append((out, lines))
    assert all(answer == answers[0] for answer in answers)


def test_vertices_are_welded_and_parts_left_out():
    def numbers(line):
        run(f"check --each {line} --json out.jsonl --quiet")
        (only,) = read_json_lines("out.jsonl")
        return only["vertices"], only["crossing"]

    cube(True).write_mesh("cube.obj")
    assert numbers("cube.obj")[0] == 28 and numbers("cube.obj --weld exact")[0] == 12
    assert numbers("named.obj") == (6, 1)
    assert numbers("named.obj --ignore-parts Blade,Sheet") == numbers("named.obj --only Blade,Blade") == (6, 0)


# ---- what goes wrong


def test_a_file_that_fails_is_a_line():
    missing = "/nowhere/at_all.obj: cannot open: No such file or directory"
    answer = run("check --each clean.obj damaged.obj /nowhere/at_all.obj touching.obj --json out.jsonl --fail-on-contact", code=1)
    assert answer.out == (
        "clean.obj: Clean: no two triangles cross or touch.\n"
        f"damaged.obj:4: face index 9 is out of range, the file has 3 vertices\n{missing}\n"
        "touching.obj: 1 pair of triangles touches, none cross. 1 place, component 0 x component 1.\n"
        "4 meshes: 1 clean, 1 only touching, 2 failed\n")
    assert answer.error == "cscd: 2 of 4 meshes could not be checked\n"
    lines = read_json_lines("out.jsonl")
    assert len(lines) == 4 and lines[2]["error"] == missing
    for line in lines[1:3]:
        assert [line[key] for key in ("triangles", "crossing", "depth", "crossing_share", "read_ms")] == [None] * 5


def test_reasons_name_their_files():
    """A part that one mesh lacks is the fault of that one; its sentence has no name of a file, and is given one."""
    answer = run("check --each clean.obj named.obj --only Blade --quiet", code=1)
    assert answer.out == "" and answer.error.startswith("cscd: clean.obj: --only: there is no part 'Blade'")
    assert "named.obj" not in answer.error


@pytest.mark.parametrize("name", SMALL)
@pytest.mark.parametrize("kind", ["crossing", "touching"])
def test_exit_codes_say_what_was_found(name, kind):
    """Those of `check` alone, of which mesh and kind ever."""
    guilty = {"crossing": ["mixed"], "touching": ["touching", "plane", "twice", "folded", "mixed"]}[kind]
    code = 3 if name in guilty else 0
    run(f"check {name}.obj --fail-on {kind}", code=code)
    run(f"check --each clean.obj {name}.obj --fail-on {kind}", code=code)


def test_failures_come_before_findings():
    run("check --each clean.obj touching.obj --fail-on-contact", code=3)
    run("check --each clean.obj damaged.obj", code=1)


@pytest.mark.parametrize("options", [
    "--frames 0:1", "--object a=b.obj", "--ignore x", "--parts x.csv", "--allow-gaps", "--csv x.csv", "--ignore-rest",
])
def test_options_of_one_recording_are_refused(options):
    usage_error(f"check --each clean.obj {options}", "--each", options.split()[0])


def test_outputs_are_as_everywhere():
    usage_error("check --each", "--each", "no meshes")
    usage_error("check --each touching.obj clean.obj --json clean.obj", "--json", "would overwrite")
    usage_error("check --each clean.obj --json x.csv", "--json", "ends in .jsonl")
    fails("check --each clean.obj --json /nowhere/x.jsonl", "/nowhere/x.jsonl", "cannot write", code=4)
    fails("check --each clean.obj --json /dev/full", "/dev/full", "No space left", code=4)


def test_a_dash_is_the_standard_output():
    answer = check_all("--json -")
    assert [json_of(line)["file"] for line in lines_of(answer.out)] == MESHES
    assert ": Clean: no two triangles cross or touch.\n" in answer.error


def test_an_interrupt_keeps_what_is_done(own_folder):
    """A thousand meshes of thousands of triangles take far longer than the signal."""
    process = start("check --each --json out.jsonl", *["open.ply"] * 1195)
    wait_until(lambda: any(path.stat().st_size > 0 for path in own_folder.glob(".cscd-output-*")), process)
    process.send_signal(signal.SIGINT)
    error, done = finish(process, code=130).error, len(read_json_lines("out.jsonl"))
    assert 0 < done < 1195
    assert error == f"cscd: interrupted after {done} of 1195 meshes; what was found is kept in out.jsonl\n"
