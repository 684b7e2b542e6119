"""Contacts, proximities and free steps equal brute force over all pairs of features, on scenes of the C tests and on grids."""

from __future__ import annotations

from typing import Any, List, Optional, Tuple

import numpy as np
import pytest

import cscd
import oracle


def scenes() -> List[Tuple[str, oracle.Scene]]:
    """Some of each family, and grids whose contacts are mostly degenerate."""
    found = [(family, oracle.make_scene(family, 300 + seed)) for family in oracle.FAMILIES
             for seed in range(3 if family != "grid" else 30)]
    return found + [("grid soup", oracle.make_grid_soup(50 + seed, triangles=25)) for seed in range(10)]


SCENES = scenes()


def names_of(found: Any) -> Any:
    return np.column_stack([found.kind, found.a, found.b])


def mesh_of(scene: oracle.Scene) -> cscd.Mesh:
    return cscd.Mesh(scene.F, len(scene.x0))


def rounded(scene: oracle.Scene, scalar: Any) -> oracle.Scene:
    return oracle.Scene(scene.x0.astype(scalar), scene.x1.astype(scalar), scene.F)


def expect_contacts(found: cscd.Contacts, scene: oracle.Scene, truth: Tuple[Any, Any], place: Any) -> None:
    """The same features at the same times; and vertices that are those of the features."""
    names, toi = truth
    assert np.array_equal(names_of(found), names), place
    assert np.array_equal(found.toi, toi), place
    edges = mesh_of(scene).edges
    vf = found.kind == 0
    assert np.array_equal(found.vertices[vf], np.column_stack([found.a[vf], scene.F[found.b[vf]]]))
    assert np.array_equal(found.vertices[~vf], np.hstack([edges[found.a[~vf]], edges[found.b[~vf]]]))


def test_contacts() -> None:
    """Contacts in one call: doubles and floats, one thread and two."""
    kinds, empty = np.zeros(2, int), 0
    for i, (name, scene) in enumerate(SCENES):
        for scalar in (np.float64, np.float32):
            moved = rounded(scene, scalar)
            truth = oracle.contacts(moved.x0, moved.x1, scene.F)
            found = cscd.contacts(moved.x0, moved.x1, mesh_of(scene), threads=1 + i % 2)
            expect_contacts(found, scene, truth, (name, i, scalar))
            kinds += np.bincount(found.kind, minlength=2)
            empty += len(found) == 0
    assert kinds.min() > 2000 and empty > 20, (kinds, empty)


def test_contacts_that_come_within_a_distance() -> None:
    """With min_separation the oracle has the test of minimum separation; times are those of that test."""
    count = 0
    for i, (name, scene) in enumerate(SCENES[::3]):
        distance = (0.003, 0.05, 0.2)[i % 3]
        names, toi = oracle.contacts(*scene, distance, 1e-6 * distance)
        found = cscd.contacts(scene.x0, scene.x1, mesh_of(scene), min_separation=distance, threads=1 + i % 2)
        assert np.array_equal(np.sort(names, axis=0), np.sort(names_of(found), axis=0)), name
        assert np.abs(np.sort(found.toi) - np.sort(toi)).max(initial=0.0) < 1e-3, name
        count += len(names)
    assert count > 3000


def test_weights_name_the_points_that_touch() -> None:
    """At its time, the weights of each contact bring its four vertices together."""
    count = 0
    for name, scene in SCENES:
        if name == "far away":  # where the points touch up to rounding that is larger
            continue
        found = cscd.contacts(scene.x0, scene.x1, mesh_of(scene))
        x = scene.x0[found.vertices] + found.toi[:, None, None] * (scene.x1 - scene.x0)[found.vertices]
        assert found.weights.shape == (len(found), 4)
        apart = (found.weights[..., None] * x).sum(axis=1)
        assert np.linalg.norm(apart, axis=1).max(initial=0.0) < 1e-5 * max(1.0, np.abs(scene.x0).max()), name
        count += len(found)
    assert count > 1000


