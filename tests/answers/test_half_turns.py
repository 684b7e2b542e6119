"""`replay` says what shrinks on straight ways, because it turns far between two frames."""
from math import cos, radians, sin
from pathlib import Path

import pytest

from support.tool.running import run

QUADS = ((1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6))


def box(size, place):
    """The corners of a box about a place."""
    return [[place[k] + size[k] * ((i >> k & 1) - 0.5) for k in range(3)] for i in range(8)]


def turned(corners, place, degrees):
    """About an axis through a place, along z."""
    c, s = cos(radians(degrees)), sin(radians(degrees))
    return [[place[0] + c * (x - place[0]) - s * (y - place[1]), place[1] + s * (x - place[0]) + c * (y - place[1]), z]
            for x, y, z in corners]


def write(name, bodies, heading="o {}"):
    """An OBJ of boxes by their names."""
    lines = []
    for k, (body, corners) in enumerate(bodies.items()):
        lines += [heading.format(body), *("v {} {} {}".format(*corner) for corner in corners),
                  *("f {} {} {} {}".format(*(8 * k + i for i in quad)) for quad in QUADS)]
    Path(name).write_text("\n".join(lines) + "\n")


def write_frames(angles, size=(6, 0.5, 0.125), heading="o {}"):
    """A still rock, and a blade far from the origin, which stands at these angles."""
    place = (1000, -500, 3)
    for k, degrees in enumerate(angles):
        write(f"f{k}.obj", {"Rock": box((1, 1, 1), (1010, -500, 3)), "Blade": turned(box(size, place), place, degrees)}, heading)


@pytest.mark.parametrize("degrees, percent", [(107, None), (108, 59), (120, 50), (150, 26), (180, 2), (-170, 9)])
def test_what_turns_far_is_named(degrees, percent):
    """A thin thing shrinks to the cosine of half the angle, and never below its thickness along the axis."""
    write_frames([0, 10, 10 + degrees, 20 + degrees, 20 + 2 * degrees])
    error = run("replay f0.obj 'f%d.obj'").error
    assert error == ("" if percent is None else
                     f"cscd: part Blade shrinks to {percent} % of its size half-way from frame 1 to 2, as straight ways do "
                     "to what turns far between two frames: it may touch itself for that reason alone, and hits of its true "
                     "way can be missed; record more frames\n")


def test_a_ball_of_a_body_keeps_its_axis():
    """A cube keeps a third of its squares, along the axis, so it is named from some 161 degrees on."""
    write_frames([0, 160], (2, 2, 2))
    assert run("replay f0.obj 'f%d.obj'").error == ""
    write_frames([0, 165], (2, 2, 2))
    assert "part Blade shrinks to 59 %" in run("replay f0.obj 'f%d.obj'").error


def test_what_is_mirrored_is_named():
    place = (5, 5, 5)
    for k in range(2):
        corners = box((4, 4, 0.25), place)
        write(f"f{k}.obj", {"Card": [[10 - x if k else x, y, z] for x, y, z in corners], "Rock": box((1, 1, 1), (20, 0, 0))})
    assert "shrinks" not in run("replay f0.obj 'f%d.obj'").error  # half of its squares stay
    for k in range(2):
        corners = box((4, 1, 0.25), place)
        write(f"f{k}.obj", {"Card": [[10 - x if k else x, y, z] for x, y, z in corners], "Rock": box((1, 1, 1), (20, 0, 0))})
    assert "part Card shrinks to 25 %" in run("replay f0.obj 'f%d.obj'").error


def test_of_several_the_worst_is_named():
    for k in range(2):
        write(f"f{k}.obj", {name: turned(box((6, 0.5, 0.125), (10 * i, 0, 0)), (10 * i, 0, 0), k * degrees)
                            for i, (name, degrees) in enumerate((("Slow", 120), ("Fast", 150), ("Medium", 130)))})
    error = run("replay f0.obj 'f%d.obj'").error
    assert "part Fast shrinks" in error and error.count("\n") == 1


def test_unnamed_parts_are_components():
    write_frames([0, 150], heading="# {}")
    assert "cscd: component 1 shrinks to 26 %" in run("replay f0.obj 'f%d.obj'").error


def test_quiet_is_quiet():
    write_frames([0, 150])
    assert run("replay f0.obj 'f%d.obj' --quiet").error == ""
