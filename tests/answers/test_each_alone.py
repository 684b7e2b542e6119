"""`check --each` and `check` of the same file say the same: what was found, how deep, and whether the run fails."""
from pathlib import Path

import pytest

from support.tool.mesh_files import box, write_glb
from support.tool.reading import json_of
from support.tool.running import run

# Cubes, each by its least corner and its side; what is found, and how deep by hand.
CASES = [
    ([((0, 0, 0), 1), ((2, 0, 0), 1)], "clean", 0.0),
    ([((0, 0, 0), 1), ((0.25, 0.25, 0.25), 0.5)], "inside", 0.25),
    ([((0.25, 0.25, 0.25), 0.5), ((0, 0, 0), 1)], "inside", 0.25),
    ([((0, 0, 0), 4), ((0.5, 1, 1), 1), ((9, 9, 9), 1)], "inside", 1.5),
    ([((0, 0, 0), 1), ((0.75, 0.25, 0.25), 0.5)], "crossing", 0.25),
]


def write_cubes(cubes, axis=0, scale=1.0):
    """axis: so many places coordinates are turned by."""
    text = ""
    for i, (low, side) in enumerate(cubes):
        low = low[3 - axis :] + low[: 3 - axis]
        text += box([scale * x for x in low], [scale * (x + side) for x in low], f"body {i}")
    Path("bodies.obj").write_text(text)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("number", range(len(CASES)))
def test_bodies_are_the_same_alone_and_among_many(number, axis):
    """Above and below its depth, --fail-depth decides as it does alone."""
    cubes, result, depth = CASES[number]
    scale = (1.0, 1.0 / 1024.0, 4096.0)[(number + axis) % 3]
    write_cubes(cubes, axis, scale)
    line = json_of(run("check --each bodies.obj --json -").out)
    frame = json_of(run("check bodies.obj --json -").out)["frames"][0]
    assert line["result"] == result and line["depth"] == frame["depth"] == pytest.approx(depth * scale, rel=1e-9)
    assert line["crossing"] == frame["crossing_pairs"] and frame["clean"] == (result == "clean")
    if axis == 0:
        for limit in (0.5 * depth * scale, 0.99 * depth * scale, 1.01 * depth * scale + 1e-9):
            code = 3 if depth > 0 and limit < depth * scale else 0
            run(f"check bodies.obj --fail-depth {limit!r} --quiet", code=code)
            run(f"check --each bodies.obj --fail-depth {limit!r} --quiet", code=code)


def test_people_read_how_deep_it_is():
    write_cubes(CASES[1][0])
    assert run("check --each bodies.obj").out == (
        "bodies.obj: 1 part lies inside another; no two triangles cross or touch. 1 place, body 0 x body 1, 0.25 deep.\n"
        "1 mesh: 0 clean, 1 with parts that share space\n")
    assert "250 mm deep.\n" in run("check --each bodies.obj --unit m --fail-depth 200mm", code=3).out
    out = run("check --each bodies.obj --no-depths").out
    assert ": Clean: no two triangles cross or touch. What lies inside was not looked at.\n" in out
    run("check --each bodies.obj --fail-depth 200mm", code=1)  # of what unit, nobody knows


def test_animations_are_played():
    """A triangle that flies through another one, at rest before it."""
    write_glb("flight.glb", [("VEC3", [0, -4, -4, 0, 4, -4, 0, 0, 4]), ("VEC3", [0, 0, 0, 1, 0.5, 0, 1, 0, 0.5]),
                             ("SCALAR", [0, 1]), ("VEC3", [1, 0, 0, -1, 0, 0])],
              nodes=[{"mesh": 0}, {"mesh": 1, "name": "dart", "translation": [1, 0, 0]}], scene=0, scenes=[{"nodes": [0, 1]}],
              meshes=[{"primitives": [{"attributes": {"POSITION": i}}]} for i in (0, 1)],
              animations=[{"samplers": [{"input": 2, "output": 3}],
                           "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]}])
    each, alone = (run(f"check {word} flight.glb --fail-on crossing", code=3).first_line for word in ("--each", ""))
    assert each == f"flight.glb: {alone}"
    for code, option in ((0, "--rest"), (3, "--fps 3"), (0, "--fps 1")):
        run(f"check --each flight.glb --fail-on crossing {option}", code=code)
