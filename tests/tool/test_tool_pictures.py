"""Pictures and pages for people with files of many programs: which way is up, how near a zoom goes, what a page is called."""
from pathlib import Path

import pytest

from support.tool.recordings import Recording, tetrahedra
from support.tool.running import fails, run


@pytest.fixture(autouse=True)
def flight(own_folder):
    flight = tetrahedra(8)
    flight.write_mesh("flight.obj")
    flight.write_mesh("flight.ply")
    flight.write_cache("flight.pc2")
    return flight


def draw(options="", model="flight.obj", frames="flight.pc2"):
    run(f"render {model} {frames} --frame 3 -o out.png --size 160x120 {options}")
    return Path("out.png").read_bytes()


def page(options="", model="flight.obj"):
    run(f"replay {model} flight.pc2 --quiet --report out.html {options}")
    return Path("out.html").read_text(encoding="utf-8")


def test_the_format_says_what_is_up():
    """OBJ stands on y, as exporters write it; PLY on z."""
    assert draw() == draw("--up y") != draw("--up z")
    assert draw(model="flight.ply") == draw("--up z", "flight.ply")
    for model, options, up in (("flight.obj", "", "y"), ("flight.obj", "--up z", "z"),
                               ("flight.ply", "", "z"), ("flight.ply", "--up y", "y")):
        assert f'"up":"{up}"' in page(options, model)


def test_a_zoom_does_not_depend_on_the_origin(flight):
    """A zoom to one contact shows what is around it, and the same wherever the body stands."""
    far = Recording(flight.triangles, [[(x + 1024, y + 1024, z + 1024) for x, y, z in frame] for frame in flight.frames])
    far.write_mesh("far.obj")
    far.write_cache("far.pc2")
    near = draw("--colour=contacts --zoom")
    assert near == draw("--colour=contacts --zoom", "far.obj", "far.pc2")
    assert near != draw("--colour=contacts")


@pytest.mark.parametrize("flake, seen", [
    ("v 0.2 1 1.15\nv 0.2 1.05 1.2\nv 0.2 0.95 1.2\nf 1 2 3\n", True),
    ("v 0.2 5 1.15\nv 0.2 5.05 1.2\nv 0.2 4.95 1.2\nf 1 2 3\n", False),
])
def test_a_zoom_shows_a_tenth_of_the_body(flake, seen):
    """A twentieth of the body on each side of the contact is in view: a flake there is seen, and one far away is not."""
    Path("flake.obj").write_text(flake)
    assert (draw("--colour=contacts --zoom") != draw("--colour=contacts --zoom --scenery flake.obj")) == seen


def test_pictures_leave_out_what_the_rules_say():
    """render leaves out what replay leaves out."""
    assert draw("--colour=contacts") != draw("--colour=contacts --ignore-parts='component 1'")
    fails("render flight.obj flight.pc2 -o out.png --only Shirt", "no part", "component 0")


def test_pages_have_a_title_and_seconds():
    text = page()
    assert '"title":"flight.obj"' in text and '"fps":null' in text
    text = page("--title 'Shot <12>' --fps 25")
    assert '"title":"Shot \\u003c12>"' in text and '"fps":25' in text
