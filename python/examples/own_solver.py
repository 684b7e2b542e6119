"""Two cloths fall on a box and on each other, by an implicit solver that never lets them touch: own_solver.py [PICTURE.svg]."""

from __future__ import annotations

import sys
from typing import Any, List, Tuple

import numpy as np

import cscd
from svg_picture import Picture

Array = Any

SIDE = 8  # cells along a cloth
SPACING = 1.0 / SIDE
STEP, FRAMES = 0.02, 36  # seconds
MASS, GRAVITY = 0.003, np.array([0.0, -9.81, 0.0])  # of a vertex, in kg; m/s^2
SPRING, BENDING = 30.0, 0.15  # N/m
REACH, STIFFNESS = 0.03, 20.0  # of the barrier: m, and N/m
SLOWEST = 1e-3  # m/s: slower corrections end Newton's method


def make_scene() -> Tuple[cscd.Scene, Array, Array]:
    """The box as an obstacle behind the two cloths, the vertices, and the springs (s, 2)."""
    i, j = np.divmod(np.arange((SIDE + 1) ** 2), SIDE + 1)
    corner = np.flatnonzero((i < SIDE) & (j < SIDE))
    faces = np.stack([corner, corner + 1, corner + SIDE + 2, corner + SIDE + 1], axis=1)
    flat = np.stack([i * SPACING - 0.5, np.zeros(len(i)), j * SPACING - 0.5], axis=1)
    turned = flat[:, ::-1] * [0.8, 1.0, -0.8] + flat * [0.6, 1.0, 0.6]
    box = np.array([[x, y, z] for x in (-0.2, 0.2) for y in (-0.6, 0.0) for z in (-0.2, 0.2)])
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    springs = [np.stack([corner, corner + SIDE + 2], axis=1), np.stack([corner + 1, corner + SIDE + 1], axis=1)]
    for apart in (1, 2):
        for first, step in ((np.flatnonzero(i + apart <= SIDE), SIDE + 1), (np.flatnonzero(j + apart <= SIDE), 1)):
            springs.append(np.stack([first, first + apart * step], axis=1))
    cloth = cscd.Mesh(faces, positions=flat)
    scene = cscd.Scene([cloth, cloth, cscd.Mesh(sides, positions=box)], obstacles=[2])
    one = np.concatenate(springs)
    start = np.concatenate([flat + [0.0, 0.06, 0.0], turned + [0.05, 0.2, 0.0], box])
    return scene, start, np.concatenate([one, one + len(flat)])


