"""Lenses, patches and cut-offs, as Python reads them."""
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import cscd

BOX = np.array([[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
                [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]])
CORNERS = np.array([[v & 1, v >> 1 & 1, v >> 2] for v in range(8)], float)


def two_boxes(depth: float, y: float = 0.55) -> Any:
    """A box whose tip is in another one, through one triangle, or with a smaller y over an edge."""
    return np.concatenate([CORNERS, 0.4 * CORNERS + [1.0 - depth, y, 0.1]]), np.concatenate([BOX, BOX + 8])


def plate(n: int, along: Any, across: Any, corner: Any) -> Any:
    """A sheet of n by n squares."""
    i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij")
    V = np.asarray(corner) + i.reshape(-1, 1) / n * np.asarray(along) + j.reshape(-1, 1) / n * np.asarray(across)
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    return V, np.concatenate([np.stack([a, a + n + 1, a + 1], 1), np.stack([a + n + 1, a + n + 2, a + 1], 1)])


def test_lenses_say_where_points_belong() -> None:
    x, faces = two_boxes(0.1)
    detector = cscd.Detector(faces)
    lenses = detector.find_lenses(x)
    assert lenses.thickness == pytest.approx(0.1) and lenses.pairs > 0 and lenses.undecided == 0
    assert len(lenses) == 1 and lenses.reason_names() == ["buried"]
    assert lenses.items.components[0].tolist() == [1, 0] and not lenses.items.fold[0]
    assert np.allclose(lenses.items.axis[0], [1, 0, 0])
    tip = lenses.points_of(0)
    assert tip.vertex.tolist() == [8, 10, 12, 14] and (tip.edge == -1).all() and not tip.along_normal.any()
    corners = x[detector.mesh.triangles[tip.triangle]]
    weights = np.stack([1 - tip.u - tip.v, tip.u, tip.v], 1)
    places = (weights[:, :, None] * corners).sum(1)
    assert np.allclose(tip.x + tip.thickness[:, None] * tip.direction, places, atol=1e-12)
    assert len(lenses.points) == 4 and "1 with 4 points" in repr(lenses)


def test_lenses_have_points_of_edges() -> None:
    x, faces = two_boxes(0.1, 0.15)
    detector = cscd.Detector(faces)
    lenses = detector.find_lenses(x)
    index = lenses.reason_names().index("edge")
    edge = lenses.points_of(index)
    assert (edge.vertex == -1).all() and lenses.items.patch[index] == -1
    ends = x[detector.mesh.edges[edge.edge]]
    assert np.allclose((1 - edge.s[:, None]) * ends[:, 0] + edge.s[:, None] * ends[:, 1], edge.x)
    assert np.allclose(edge.direction, [-1, 0, 0]) and np.allclose(edge.thickness, 0.1)


def test_untangling_tells_the_thickest_lens() -> None:
    for depth in (0.05, 0.1, 0.23):
        x, faces = two_boxes(depth)
        detector = cscd.Detector(faces)
        assert detector.untangle(x).thickness == detector.find_lenses(x).thickness == pytest.approx(depth)


def test_lenses_stay_when_the_detector_goes_on() -> None:
    x, faces = two_boxes(0.1)
    detector = cscd.Detector(faces)
    lenses = detector.find_lenses(x)
    before = lenses.points.copy()
    assert len(detector.find_lenses(x + np.arange(16)[:, None])) >= 0
    del detector
    assert (lenses.points == before).all()


def test_what_is_clean_has_none() -> None:
    x, faces = two_boxes(-0.1)
    lenses = cscd.Detector(faces).find_lenses(x)
    assert len(lenses) == len(lenses.points) == lenses.pairs == 0 and lenses.thickness == 0.0
    assert lenses.reason_names() == []


def test_parts_have_lenses_of_their_own() -> None:
    x, faces = two_boxes(0.1)
    detector = cscd.Detector(faces)
    detector.set_parts(np.repeat([1, 0], 12))
    lenses = detector.find_lenses(x)
    assert lenses.items.parts.tolist() == [[0, 1]] and lenses.items.objects[0].tolist() == [0, 0]
    assert lenses.thickness == detector.find_lenses(x, part_bodies=True).thickness


def test_patches_say_what_is_buried() -> None:
    x, faces = two_boxes(0.1)
    detector = cscd.Detector(faces)
    found = detector.find_intersections(x)
    lenses, patches = detector.find_lenses(x), found.patches
    assert len(patches) == 3 and patches is found.patches
    tip = lenses.items.patch[0]
    assert patches.vertices_of(tip).tolist() == [8, 10, 12, 14]
    assert patches.items.vertex_count[tip] == 4 and patches.items.component[tip] == 1
    assert patches.items.own[tip] == 1 or patches.items.winding_count[tip] == 1
    assert patches.items.triangle_count.tolist() == [len(patches.triangles_of(i)) for i in range(3)]
    assert (patches.vertex_patches >= 0).all() and (patches.triangle_patches == -1).any()
    assert patches.corner_patches.shape == (24, 3) and not patches.turned.any()
    assert len(patches.cut_offs) == 0 and len(found.curves) == 1
    assert cscd.Detector(np.concatenate([BOX, BOX[:, ::-1] + 8])).find_intersections(x).patches.turned.tolist() == [
        False, True]


def test_cut_offs_are_the_smaller_parts() -> None:
    lower, squares = plate(10, [2, 0, 0], [0, 2, 0], [0, 0, 0])
    upper, standing = plate(8, [0.9, 0, 0], [0, 0, 1], [0.53, 1.07, -0.3])
    x, faces = np.concatenate([lower, upper]), np.concatenate([squares, standing + len(lower)])
    detector = cscd.Detector(faces)
    found = detector.find_intersections(x)
    cut = found.patches.cut_offs
    assert len(cut) == 1 and cut.component[0] == 1
    assert cut.area[0] == pytest.approx(0.27) and cut.rest[0] == pytest.approx(0.63)
    below = found.patches.cut_off_patches(0)
    lenses = detector.find_lenses(x)
    assert below.tolist() == lenses.items.patch.tolist() and lenses.reason_names() == ["smaller side"]
    assert lenses.thickness == pytest.approx(0.3)
    assert sorted(found.patches.vertices_of(below[0])) == lenses.points_of(0).vertex.tolist()


def test_patches_that_do_not_fit_are_refused() -> None:
    x, faces = two_boxes(0.1)
    found = cscd.Detector(faces, max_memory=1000).find_intersections(x)
    with pytest.raises(MemoryError, match="do not fit max_memory"):
        found.patches
    with pytest.raises(cscd.ListTooLong):
        cscd.Detector(faces, max_memory=1000).find_lenses(x)
    with pytest.raises(ValueError, match="patches"):
        cscd.Detector(faces).find_intersections(x, kinds="crossing").patches
