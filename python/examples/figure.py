"""The share of self-intersecting faces over a data set, as a paper prints it: figure.py MODEL FRAMES [PLOT.svg]."""

from __future__ import annotations

import sys
from typing import List

import numpy as np

import cscd


def write_plot(path: str, share: np.ndarray) -> None:  # type: ignore[type-arg]
    """Draws shares in percent, frame by frame, as an SVG without any further package."""
    width, height, left, bottom = 640, 240, 50, 40
    top = max(float(share.max()), 1e-9)
    x = left + np.arange(len(share)) * (width - left - 10) / max(len(share) - 1, 1)
    y = height - bottom - share / top * (height - bottom - 15)
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y))
    lines: List[str] = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
        f'<rect width="{width}" height="{height}" fill="white"/>',
        f'<path d="M{left} 15V{height - bottom}H{width - 10}" fill="none" stroke="black"/>',
        f'<polyline points="{points}" fill="none" stroke="#c03020" stroke-width="2"/>',
        f'<text x="{left - 6}" y="19" text-anchor="end">{top:.2f}</text>',
        f'<text x="{left - 6}" y="{height - bottom}" text-anchor="end">0</text>',
        f'<text x="{left}" y="{height - bottom + 16}" text-anchor="middle">0</text>',
        f'<text x="{width - 10}" y="{height - bottom + 16}" text-anchor="end">{len(share) - 1}</text>',
        f'<text x="{(left + width) / 2}" y="{height - 6}" text-anchor="middle">frame</text>',
        f'<text x="12" y="{(height - bottom) / 2}" text-anchor="middle" '
        f'transform="rotate(-90 12 {(height - bottom) / 2})">self-intersecting faces, %</text>',
        "</svg>"]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def main(model: str, frames: str, plot: str = "") -> None:
    recording = cscd.read(model, frames)
    crossing = cscd.self_intersecting_faces(recording.frames, recording.mesh, threads=0)

    share = 100.0 * crossing.mean(axis=1)
    worst = int(share.argmax())
    print(f"{len(share)} frames of {recording.mesh.face_count} faces")
    print(f"self-intersecting faces: {share.mean():.2f} % on average, standard deviation {share.std():.2f} %, median "
          f"{np.median(share):.2f} %")
    print(f"worst: {share.max():.2f} % in frame {recording.frame_numbers[worst]}; {int((share == 0.0).sum())} frames have none")
    print(f"{100.0 * crossing.any(axis=0).mean():.2f} % of the faces intersect in some frame")
    if plot:
        write_plot(plot, share)


if __name__ == "__main__":
    main(*sys.argv[1:])