@pytest.mark.parametrize("threads", [1, 2])
def test_steps_of_a_detector(threads: int) -> None:
    """Many steps of one detector, forth and back, with and without a plan: each as by itself."""
    count = 0
    for name, scene in SCENES[1::3]:
        mesh = mesh_of(scene)
        plans: List[Optional[cscd.Plan]] = [None]
        if mesh.is_closed_manifold:
            plans.append(cscd.Plan.kmeans(mesh, scene.x0, k=2))
        for plan in plans:
            detector = cscd.Detector(mesh, plan=plan, threads=threads)
            for x0, x1 in ((scene.x0, scene.x1), (scene.x1, scene.x0), (scene.x0, scene.x0), (scene.x0, scene.x1)):
                truth = oracle.contacts(x0, x1, scene.F)
                expect_contacts(detector.step(x0, x1), scene, truth, name)
                count += len(truth[0])
    assert count > 2000


def test_slow_steps() -> None:
    """Steps in which little moves are answered from lists of pairs, unless coherence is off, and are the same."""
    answered, touching = 0, 0
    for i, (_, scene) in enumerate([(name, scene) for name, scene in SCENES if name == "two spheres"]):
        edges = scene.x0[mesh_of(scene).edges]
        length = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1).mean()
        way = scene.x1 - scene.x0
        step = 0.01 * length / np.linalg.norm(way, axis=1).max()
        lists, none = (cscd.Detector(mesh_of(scene), method="single", coherence=c) for c in ("auto", "off"))
        for k in range(60):
            a, b = (scene.x0 + min(j * step, 1.0) * way for j in (k, k + 1))
            found, same = lists.step(a, b), none.step(a, b)
            assert np.array_equal(names_of(found), names_of(same)) and np.array_equal(found.toi, same.toi)
            if k % 20 == 0:
                expect_contacts(found, scene, oracle.contacts(a, b, scene.F), (i, k))
            answered += lists.counters["coherent"]
            touching += len(found)
            assert none.counters["coherent"] == 0
    assert answered > 60


def check_middles(found: Any, x: Any) -> None:
    """Halves of what both features name; u and v lead to the same weights as those of a contact."""
    middles = 0.5 * (np.abs(found.weights)[..., None] * x[found.vertices]).sum(axis=1)
    assert np.abs(found.points(x) - middles).max(initial=0.0) < 1e-12 * max(1.0, np.abs(x).max())
    vf = found.kind == 0
    assert np.array_equal(found.weights[vf, 1], found.u[vf] + found.v[vf] - 1.0)
    assert np.array_equal(found.weights[~vf, 0], 1.0 - found.u[~vf])


def test_pairs_beyond_what_they_keep() -> None:
    """The pairs within the sum of separation and distance, of a detector and on a line; weights are thirds of areas."""
    for i, (name, scene) in enumerate(SCENES[:6]):
        mesh = mesh_of(scene)
        detector, plain = cscd.Detector(mesh, min_separation=0.05), cscd.Detector(mesh)
        found, expected = detector.near(scene.x0, 0.03, beyond=True), plain.near(scene.x0, 0.08)
        assert np.array_equal(names_of(found), names_of(expected)), name
        assert (found.separation == 0.05).all() and (expected.separation == 0.0).all()
        line = detector.line_search(scene.x0, scene.x1, 0.03)
        for unique in (False, True):
            here = detector.near(line.positions(0.5), 0.03, unique, True)
            assert np.array_equal(line.near(0.5, 0.03, unique, True), here), name
        assert (found.weight == 1.0).all()
        plain.set_rest(scene.x0)
        corners = scene.x0[scene.F]
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
        around = np.bincount(scene.F.ravel(), np.repeat(areas / 3, 3), len(scene.x0))
        weighed = plain.near(scene.x0, 0.08)
        vf = weighed.kind == 0
        assert np.allclose(weighed.weight[vf], around[weighed.a[vf]] / 4, rtol=1e-12)


