/* Pairs of triangles that touch along one of the seven directions of 14-DOPs, to the last bit of a double. */
#include "tests/support/bvh/touching.h"

#include "tests/support/bvh/direction_gap.h"

#include <math.h>
#include <stddef.h>

static long double gap_along(const double *below, const double *above, int direction) {
    long double highest = -INFINITY, lowest = INFINITY;
    for (int i = 0; i < 3; i++) {
        const double *p = below + 3 * i, *q = above + 3 * i;
        highest = fmaxl(highest, along_direction((long double[3]){p[0], p[1], p[2]}, direction));
        lowest = fminl(lowest, along_direction((long double[3]){q[0], q[1], q[2]}, direction));
    }
    return lowest - highest;
}

/* Moves the upper triangle along one axis until it touches the lower one. */
static void let_touch(const double *below, double *above, int direction) {
    int axis = direction < 3 ? direction : 0;
    double sign = directions[direction][axis], more = 0x1p-53;
    double shift = (double)gap_along(below, above, direction);
    do {
        for (int i = 0; i < 3; i++) above[3 * i + axis] -= sign * shift;
        shift = more;
        more *= 2.0;
    } while (gap_along(below, above, direction) > 0.0L);
}

void make_touching_pairs(random_stream *random, uint32_t pair_count, double spread, scene *out) {
    scene_clear(out);
    out->vertex_count = pair_count * 6;
    out->triangle_count = pair_count * 2;
    for (uint32_t i = 0; i < pair_count * 6; i++) out->triangles[i] = i;
    for (size_t p = 0; p < pair_count; p++) {
        double centre[3];
        for (int k = 0; k < 3; k++) centre[k] = stream_between(random, -spread, spread);
        for (size_t i = 18 * p; i < 18 * p + 18; i++) {
            out->x0[i] = centre[i % 3] + stream_between(random, -1.0, 1.0);
            out->x1[i] = out->x0[i] + stream_between(random, -0.5, 0.5);
        }
        int direction = (int)stream_below(random, DIRECTION_COUNT);
        size_t above = 18 * p + 9 * stream_below(random, 2), below = 36 * p + 9 - above;
        let_touch(out->x0 + below, out->x0 + above, direction);
        let_touch(out->x1 + below, out->x1 + above, direction);
    }
}
