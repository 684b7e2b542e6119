"""The blocks of docs/python/bridges.md, as they stand there, run with meshio, VTK and torch, and with stand-ins of others.

`make test-bridges` runs this file; the packages are those of Debian.
"""

from __future__ import annotations

import functools
import os
import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Dict

import meshio
import numpy as np
import torch
import vtk
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

import cscd

ROOT = Path(__file__).resolve().parent.parent.parent
PAGE = (ROOT / "docs" / "python" / "bridges.md").read_text(encoding="utf-8")
BLOCKS: Dict[str, str] = dict(re.findall(r"^```python (\w+)\n(.*?)^```$", PAGE, re.M | re.S))
TESTED = {"autograd", "jax", "meshio", "pyvista", "torch", "trimesh", "vtk"}

# Two boxes, of which the second one has a corner in the first.
CORNERS = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)], float)
SIDES = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
V = np.concatenate([CORNERS, CORNERS + [0.7, 0.65, 0.6]])
QUADS = np.concatenate([SIDES, SIDES + 8])
TRIANGLES = QUADS[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
TRUTH = cscd.self_intersections(V, TRIANGLES)


def run(name: str, **given: Any) -> Dict[str, Any]:
    """Runs a block of the page with what it needs; returns all its names."""
    names = {"cscd": cscd, "np": np, **given}
    exec(compile(BLOCKS[name], f"bridges.md: {name}", "exec"), names)
    assert names["found"].pairs.tolist()
    return names


def expect(faces: Any, depth: Any) -> None:
    """The answer that was brought back is that of the arrays."""
    assert 0 < TRUTH.faces.sum() < len(TRIANGLES) and abs(TRUTH.depth.max() - 0.3) < 1e-12
    assert np.array_equal(np.asarray(faces, bool), TRUTH.faces)
    assert np.array_equal(depth, TRUTH.depth)


def test_every_block_is_tested() -> None:
    assert set(BLOCKS) == TESTED
    assert PAGE.count("```python") == len(TESTED)
    versions = {"meshio": meshio.__version__, "VTK": vtk.vtkVersion.GetVTKVersion(), "torch": torch.__version__}
    for name, version in versions.items():
        assert f"{name} {'.'.join(version.split('.')[:2])}" in PAGE, (name, version)


def test_meshio(tmp_path: Path) -> None:
    mesh = meshio.Mesh(V, [("line", np.array([[0, 1]])), ("triangle", TRIANGLES)])
    run("meshio", mesh=mesh)
    mesh.write(str(tmp_path / "checked.vtu"))
    again = meshio.read(str(tmp_path / "checked.vtu"))
    assert again.cell_data["intersecting"][0].tolist() == [0]
    expect(again.cell_data["intersecting"][1], again.point_data["depth"])


def poly_data(faces: Any) -> Any:
    """A mesh of VTK."""
    mesh, points, cells = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray()
    points.SetData(numpy_to_vtk(V, deep=True))
    rows = np.column_stack([np.full(len(faces), faces.shape[1]), faces]).ravel().astype(np.int64)
    cells.SetCells(len(faces), numpy_to_vtkIdTypeArray(rows, deep=True))
    mesh.SetPoints(points)
    mesh.SetPolys(cells)
    return mesh


def test_vtk() -> None:
    mesh = poly_data(TRIANGLES)
    run("vtk", mesh=mesh)
    expect(vtk_to_numpy(mesh.GetCellData().GetArray("intersecting")), vtk_to_numpy(mesh.GetPointData().GetArray("depth")))


def test_vtk_with_faces_of_four_corners() -> None:
    mesh = poly_data(QUADS)
    run("vtk", mesh=mesh)
    found = vtk_to_numpy(mesh.GetCellData().GetArray("intersecting"))
    assert np.array_equal(found.astype(bool), cscd.self_intersections(V, QUADS).faces) and found.any()


def test_torch() -> None:
    for scalar in (torch.float32, torch.float64):
        x = torch.tensor(V, dtype=scalar, requires_grad=True)
        names = run("torch", torch=torch, x=x, faces=torch.tensor(TRIANGLES))
        assert names["intersecting"].dtype == torch.bool and names["depth"].dtype == scalar
        truth = cscd.self_intersections(V.astype(np.float32), TRIANGLES) if scalar == torch.float32 else TRUTH
        assert np.array_equal(names["intersecting"].numpy(), truth.faces)
        assert np.array_equal(names["depth"].numpy(), truth.depth.astype(names["depth"].numpy().dtype))


APART = np.concatenate([CORNERS, CORNERS * [1.0, 0.9, 1.1] + [1.04, 0.11, 0.07]])


def run_energy(name: str, **given: Any) -> Dict[str, Any]:
    """Runs a block about energies of near pairs."""
    names = {"cscd": cscd, "np": np, "reach": 0.1, "rest": APART, **given}
    exec(compile(BLOCKS[name], f"bridges.md: {name}", "exec"), names)
    return names


def expect_gradient(value: Any, gradient: Any) -> None:
    """The gradient at APART is that of differences."""
    along = np.random.default_rng(1).normal(size=APART.shape)
    slope = (value(APART + 1e-7 * along) - value(APART - 1e-7 * along)) / 2e-7
    assert abs(slope - (gradient * along).sum()) < 1e-6 * abs(slope)


def test_autograd() -> None:
    x = torch.tensor(APART, requires_grad=True)
    names = run_energy("autograd", torch=torch, x=x, faces=torch.tensor(TRIANGLES))
    (3.0 * names["loss"]).backward()
    call = names["NearEnergy"].apply
    expect_gradient(lambda at: 3.0 * float(call(torch.tensor(at), names["energy"], names["detector"])), x.grad.numpy())
    batch = torch.tensor(np.stack([APART, 0.99 * APART]), requires_grad=True)
    values = call(batch, names["energy"], names["detector"])
    (values * torch.tensor([3.0, 0.0])).sum().backward()
    assert values.shape == (2,) and torch.equal(batch.grad[0], x.grad) and not batch.grad[1].any()


class StandInForJax:
    """What the block takes of JAX; calls are made at once."""

    ShapeDtypeStruct = SimpleNamespace

    def __getattr__(self, name: str) -> Any:
        raise AssertionError(f"the stand-in has no {name}")

    @staticmethod
    def custom_vjp(function: Any, nondiff_argnums: Any) -> Any:
        assert nondiff_argnums == (1, 2)

        def call(*arguments: Any) -> Any:
            return function(*arguments)
        call.defvjp = lambda *rules: setattr(call, "rules", rules)  # type: ignore[attr-defined]
        return call

    @staticmethod
    def pure_callback(function: Any, shapes: Any, x: Any) -> Any:
        found = function(x)
        assert [(part.shape, part.dtype) for part in found] == [shape for shape in shapes]
        return found


def test_jax_by_a_stand_in() -> None:
    stand_in = StandInForJax()
    stand_in.ShapeDtypeStruct = lambda shape, dtype: (shape, dtype)  # type: ignore[assignment, misc, return-value]
    names = run_energy("jax", jax=stand_in, functools=functools)
    detector = cscd.Detector(TRIANGLES)
    detector.set_rest(APART)
    energy = cscd.Energy(detector.mesh, 0.1, "quadratic")
    forward, backward = names["near_energy"].rules
    value, kept = forward(APART, energy, detector)
    (gradient,) = backward(energy, detector, kept, np.asarray(3.0))
    assert value == names["near_energy"](APART, energy, detector)
    expect_gradient(lambda at: 3.0 * float(names["near_energy"](at, energy, detector)), gradient)


def test_trimesh_by_a_stand_in() -> None:
    mesh = SimpleNamespace(vertices=V, faces=TRIANGLES, visual=SimpleNamespace(), vertex_attributes={})
    run("trimesh", mesh=mesh)
    colours = mesh.visual.face_colors
    assert colours.shape == (len(TRIANGLES), 4) and colours.dtype == np.uint8
    expect(colours[:, 0] == 214, mesh.vertex_attributes["depth"])


def test_pyvista_by_a_stand_in() -> None:
    faces = np.column_stack([np.full(len(TRIANGLES), 3), TRIANGLES]).ravel()
    mesh = SimpleNamespace(points=V, faces=faces, cell_data={}, point_data={})
    run("pyvista", mesh=mesh)
    expect(mesh.cell_data["intersecting"], mesh.point_data["depth"])


def test_the_training_loop_prints_the_same_with_torch(tmp_path: Path) -> None:
    """test_examples.py compares what it prints without torch."""
    page = (ROOT / "docs" / "python" / "training-loop.md").read_text(encoding="utf-8")
    shown = re.search(r"\) prints\n\n((?:    .*\n)+)", page)
    program = ROOT / os.environ.get("BUILD", "build/release") / "models" / "folds"
    subprocess.run([str(program), str(tmp_path)], check=True, stdout=subprocess.DEVNULL)
    done = subprocess.run([sys.executable, str(ROOT / "python" / "examples" / "training_loop.py"), "folds.obj", "folds.pc2"],
                          cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT / "build" / "python")}, check=True,
                          text=True, stdout=subprocess.PIPE)
    assert shown is not None and done.stdout == re.sub("(?m)^    ", "", shown[1])


def test_the_gradient_of_torch_is_that_of_differences() -> None:
    """NearPenalty of the example, in a direction, beside differences of its value."""
    sys.path.insert(0, str(ROOT / "python" / "examples"))
    import training_loop
    apart = np.concatenate([CORNERS, CORNERS * [1.0, 0.9, 1.1] + [1.04, 0.11, 0.07]])
    detector = cscd.Detector(TRIANGLES)
    x = torch.tensor(apart, requires_grad=True)
    (3.0 * training_loop.NearPenalty.apply(x, detector, 0.1)).backward()
    along = np.random.default_rng(1).normal(size=apart.shape)
    up, down = (3.0 * training_loop.near_penalty(detector, apart + h * along, 0.1)[0] for h in (1e-7, -1e-7))
    assert abs((up - down) / 2e-7 - (x.grad.numpy() * along).sum()) < 1e-5 * abs(up - down) / 2e-7
    assert up != down
