"""Small meshes of the kinds on which programs are known to go wrong."""

import math


def quads(columns, rows, place):
    """A sheet of quads, two triangles each."""
    vertices = [place(i, j) for j in range(rows + 1) for i in range(columns + 1)]
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            triangles += [(a, b, c), (a, c, d)]
    return vertices, triangles


def turned(x, y, z):
    """A point in a plane that has no simple direction; rounding leaves it near that plane only."""
    u, v = (0.36, 0.48, -0.8), (0.8, -0.6, 0.0)
    w = (-0.48, -0.64, -0.6)
    return tuple(x * u[k] + y * v[k] + z * w[k] for k in range(3))


def box(low, high):
    vertices = [tuple(high[k] if i >> k & 1 else low[k] for k in range(3)) for i in range(8)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return vertices, [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]


def ball(middle, radius, rings=8, turns=12):
    vertices = [(middle[0], middle[1], middle[2] - radius)]
    for j in range(1, rings):
        for i in range(turns):
            up, around = math.pi * j / rings, 2 * math.pi * i / turns
            vertices.append((middle[0] + radius * math.sin(up) * math.cos(around),
                             middle[1] + radius * math.sin(up) * math.sin(around),
                             middle[2] - radius * math.cos(up)))
    vertices.append((middle[0], middle[1], middle[2] + radius))
    ring = lambda j, i: 1 + (j - 1) * turns + i % turns
    triangles = [(0, ring(1, i + 1), ring(1, i)) for i in range(turns)]
    for j in range(1, rings - 1):
        for i in range(turns):
            a, b, c, d = ring(j, i), ring(j, i + 1), ring(j + 1, i + 1), ring(j + 1, i)
            triangles += [(a, b, c), (a, c, d)]
    triangles += [(len(vertices) - 1, ring(rings - 1, i), ring(rings - 1, i + 1)) for i in range(turns)]
    return vertices, triangles


def joined(*parts):
    vertices, triangles = [], []
    for points, faces in parts:
        triangles += [tuple(v + len(vertices) for v in t) for t in faces]
        vertices += points
    return vertices, triangles


def fan(blades, height):
    """Blades around a middle that is nearly in their plane."""
    rim = [(math.cos(2 * math.pi * i / blades), math.sin(2 * math.pi * i / blades), height * (i % 2))
           for i in range(blades)]
    return [(0.0, 0.0, 0.0)] + rim, [(0, 1 + i, 1 + (i + 1) % blades) for i in range(blades)]


def beside(vertices, triangles):
    """The same with a triangle far off its plane, for programs that refuse what lies in one plane."""
    return joined((vertices, triangles), ([(50, 0, 20), (50, 9, 25), (57, 0, 30)], [(0, 1, 2)]))


def meshes():
    """Returns each mesh as name -> vertices, triangles."""
    sheet = quads(8, 8, lambda i, j: (i, j, 0.0))
    moved = quads(8, 8, lambda i, j: (i + 0.5, j + 0.5, 0.0))
    turned_sheet = quads(8, 8, lambda i, j: turned(i / 7, j / 7, 0.0))
    far = 1e6
    small = lambda i: far + i * 1e-3
    cube = box((far, far, far), (small(1), small(1), small(1)))
    next_cube = box((small(1.1), far, far), (small(2.1), small(1), small(1)))
    crossing_cube = box((small(0.7), small(0.2), small(0.3)), (small(1.7), small(1.2), small(1.4)))
    field = ([(0.0, 0.0, 0.0), (1e5, 0.0, 0.0), (0.0, 1e5, 0.0)], [(0, 1, 2)])
    return {
        "a flat sheet of 8 by 8 quads, and nothing else": sheet,
        "the same sheet": beside(*sheet),
        "the sheet in a plane that has no simple direction": beside(*turned_sheet),
        "the sheet, and one on it that is moved by half a quad": beside(*joined(sheet, moved)),
        "a fan of 40 blades, every other tip 1e-9 too high": beside(*fan(40, 1e-9)),
        "a fan of 40 blades in one plane": beside(*fan(40, 0.0)),
        "two triangles in one plane that share a vertex and nothing else": beside(
            [(0, 0, 0), (2, 1, 0), (1, 2, 0), (-2, -1, 0), (-1, -2, 0)], [(0, 1, 2), (0, 3, 4)]),
        "two in one plane that share a vertex and some area": beside(
            [(0, 0, 0), (4, 0, 0), (0, 4, 0), (3, 1, 0), (3, 3, 0)], [(0, 1, 2), (0, 3, 4)]),
        "two that share an edge, folded onto each other": beside(
            [(0, 0, 0), (4, 0, 0), (1, 3, 0), (2, 1, 0)], [(0, 1, 2), (1, 0, 3)]),
        "two that share a vertex and pass through each other": beside(
            [(0, 0, 0), (4, 2, 0), (4, -2, 0), (4, 0, 2), (4, 0, -2)], [(0, 1, 2), (0, 3, 4)]),
        "two that share a vertex; a corner of one is in the other": beside(
            [(0, 0, 0), (4, 2, 0), (4, -2, 0), (3, 0, 0), (4, 0, 2)], [(0, 1, 2), (0, 3, 4)]),
        "a triangle that stands on another one with a corner": beside(
            [(0, 0, 0), (4, 0, 0), (0, 4, 0), (1, 1, 0), (1, 2, 1), (2, 1, 1)], [(0, 1, 2), (3, 4, 5)]),
        "two whose edges meet in a point": beside(
            [(0, 0, 0), (2, 0, 0), (1, 2, 0), (1, 0, -1), (1, 0, 1), (1, -2, 0)], [(0, 1, 2), (3, 4, 5)]),
        "two at an edge that has vertices of its own in each": beside(
            [(0, 0, 0), (2, 0, 0), (1, 2, 0), (0, 0, 0), (2, 0, 0), (1, 0, 2)], [(0, 1, 2), (4, 3, 5)]),
        "a triangle, and a copy with vertices of its own": beside(
            [(0, 0, 0), (2, 0, 0), (1, 2, 0)] * 2, [(0, 1, 2), (3, 4, 5)]),
        "the same three vertices twice, once turned around": beside(
            [(0, 0, 0), (2, 0, 0), (1, 2, 0)], [(0, 1, 2), (0, 2, 1)]),
        "a triangle without area that passes through another one": beside(
            [(0, 0, 0), (4, 0, 0), (0, 4, 0), (1, 1, -1), (1, 1, 0.5), (1, 1, 1)], [(0, 1, 2), (3, 4, 5)]),
        "three triangles at one edge, one folded on another": beside(
            [(0, 0, 0), (4, 0, 0), (1, 3, 0), (2, 1, 0), (2, 0, 3)], [(0, 1, 2), (1, 0, 3), (0, 1, 4)]),
        "a box that stands on another one": joined(
            box((0.0, 0.0, 0.0), (4.0, 4.0, 1.0)), box((1.0, 1.0, 1.0), (2.0, 2.0, 3.0))),
        "two balls of radius 1, 100 apart": joined(ball((0.0, 0.0, 0.0), 1.0), ball((102.0, 0.0, 0.0), 1.0)),
        "at 1e6, two boxes of 1e-3 that are 1e-4 apart": joined(cube, next_cube),
        "at 1e6, two boxes of 1e-3 that cross": joined(cube, crossing_cube),
        "the boxes that are apart, and a triangle of 1e5": joined(cube, next_cube, field),
        "the boxes that cross, and a triangle of 1e5": joined(cube, crossing_cube, field),
    }
