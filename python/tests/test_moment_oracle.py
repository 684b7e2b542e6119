"""Questions about one moment equal brute force over all pairs of triangles, on scenes of the C tests and on grids."""

from __future__ import annotations

from typing import Any, Iterator, List, Tuple

import numpy as np
import pytest

import cscd
import oracle

SUBSETS = ["crossing", ("coplanar",), ("folded", "duplicate"), ("crossing", "coplanar", "folded", "duplicate"), "touching"]


def scenes() -> List[Tuple[str, oracle.Scene]]:
    """Scenes with and without intersections, also at the end of their motion."""
    found = []
    for family in oracle.FAMILIES:
        for seed in range(3 if family != "grid" else 30):
            scene = oracle.make_scene(family, 70 + seed)
            found.append((family, scene))
            found.append((family, oracle.Scene(scene.x1, scene.x0, scene.F)))
    found += [("grid soup", oracle.make_grid_soup(seed)) for seed in range(40)]
    return found


SCENES = scenes()


def rows_of(found: cscd.Intersections) -> Any:
    return np.column_stack([found.triangles, found.kind, found.shared])


def codes_of(kinds: Any) -> List[int]:
    return [cscd.INTERSECTION_KINDS.index(name) for name in ([kinds] if isinstance(kinds, str) else kinds)]


def test_all_pairs_and_kinds() -> None:
    """The same pairs, kinds and shared vertices, with one thread and with two, in doubles and in floats."""
    of_kind = np.zeros(5, int)
    empty = 0
    for i, (name, scene) in enumerate(SCENES):
        for scalar in (np.float64, np.float32):
            x = scene.x0.astype(scalar)
            truth = oracle.kinds(x.astype(np.float64), scene.F)
            found = cscd.self_intersections(x, scene.F, threads=1 + i % 2)
            assert np.array_equal(rows_of(found), truth), (name, i)
            assert np.array_equal(found.pairs, truth[:, :2])
            assert len(found) == len(truth) and bool(found) == bool(len(truth))
            assert found.kind_names() == [cscd.INTERSECTION_KINDS[kind] for kind in truth[:, 2]]
            of_kind += np.bincount(truth[:, 2], minlength=5)
            empty += len(truth) == 0
    assert of_kind.min() > 40 and empty > 50, (of_kind, empty)


def test_some_kinds_and_the_first_pair() -> None:
    """Of a set of kinds the pairs of these; whether there is one; and the faces that are in one."""
    answers = {True: 0, False: 0}
    for name, scene in SCENES[::2]:
        truth = oracle.kinds(scene.x0, scene.F)
        for kinds in SUBSETS:
            wanted = truth[np.isin(truth[:, 2], codes_of(kinds))]
            assert np.array_equal(rows_of(cscd.self_intersections(scene.x0, scene.F, kinds)), wanted), (name, kinds)
            answer = cscd.is_self_intersecting(scene.x0, scene.F, kinds)
            assert answer is (len(wanted) > 0), (name, kinds)
            answers[answer] += 1
        assert cscd.is_self_intersecting(scene.x0, scene.F, threads=2) is (len(truth) > 0)
    assert min(answers.values()) > 50, answers


@pytest.mark.parametrize("threads", [1, 2])
def test_faces_of_many_frames(threads: int) -> None:
    """Every frame of a motion as by itself; an array of frames, a list, and a generator."""
    marked = 0
    for family in ("noisy sphere", "nested spheres", "soup", "bow-tie"):
        scene = oracle.make_scene(family, 5)
        times = np.linspace(0.0, 1.0, 7)[:, None, None]
        frames = (1.0 - times) * scene.x0 + times * scene.x1
        truth = np.zeros((len(frames), len(scene.F)), bool)
        for row, frame in zip(truth, frames):
            pairs = oracle.kinds(frame, scene.F)
            row[pairs[pairs[:, 2] == 0, :2]] = True
        for given in (frames, list(frames), (frame for frame in frames), np.asfortranarray(frames)):
            found = cscd.self_intersecting_faces(given, scene.F, threads=threads)
            assert found.dtype == bool and np.array_equal(found, truth), family
        found = cscd.self_intersecting_faces(frames, scene.F, iter(["crossing"]), threads=threads)
        assert np.array_equal(found, truth), "kinds that can be read only once are those of every frame"
        marked += truth.sum()
    assert marked > 300


@pytest.mark.parametrize("threads", [1, 2, 0])
def test_frames_in_one_array(threads: int) -> None:
    """A generator that fills the same array for each frame."""
    random = np.random.default_rng(5)
    F = np.arange(12000).reshape(-1, 3)
    frames = [np.repeat(random.uniform(0, 20, (4000, 3)), 3, axis=0) + random.uniform(0, 1, (12000, 3)) for _ in range(13)]

    def refilled() -> Iterator[Any]:
        array = np.empty_like(frames[0])
        for frame in frames:
            array[:] = frame
            yield array

    truth = cscd.self_intersecting_faces(frames, F)
    assert len(np.unique(truth, axis=0)) == len(frames)
    assert np.array_equal(cscd.self_intersecting_faces(refilled(), F, threads=threads), truth)


