"""Plans by charge: by a tree, which every installation has, and by the dense solver, to compare with."""

from __future__ import annotations

import warnings
from typing import Any, List

import numpy as np
import pytest

import cscd
import oracle

SCENE = oracle.make_scene("noisy sphere", 1)


def densities(solver: str) -> Any:
    """Charge densities of the scene."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        plan = cscd.Plan.charge(cscd.Mesh(SCENE.F), SCENE.x0, solver=solver)
    assert plan.method == "charge" and plan.region_count >= 1
    return plan.charges


def test_the_tree_is_the_default() -> None:
    plan = cscd.Plan.charge(cscd.Mesh(SCENE.F), SCENE.x0)
    assert np.array_equal(plan.charges, densities("tree"))
    assert plan.charge_kernels is None and plan.better_kernels is None


def test_solvers_agree() -> None:
    fine, coarse = densities("tree"), densities("coarse")
    assert 0.0 < np.abs(coarse - fine).mean() < 0.02 * fine.mean()
    try:
        dense = densities("dense")
    except cscd.Error as error:
        assert 'Take solver="tree"' in str(error) or "not built for Windows" in str(error)
        return
    assert 0.0 < np.abs(fine - dense).max() < 1e-3 * dense.mean()


def test_other_solvers_are_refused() -> None:
    others: List[Any] = ["fast", "", "Tree", "tree\0", b"tree", None, 0, 1.0, True, ["tree"], {}]
    for other in others:
        with pytest.raises(ValueError) as caught:
            cscd.Plan.charge(cscd.Mesh(SCENE.F), SCENE.x0, solver=other)
        assert str(caught.value).startswith("solver: expected one of tree, dense, coarse; got ")


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(MemoryError) as caught:
        cscd.Plan.charge(cscd.Mesh(SCENE.F), SCENE.x0, memory_limit=1000)
    assert "triangles takes" in str(caught.value)
