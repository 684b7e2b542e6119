"""Two cloths fall on a box and on each other, by an implicit solver that never lets them touch: own_solver.py [PICTURE.svg]."""
import sys

import numpy as np

import cscd
from svg_picture import Picture

CELLS, STEP, FRAMES = 8, 0.02, 36  # along a cloth; seconds
INERTIA, FALL = 0.003 / STEP ** 2, STEP ** 2 * np.array([0.0, -9.81, 0.0])  # kg/s^2 of a vertex; m
SPRING, BENDING, REACH = 30.0, 0.15, 0.03  # N/m, N/m; of the barrier: m

i, j = np.divmod(np.arange((CELLS + 1) ** 2), CELLS + 1)
corner = np.flatnonzero((i < CELLS) & (j < CELLS))
flat = np.stack([i / CELLS - 0.5, 0.0 * i, j / CELLS - 0.5], axis=1)
turned = flat[:, ::-1] * [0.8, 1.0, -0.8] + flat * [0.6, 1.0, 0.6]
box = np.array([[x, y, z] for x in (-0.2, 0.2) for y in (-0.6, 0.0) for z in (-0.2, 0.2)])
sides = cscd.Mesh([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]], positions=box)
cloth = cscd.Mesh(corner[:, None] + [0, 1, CELLS + 2, CELLS + 1], positions=flat)
scene = cscd.Scene([cloth, cloth, sides], obstacles=[2])
apart = [(a, b) for a in range(len(i)) for b in range(a) if (i[a] - i[b]) ** 2 + (j[a] - j[b]) ** 2 in (1, 2, 4)]
springs = np.concatenate([apart, np.add(apart, len(flat))])
x = np.concatenate([flat + [0.0, 0.06, 0.0], turned + [0.05, 0.2, 0.0], box])
free, v, rest = 3 * (len(x) - len(box)), np.zeros_like(x), np.linalg.norm(x[springs[:, 1]] - x[springs[:, 0]], axis=1)
stiff = np.where(rest > 1.9 / CELLS, BENDING, SPRING)
detector = cscd.Detector(scene, min_separation=1e-3 * REACH, threads=0)
detector.set_rest(x)
barrier = cscd.Energy(scene, REACH, stiffness=20.0, by_count=True)


def energy(x, near, aim):
    """Inertia, springs and barriers: their sum, its gradient (n, 3), and a Hessian (3n, 3n) that is positive definite."""
    along = x[springs[:, 1]] - x[springs[:, 0]]
    length = np.linalg.norm(along, axis=1)
    ends, force = np.concatenate([-along, along], axis=1) / length[:, None], stiff * (length - rest)
    places = (3 * springs[:, :, None] + np.arange(3)).reshape(-1, 6)
    found = barrier.evaluate(x, near, hessian="coo")
    gradient, hessian = INERTIA * (x - aim) + found.gradient, INERTIA * np.eye(x.size)
    np.add.at(gradient.reshape(-1), places, force[:, None] * ends)
    np.add.at(hessian, (places[:, :, None], places[:, None, :]), stiff[:, None, None] * ends[:, :, None] * ends[:, None, :])
    np.add.at(hessian, found.hessian[1], found.hessian[0])
    return 0.5 * INERTIA * ((x - aim) ** 2).sum() + 0.5 * force @ (length - rest) + found.value, gradient, hessian


frames, crossing = [x], 0
for frame in range(FRAMES):
    x0, aim = x, np.concatenate([(x + STEP * v + FALL)[:-len(box)], box])
    now, direction = energy(x, detector.near(x, REACH, unique=True), aim), np.zeros_like(x)
    while True:  # Newton's method
        direction.reshape(-1)[:free] = np.linalg.solve(now[2][:free, :free], -now[1].reshape(-1)[:free])
        if np.abs(direction).max() < 1e-3 * STEP:
            break
        line, fraction, before, slope = detector.line_search(x, x + direction, REACH), 1.0, now[0], (now[1] * direction).sum()
        while fraction == 1.0 or now[0] > before + 2e-4 * fraction * slope:  # as far as the energy falls, never through anything
            x, fraction, _ = line.max_step(fraction)
            now = energy(x, line.near(fraction, REACH, unique=True), aim)
            fraction *= 0.5
    v, crossing = (x - x0) / STEP, crossing + cscd.is_self_intersecting(x, scene)
    frames.append(x)
print(f"{FRAMES} frames of {scene.triangle_count} triangles: {crossing} intersect or touch")
if len(sys.argv) > 1:
    picture = Picture(900, 330, panels=4)
    paint = np.array([(222, 196, 150, 0.06), (120, 160, 200, 0.12), (190, 190, 190, 0.0)])[scene.triangle_objects]
    for panel, x in enumerate(frames[::FRAMES // 3]):
        picture.look(panel, 30.0, 20.0, (0.0, -0.2, 0.0), 0.9)
        picture.surface(x, scene.triangles, paint[:, :3], nearer=paint[:, 3])
    picture.write(sys.argv[1])
