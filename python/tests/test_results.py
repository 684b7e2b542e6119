"""Results: whole numbers are signed and of 64 bits, so that what callers compute from them does not wrap."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any, List, Tuple

import numpy as np
import pytest

import cscd
import oracle


def crossing_cubes() -> Tuple[Any, Any]:
    """Two cubes, the second shifted into the first, so that vertices and edges have depths."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    faces = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    return np.concatenate([corners, corners * [.5, .5, 3] + [.25, .25, -.5]]), np.concatenate([faces, faces + 8])


def integers_of(array: Any) -> List[Any]:
    """The dtypes of whole numbers of an array, or of the members of its records."""
    dtypes = [array.dtype] if array.dtype.names is None else [array.dtype[name].base for name in array.dtype.names]
    return [dtype for dtype in dtypes if dtype.kind in "iu"]


def check_signed(*arrays: Any) -> None:
    for array in arrays:
        found = integers_of(array)
        assert found and set(found) == {np.dtype(np.int64)}, array.dtype


def test_whole_numbers_are_signed() -> None:
    V, F = crossing_cubes()
    found = cscd.self_intersections(V, F)
    mesh = found.mesh
    check_signed(found.pairs, found.triangles, found.kind, found.shared, found.components, found.objects, found.depths,
                 found.by_parts(np.zeros(mesh.triangle_count, int)), found.curves[0].triangles)
    check_signed(mesh.triangles, mesh.triangle_face, mesh.triangle_objects, mesh.triangle_components, mesh.edges)
    detector = cscd.Detector(mesh)
    near = detector.near(V, .2, unique=True)
    check_signed(near, detector.check(V))
    replay = cscd.replay([V, V], mesh)
    for _ in replay:
        pass
    check_signed(replay.events)
    plan = cscd.Plan.kmeans(mesh, V, 2)
    check_signed(plan.triangle_regions, plan.regions)
    assert len(near) and (-near["count"] < 0).all() and (near["a"] - near["b"]).min() < 0


def test_what_has_no_surface_is_named() -> None:
    """Two cubes that cross, of which the one, the other, both or none is hidden: by a scale of 0, or squashed to a line."""
    V, F = crossing_cubes()
    mesh = cscd.Mesh(F, positions=V)
    detector = cscd.Detector(mesh)
    frames, hidden = [], [[], [0], [1], [0, 1], [1], []]
    for number, gone in enumerate(hidden):
        frame = V.copy()
        for cube in gone:
            frame[8 * cube:8 * cube + 8] *= [0, 0, number % 2]
        frames.append(frame)
    for frame, gone in zip(frames, hidden):
        for found in (cscd.self_intersections(frame, F), detector.find_intersections(frame)):
            assert found.collapsed.tolist() == gone and found.collapsed.dtype == np.int64
            assert len(found) == 0 if gone else len(found) > 0
            assert ("without a surface" in repr(found)) == bool(gone), repr(found)
            assert detector.is_intersecting(frame) == (not gone)
        assert pickle.loads(pickle.dumps(found)).collapsed.tolist() == gone
        assert (found.max_depth > 0.0) == (not gone)
    for answer, gone in zip(cscd.replay(frames, mesh), hidden):
        assert answer.intersections.collapsed.tolist() == gone
    both = cscd.intersections(frames[1][:8], F[:6], V[8:], F[:6])
    assert len(both) == 0 and both.collapsed.tolist() == [0]
    detector.check(frames[2])
    assert detector.collapsed() == [1]
    detector.step(frames[1], frames[2])
    assert detector.collapsed() == [0, 1]
    assert [detector.guarantee(i)["reason"] for i in (0, 1)] == [detector.guarantee(0)["reason"]] * 2
    assert not detector.guarantee(0)["complete"]


def test_contacts_are_signed_and_have_their_weights() -> None:
    scene = oracle.make_grid_soup(3)
    scene = oracle.Scene(scene.x0.astype(float), scene.x1.astype(float), scene.F)
    found = cscd.contacts(scene.x0, scene.x1, scene.F)
    check_signed(found, found[:2], found[0:0])
    moved = scene.x0[found.vertices] + found.toi[:, None, None] * (scene.x1 - scene.x0)[found.vertices]
    assert len(found) > 5
    np.testing.assert_allclose((found.weights[..., None] * moved).sum(1), 0, atol=1e-7)


def test_what_there_is_not_is_minus_one() -> None:
    V, F = crossing_cubes()
    depths = cscd.self_intersections(V, F).depths
    of_vertices, of_edges = depths[depths["vertex"] != -1], depths[depths["edge"] != -1]
    of_faces = depths[(depths["vertex"] == -1) & (depths["edge"] == -1)]
    assert len(of_edges) and len(of_faces) and len(of_vertices) + len(of_edges) + len(of_faces) == len(depths)
    assert (of_edges["vertex"] == -1).all() and (of_edges["patch"] == -1).all() and (depths["face"] >= 0).all()
    component = cscd.Mesh(F, positions=V).component(0)
    assert component["first_open_edge"] == -1 and component["vertex_count"] == 8


def test_lists_are_whole() -> None:
    """A list that is longer than what is copied at once: all pairs of triangles at the same place."""
    count = 400
    x = np.tile([[0., 0, 0], [1, 0, 0], [0, 1, 0]], (count, 1))
    found = cscd.Detector(np.arange(3 * count).reshape(-1, 3)).check(x)
    np.testing.assert_array_equal(found, np.column_stack(np.triu_indices(count, 1)))


def test_depth_in_two_objects() -> None:
    """A vertex that two bodies contain is as deep as in the one that contains it deeper, whichever comes first."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    faces = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    large, shifted, small = 4 * corners, 4 * corners + 1, .5 * corners + 1.5
    scene = cscd.Scene([cscd.Mesh(faces, positions=corners)] * 3)
    for bodies in ([large, shifted, small], [shifted, large, small]):
        np.testing.assert_allclose(cscd.self_intersections(np.concatenate(bodies), scene).depth[16:], small.min(axis=1))


def test_faces_without_a_part(tmp_path: Path) -> None:
    """A face of a file that stands before the first group."""
    path = tmp_path / "part.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\ng Named\nf 1 2 4\n", encoding="ascii")
    recording = cscd.read(path)
    assert recording.part_names == ["Named"] and recording.part_labels.tolist() == [-1, 0]


def test_what_does_not_fit_is_not_given() -> None:
    V, F = crossing_cubes()
    mesh = cscd.self_intersections(V, F).mesh
    for limit, value in (("max_memory", 1 << 12), ("max_work", 1)):
        found = cscd.Detector(mesh, **{limit: value}).find_intersections(V)
        with pytest.raises(MemoryError) as caught:
            assert found.max_depth >= 0.0
        assert f"do not fit {limit}, of which " in str(caught.value)
    assert cscd.Detector(mesh, max_work=1 << 20).find_intersections(V).max_depth > 0.0