def test_pairs_that_are_near() -> None:
    """Every pair of features within the distance, and the nearest points that its weights name."""
    count = 0
    for i, (name, scene) in enumerate(SCENES):
        distance = (1e-3, 0.03, 0.2)[i % 3]
        detector = cscd.Detector(mesh_of(scene), threads=1 + i % 2)
        found = detector.near(scene.x0, distance)
        assert np.array_equal(names_of(found), oracle.near(scene.x0, scene.F, distance)), (name, i)
        apart = (found.weights[..., None] * scene.x0[found.vertices]).sum(axis=1)
        error = np.abs(np.linalg.norm(apart, axis=1) - found.distance).max(initial=0.0)
        assert error < 1e-12 * max(1.0, np.abs(scene.x0).max()), name
        assert (found.distance <= distance * (1 + 1e-6)).all() and (found["count"] == 1).all()
        unique = detector.near(scene.x0, distance, unique=True)
        assert unique["count"].sum() == len(found) or unique.distance.max() > distance
        check_middles(found, scene.x0)
        count += len(found)
    assert count > 3000


def test_steps_without_contact() -> None:
    """What max_step has reached is free of contact by the oracle, and what limits it is a contact of the whole motion."""
    limited = touching = 0
    for i, (name, scene) in enumerate(SCENES):
        for scalar in (np.float64, np.float32):
            moved = rounded(scene, scalar)
            names, toi = oracle.contacts(moved.x0, moved.x1, scene.F)
            detector = cscd.Detector(mesh_of(scene), threads=1 + i % 2)
            if len(toi) and toi[0] == 0.0:
                with pytest.raises(cscd.InContact) as caught:
                    detector.max_step(moved.x0, moved.x1)
                assert names_of(caught.value.pair).tolist()[0] in names[toi == 0.0].tolist()
                touching += 1
                continue
            x, fraction, limit = detector.max_step(moved.x0, moved.x1)
            assert x.dtype == scalar and 0.0 < fraction <= 1.0
            assert len(oracle.contacts(moved.x0, x, scene.F)[0]) == 0, (name, i)
            assert (limit is None) == (fraction == 1.0) == (len(names) == 0), (name, i)
            if limit is not None:
                assert names_of(limit).tolist()[0] in names.tolist() and fraction <= 0.8 * limit.toi[0]
                limited += 1
            else:
                assert np.array_equal(x, moved.x1)
    assert limited > 20 and touching > 20, (limited, touching)


def test_a_line_search() -> None:
    """Shorter steps and moments of one line are those of the detector itself."""
    near = stopped = 0
    for name, scene in SCENES[::2]:
        names, toi = oracle.contacts(*scene)
        if len(toi) and toi[0] == 0.0:
            continue
        detector = cscd.Detector(mesh_of(scene))
        line = detector.line_search(scene.x0, scene.x1, reach=0.1)
        for longest in (1.0, 0.5, 0.125):
            x, fraction, limit = line.max_step(longest)
            assert np.array_equal(x, line.positions(fraction)) and fraction <= longest
            assert len(oracle.contacts(scene.x0, x, scene.F)[0]) == 0, name
            assert np.array_equal(names_of(line.near(fraction, 0.1)), oracle.near(x, scene.F, 0.1)), name
            near += len(line.near(fraction, 0.1))
            stopped += limit is not None
    assert near > 500 and stopped > 5, (near, stopped)


def test_several_objects() -> None:
    """Objects with obstacles and thicknesses, as one array and as an array for each."""
    count = 0
    for seed in range(10):
        parts = [oracle.make_scene(name, seed) for name in ("soup", "spike", "grid")]
        whole, objects, moved = oracle.joined(parts)
        scene = cscd.Scene([cscd.Mesh(part.F, len(part.x0)) for part in parts], obstacles=[1])
        thick = np.array([0.02, 0.0, 0.06]) if seed % 2 else np.zeros(3)
        distances = 0.5 * (thick[:, None] + thick[None, :])
        distances[1, 1] = -1.0
        if seed % 3 == 0:
            distances[0, 0] = -1.0
        rules = [{"thickness": thickness, "self": seed % 3 != 0 or i > 0} for i, thickness in enumerate(thick)]
        detector = cscd.Detector(scene, rules=rules, threads=1 + seed % 2)
        names, toi = oracle.contacts_by_rules(whole.x0, whole.x1, whole.F, objects, distances)
        found = detector.step(whole.x0, whole.x1)
        assert sorted(names_of(found).tolist()) == sorted(names.tolist()), seed
        again = detector.step([part.x0 for part in moved], [part.x1 for part in moved])
        assert np.array_equal(found, again)
        count += len(names)
    assert count > 1000


