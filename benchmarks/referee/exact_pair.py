"""The common points of two triangles, in integers: the referee of pairs on which programs differ. It shares no code with
the library: one triangle is cut by the planes that bound the other one, and the corners of what is left tell.
"""

from fractions import Fraction


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def normal(t):
    return cross(minus(t[1], t[0]), minus(t[2], t[0]))


def as_integers(points):
    """The same points times a power of two that makes all coordinates integers."""
    ratios = [[x.as_integer_ratio() for x in p] for p in points]
    scale = max(d for p in ratios for _, d in p)
    return [tuple(n * (scale // d) for n, d in p) for p in ratios]


def equation(n, p):
    d = dot(n, p)
    return [(n, d), ((-n[0], -n[1], -n[2]), -d)]


def half_spaces(t):
    """A triangle, even one without area, as all (n, d) with n . x >= d for its points x."""
    n = normal(t)
    if n != (0, 0, 0):
        edges = [(t[i], t[(i + 1) % 3]) for i in range(3)]
        inward = [(cross(n, minus(q, p)), p) for p, q in edges]
        return equation(n, t[0]) + [(m, dot(m, p)) for m, p in inward]
    p, q = min(t), max(t)
    if p == q:
        return [e for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1)) for e in equation(axis, p)]
    d = minus(q, p)
    across = [(0, d[2], -d[1]), (-d[2], 0, d[0]), (d[1], -d[0], 0)]
    ends = [(d, dot(d, p)), ((-d[0], -d[1], -d[2]), -dot(d, q))]
    return [e for n in across for e in equation(n, p)] + ends


def height(point, h):
    """point: x, y, z and what they are divided by, which is above 0."""
    n, d = h
    return dot(n, point) - d * point[3]


def cut(polygon, h):
    left = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1]):
        at_p, at_q = height(p, h), height(q, h)
        if at_p >= 0:
            left.append(p)
        if at_p * at_q < 0:
            up, down = abs(at_q), abs(at_p)
            left.append(tuple(up * p[k] + down * q[k] for k in range(4)))
    return left


def common_corners(a, b):
    """The corners of what two triangles have in common, each once."""
    polygon = [p + (1,) for p in a]
    for h in half_spaces(b):
        polygon = cut(polygon, h)
    return list({tuple(Fraction(p[k], p[3]) for k in range(3)) for p in polygon})


def within_edge(x, p, q):
    d, e = minus(q, p), minus(x, p)
    return cross(d, e) == (0, 0, 0) and 0 <= dot(d, e) <= dot(d, d)


def inside_edges(point, t):
    n = normal(t)
    return all(dot(cross(n, minus(t[(i + 1) % 3], t[i])), minus(point, t[i])) > 0 for i in range(3))


CASES = {
    "apart": "have nothing in common but what they share by index",
    "crossing": "cross",
    "area": "lie on each other in one plane",
    "duplicate": "have the same three vertices",
    "touching": "touch",
    "equal places": "touch only where vertices of both, with different numbers, are at one place",
    "no area": "meet, and one of them has no area",
}


def case_of(a, b, positions):
    """The case of two triangles, given by their vertices' numbers."""
    points = as_integers([positions[v] for v in list(a) + list(b)])
    s, t = points[:3], points[3:]
    flat = (0, 0, 0) in (normal(s), normal(t))
    shared = [points[i] for i in range(3) if a[i] in b]
    if len(shared) == 3:
        return "no area" if flat else "duplicate"
    found = common_corners(s, t)
    if len(shared) == 1:
        elsewhere = [x for x in found if x != shared[0]]
    elif len(shared) == 2:
        elsewhere = [x for x in found if not within_edge(x, shared[0], shared[1])]
    else:
        elsewhere = found
    if not elsewhere:
        return "apart"
    if flat:
        return "no area"
    middle = tuple(sum(x[k] for x in found) / len(found) for k in range(3))
    if inside_edges(middle, s) and inside_edges(middle, t):
        return "area" if cross(normal(s), normal(t)) == (0, 0, 0) else "crossing"
    both = set(s) & set(t)
    return "equal places" if all(x in both for x in elsewhere) else "touching"
