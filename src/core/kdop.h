/* The directions of 14-DOPs; the first three are those of boxes. */
#pragma once

enum { BOX_AXES = 3, KDOP_AXES = 7 };

/* x, y, z, x+y+z, x+y-z, x-y+z, -x+y+z. Vector code writes these sums out, in this order. */
static const double kdop_axes[KDOP_AXES][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},
                                               {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

static inline double kdop_along(const double v[3], int axis) {
    return kdop_axes[axis][0] * v[0] + kdop_axes[axis][1] * v[1] + kdop_axes[axis][2] * v[2];
}
