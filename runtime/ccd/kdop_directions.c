/* Finds features that one direction keeps apart throughout an interval. */
#include "runtime/ccd/kdop_directions.h"

#include "src/core/kdop.h"
#include "src/core/vec3.h"

/* The extent of points along one direction. */
typedef struct span {
    double low, high;
} span;

static span span_along_axis(const double (*points)[3], int count, int axis) {
    span s = {points[0][axis], points[0][axis]};
    for (int i = 1; i < count; i++) {
        s.low = min_of(s.low, points[i][axis]);
        s.high = max_of(s.high, points[i][axis]);
    }
    return s;
}

/* Coordinates are taken relative to an origin, because they may be far larger than distances between the
 * points. With u = 2^-53, differences are off by u of themselves, their sum by 2 u more, and widening it by
 * u: together 4 u of the sum of magnitudes. 8 u is taken. */
static span span_along_diagonal(const double (*points)[3], int count, int diagonal, const double origin[3]) {
    const double *signs = kdop_axes[BOX_AXES + diagonal];
    span s = {INFINITY, -INFINITY};
    for (int i = 0; i < count; i++) {
        double sum = 0.0, size = 0.0;
        for (int k = 0; k < 3; k++) {
            double offset = points[i][k] - origin[k];
            sum += signs[k] * offset;
            size += fabs(offset);
        }
        s.low = min_of(s.low, sum - 0x1p-50 * size);
        s.high = max_of(s.high, sum + 0x1p-50 * size);
    }
    return s;
}

/* Are the spans on the same side at both ends, farther apart than `gap`? Rounding is monotone, so spans that
 * are no farther apart than that are never computed to be. */
static bool stay_beyond(span a0, span b0, span a1, span b1, double gap) {
    return (b0.low - a0.high > gap && b1.low - a1.high > gap) ||
           (a0.low - b0.high > gap && a1.low - b1.high > gap);
}

bool directions_part(const elementary_query *query, cscd_contact_kind kind, double distance) {
    const double(*x0)[3] = (const double(*)[3])query->x0, (*x1)[3] = (const double(*)[3])query->x1;
    int a = points_of_first(kind), b = 4 - a;
    for (int k = 0; k < BOX_AXES; k++) {
        if (stay_beyond(span_along_axis(x0, a, k), span_along_axis(x0 + a, b, k), span_along_axis(x1, a, k),
                        span_along_axis(x1 + a, b, k), distance))
            return true;
    }
    double along_diagonal = 1.7320508075688774 * distance * (1.0 + 0x1p-50);
    for (int k = 0; k < KDOP_AXES - BOX_AXES; k++) {
        if (stay_beyond(span_along_diagonal(x0, a, k, x0[0]), span_along_diagonal(x0 + a, b, k, x0[0]),
                        span_along_diagonal(x1, a, k, x1[0]), span_along_diagonal(x1 + a, b, k, x1[0]),
                        along_diagonal))
            return true;
    }
    return false;
}
