"""What the files for viewers say of each vertex and triangle, on scenes that only one number fits."""
from itertools import permutations
from pathlib import Path

import pytest

from support.tool.exported import Vtp
from support.tool.mesh_files import box, cube
from support.tool.running import run

KINDS = ("crossing", "coplanar", "folded", "duplicate", "touching")


def exported(*boxes, options=""):
    """The file of a scene."""
    Path("scene.obj").write_text("".join(boxes))
    run(f"check scene.obj --vtk out --quiet {options}")
    return Vtp("out_0000.vtp")


@pytest.mark.parametrize("order", permutations(range(3)))
def test_the_deepest_counts_where_several_bodies_contain_a_vertex(order):
    """The corner (1, 1, 1) of the probe is 1 deep in one cube, and 0.25 in the other."""
    boxes = (cube(0, 4, "Wide"), cube(0.75, 4, "Near"), cube(1, 8, "Probe"))
    file = exported(*(boxes[i] for i in order))
    places, depths = file.values("Points", "Points", "Float64"), file.values("PointData", "depth", "Float64")
    assert [depth for i, depth in enumerate(depths) if places[3 * i:3 * i + 3] == [1, 1, 1]] == [1]


@pytest.mark.parametrize("options, buried", [("", 1), ("--orientation as-given", 0)])
def test_what_an_inverted_body_holds_is_buried_unless_it_is_kept_as_given(options, buried):
    file = exported(cube(0, 4, "Room", inverted=True), cube(1, 1, "Crate"), options=options)
    assert file.values("CellData", "buried", "UInt8") == [0] * 12 + [buried] * 12


@pytest.mark.parametrize("order", permutations(range(3)))
def test_crossing_comes_before_touching(order):
    """A rod goes through a wall that a crate rests on."""
    boxes = (box((0, 0, 0), (8, 8, 1), "Wall"), box((1, 2, -1), (2, 3, 3), "Rod"), cube((1, 4, 1), 1, "Crate"))
    file = exported(*(boxes[i] for i in order))
    counts = list(zip(*(file.values("CellData", kind, "UInt32") for kind in KINDS)))
    assert any(crossing and any(others) for crossing, *others in counts)
    expected = [2 if crossing else int(any(others)) for crossing, *others in counts]
    assert file.values("CellData", "intersecting", "UInt8") == expected
