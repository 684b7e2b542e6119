"""The frames of a page: their positions are near the given ones, by an error that the page states; of many, some are kept."""
import math
import random
import struct
from pathlib import Path

import pytest

from replayed import report_of, write
from report_file import Report
from support.tool.recordings import Recording, tetrahedra
from support.tool.running import fails, run

BODY = [tuple(random.Random(3 * v + k).uniform(-1.0, 1.0) for k in range(3)) for v in range(50)]
FRAMES = 24


def body(size, x=0.0, centre=None):
    """The points of the body, times the size, about a centre."""
    sizes = (size, size, size) if isinstance(size, float) else size
    return [tuple(c + s * p for c, s, p in zip(centre or (x, -x / 2.0, 0.0), sizes, point)) for point in BODY]


def bursting(f):
    """Exceeds everything that a page can show."""
    return body(0.0, 1e80) if f == 20 else body(1.0 if f < 5 else 1e80 if f % 2 == 0 else 1e-60)


# How a body moves: the points in frame f, how many of the frames may begin a grid, and the largest relative error.
MOTIONS = {
    "still": (lambda f: body(1.0), 1, 2e-5),
    "wobbling": (lambda f: body((1.0 + 0.1 * math.sin(f), 1.0, 2.0), centre=(0.0, 0.01 * f, 0.0)), 1, 2e-5),
    "flying far": (lambda f: body(1.0, 10.0 ** (f % 12)), FRAMES, 2e-5),
    "shrinking": (lambda f: body(10.0**-f), FRAMES, 2e-5),
    "exploding": (lambda f: body(10.0**f, 3.0), 8, 2e-5),
    "swelling": (lambda f: body(1.7**f), 2, 2e-5),  # so slowly at first that the first grid becomes very fine
    "from a point": (lambda f: body(0.0 if f < 3 or f == 10 else 1.0, 5.0), 6, 2e-5),
    "flat": (lambda f: body((1.0, 0.0, 1e-9), centre=(f, f, 1e9)), 1, 2e-5),
    "a point": (lambda f: body(0.0, f * 1.1), FRAMES, 2e-5),
    "huge": (lambda f: body(2.0**280, f * 2.0**279), 1, 2e-5),
    "huge with zeros": (lambda f: [(0.0, f * 2.0**-300, 0.0) if v % 2 else p for v, p in enumerate(body(2.0**279))], 1, 2e-5),
    "tiny": (lambda f: body(2.0**-250, f * 2.0**-260), 1, 2e-5),
    "coarse doubles": (lambda f: [tuple(map(round, p)) for p in body(4.0, 2.0**52 + f)], 1, 2e-5),
    "jumping": (lambda f: body(1.0, 16000.0 if f % 2 == 0 else -16000.0), 2, 2e-5),
    "bursting": (bursting, FRAMES, 1.1),
}


@pytest.mark.parametrize("name", MOTIONS)
def test_frames_come_back(name):
    """The errors that the page states are those that are made, whatever the size of the body, and where it is."""
    place, grids_max, error_max = MOTIONS[name]
    given = [place(f) for f in range(FRAMES)]
    for f, points in enumerate(given):
        Path(f"f{f}.obj").write_text("".join("v {!r} {!r} {!r}\n".format(*p) for p in points) + "f 1 2 3\n")
    run("replay f0.obj f%d.obj --report page.html --method none --no-check --quiet")
    report = Report("page.html")
    scene, (error, relative) = report.scene, report.errors(given)
    assert scene["frames"] == list(range(FRAMES)) and len(report.frames()) == FRAMES
    assert (scene["max_error"], scene["relative_error"]) == (error, relative) and relative < error_max
    assert sum(begins for begins, *_ in report.records()) <= grids_max
    assert scene["plan"] is None and not {"region", "charge"} & set(report.arrays)
    size = {"huge": 2.0**280, "tiny": 2.0**-250}.get(name, scene["unit"])
    assert size <= scene["unit"] <= 8.0 * size


def test_still_frames_are_small():
    still = Recording([(0, 1, 2)], [body(1.0)])
    still.write_mesh("model.obj")
    still.write_cache("frames.pc2", 1000)
    report = report_of("--no-check")
    assert len(report.frames()) == 1000 and report.packed_sizes["frames"] < 3 * 150 + 2000


def test_of_long_recordings_few_frames_are_kept():
    """Eight vertices in more than two million frames. Every fifth is kept, and the replay ends early, after frame 112."""
    scene, size = tetrahedra(13), 8 * 12
    scene.write_mesh("model.obj")
    scene.write_cache("short.pc2")
    with open("frames.pc2", "wb") as file:  # most of it is a hole
        file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, 8, 0.0, 1.0, 2100101))
        file.seek(32 + 100 * size)
        file.write(Path("short.pc2").read_bytes()[32:] + struct.pack("<f", math.inf))
        file.truncate(32 + 2100101 * size)
    fails("replay model.obj frames.pc2 --frames 100: --report page.html --method single --quiet", "frame 113")
    report = Report("page.html")
    assert report.scene["frames"] == [100, 105, 110, 112] and report.scene["last"] == 112
    shown = zip(*report.frames()[3])
    assert all(math.dist(p, q) < 1e-3 for p, q in zip(shown, scene.frames[12]))
    assert len(report.arrays["orientation"]) == 3 * 2  # of the intervals 100, 105, 110
    assert "detector_points" not in report.arrays  # they would be two million times two


@pytest.mark.parametrize("moves, kept", [(True, list(range(0, 101, 2))), (False, list(range(101)))])
def test_moving_scenery_takes_room(moves, kept):
    """The page has room for four million positions of both."""
    write(tetrahedra(7)).write_cache("frames.pc2", 101)
    Path("ground.obj").write_text("v 0 0 0\n" * 40000 + "f 1 2 3\n")
    with open("ground.pc2", "wb") as file:
        file.write(struct.pack("<12siiffi", b"POINTCACHE2\0", 1, 40000, 0.0, 1.0, 101))
        file.truncate(32 + 101 * 40000 * 12)
    report = report_of("--no-check --scenery ground.obj" + " --scenery-frames ground.pc2" * moves)
    assert report.scene["frames"] == kept and report.scene["scenery"]["frames"] == (kept if moves else [0])


@pytest.mark.parametrize("moves", [False, True])
def test_scenery_comes_back(moves):
    write(tetrahedra(2))
    ground = Recording([(0, 1, 2)], [[(0, 0, z), (1, 0, z), (0, 1, z)] for z in range(2)])
    ground.write_mesh("ground.obj")
    ground.write_cache("ground.pc2")
    report = report_of("--scenery ground.obj" + " --scenery-frames ground.pc2" * moves)
    assert report.scene["scenery"] == {"vertices": 3, "triangles": 1, "frames": [0, 1] if moves else [0]}
    assert list(report.arrays["scenery_triangles"]) == [0, 1, 2]
    shown = [list(zip(*axes)) for axes in report.frames("scenery_frames", 3)]
    assert shown == ground.frames[: 1 + moves]  # exact: powers of two