def test_layouts() -> None:
    """Positions of any order and stride give the same contacts, and stay as they are."""
    scene = rounded(oracle.make_scene("soup", 4), np.float32)
    names, toi = oracle.contacts(*scene)
    detector = cscd.Detector(mesh_of(scene))
    assert len(names) > 50
    for (name, x0), (_, x1) in zip(oracle.layouts(scene.x0), list(oracle.layouts(scene.x1))[::-1]):
        before = x0.copy(), x1.copy()
        found = detector.step(x0, x1)
        assert np.array_equal(names_of(found), names) and np.array_equal(found.toi, toi), name
        assert np.array_equal(before[0], x0) and np.array_equal(before[1], x1)


def test_results_own_their_memory() -> None:
    """What a call gave back stays as it is, whatever the detector does later."""
    scene = oracle.make_scene("soup", 4)
    detector = cscd.Detector(mesh_of(scene))
    found, near, pairs = detector.step(scene.x0, scene.x1), detector.near(scene.x0, 0.1), detector.check(scene.x0)
    kept = found.copy(), near.copy(), pairs.copy()
    for _ in range(3):
        detector.step(scene.x1, scene.x0)
        detector.near(scene.x1, 0.5)
        detector.check(scene.x1)
    del detector
    assert np.array_equal(found, kept[0]) and np.array_equal(near, kept[1]) and np.array_equal(pairs, kept[2])
    assert all(array.flags.owndata or array.base.flags.owndata for array in (found, near, pairs))


def test_single_pairs() -> None:
    """Batches of single pairs have the contacts of a step with just these features, and its times."""
    random = np.random.default_rng(5)
    for kind in ("vf", "ee"):
        hits = 0
        x0, x1 = random.uniform(-1, 1, (400, 3)), random.uniform(-1, 1, (400, 3))
        found = cscd.pairs_step(kind, x0, x1, threads=2)
        for i in range(100):
            points = slice(4 * i, 4 * i + 4)
            faces = np.array([[1, 2, 3], [0, 4, 5]] if kind == "vf" else [[0, 1, 4], [2, 3, 5]])
            far = np.full((2, 3), 50.0) * np.array([[1.0], [-1.0]])
            names, toi = oracle.contacts(np.vstack([x0[points], far]), np.vstack([x1[points], far]), faces)
            edges = cscd.Mesh(faces).edges.tolist()
            wanted = [0, 0, 0] if kind == "vf" else [1, edges.index([0, 1]), edges.index([2, 3])]
            match = (names == wanted).all(axis=1)
            assert bool(found.contact[i]) == bool(match.any()), (kind, i)
            assert found.toi[i] == (toi[match][0] if match.any() else np.inf)
            hits += int(match.any())
        assert 5 < hits < 95, hits


def test_scenes_without_triangles() -> None:
    """Points fall onto a half-space: ``contacts`` finds what a detector finds."""
    ground = cscd.Scene([cscd.Points(2), cscd.HalfSpace([0, 0, 1])])
    x0 = np.array([[0, 0, 1.0], [5, 0, 3.0], [0, 0, 0]])
    x1 = x0 - np.array([[0, 0, 2.0], [0, 0, 2.0], [0, 0, 0]])
    found = cscd.contacts(x0, x1, ground)
    assert len(found) == 1 and abs(found.toi[0] - 0.5) < 1e-9 and found.a[0] == 0
    assert np.array_equal(found, cscd.Detector(ground).step(x0, x1))
