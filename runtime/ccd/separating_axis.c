/* Separating directions of level one: planes that keep two moving features apart during the whole interval.
 *
 * All points move linearly, so the gap along a fixed direction between two of them is least at t = 0 or 1: a
 * direction along which every point of one feature lies beyond every point of the other at both ends
 * separates them throughout. */
#include "runtime/ccd/elementary_levels.h"
#include "src/core/vec3.h"

#include <string.h>

/* ---- level one ----------------------------------------------------------------------------------------- */

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

/* A query whose points may lie elsewhere by as much as slack / 2 along each axis. */
typedef struct loose_query {
    elementary_query points;
    double slack;
} loose_query;

/* Does every point of the first feature lie beyond every point of the second along n? A gap is three
 * differences, three products and two sums: 4 roundings of parts that add up to `size`, below 4.1 u size
 * with u = 2^-53. The bound 8 u size leaves room for computing it. Underflow loses 3 times 2^-1075 at most.
 * Slack makes a gap smaller by its share of the sum of |n|; what computing that loses, its maker has added. */
static bool beyond_along(const double x[4][3], cscd_contact_kind kind, const double n[3], double slack) {
    int first = points_of_first(kind);
    double loose = slack * (fabs(n[0]) + fabs(n[1]) + fabs(n[2]));
    for (int i = 0; i < first; i++) {
        for (int j = first; j < 4; j++) {
            double gap = 0.0, size = 0.0;
            for (int k = 0; k < 3; k++) {
                double part = (x[i][k] - x[j][k]) * n[k];
                gap += part;
                size += fabs(part);
            }
            if (!(gap > 0x1p-50 * size + (loose + 0x1p-1060))) return false;
        }
    }
    return true;
}

static bool separated_along(const loose_query *query, cscd_contact_kind kind, const double n[3]) {
    return beyond_along(query->points.x0, kind, n, query->slack) &&
           beyond_along(query->points.x1, kind, n, query->slack);
}

/* Tries the direction times * n, at a size at which nothing over- or underflows. */
static bool separated_along_scaled(const loose_query *query, cscd_contact_kind kind, double times,
                                   const double n[3]) {
    int exponent;
    double scaled[3], largest = vec3_largest(n);
    if (!(largest > 0.0)) return false;
    frexp(largest, &exponent);
    for (int k = 0; k < 3; k++) scaled[k] = ldexp(times * n[k], -exponent);
    return separated_along(query, kind, scaled);
}

static bool separated_either_way(const loose_query *query, cscd_contact_kind kind, const double n[3]) {
    return separated_along_scaled(query, kind, 1.0, n) || separated_along_scaled(query, kind, -1.0, n);
}

/* Writes twice the vector between two points at t = 1/2. */
static void between_at_middle(const loose_query *query, int from, int to, double out[3]) {
    const elementary_query *q = &query->points;
    for (int k = 0; k < 3; k++) out[k] = (q->x0[to][k] - q->x0[from][k]) + (q->x1[to][k] - q->x1[from][k]);
}

/* Tries the directions along which the vertex lies beyond a side of the face at mid-interval. */
static bool vertex_outside_face(const loose_query *query) {
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
static bool edges_beside(const loose_query *query) {
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

static bool separated_in_common_plane(const loose_query *query, cscd_contact_kind kind) {
    return kind == CSCD_CONTACT_VF ? vertex_outside_face(query) : edges_beside(query);
}

bool separated_in_plane(const elementary_query *query, cscd_contact_kind kind) {
    const loose_query exact = {*query, 0.0};
    return separated_in_common_plane(&exact, kind);
}

/* ---- in a part of the interval ------------------------------------------------------------------------------- */

static double blend_ends(double start, double end, double t) {
    return (1.0 - t) * start + t * end;
}

/* The points from begin to end. A coordinate there is off by three roundings of numbers up to the largest
 * coordinate C, less than 3.1 u C, so that a difference of two is off by less than 6.2 u C; 8 u C is the
 * slack. Nothing underflows: coordinates are multiples of 2^-352, and times of 2^-103. */
static loose_query part_of_query(const elementary_query *query, double begin, double end) {
    loose_query part;
    double largest = 0.0;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) {
            part.points.x0[i][k] = blend_ends(query->x0[i][k], query->x1[i][k], begin);
            part.points.x1[i][k] = blend_ends(query->x0[i][k], query->x1[i][k], end);
        }
        largest = max_of(largest, max_of(vec3_largest(query->x0[i]), vec3_largest(query->x1[i])));
    }
    part.slack = 0x1p-50 * largest;
    return part;
}

static bool separated_along_axes(const loose_query *query, cscd_contact_kind kind) {
    static const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; k++) {
        if (separated_either_way(query, kind, axes[k])) return true;
    }
    return false;
}

/* Parallel edges, and a vertex and a face that is all but a segment, have no normal. Tries the direction
 * along the longest side, and the one across it to the other feature. */
static bool separated_beside_longest(const loose_query *query, cscd_contact_kind kind) {
    static const int sides_of_face[3][3] = {{1, 2, 0}, {2, 3, 0}, {3, 1, 0}},
                     edges[2][3] = {{0, 1, 2}, {2, 3, 0}};
    const int(*sides)[3] = kind == CSCD_CONTACT_VF ? sides_of_face : edges;
    double along[3] = {0.0}, to_other[3] = {0.0}, normal[3], across[3];
    for (int i = 0; i < (kind == CSCD_CONTACT_VF ? 3 : 2); i++) {
        double side[3];
        between_at_middle(query, sides[i][0], sides[i][1], side);
        if (!(vec3_largest(side) > vec3_largest(along))) continue;
        memcpy(along, side, sizeof along);
        between_at_middle(query, sides[i][0], sides[i][2], to_other);
    }
    vec3_cross(to_other, along, normal);
    vec3_cross(along, normal, across);
    return separated_either_way(query, kind, across) || separated_either_way(query, kind, along);
}

bool separated_in_part(const elementary_query *query, cscd_contact_kind kind, double begin, double end) {
    loose_query part = part_of_query(query, begin, end);
    return separated_along_axes(&part, kind) || separated_in_common_plane(&part, kind) ||
           separated_beside_longest(&part, kind);
}

/* ---- the directions of 14-DOPs, and a distance --------------------------------------------------------- */

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