class Solver:
    """The energy that each time step minimises: inertia, springs and barriers."""

    def __init__(self, scene: cscd.Scene, x: Array, springs: Array) -> None:
        self.detector = cscd.Detector(scene, min_separation=1e-3 * REACH, threads=0)
        self.detector.set_rest(x)
        self.barrier = cscd.Energy(scene, REACH, stiffness=STIFFNESS, by_count=True)
        self.x, self.v = x, np.zeros_like(x)
        self.free = len(x) - 8  # the box rests
        self.springs = springs
        self.lengths = np.sqrt(((x[springs[:, 1]] - x[springs[:, 0]]) ** 2).sum(axis=1))
        self.stiffness = np.where(self.lengths > 1.9 * SPACING, BENDING, SPRING)

    def energy(self, x: Array, near: cscd.Proximities) -> float:
        """The energy at positions, of which the near pairs are given."""
        stretch = self.lengths_at(x)[1] - self.lengths
        away = (x - self.aim)[: self.free]
        return float(0.5 * MASS / STEP ** 2 * (away * away).sum() + 0.5 * (self.stiffness * stretch * stretch).sum()
                     + self.barrier.evaluate(x, near, gradient=False).value)

    def lengths_at(self, x: Array) -> Tuple[Array, Array]:
        """Directions (s, 3) and lengths (s,) of the springs."""
        along = x[self.springs[:, 1]] - x[self.springs[:, 0]]
        length = np.sqrt((along * along).sum(axis=1))
        return along / length[:, None], length

    def derivatives(self, x: Array, near: cscd.Proximities) -> Tuple[Array, Array]:
        """The gradient (n, 3), and a Hessian (n, 3, n, 3) without what makes it indefinite."""
        gradient = MASS / STEP ** 2 * (x - self.aim)
        direction, length = self.lengths_at(x)
        force = (self.stiffness * (length - self.lengths))[:, None] * direction
        np.add.at(gradient, self.springs, np.stack([-force, force], axis=1))
        outer = direction[:, :, None] * direction[:, None, :]
        across = np.maximum(0.0, 1.0 - self.lengths / length)[:, None, None]
        blocks = self.stiffness[:, None, None] * (outer + across * (np.eye(3) - outer))

        barrier = self.barrier.evaluate(x, near, hessian="coo")
        data, (rows, columns) = barrier.hessian
        hessian = self.hessian(len(x), blocks)
        np.add.at(hessian.reshape(3 * len(x), 3 * len(x)), (rows, columns), data)
        return gradient + barrier.gradient, hessian

    def hessian(self, count: int, springs: Array) -> Array:
        """The masses, and a block of 3 x 3 for each two ends of a spring."""
        hessian = np.zeros((count, 3, count, 3))
        vertices, (a, b) = np.arange(count), self.springs.T
        hessian[vertices, :, vertices, :] = MASS / STEP ** 2 * np.eye(3)
        for rows, columns, sign in ((a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)):
            np.add.at(hessian, (rows, slice(None), columns, slice(None)), sign * springs)
        return hessian

    def advance(self) -> None:
        """One step of time: Newton's method, every step of which is certified."""
        start = self.x
        self.aim = start + STEP * self.v + STEP ** 2 * GRAVITY
        self.aim[self.free:] = start[self.free:]
        near = self.detector.near(self.x, REACH, unique=True)
        for _ in range(40):
            gradient, hessian = self.derivatives(self.x, near)
            n = self.free
            direction = np.zeros_like(self.x)
            direction[:n] = np.linalg.solve(hessian[:n, :, :n].reshape(3 * n, 3 * n), -gradient[:n].ravel()).reshape(n, 3)
            if np.abs(direction).max() < SLOWEST * STEP:
                break
            near = self.search(direction, float((gradient[:n] * direction[:n]).sum()), near)
        self.v = (self.x - start) / STEP

    def search(self, direction: Array, slope: float, near: cscd.Proximities) -> cscd.Proximities:
        """Goes along a direction until the energy falls, never through anything; returns the pairs that are near then."""
        before = self.energy(self.x, near)
        line = self.detector.line_search(self.x, self.x + direction, REACH)
        longest = 1.0
        while True:
            x, fraction, _ = line.max_step(longest)
            near = line.near(fraction, REACH, unique=True)
            if self.energy(x, near) <= before + 1e-4 * fraction * slope or fraction < 1e-9:
                self.x = x
                return near
            longest = 0.5 * fraction


def draw(path: str, scene: cscd.Scene, frames: List[Array]) -> None:
    """Draws the scene at some moments."""
    picture = Picture(900, 330, panels=len(frames))
    colours = np.array([(222, 196, 150), (120, 160, 200), (190, 190, 190)])[scene.triangle_objects]
    nearer = np.array([0.06, 0.12, 0.0])[scene.triangle_objects]  # the upper cloth hides what is under it
    for panel, x in enumerate(frames):
        picture.look(panel, 30.0, 20.0, (0.0, -0.2, 0.0), 0.9)
        picture.surface(x, scene.triangles, colours, nearer=nearer)
    picture.write(path)


def main(picture: str = "") -> None:
    """Lets the cloths fall."""
    scene, x, springs = make_scene()
    solver = Solver(scene, x, springs)
    kept, crossing, nearest = [x], 0, np.inf
    for frame in range(1, FRAMES + 1):
        solver.advance()
        crossing += cscd.is_self_intersecting(solver.x, scene)
        nearest = min(nearest, float(solver.detector.near(solver.x, REACH).distance.min(initial=REACH)))
        if frame % (FRAMES // 3) == 0:
            kept.append(solver.x)
    print(f"{FRAMES} frames of {scene.triangle_count} triangles: {crossing} intersect or touch")
    print(f"nothing comes nearer than {nearest:.4f}; the barrier begins at {REACH}")
    if picture:
        draw(picture, scene, kept)


if __name__ == "__main__":
    main(*sys.argv[1:])
