"""Volumes of overlaps, lengths of curves, surfaces of tetrahedra, and lists of candidates, as Python sees them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import cscd

BOX = np.array([[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
                [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]])
SHEET = np.array([[0, 1, 3], [0, 3, 2]])
CORNERS = np.array([[v & 1, v >> 1 & 1, v >> 2] for v in range(8)], float)


def boxes(offset: Any) -> Any:
    return np.concatenate([CORNERS, CORNERS + offset])


def detector_of_boxes() -> cscd.Detector:
    return cscd.Detector(cscd.Scene([cscd.Mesh(BOX), cscd.Mesh(BOX)]), threads=2)


@pytest.mark.parametrize("scalar", [np.float64, np.float32])
def test_volume_and_gradient(scalar: Any) -> None:
    """The volume of two boxes, and its differences."""
    detector = detector_of_boxes()
    x = boxes([0.5, 0.25, 0.75]).astype(scalar)
    found = detector.overlap_volumes(x)
    assert found.bodies.tolist() == [[0, 1]] and found.unknown == 0 and len(found) == 1
    assert float(found) == found.sum == pytest.approx(0.5 * 0.75 * 0.25, abs=1e-14)
    gradient = found.gradient
    assert gradient.shape == (16, 3) and np.allclose(gradient.sum(0), 0, atol=1e-14)
    assert np.allclose(gradient[8:].sum(0), [-0.75 * 0.25, -0.5 * 0.25, -0.5 * 0.75], atol=1e-14)
    assert np.array_equal(found.gradient_of(0), gradient)
    assert np.array_equal(found.weighted([2.0]), 2.0 * gradient)
    with pytest.raises(ValueError, match="weights: expected 1 numbers"):
        found.weighted([1.0, 2.0])


def test_length_and_gradient() -> None:
    detector = detector_of_boxes()
    x = boxes([0.5, 0.25, 0.75])
    found = detector.curve_lengths(x)
    assert found.sum == pytest.approx(2 * (0.5 + 0.75 + 0.25), abs=1e-14)
    rng = np.random.default_rng(1)
    step = rng.normal(size=x.shape) * 1e-6
    ahead, behind = (detector.curve_lengths(x + sign * step).sum for sign in (1, -1))
    assert 0.5 * (ahead - behind) == pytest.approx((found.gradient * step).sum(), rel=1e-5)


def test_unknown_volumes() -> None:
    """A sheet in a box: its own volume is unknown, and that of the boxes is not."""
    detector = cscd.Detector(cscd.Scene([cscd.Mesh(BOX), cscd.Mesh(BOX), cscd.Mesh(SHEET)]))
    sheet = np.array([[0.1, 0.1, 0.5], [0.3, 0.1, 0.5], [0.1, 0.2, 0.5], [0.3, 0.2, 0.5]])
    found = detector.overlap_volumes(np.concatenate([boxes([0.5, 0.25, 0.75]), sheet]))
    assert found.bodies.tolist() == [[0, 1], [0, 2]] and found.unknown == 1
    assert np.isnan(found.values[1]) and np.isnan(found.gradient_of(1)).all()
    assert found.sum == found.values[0] and np.isfinite(found.gradient).all()
    assert "1 unknown" in repr(found)


def test_apart() -> None:
    found = detector_of_boxes().overlap_volumes(boxes([2.0, 0.0, 0.0]))
    assert len(found) == 0 and found.sum == 0.0 and not found.gradient.any() and found.bodies.shape == (0, 2)


def test_batches_are_lists() -> None:
    """A batch is an array; a list of arrays of one size is still the objects of one scene."""
    detector = detector_of_boxes()
    batch = np.stack([boxes([0.5, 0.25, 0.75]), boxes([2.0, 0.0, 0.0]), boxes([0.25, 0.25, 0.25])])
    for measure in (detector.overlap_volumes, detector.curve_lengths):
        alone = [measure(x) for x in batch]
        together = measure(batch)
        assert [found.sum for found in together] == [found.sum for found in alone]
        assert all(np.array_equal(a.gradient, b.gradient) for a, b in zip(together, alone))
        assert measure([batch[0, :8], batch[0, 8:]]).sum == alone[0].sum and measure(batch[:0]) == []


def test_descent_parts_bodies() -> None:
    """A few steps against the gradient, and the boxes are apart."""
    detector = detector_of_boxes()
    x = boxes([0.9, 0.1, 0.2])
    for _ in range(50):
        found = detector.overlap_volumes(x)
        if found.sum == 0.0:
            break
        way = found.gradient[8:].sum(0)
        x[8:] -= way * (found.sum / (way @ way) + 1e-9)
    assert detector.overlap_volumes(x).sum == 0.0 and not detector.is_intersecting(x, "crossing")


def test_surface_of_tetrahedra() -> None:
    """The outer faces of a fan around a middle point, and the way back to its nodes."""
    corners = BOX + 1
    tetrahedra = np.column_stack([corners[:, 1], corners[:, 0], corners[:, 2], np.zeros(12, int)])
    surface = cscd.tet_surface(tetrahedra)
    assert surface.vertices.tolist() == list(range(1, 9)) and surface.tetrahedra.tolist() == list(range(12))
    nodes = np.concatenate([[[0.5, 0.5, 0.5]], CORNERS])
    x = nodes[surface.vertices]
    a, b, c = (x[surface.triangles[:, i]] for i in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(1.0)
    forces = np.zeros_like(nodes)
    np.subtract.at(forces, surface.vertices, np.ones_like(x))
    assert forces[0].tolist() == [0, 0, 0] and (forces[1:] == -1).all()


@pytest.mark.parametrize("tetrahedra, words", [
    ([[0, 1, 2, 2]], "tetrahedron 0 has the vertex 2 twice"),
    ([[0, 1, 2, 3], [0, 1, 2, 4]], "tetrahedra 0 and 1 lie on one side"),
    ([[0, 1, 2, 3], [0, 2, 1, 4], [1, 0, 2, 5]], "0, 1 and 2 have the face"),
    ([[0, 1, 2]], "tetrahedra: expected"),
])
def test_bad_tetrahedra(tetrahedra: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        cscd.tet_surface(tetrahedra)
    with pytest.raises(ValueError):
        cscd.tet_surface([[0, 1, 2, 5]], vertex_count=5)


def test_candidates() -> None:
    """Every near pair on the way is a candidate."""
    detector = detector_of_boxes()
    line = detector.line_search(boxes([0, 0, 1.3]), boxes([0.1, 0.2, 1.05]), 0.1)
    listed = line.candidates()
    assert listed.shape[1] == 3 and 0 < len(listed) <= line.candidate_count
    rows = [tuple(row) for row in listed]
    assert rows == sorted(set(rows))
    near = line.near(1.0, 0.1)
    assert len(near) and {(p.kind, p.a, p.b) for p in near} <= set(rows)