def test_without_triangles() -> None:
    """Positions and kinds that do not fit are refused, although there is nothing to find."""
    V = np.zeros((3, 3))
    for call in (cscd.self_intersections, cscd.is_self_intersecting, cscd.self_intersecting_faces):
        positions: Any = [V] if call is cscd.self_intersecting_faces else V
        assert not np.any(len(call(positions, [])) if call is cscd.self_intersections else call(positions, []))
        with pytest.raises(ValueError, match="^kinds: .*'cross'"):
            call(positions, [], "cross")
    for call in (cscd.self_intersections, cscd.is_self_intersecting):
        with pytest.raises(ValueError, match="^V: vertex 0 has x = nan"):
            call(V * np.nan, [])
    with pytest.raises(ValueError, match="^x1: vertex 0 has x = nan"):
        cscd.contacts(V, V * np.nan, [])
    with pytest.raises(ValueError, match="^x1: expected"):
        cscd.contacts(V, V[:2], [])


def test_intersections_of_two_meshes() -> None:
    """Pairs of one triangle each; what a mesh does with itself is left out."""
    count = 0
    for seed in range(12):
        parts = [oracle.make_scene(name, seed) for name in ("soup", "noisy sphere" if seed % 2 else "grid")]
        whole, _, (first, second) = oracle.joined(parts)
        border = len(first.F)
        truth = oracle.kinds(whole.x0, whole.F)
        truth = truth[(truth[:, 0] < border) & (truth[:, 1] >= border)]
        found = cscd.intersections(first.x0, first.F, second.x0, second.F, threads=1 + seed % 2)
        assert np.array_equal(rows_of(found), truth)
        assert np.array_equal(found.pairs, truth[:, :2] - np.array([0, border]))
        assert (found.objects == [0, 1]).all()
        count += len(truth)
    assert count > 100


def test_check_of_a_detector() -> None:
    """The check lists all pairs, and goes on being right after other calls."""
    count = 0
    for name, scene in SCENES[1::4]:
        detector = cscd.Detector(cscd.Mesh(scene.F, len(scene.x0)), threads=2)
        for x in (scene.x0, scene.x1, scene.x0):
            truth = oracle.kinds(x, scene.F)
            assert np.array_equal(detector.check(x), truth[:, :2]), name
            count += len(truth)
    assert count > 1000


def test_faces_of_four_corners() -> None:
    """Pairs of squares are those of the triangles that they are cut into, by rows of F."""
    random = np.random.default_rng(3)
    count = 0
    for _ in range(40):
        corners = random.integers(0, 9, (12, 1, 3)) + random.permuted(
            np.array([[0, 0, 0], [3, 0, 0], [3, 3, 0], [0, 3, 0]]), axis=1)[None]
        V = corners.reshape(-1, 3)
        F = np.arange(len(V)).reshape(-1, 4)
        found = cscd.self_intersections(V, F)
        triangles, face = found.mesh.triangles, found.mesh.triangle_face
        assert np.array_equal(face, np.repeat(np.arange(12), 2))
        truth = oracle.kinds(V.astype(np.float64), triangles)
        assert np.array_equal(rows_of(found), truth)
        assert np.array_equal(found.pairs, face[truth[:, :2]])
        marked = np.zeros(len(F), bool)
        marked[face[truth[truth[:, 2] == 0, :2]]] = True
        assert np.array_equal(cscd.self_intersecting_faces(V[None], F)[0], marked)
        count += len(truth)
    assert count > 400


@pytest.mark.parametrize("scalar", [np.float64, np.float32, np.float16, np.int16, np.int64, np.uint8])
def test_layouts(scalar: Any) -> None:
    """Positions of any order, stride and type of number, and faces of any integers, give the same answer."""
    scene = oracle.make_grid_soup(8)
    x = scene.x0.astype(scalar)
    truth = oracle.kinds(scene.x0, scene.F)
    detector = cscd.Detector(cscd.Mesh(scene.F, len(x)))
    for name, given in oracle.layouts(x):
        before = given.copy()
        assert np.array_equal(rows_of(detector.find_intersections(given)), truth), name
        assert np.array_equal(before, given), name
    for F in (scene.F.astype(np.uint8), scene.F.astype(">i8"), np.asfortranarray(scene.F.astype(np.int64)),
              scene.F.tolist(), scene.F.astype(np.uint64)[::-1][::-1], np.pad(scene.F, ((0, 0), (1, 1)))[:, 1:4]):
        assert np.array_equal(rows_of(cscd.self_intersections(x.tolist(), F)), truth)


def test_sums_by_parts_have_curves_and_depths() -> None:
    """Two cubes, a corner of the second 0.3 deep in the first, as two parts of one mesh."""
    corners = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)], float)
    sides = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    cubes = np.concatenate([corners, corners + [0.7, 0.65, 0.6]])
    found = cscd.self_intersections(cubes, np.concatenate([sides, sides + 8]))
    sums = found.by_parts(found.mesh.triangle_components)
    both, = sums[sums.a != sums.b]
    assert (both.a, both.b, both.crossing, both.curves) == (0, 1, len(found), len(found.curves))
    assert len(found) > 5 and len(found.curves) == 1 and abs(both.length - found.curves[0].length) < 1e-12
    assert abs(both.depth - 0.3) < 1e-12 and both.depth <= both.bound <= 1.01 * both.depth
