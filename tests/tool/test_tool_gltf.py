"""The tool replays glTF files, which hold a model and its frames."""
from pathlib import Path

import pytest

from support.tool.mesh_files import write_glb
from support.tool.reading import read_contacts
from support.tool.running import fails, run, usage_error


@pytest.fixture(autouse=True)
def files(own_folder):
    """Two triangles, of nodes "wall" at x = 0 and "dart" that flies through it.

    That is at x = 1 after 0 s, at -1 after 1 s, and there after 2 s by the second animation.
    """
    def animation(name, times):
        return {"name": name, "samplers": [{"input": times, "output": 4}],
                "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]}

    write_glb("scene.glb", [("VEC3", [0, -4, -4, 0, 4, -4, 0, 0, 4]), ("VEC3", [0, 0, 0, 1, 0.5, 0, 1, 0, 0.5]),
                            ("SCALAR", [0, 1]), ("SCALAR", [0, 2]), ("VEC3", [1, 0, 0, -1, 0, 0])],
              scene=0, scenes=[{"nodes": [0, 1]}],
              nodes=[{"mesh": 0, "name": "wall"}, {"mesh": 1, "name": "dart", "translation": [1, 0, 0]}],
              meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}, {"primitives": [{"attributes": {"POSITION": 1}}]}],
              animations=[animation("fast", 2), animation("slow", 3)])


@pytest.mark.parametrize("options, frame, toi", [
    ("", 11, 1.0),  # 24 frames a second: at frame 12
    ("--fps 5", 2, 0.5),
    ("--fps 5 --animation slow", 4, 1.0),
])
def test_a_file_is_model_and_frames(options, frame, toi):
    """The tip of the dart, vertex 3, is at the wall half way."""
    run(f"replay scene.glb --quiet --contacts out.csv {options}")
    first = read_contacts("out.csv")[0]
    assert (first.frame, first.kind, first.a) == (frame, "vf", (3,)) and first.toi == pytest.approx(toi, abs=1e-6)


def test_check_plays_the_animation():
    """check looks at the animation that a file holds, as replay does, and says so if not at all of it."""
    own = run("check scene.glb --fail-on crossing", code=3)
    assert own == run("check scene.glb scene.glb --fail-on crossing", code=3)
    assert "Frames 13 to 23 cross (11 of 25), frames 12, 24 touch (2 of 25). " in own.out
    assert "Only one of the 2 animations of scene was played.\n" in own.out
    assert run("check scene.glb --rest --fail-on crossing").out == \
        "Clean: no two triangles cross or touch. Only the rest pose of scene was looked at; its file holds animations.\n"
    usage_error("replay scene.glb --rest", "no FRAMES given")


def test_animations_of_objects_are_played():
    """So do the files of objects, which have as many frames, or are refused."""
    run("check --object scene=scene.glb --fail-on crossing --quiet", code=3)
    run("replay --object scene=scene.glb --fail-on crossing --quiet", code=3)
    run("check --object scene=scene.glb --fail-on crossing --quiet --rest")
    for name in ("beside.obj", "beside_2.obj"):
        Path(name).write_text("v 50 0 0\nv 51 0 0\nv 50 1 0\nf 1 2 3\n")
    run("check beside.obj --object scene=scene.glb --fail-on crossing --quiet", code=3)
    two_frames = "check beside.obj beside.obj beside_2.obj --object scene=scene.glb"
    fails(two_frames, "beside has 2 frames", "scene has 25", "--rest leaves files at rest")
    assert " Only the rest pose of scene was looked at; its file holds animations.\n" in run(f"{two_frames} --rest").out


def test_render_draws_the_animation():
    run("render scene.glb --frame 24 --size 64x48 -o frame.png")
    run("render scene.glb --frames 0:24:8 --size 32x24 -o frame.png")
    fails("render scene.glb --frame 24 --rest -o frame.png", "--frame 24")


def test_unknown_animations_are_refused():
    fails("replay scene.glb --animation walk", "holds no animation walk", "fast", "slow")
    usage_error("replay scene.glb --fps 0", "--fps cannot be '0'")
