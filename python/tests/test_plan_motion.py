"""Plans for a motion: how stiff the material is, and positions in frames."""

from __future__ import annotations

import pickle
from typing import Any, List

import numpy as np
import pytest

import cscd
import oracle

SCENE = oracle.make_scene("noisy sphere", 1)


def labels(**options: Any) -> Any:
    """The regions of a plan of the scene."""
    return cscd.Plan.charge(cscd.Mesh(SCENE.F), SCENE.x0, **options).triangle_regions


def test_uniform_stiffness_changes_nothing() -> None:
    plain = labels()
    for values in (np.ones(len(SCENE.F)), np.full(len(SCENE.F), 3, np.int64), [0.5] * len(SCENE.F)):
        assert np.array_equal(labels(stiffness=values), plain)


def test_bad_stiffness_is_refused() -> None:
    for bad in (0.0, -1.0, np.inf, np.nan):
        values = np.ones(len(SCENE.F))
        values[7] = values[9] = bad
        with pytest.raises(ValueError) as caught:
            labels(stiffness=values)
        said = str(caught.value).replace("-nan", "nan")
        assert f"the stiffness of triangle 7 is {bad:g}, expected a positive finite number" in said
    others: List[Any] = [1.0, np.ones(3), np.ones((len(SCENE.F), 1)), "soft"]
    for other in others:
        with pytest.raises(ValueError) as caught:
            labels(stiffness=other)
        assert str(caught.value).startswith("stiffness: expected ")


def test_frames_at_rest_change_nothing() -> None:
    plain = labels()
    assert np.array_equal(labels(frames=[]), plain)
    assert np.array_equal(labels(frames=[SCENE.x0]), plain)
    assert np.array_equal(labels(frames=np.stack([SCENE.x0, SCENE.x0])), plain)


def test_bad_frames_are_refused() -> None:
    others: List[Any] = [3, "frames", SCENE.x0, [SCENE.x0, SCENE.x0[1:]], [None]]
    for other in others:
        with pytest.raises(ValueError) as caught:
            labels(frames=other)
        assert str(caught.value).startswith("frames")
    beyond = SCENE.x0.copy()
    beyond[2, 1] = np.nan
    with pytest.raises(ValueError) as caught:
        labels(frames=[SCENE.x0, beyond])
    assert "frames[1]" in str(caught.value)


def test_auto_keeps_one_of_what_it_compares() -> None:
    plan = cscd.Plan.auto(cscd.Mesh(SCENE.F), SCENE.x0, frames=[SCENE.x0, SCENE.x1])
    kept = [found for found in plan.compared if found.kept]
    assert [found.method for found in plan.compared][:3] == ["charge", "single", "kmeans"]
    assert len(kept) == 1 and kept[0].method == plan.method and kept[0].region_count == plan.region_count
    assert kept[0].tested_share <= min(found.tested_share for found in plan.compared) / 0.98
    assert all(0 <= found.tested_share <= 1 and found.failure is None for found in plan.compared)
    assert [found.k for found in plan.compared][:3] == [None, None, 4]
    assert cscd.Plan.charge(cscd.Mesh(SCENE.F), SCENE.x0).compared == []
    with pytest.raises(ValueError) as caught:
        cscd.Plan.auto("mesh", SCENE.x0)  # type: ignore[arg-type]
    assert "expected a Mesh" in str(caught.value)


def test_steps_of_the_published_method() -> None:
    mesh = cscd.Mesh(SCENE.F)
    steps = ["charge", "ranks", "cuts", "points"]
    plan = cscd.Plan.published(mesh, SCENE.x0, ours=steps)
    usual = cscd.Plan.charge(mesh, SCENE.x0)
    assert plan.method == "published" and np.array_equal(plan.triangle_regions, usual.triangle_regions)
    assert np.array_equal(plan.detector_points, usual.detector_points)
    assert plan.charges is not None and plan.capacitances is not None
    assert plan.origin is not None and plan.origin.startswith(
        "method=published solver=tree threshold=0.1 growing=0.0025 ours=15 version=")
    again = pickle.loads(pickle.dumps(plan))
    assert again.origin == plan.origin and np.array_equal(again.charges, plan.charges)
    assert cscd.Plan.from_parts(mesh, SCENE.x0, plan.triangle_regions, plan.detector_points).origin is None
    with pytest.raises(ValueError, match="ours: expected some of charge, ranks, cuts, points; got 'speed'"):
        cscd.Plan.published(mesh, SCENE.x0, ours=["speed"])
    with pytest.raises(ValueError, match="growing"):
        cscd.Plan.published(mesh, SCENE.x0, growing=2.0, ours=steps)


def test_the_published_search() -> None:
    """With exact tests it finds a part of all contacts; and with all steps ours as many as there are, or nearly."""
    every = ["motion", "starts", "representatives", "neighbours", "tests", "boxes"]
    found = [cscd.Detector(SCENE.F, method=method, ours=ours).step(SCENE.x0, SCENE.x1)
             for method, ours in (("none", []), ("published", ["tests"]), ("iccd-published", ["tests"]), ("published", every))]
    listed = [{(c.kind, c.a, c.b) for c in contacts} for contacts in found]
    assert all(part <= listed[0] for part in listed)
    with pytest.raises(ValueError, match="ours: expected some of motion, starts"):
        cscd.Detector(SCENE.F, method="published", ours=["speed"])
    with pytest.raises(ValueError, match="ours has steps that a detector of method none does not take"):
        cscd.Detector(SCENE.F, method="none", ours=["tests"])
