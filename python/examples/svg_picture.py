"""Pictures of meshes as SVG, by numpy alone: the examples in this folder draw with it."""

from __future__ import annotations

from typing import Any, Dict, List, Sequence, Tuple

import numpy as np

Array = Any

SURFACE, MARKED = (225, 220, 210), (214, 64, 40)


class Picture:
    """One row of panels, each of which is seen along one direction, without perspective."""

    def __init__(self, width: int, height: int, panels: int = 1) -> None:
        self.width, self.height, self.panels = width, height, panels
        self.lines: List[str] = []
        self.colours: Dict[str, int] = {}

    def look(self, panel: int, around: float, above: float, centre: Sequence[float], extent: float) -> None:
        """Sets the view: degrees around the axis y and above the ground, what is in the middle, and half the height."""
        a, e = np.radians(around), np.radians(above)
        right = [np.cos(a), 0.0, -np.sin(a)]
        forward = [-np.sin(a) * np.cos(e), -np.sin(e), -np.cos(a) * np.cos(e)]
        self.axes = np.array([right, np.cross(right, forward), forward])
        self.centre, self.scale = np.asarray(centre, float), 0.5 * self.height / extent
        self.middle = np.array([(panel + 0.5) * self.width / self.panels, 0.5 * self.height])

    def project(self, points: Array) -> Tuple[Array, Array]:
        """Places on the picture (n, 2), and how far behind the centre each point is (n,)."""
        seen = ((np.asarray(points, float) - self.centre)[:, None, :] * self.axes).sum(axis=2)
        return self.middle + self.scale * seen[:, :2] * [1.0, -1.0], seen[:, 2]

    def surface(self, V: Array, triangles: Array, colours: Array, closed: bool = False, nearer: Any = 0.0) -> None:
        """Draws triangles from back to front; ``colours`` (t, 3), 0 to 255. Triangles that face away are darker, or left out.

        Triangles are sorted by their centres, as if these were ``nearer`` by this length.
        """
        place, far = self.project(V)
        corner = place[triangles]
        edge = V[triangles[:, 1:]] - V[triangles[:, :1]]
        normal = np.cross(edge[:, 0], edge[:, 1])
        facing = -(normal * self.axes[2]).sum(axis=1) / np.maximum(np.sqrt((normal * normal).sum(axis=1)), 1e-300)
        light = np.where(facing >= 0.0, 0.45 + 0.55 * facing, 0.4)
        shades = (np.asarray(colours) * (np.round(light * 12.0) / 12.0)[:, None]).astype(int)
        inside = ((corner.max(axis=1) > 0.0) & (corner.min(axis=1) < [self.width, self.height])).all(axis=1)
        seen = inside & (facing > 0.0) if closed else inside
        corner = np.rint(corner).astype(int)
        for t in np.argsort(nearer - far[triangles].mean(axis=1), kind="stable"):
            if seen[t]:
                number = self.colours.setdefault("#%02x%02x%02x" % tuple(shades[t]), len(self.colours))
                a, b, c = corner[t]
                self.lines.append(f'<path class="c{number}" d="M{a[0]} {a[1]}L{b[0]} {b[1]} {c[0]} {c[1]}z"/>')

    def curve(self, points: Array, colour: str = "black", width: float = 2.0) -> None:
        """Draws a line over what is drawn already."""
        places = " ".join(f"{x:.1f},{y:.1f}" for x, y in self.project(points)[0])
        self.lines.append(f'<polyline points="{places}" fill="none" stroke="{colour}" stroke-width="{width}"/>')

    def dots(self, points: Array, colour: str, width: float) -> None:
        """Draws dots over what is drawn already."""
        path = "".join(f"M{x:.0f} {y:.0f}h0" for x, y in self.project(points)[0])
        self.lines.append(f'<path d="{path}" stroke="{colour}" stroke-width="{width}" stroke-linecap="round"/>')

    def caption(self, panel: int, text: str) -> None:
        """Writes below a panel."""
        x = (panel + 0.5) * self.width / self.panels
        wide = self.width / self.panels
        self.lines.append(f'<rect x="{x - 0.5 * wide:.0f}" y="{self.height - 26}" width="{wide:.0f}" height="26" fill="white"/>')
        self.lines.append(f'<text x="{x:.0f}" y="{self.height - 8}" text-anchor="middle">{text}</text>')

    def write(self, path: str) -> None:
        """Writes the file."""
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" '
                f'font-family="sans-serif" font-size="14">')
        styles = "".join(f".c{i}{{fill:{colour};stroke:{colour}}}" for colour, i in self.colours.items())
        ground = f'<rect width="{self.width}" height="{self.height}" fill="white"/>'
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join([head, f"<style>{styles}</style>", ground, *self.lines, "</svg>"]) + "\n")


def write_plot(path: str, lines: Sequence[Tuple[str, str, Array]], across: str, up: str) -> None:
    """Draws lines, each a label, a colour and its values one after the other, in common axes from 0 on."""
    width, height, left, bottom = 640, 240, 50, 40
    top = max(float(np.max(values)) for _, _, values in lines)
    last = max(len(values) for _, _, values in lines) - 1
    texts = [(left - 6, 19, "end", f"{top:.2f}"), (left - 6, height - bottom, "end", "0"),
             (left, height - bottom + 16, "middle", "0"), (width - 10, height - bottom + 16, "end", str(last)),
             ((left + width) // 2, height - 6, "middle", across)]
    drawn = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
             f'<rect width="{width}" height="{height}" fill="white"/>',
             f'<path d="M{left} 15V{height - bottom}H{width - 10}" fill="none" stroke="black"/>',
             f'<text x="12" y="{(height - bottom) // 2}" text-anchor="middle" '
             f'transform="rotate(-90 12 {(height - bottom) // 2})">{up}</text>']
    for i, (label, colour, values) in enumerate(lines):
        x = left + np.arange(len(values)) * (width - left - 10) / last
        y = height - bottom - np.asarray(values) / top * (height - bottom - 15)
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y))
        drawn.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
        drawn.append(f'<text x="{width - 20}" y="{80 + 18 * i}" text-anchor="end" fill="{colour}">{label}</text>')
    drawn += [f'<text x="{x}" y="{y}" text-anchor="{anchor}">{text}</text>' for x, y, anchor, text in texts]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join([*drawn, "</svg>"]) + "\n")
