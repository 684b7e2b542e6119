"""A recording for the tests with VTK: a worm creeps through a ring, and at last into itself and the ring."""
import math
import os

RINGS, AROUND = 30, 12  # of the ring
SEGMENTS, SIDES = 40, 8  # of the worm
FIRST, COUNT = 1001, 8


def ring_vertices():
    for i in range(RINGS):
        a = 2 * math.pi * i / RINGS
        for k in range(AROUND):
            b = 2 * math.pi * k / AROUND
            r = 1.0 + 0.25 * math.cos(b)
            yield r * math.cos(a), r * math.sin(a), 0.25 * math.sin(b)


def ring_faces():
    for i in range(RINGS):
        for k in range(AROUND):
            j, m = (i + 1) % RINGS, (k + 1) % AROUND
            yield i * AROUND + k, j * AROUND + k, j * AROUND + m, i * AROUND + m


def worm_vertices(t):
    """t from 0 to 1: it stands in the ring's hole, leans over, and curls up."""
    bend = 1.2 + 5.5 * t
    for i in range(SEGMENTS + 1):
        s = i / SEGMENTS
        angle = bend * s
        x, z = 0.2 + 2.0 * (1 - math.cos(angle)) / bend, -1.0 + 2.0 * math.sin(angle) / bend
        for k in range(SIDES):
            b = 2 * math.pi * k / SIDES + 0.1
            across = 0.15 * math.cos(b)
            yield x - across * math.cos(angle), 0.15 * math.sin(b) + 0.013, z + across * math.sin(angle)


def worm_faces(first):
    for i in range(SEGMENTS):
        for k in range(SIDES):
            a, b = first + i * SIDES + k, first + i * SIDES + (k + 1) % SIDES
            yield a, a + SIDES, b + SIDES, b
    yield tuple(first + k for k in range(SIDES))
    yield tuple(first + SEGMENTS * SIDES + k for k in reversed(range(SIDES)))


def write_scene(folder):
    """Returns the paths of the frames; the first is the model, too."""
    paths = []
    for frame in range(COUNT):
        paths.append(os.path.join(folder, f'scene_{FIRST + frame}.obj'))
        with open(paths[-1], 'w') as out:
            out.write('o Ring\n')
            out.writelines('v %.17g %.17g %.17g\n' % v for v in ring_vertices())
            out.writelines('f %d %d %d %d\n' % tuple(i + 1 for i in f) for f in ring_faces())
            out.write('o Worm\n')
            out.writelines('v %.17g %.17g %.17g\n' % v for v in worm_vertices(frame / (COUNT - 1)))
            out.writelines('f ' + ' '.join(str(i + 1) for i in f) + '\n' for f in worm_faces(RINGS * AROUND))
    return paths
