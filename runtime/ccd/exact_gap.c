/* Computes by integers how much farther apart than a length two features at rest are.
 *
 * The distance is the least of finitely many: between two points, between a point and the inside of an edge,
 * between a point and the inside of a face, and between the insides of two edges. If the foot of the
 * perpendicular is inside, which signs of integers say, the square of such a distance is a fraction n / m of
 * integers, and so is
 *     n / m - s^2 = (distance - s) (distance + s)
 * for a length s. Each fraction is rounded at the end only, so that nothing cancels. As every such distance is that of
 * two points of the features, the least rounded result is right. */
#include "runtime/ccd/exact.h"
#include "src/core/floating.h"

#include <math.h>

/* The points and the length as integers, in units of 2^exponent. */
typedef struct integer_pair {
    integer_pool *pool;
    integer x[4][3];
    integer squared_length;
    double length; /* in ordinary units */
    int exponent;
    double least; /* of the gaps found so far, in ordinary units */
} integer_pair;

/* ---- vectors ------------------------------------------------------------------------------------------- */

static void subtract_vectors(integer_pool *pool, const integer a[3], const integer b[3], integer out[3]) {
    for (int k = 0; k < 3; k++) out[k] = integer_subtract(pool, a[k], b[k]);
}

static integer dot_vectors(integer_pool *pool, const integer a[3], const integer b[3]) {
    integer sum = integer_from_int(pool, 0);
    for (int k = 0; k < 3; k++) sum = integer_add(pool, sum, integer_multiply(pool, a[k], b[k]));
    return sum;
}

static void cross_vectors(integer_pool *pool, const integer a[3], const integer b[3], integer out[3]) {
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        out[k] =
            integer_subtract(pool, integer_multiply(pool, a[i], b[j]), integer_multiply(pool, a[j], b[i]));
    }
}

/* ---- distances ----------------------------------------------------------------------------------------- */

/* Returns the root of mantissa 2^exponent. */
static double root_of(double mantissa, int exponent) {
    int odd = exponent & 1;
    return ldexp(sqrt(odd ? 2.0 * mantissa : mantissa), (exponent - odd) / 2);
}

/* Takes a distance whose square is n / m. Three conversions, a root, a sum and three more operations are off
 * by 2^-48 together; 2^-40 is taken off at the end. A distance that underflows here is far below what counts
 * as 0. */
static void take_distance(integer_pair *p, integer n, integer m) {
    integer_pool *pool = p->pool;
    integer above = integer_subtract(pool, n, integer_multiply(pool, m, p->squared_length));
    int n_exponent, m_exponent, above_exponent, sum_exponent;
    double gap = 0.0;
    if (integer_sign(above) > 0) {
        double n_part = integer_to_double(n, &n_exponent), m_part = integer_to_double(m, &m_exponent);
        double above_part = integer_to_double(above, &above_exponent);
        double distance = root_of(n_part / m_part, n_exponent - m_exponent + 2 * p->exponent);
        double sum = frexp(distance + p->length, &sum_exponent);
        if (sum > 0.0)
            gap = ldexp(above_part / m_part / sum,
                        above_exponent - m_exponent + 2 * p->exponent - sum_exponent);
    }
    p->least = min_of(p->least, gap);
}

static void take_points(integer_pair *p, int a, int b) {
    uint32_t mark = p->pool->used;
    integer offset[3];
    subtract_vectors(p->pool, p->x[a], p->x[b], offset);
    take_distance(p, dot_vectors(p->pool, offset, offset), integer_from_int(p->pool, 1));
    p->pool->used = mark;
}

/* A point, and the inside of the edge from b to c. */
static void take_point_edge(integer_pair *p, int point, int b, int c) {
    integer_pool *pool = p->pool;
    uint32_t mark = pool->used;
    integer side[3], offset[3], area[3];
    subtract_vectors(pool, p->x[c], p->x[b], side);
    subtract_vectors(pool, p->x[point], p->x[b], offset);
    integer along = dot_vectors(pool, side, offset), squared = dot_vectors(pool, side, side);
    if (integer_sign(along) > 0 && integer_sign(integer_subtract(pool, squared, along)) > 0) {
        cross_vectors(pool, side, offset, area);
        take_distance(p, dot_vectors(pool, area, area), squared);
    }
    pool->used = mark;
}

