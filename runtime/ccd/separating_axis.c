/* Separating directions of level one: planes that keep two moving features apart during the whole interval.
 *
 * All points move linearly, so the gap along a fixed direction between two of them is least at t = 0 or 1: a
 * direction along which every point of one feature lies beyond every point of the other at both ends
 * separates them throughout. */
#include "runtime/ccd/separating_axis.h"

#include "src/core/vec3.h"

enum { DIAGONAL_COUNT = 4 };

/* Returns 1 when the first feature lies beyond the second along axis k, -1 when it lies before it, and 0
 * otherwise. The comparison is exact. */
static int side_along_axis(const double x[4][3], cscd_contact_kind kind, int k) {
    bool edges = kind == CSCD_CONTACT_EE;
    double a = x[0][k], b = x[1][k], c = x[2][k], d = x[3][k];
    double a_low = edges && b < a ? b : a, a_high = edges && b > a ? b : a;
    double b_low = c < d ? c : d, b_high = c > d ? c : d;
    if (!edges) {
        b_low = b < b_low ? b : b_low;
        b_high = b > b_high ? b : b_high;
    }
    return (a_low > b_high) - (a_high < b_low);
}

/* Writes x+y+z, x+y-z, x-y+z and -x+y+z, and how far they may be off. Each takes two additions with a
 * relative error u = 2^-53 of numbers below s = |x|+|y|+|z|, which makes at most (2u + u^2) s. 2^-51 s = 4u s
 * covers the rounding of s and of the comparison, too. */
static void sum_diagonals(const double p[3], double sums[DIAGONAL_COUNT], double *error) {
    sums[0] = p[0] + p[1] + p[2];
    sums[1] = p[0] + p[1] - p[2];
    sums[2] = p[0] - p[1] + p[2];
    sums[3] = p[1] + p[2] - p[0];
    *error = 0x1p-51 * (fabs(p[0]) + fabs(p[1]) + fabs(p[2]));
}

static void sides_along_diagonals(const double x[4][3], cscd_contact_kind kind, int sides[DIAGONAL_COUNT]) {
    double sums[4][DIAGONAL_COUNT], error[4];
    for (int i = 0; i < 4; i++) sum_diagonals(x[i], sums[i], &error[i]);
    for (int k = 0; k < DIAGONAL_COUNT; k++) {
        double a_low = INFINITY, a_high = -INFINITY, b_low = INFINITY, b_high = -INFINITY;
        for (int i = 0; i < 4; i++) {
            double low = sums[i][k] - error[i], high = sums[i][k] + error[i];
            if (i < points_of_first(kind)) {
                a_low = low < a_low ? low : a_low;
                a_high = high > a_high ? high : a_high;
            } else {
                b_low = low < b_low ? low : b_low;
                b_high = high > b_high ? high : b_high;
            }
        }
        sides[k] = (a_low > b_high) - (a_high < b_low);
    }
}

bool separated_by_axes(const elementary_query *query, cscd_contact_kind kind) {
    for (int k = 0; k < 3; k++) {
        int side = side_along_axis(query->x0, kind, k);
        if (side != 0 && side == side_along_axis(query->x1, kind, k)) return true;
    }
    return false;
}

bool separated_by_diagonals(const elementary_query *query, cscd_contact_kind kind) {
    int start[DIAGONAL_COUNT], end[DIAGONAL_COUNT];
    sides_along_diagonals(query->x0, kind, start);
    sides_along_diagonals(query->x1, kind, end);
    for (int k = 0; k < DIAGONAL_COUNT; k++) {
        if (start[k] != 0 && start[k] == end[k]) return true;
    }
    return false;
}

/* Does every point of the first feature lie beyond every point of the second along n? A gap is three
 * differences, three products and two sums: 4 roundings of parts that add up to `size`, below 4.1 u size with
 * u = 2^-53. The bound 8 u size leaves room for computing it. Underflow loses 3 times 2^-1075 at most. */
static bool beyond_along(const double x[4][3], cscd_contact_kind kind, const double n[3]) {
    int first = points_of_first(kind);
    for (int i = 0; i < first; i++) {
        for (int j = first; j < 4; j++) {
            double gap = 0.0, size = 0.0;
            for (int k = 0; k < 3; k++) {
                double part = (x[i][k] - x[j][k]) * n[k];
                gap += part;
                size += fabs(part);
            }
            if (!(gap > 0x1p-50 * size + 0x1p-1060)) return false;
        }
    }
    return true;
}

static bool separated_along(const elementary_query *query, cscd_contact_kind kind, const double n[3]) {
    return beyond_along(query->x0, kind, n) && beyond_along(query->x1, kind, n);
}

/* Tries the direction times * n, at a size at which nothing over- or underflows. */
static bool separated_along_scaled(const elementary_query *query, cscd_contact_kind kind, double times,
                                   const double n[3]) {
    int exponent;
    double scaled[3], largest = vec3_largest(n);
    if (!(largest > 0.0)) return false;
    frexp(largest, &exponent);
    for (int k = 0; k < 3; k++) scaled[k] = ldexp(times * n[k], -exponent);
    return separated_along(query, kind, scaled);
}

/* Writes twice the vector between two points at t = 1/2. */
static void between_at_middle(const elementary_query *query, int from, int to, double out[3]) {
    for (int k = 0; k < 3; k++)
        out[k] = (query->x0[to][k] - query->x0[from][k]) + (query->x1[to][k] - query->x1[from][k]);
}

/* Tries the directions along which the vertex lies beyond a side of the face at mid-interval. */
static bool vertex_outside_face(const elementary_query *query) {
    double sides[3][3], normal[3];
    for (int i = 0; i < 3; i++) between_at_middle(query, 1 + i, 1 + (i + 1) % 3, sides[i]);
    vec3_cross(sides[0], sides[1], normal);
    for (int i = 0; i < 3; i++) {
        double outwards[3], to_vertex[3];
        vec3_cross(sides[i], normal, outwards);
        between_at_middle(query, 1 + i, 0, to_vertex);
        if (vec3_dot(outwards, to_vertex) > 0.0 &&
            separated_along_scaled(query, CSCD_CONTACT_VF, 1.0, outwards))
            return true;
    }
    return false;
}

/* Tries the directions along which both ends of one edge lie on one side of the other at mid-interval. */
static bool edges_beside(const elementary_query *query) {
    double a[3], b[3], normal[3];
    between_at_middle(query, 0, 1, a);
    between_at_middle(query, 2, 3, b);
    vec3_cross(a, b, normal);
    for (int i = 0; i < 2; i++) {
        double across[3], to_first[3], to_second[3];
        vec3_cross(normal, i == 0 ? b : a, across);
        between_at_middle(query, i == 0 ? 2 : 0, i == 0 ? 0 : 2, to_first);
        between_at_middle(query, i == 0 ? 2 : 0, i == 0 ? 1 : 3, to_second);
        double first = vec3_dot(across, to_first), second = vec3_dot(across, to_second);
        if (!(first > 0.0 && second > 0.0) && !(first < 0.0 && second < 0.0)) continue;
        double turn = (first > 0.0) == (i == 0) ? 1.0 : -1.0;
        if (separated_along_scaled(query, CSCD_CONTACT_EE, turn, across)) return true;
    }
    return false;
}

bool separated_in_plane(const elementary_query *query, cscd_contact_kind kind) {
    return kind == CSCD_CONTACT_VF ? vertex_outside_face(query) : edges_beside(query);
}
