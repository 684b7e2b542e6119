"""Plans at rest, with stiffness, and for frames: pairs and times of a step of recordings in which each is used.

The first recording is made here: a capsule that is rigid except for a soft place off its middle, where it bends by 110 degrees.
Arguments name further ones, MODEL.obj and MODEL.pc2 side by side. Their stiffness is painted as an artist would: from 1 down
to 0.1 where edges change their lengths the most, in the tenth of the triangles that do so beyond all others.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, Iterator, List, Tuple

import numpy as np

import cscd

Recording = Tuple[str, Any, Any, Any, Any]  # its name, faces, positions at rest, frames, and stiffness


def hinge() -> Recording:
    """A capsule that bends in one place."""
    around, rows, cap = 40, 120, 10
    s = [-np.cos(0.5 * np.pi * i / cap) for i in range(1, cap)] + list(np.linspace(0.0, 16.0, rows)) \
        + [16.0 + np.sin(0.5 * np.pi * i / cap) for i in range(1, cap)]
    rho = [np.sin(0.5 * np.pi * i / cap) for i in range(1, cap)] + [1.0] * rows \
        + [np.cos(0.5 * np.pi * i / cap) for i in range(1, cap)]
    rings = len(s)
    angles = 2.0 * np.pi * np.arange(around) / around
    rest = np.array([[-1.0, 0.0, 0.0], [17.0, 0.0, 0.0]]
                    + [[s[i], rho[i] * np.cos(a), rho[i] * np.sin(a)] for i in range(rings) for a in angles])
    faces: List[Tuple[int, int, int]] = []
    for a in range(around):
        b = (a + 1) % around
        faces += [(0, 2 + a, 2 + b), (1, 2 + (rings - 1) * around + b, 2 + (rings - 1) * around + a)]
        for i in range(rings - 1):
            p, q = 2 + i * around, 2 + (i + 1) * around
            faces += [(p + a, q + a, q + b), (p + a, q + b, p + b)]
    first, last = 10.3, 12.7
    frames = []
    for bend in np.radians(np.linspace(0.0, 110.0, 60)):
        curvature = bend / (last - first)
        inside = np.clip(rest[:, 0], first, last) - first
        angle = curvature * inside
        before, behind = np.minimum(rest[:, 0] - first, 0.0), np.maximum(rest[:, 0] - last, 0.0)
        along = inside if bend == 0.0 else np.sin(angle) / curvature
        up = 0.0 * inside if bend == 0.0 else (1.0 - np.cos(angle)) / curvature
        frames.append(np.stack([first + before + along + behind * np.cos(angle) - rest[:, 1] * np.sin(angle),
                                up + behind * np.sin(angle) + rest[:, 1] * np.cos(angle), rest[:, 2]], axis=1))
    F = np.array(faces)
    middle = rest[F].mean(axis=1)[:, 0]
    return "hinge", F, rest, np.array(frames), np.where((middle > first) & (middle < last), 0.1, 1.0)


def paint(F: Any, rest: Any, frames: Any) -> Any:
    """A stiffness from the strain of edges, smoothed a little."""
    def lengths(x: Any) -> Any:
        return np.stack([np.linalg.norm(x[F[:, i]] - x[F[:, (i + 1) % 3]], axis=1) for i in range(3)])

    at_rest = lengths(rest)
    strain = np.zeros(len(F))
    for frame in frames:
        strain = np.maximum(strain, np.abs(lengths(frame) / at_rest - 1.0).max(axis=0))
    for _ in range(3):
        total, count = np.zeros(len(rest)), np.zeros(len(rest))
        for i in range(3):
            np.add.at(total, F[:, i], strain)
            np.add.at(count, F[:, i], 1.0)
        strain = (total / np.maximum(count, 1.0))[F].mean(axis=1)
    return np.clip(1.0 - 0.9 * strain / np.quantile(strain, 0.9), 0.1, 1.0)


def recordings(paths: List[str]) -> Iterator[Recording]:
    """The one that is made here, and those named."""
    yield hinge()
    for path in paths:
        rest, F = [], []
        for line in Path(path).read_text(encoding="utf-8").splitlines():
            words = line.split()
            if words and words[0] == "v":
                rest.append([float(word) for word in words[1:4]])
            elif words and words[0] == "f":
                F.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
        data = Path(path).with_suffix(".pc2").read_bytes()
        vertices, count = int.from_bytes(data[16:20], "little"), int.from_bytes(data[28:32], "little")
        frames = np.frombuffer(data, "<f4", vertices * count * 3, 32).reshape(count, vertices, 3).astype(np.float64)
        yield Path(path).stem, np.array(F), np.array(rest), frames, paint(np.array(F), np.array(rest), frames)


def measure(mesh: Any, plan: Any, frames: Any) -> Tuple[float, float]:
    """Over all intervals: the mean of the pairs that are tested, and the median of the milliseconds."""
    detector = cscd.Detector(mesh, plan=plan, method=plan.method, start="vouched", threads=1)
    pairs, times = [], []
    for i in range(len(frames) - 1):
        detector.step(frames[i], frames[i + 1])
        pairs.append(detector.counters["pcp"])
        times.append(detector.timings["total_ms"])
    return float(np.mean(pairs)), float(np.median(times))


def main() -> None:
    """Prints a row for each plan."""
    for name, F, rest, frames, stiffness in recordings(sys.argv[1:]):
        mesh = cscd.Mesh(F)
        chosen = [frames[i] for i in np.linspace(0, len(frames) - 1, 8).astype(int)]
        for kind, make, options in (("rest", cscd.Plan.charge, {}), ("stiffness", cscd.Plan.charge, {"stiffness": stiffness}),
                                    ("auto with stiffness", cscd.Plan.auto, {"stiffness": stiffness}),
                                    ("frames", cscd.Plan.charge, {"frames": chosen})):
            plan = make(mesh, rest, threads=1, **options)
            pairs, milliseconds = measure(mesh, plan, frames)
            print(f"{name} ({len(F):,}) {kind}: {plan.method}, {plan.region_count} regions, {pairs:,.0f} pairs, "
                  f"{milliseconds:.3f} ms")


if __name__ == "__main__":
    main()
