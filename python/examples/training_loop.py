"""A surface is fitted with and without a penalty on what is near: training_loop.py MODEL FRAMES [PLOT.svg].

With torch, if it can be imported, by its autograd and its Adam; else by numpy alone. Both print the same.
"""

from __future__ import annotations

import sys
from typing import Any, List, Tuple

import numpy as np

import cscd
from svg_picture import write_plot

try:
    import torch
except ImportError:
    torch = None  # type: ignore[assignment]

Array = Any

REACH, STIFFNESS = 0.0155, 5.0
RATE, ITERATIONS = 0.001, 60


def near_penalty(detector: cscd.Detector, x: Array, reach: float) -> Tuple[float, Array]:
    """The sum of (reach - distance)^2 / 2 over all pairs of features nearer than reach, and its gradient (n, 3)."""
    near = detector.near(x, reach, unique=True)
    missing = reach - near.distance
    of_corners = (-missing[:, None] * near.weights)[:, :, None] * near.normal[:, None, :]
    gradient = np.zeros((len(x), 3))
    np.add.at(gradient, near.vertices, of_corners)
    return 0.5 * float((missing * missing).sum()), gradient


if torch is not None:
    class NearPenalty(torch.autograd.Function):
        """The same as a function of torch."""

        @staticmethod
        def forward(ctx: Any, x: Any, detector: cscd.Detector, reach: float) -> Any:
            value, gradient = near_penalty(detector, x.detach().cpu().numpy(), reach)
            ctx.save_for_backward(torch.from_numpy(gradient).to(x))
            return x.new_tensor(value)

        @staticmethod
        def backward(ctx: Any, *outer: Any) -> Any:
            gradient, = ctx.saved_tensors
            return outer[0] * gradient, None, None


class TorchFit:
    """Positions as a parameter of torch."""

    def __init__(self, start: Array) -> None:
        self.x = torch.tensor(start, requires_grad=True)
        self.adam = torch.optim.Adam([self.x], lr=RATE)

    def positions(self) -> Array:
        """The positions as an array, which shares its memory with the tensor."""
        return self.x.detach().numpy()

    def step(self, target: Array, detector: cscd.Detector, stiffness: float) -> None:
        """One iteration."""
        loss = 0.5 * ((self.x - torch.from_numpy(target)) ** 2).sum()
        if stiffness > 0.0:
            loss = loss + stiffness * NearPenalty.apply(self.x, detector, REACH)
        self.adam.zero_grad()
        loss.backward()
        self.adam.step()


class NumpyFit:
    """Positions as an array, and Adam (Kingma and Ba 2015)."""

    def __init__(self, start: Array) -> None:
        self.x = start.copy()
        self.mean, self.square, self.count = np.zeros_like(start), np.zeros_like(start), 0

    def positions(self) -> Array:
        """The positions."""
        return self.x

    def step(self, target: Array, detector: cscd.Detector, stiffness: float) -> None:
        """One iteration."""
        gradient = self.x - target
        if stiffness > 0.0:
            gradient += stiffness * near_penalty(detector, self.x, REACH)[1]
        self.count += 1
        self.mean += 0.1 * (gradient - self.mean)
        self.square += 0.001 * (gradient * gradient - self.square)
        size = np.sqrt(self.square / (1.0 - 0.999 ** self.count)) + 1e-8
        self.x -= RATE / (1.0 - 0.9 ** self.count) * self.mean / size


def fit(start: Array, target: Array, mesh: cscd.Mesh, stiffness: float) -> Tuple[Array, Array]:
    """Fits positions to a target. Returns them, and the share of crossing faces before each iteration, in percent."""
    detector = cscd.Detector(mesh, threads=0)
    model: Any = NumpyFit(start) if torch is None else TorchFit(start)
    shares: List[float] = []
    for _ in range(ITERATIONS):
        shares.append(100.0 * detector.find_intersections(model.positions(), "crossing").faces.mean())
        model.step(target, detector, stiffness)
    return model.positions(), np.array(shares)


def main(model: str, frames: str, plot: str = "") -> None:
    """Fits the first frame to the one in the middle, which intersects itself."""
    recording = cscd.read(model, frames)
    start, target = recording.frames[0], recording.frames[len(recording.frames) // 2]
    lines = []
    for title, colour, stiffness in (("without", "#c03020", 0.0), ("with", "#205080", STIFFNESS)):
        x, shares = fit(start, target, recording.mesh, stiffness)
        far = np.sqrt(((x - target) ** 2).sum(axis=1).mean())
        print(f"{title} the penalty: {shares[-1]:.2f} % of the faces cross at the end, {shares.max():.2f} % at most; "
              f"{far:.4f} from the target")
        lines.append((f"{title} the penalty", colour, shares))
    if plot:
        write_plot(plot, lines, "iteration", "self-intersecting faces, %")


if __name__ == "__main__":
    main(*sys.argv[1:])