/* The squared height of c over the plane of a and b, if the parameters of its foot are inside. */
static void take_height(integer_pair *p, const integer a[3], const integer b[3], const integer c[3],
                        cscd_contact_kind kind) {
    integer_pool *pool = p->pool;
    integer normal[3], side[3];
    cross_vectors(pool, a, b, normal);
    integer area = dot_vectors(pool, normal, normal);
    if (integer_sign(area) == 0) return;
    cross_vectors(pool, c, b, side);
    integer u = dot_vectors(pool, side, normal);
    bool vf = kind == CSCD_CONTACT_VF;
    cross_vectors(pool, vf ? a : c, vf ? c : a, side);
    integer v = dot_vectors(pool, side, normal);
    integer rest_u = integer_subtract(pool, area, vf ? integer_add(pool, u, v) : u);
    integer rest_v = integer_subtract(pool, area, v);
    if (integer_sign(u) < 0 || integer_sign(v) < 0 || integer_sign(rest_u) < 0 || integer_sign(rest_v) < 0)
        return;
    integer height = dot_vectors(pool, c, normal);
    take_distance(p, integer_multiply(pool, height, height), area);
}

static void take_insides(integer_pair *p, cscd_contact_kind kind) {
    uint32_t mark = p->pool->used;
    bool vf = kind == CSCD_CONTACT_VF;
    integer a[3], b[3], c[3];
    subtract_vectors(p->pool, p->x[vf ? 2 : 1], p->x[vf ? 1 : 0], a);
    subtract_vectors(p->pool, p->x[3], p->x[vf ? 1 : 2], b);
    subtract_vectors(p->pool, p->x[vf ? 0 : 2], p->x[vf ? 1 : 0], c);
    take_height(p, a, b, c, kind);
    p->pool->used = mark;
}

/* ---- the pair ------------------------------------------------------------------------------------------ */

static int least_exponent(const double x[4][3], double length) {
    int least = length > 0.0 ? integer_lowest_bit(length) : INT32_MAX;
    for (int i = 0; i < 12; i++) {
        if (x[i / 3][i % 3] == 0.0) continue;
        int lowest = integer_lowest_bit(x[i / 3][i % 3]);
        least = lowest < least ? lowest : least;
    }
    return least;
}

static void take_vertex_face(integer_pair *p) {
    for (int i = 1; i < 4; i++) {
        take_points(p, 0, i);
        take_point_edge(p, 0, i, i % 3 + 1);
    }
}

static void take_edges(integer_pair *p) {
    for (int i = 0; i < 2; i++) {
        for (int j = 2; j < 4; j++) take_points(p, i, j);
        take_point_edge(p, i, 2, 3);
        take_point_edge(p, 2 + i, 0, 1);
    }
}

double exact_gap(cscd_contact_kind kind, const double x[4][3], double length) {
    integer_pool pool;
    integer_pair p = {.pool = &pool, .length = length, .least = INFINITY};
    p.exponent = least_exponent(x, length);
    if (p.exponent == INT32_MAX) return 0.0;
    integer_pool_start(&pool);
    for (int i = 0; i < 12; i++) p.x[i / 3][i % 3] = integer_from_double(&pool, x[i / 3][i % 3], p.exponent);
    integer whole = integer_from_double(&pool, length, p.exponent);
    p.squared_length = integer_multiply(&pool, whole, whole);
    if (kind == CSCD_CONTACT_VF)
        take_vertex_face(&p);
    else
        take_edges(&p);
    take_insides(&p, kind);
    double gap = p.least * (1.0 - 0x1p-40);
    return gap >= 0x1p-352 ? gap : 0.0;
}
