/* Gaps between moving features along the seven directions of 14-DOPs, in long double. */
#include "tests/support/bvh/direction_gap.h"

#include <math.h>
#include <stddef.h>

const int directions[DIRECTION_COUNT][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},
                                            {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

long double along_direction(const long double p[3], int direction) {
    const int *d = directions[direction];
    return d[0] * p[0] + d[1] * p[1] + d[2] * p[2];
}

typedef struct gap_extent {
    long double low, high;
} gap_extent;

static long double lesser_of(long double a, long double b) {
    return a < b ? a : b;
}

static long double greater_of(long double a, long double b) {
    return a > b ? a : b;
}

static gap_extent extent_of(const double *x, point_set points, int direction) {
    gap_extent out = {INFINITY, -INFINITY};
    for (int i = 0; i < points.count; i++) {
        const double *p = x + (size_t)points.vertices[i] * 3;
        long double value =
            direction < 3 ? p[direction] : along_direction((long double[3]){p[0], p[1], p[2]}, direction);
        out.low = lesser_of(out.low, value);
        out.high = greater_of(out.high, value);
    }
    return out;
}

static long double gap_along_some(gap_motion m, point_set a, point_set b, int count, long double enough) {
    long double largest = -INFINITY;
    for (int k = 0; k < count && largest <= enough; k++) {
        gap_extent a0 = extent_of(m.x0, a, k), a1 = extent_of(m.x1, a, k);
        gap_extent b0 = extent_of(m.x0, b, k), b1 = extent_of(m.x1, b, k);
        long double above = lesser_of(a0.low - b0.high, a1.low - b1.high);
        long double below = lesser_of(b0.low - a0.high, b1.low - a1.high);
        long double gap = greater_of(above, below);
        largest = greater_of(largest, k < 3 ? gap : gap / sqrtl(3.0L));
    }
    return largest;
}

long double direction_gap(gap_motion m, point_set a, point_set b, long double enough) {
    return gap_along_some(m, a, b, DIRECTION_COUNT, enough);
}

long double axis_gap(gap_motion m, point_set a, point_set b, long double enough) {
    return gap_along_some(m, a, b, 3, enough);
}

double motion_extent(gap_motion m, uint32_t vertex_count) {
    double largest = 0.0;
    for (uint32_t i = 0; i < vertex_count * 3; i++) {
        largest = fmax(largest, fabs(m.x0[i] - m.x0[i % 3]));
        largest = fmax(largest, fabs(m.x1[i] - m.x0[i % 3]));
    }
    return largest;
}
