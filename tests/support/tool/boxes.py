"""Boxes along the axes as text of OBJ files, which count their vertices from the end, so that texts are put together."""

# The corners of each side, by bits x, y, z, counter-clockwise from outside.
SIDES = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def corners_of(low, high):
    """The eight corners."""
    return [tuple((low, high)[corner >> axis & 1][axis] for axis in range(3)) for corner in range(8)]


def box(low, high, name="", inverted=False, cut=None):
    """A box of six quads. inverted: inside out. cut: its sides are two triangles, along the one diagonal (0) or the other (1)."""
    lines = [f"o {name}"] * bool(name) + ["v {!r} {!r} {!r}".format(*corner) for corner in corners_of(low, high)]
    for side in SIDES:
        a, b, c, d = (corner - 8 for corner in (reversed(side) if inverted else side))
        if cut == 1:
            a, b, c, d = b, c, d, a
        lines += [f"f {a} {b} {c} {d}"] if cut is None else [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    return "\n".join(lines) + "\n"


def cube(low, size, name="", **options):
    """A cube from a corner with equal coordinates, or from any."""
    low = (low, low, low) if isinstance(low, (int, float)) else low
    return box(low, tuple(x + size for x in low), name, **options)
