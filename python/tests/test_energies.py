"""Energies: their values and derivatives from Python, in every form of a matrix, and what is refused."""
from typing import Any, Tuple

import cscd
import numpy as np
import pytest


def scene() -> Tuple[Any, Any, Any]:
    """Two triangles that are near each other, askew; a detector, and an energy that reaches across."""
    x = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [.2, .3, .31], [.9, .4, .4], [.3, 1.1, .5]])
    detector = cscd.Detector([[0, 1, 2], [3, 4, 5]])
    return x, detector, cscd.Energy(detector.mesh, 0.6, "barrier_squared", stiffness=3.0, friction=[0.4], slip=0.05)


def full_matrix(form: str, hessian: Any, n: int) -> Any:
    """The matrix of a Hessian in one of the forms."""
    full = np.zeros((3 * n, 3 * n))
    if form == "coo":
        data, (rows, columns) = hessian
        full[rows, columns] = data
        return full
    data, indices, indptr = hessian
    rows = np.repeat(np.arange(len(indptr) - 1), np.diff(indptr))
    if form == "csr":
        full[rows, indices] = data
    for row, column, block in zip(rows, indices, data) if form == "bsr" else ():
        full[3 * row: 3 * row + 3, 3 * column: 3 * column + 3] = block
    return full


def test_derivatives_are_those_of_differences() -> None:
    x, detector, energy = scene()
    near = detector.near(x, 0.6, unique=True)
    found = energy.evaluate(x, near, hessian="csr", project=False)
    second = full_matrix("csr", found.hessian, 6)
    assert found.value > 0 and found.active == len(near) and found.infinite == 0
    assert found.least == pytest.approx(near.distance.min())
    for i in range(18):
        step = np.zeros(18)
        step[i] = 1e-6
        ends = [energy.evaluate(x + side * step.reshape(6, 3), near) for side in (-1, 1)]
        assert (ends[1].value - ends[0].value) / 2e-6 == pytest.approx(found.gradient.ravel()[i], abs=1e-7)
        assert (ends[1].gradient - ends[0].gradient).ravel() / 2e-6 == pytest.approx(second[i], abs=1e-6)


def test_all_forms_have_one_matrix() -> None:
    x, detector, energy = scene()
    near = detector.near(x, 0.6, unique=True)
    summed = np.zeros((18, 18))
    for vertices, block in zip(near.vertices, energy.evaluate(x, near, hessian="blocks").hessian):
        places = (3 * vertices[:, None] + np.arange(3)).ravel()
        np.add.at(summed, (places[:, None], places), block)
    for form in ("csr", "bsr", "coo"):
        matrix = full_matrix(form, energy.evaluate(x, near, hessian=form).hessian, 6)
        assert matrix == pytest.approx(summed, abs=1e-12)
    assert np.linalg.eigvalsh(summed).min() > -1e-12 * np.abs(summed).max()


def test_a_batch_is_each_of_its_moments() -> None:
    x, detector, energy = scene()
    batch = np.stack([x, x + [0, 0, 1], x * [1, 1, .9]])
    values, gradients = energy.at(detector, batch)
    assert gradients.shape == batch.shape and values[0] == pytest.approx(values[1]) and values[2] > values[0]
    value, gradient = energy.at(detector, batch[2].astype(np.float32))
    assert value == pytest.approx(values[2], rel=1e-5) and gradient == pytest.approx(gradients[2], rel=1e-3, abs=1e-5)
    energy.stiffness = 6.0
    assert energy.at(detector, x)[0] == pytest.approx(2 * values[0]) and energy.stiffness == 6.0


def test_friction_holds_against_sliding() -> None:
    x, detector, energy = scene()
    assert energy.evaluate_friction(x, x).value == 0.0
    energy.freeze_friction(x, detector.near(x, 0.6, unique=True))
    moved = x.copy()
    moved[3:, 0] += 0.3
    found = energy.evaluate_friction(x, moved, hessian="coo")
    assert found.value > 0 and found.gradient[3:, 0].sum() > 0
    assert found.gradient.sum(0) == pytest.approx(np.zeros(3), abs=1e-12)
    assert np.linalg.eigvalsh(full_matrix("coo", found.hessian, 6)).min() > -1e-9


def test_what_is_wrong_is_said() -> None:
    x, detector, energy = scene()
    near = detector.near(x, 0.6)
    for make in (lambda: cscd.Energy(detector.mesh, 0.0).evaluate(x, near), lambda: cscd.Energy(detector.mesh, 1.0, "log"),
                 lambda: energy.evaluate(x[:5], near), lambda: energy.evaluate(x, near, hessian="dense"),
                 lambda: cscd.Energy(detector.mesh, 1.0).freeze_friction(x, near),
                 lambda: cscd.Energy(detector.mesh, 1.0, friction=[.1, .2])):
        with pytest.raises(ValueError):
            make()
    lost = near.copy()
    lost["vertices"] = 77
    with pytest.raises(ValueError, match="does not have"):
        energy.evaluate(x, lost)
