/* Level three of the elementary tests: do two moving features touch, decided in exact arithmetic.
 *
 * At any moment, whether the features touch follows from the signs of finitely many polynomials in t: the
 * volume f of the four points (degree 3), the areas of the projections of their triangles onto the coordinate
 * planes (degree 2) and differences of coordinates (degree 1). So the set of times at which they touch, which
 * is closed, begins at 0 or at a root of one of these polynomials that is not identically 0, and only such
 * times are tried. If f is not identically 0, its roots are enough, because features that touch are coplanar.
 *
 * Consider one projection at such a time. Let m_i be the area of the triangle without point i, and w_i =
 * (-1)^i m_i. For coplanar points, sum w_i = 0 and sum w_i x_i = 0 (Radon). Let W be the sum of the first
 * feature's w_i: it is a component of the face's normal (VF) or of the cross product of the edges (EE).
 *     If W != 0 in some projection, it is one-to-one on the plane of the points. The features touch if and
 *     only if the first feature's w_i have the sign of W or are 0, and the others' have the opposite sign or
 *     are 0.
 *     If W = 0 in all three, the face has collapsed to a segment, the union of its sides, or the edges are
 *     parallel or points. The features touch if and only if some vertex of one lies on a segment of the
 *     other: it is collinear with the segment's ends (all three areas are 0) and between them in each
 *     coordinate. */
#include "runtime/ccd/exact.h"

/* Coordinates relative to point 0, and areas. */
typedef struct configuration {
    cscd_contact_kind kind;
    polynomial offset[4][3]; /* x_i - x_0 */
    polynomial area[4][3];   /* of the triangle without point i, projected along axis k */
    polynomial volume;
} configuration;

static int common_exponent(const elementary_query *query) {
    const double *x[2] = {&query->x0[0][0], &query->x1[0][0]};
    int least = INT32_MAX;
    for (int i = 0; i < 24; i++) {
        double coordinate = x[i / 12][i % 12];
        if (coordinate == 0.0) continue;
        int lowest = integer_lowest_bit(coordinate);
        least = lowest < least ? lowest : least;
    }
    return least;
}

/* Returns a0 + (a1 - a0) t - (b0 + (b1 - b0) t), all times 2^-exponent, where a is coordinate k of point i
 * and b is that of point 0. */
static polynomial coordinate_offset(integer_pool *pool, const elementary_query *query, int i, int k,
                                    int exponent) {
    uint32_t mark = pool->used;
    integer start = integer_subtract(pool, integer_from_double(pool, query->x0[i][k], exponent),
                                     integer_from_double(pool, query->x0[0][k], exponent));
    integer end = integer_subtract(pool, integer_from_double(pool, query->x1[i][k], exponent),
                                   integer_from_double(pool, query->x1[0][k], exponent));
    polynomial out = polynomial_linear(start, integer_subtract(pool, end, start));
    polynomial_keep(pool, mark, &out);
    return out;
}

/* Returns component k of a x b. */
static polynomial cross_component(integer_pool *pool, const polynomial a[3], const polynomial b[3], int k) {
    uint32_t mark = pool->used;
    polynomial plus = polynomial_multiply(pool, &a[(k + 1) % 3], &b[(k + 2) % 3]);
    polynomial minus = polynomial_multiply(pool, &a[(k + 2) % 3], &b[(k + 1) % 3]);
    polynomial out = polynomial_subtract(pool, &plus, &minus);
    polynomial_keep(pool, mark, &out);
    return out;
}

/* Returns the determinant along axis 0, x1 m1 - x2 m2 + x3 m3, up to its sign. */
static polynomial volume_of(integer_pool *pool, const configuration *c) {
    uint32_t mark = pool->used;
    polynomial sum = polynomial_zero();
    for (int i = 1; i < 4; i++) {
        polynomial part = polynomial_multiply(pool, &c->offset[i][0], &c->area[i][0]);
        sum = i == 2 ? polynomial_subtract(pool, &sum, &part) : polynomial_add(pool, &sum, &part);
    }
    polynomial_keep(pool, mark, &sum);
    return sum;
}

static void find_configuration(integer_pool *pool, const elementary_query *query, cscd_contact_kind kind,
                               configuration *c) {
    int exponent = common_exponent(query);
    c->kind = kind;
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) c->offset[i][k] = coordinate_offset(pool, query, i, k, exponent);
    }
    for (int k = 0; k < 3; k++) {
        c->area[1][k] = cross_component(pool, c->offset[2], c->offset[3], k);
        c->area[2][k] = cross_component(pool, c->offset[1], c->offset[3], k);
        c->area[3][k] = cross_component(pool, c->offset[1], c->offset[2], k);
        uint32_t mark = pool->used;
        polynomial sum = polynomial_subtract(pool, &c->area[1][k], &c->area[2][k]);
        c->area[0][k] = polynomial_add(pool, &sum, &c->area[3][k]);
        polynomial_keep(pool, mark, &c->area[0][k]);
    }
    c->volume = volume_of(pool, c);
}

/* Returns W, the sum of w_i over the first feature. */
static polynomial radon_sum(integer_pool *pool, const configuration *c, int k) {
    if (c->kind == CSCD_CONTACT_VF) return c->area[0][k];
    return polynomial_subtract(pool, &c->area[0][k], &c->area[1][k]);
}

static bool weights_agree(integer_pool *pool, const configuration *c, const algebraic *root, int k, int sum) {
    for (int i = 0; i < 4; i++) {
        int expected = (i < points_of_first(c->kind)) == (i % 2 == 0) ? sum : -sum;
        if (algebraic_sign(pool, root, &c->area[i][k]) * expected < 0) return false;
    }
    return true;
}

/* Does a point lie on the segment between two others? `other` is the fourth point. */
static bool on_segment(integer_pool *pool, const configuration *c, const algebraic *root, int point, int from,
                       int to, int other) {
    for (int k = 0; k < 3; k++) {
        if (algebraic_sign(pool, root, &c->area[other][k]) != 0) return false;
    }
    for (int k = 0; k < 3; k++) {
        uint32_t mark = pool->used;
        polynomial after = polynomial_subtract(pool, &c->offset[point][k], &c->offset[from][k]);
        polynomial before = polynomial_subtract(pool, &c->offset[to][k], &c->offset[point][k]);
        int beyond = algebraic_sign(pool, root, &after) * algebraic_sign(pool, root, &before);
        pool->used = mark;
        if (beyond < 0) return false;
    }
    return true;
}

static bool collapsed_touch(integer_pool *pool, const configuration *c, const algebraic *root) {
    static const int vf[3][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}};
    static const int ee[4][4] = {{0, 2, 3, 1}, {1, 2, 3, 0}, {2, 0, 1, 3}, {3, 0, 1, 2}};
    int count = c->kind == CSCD_CONTACT_VF ? 3 : 4;
    for (int i = 0; i < count; i++) {
        const int *p = c->kind == CSCD_CONTACT_VF ? vf[i] : ee[i];
        if (on_segment(pool, c, root, p[0], p[1], p[2], p[3])) return true;
    }
    return false;
}

/* Do the features touch at a time at which the points are coplanar? */
static bool touch_at(integer_pool *pool, const configuration *c, const algebraic *root) {
    for (int k = 0; k < 3; k++) {
        uint32_t mark = pool->used;
        polynomial w = radon_sum(pool, c, k);
        int sum = algebraic_sign(pool, root, &w);
        pool->used = mark;
        if (sum != 0) return weights_agree(pool, c, root, k, sum);
    }
    return collapsed_touch(pool, c, root);
}

/* The cell of the first touch that was found so far, or 2 if there is none. */
typedef struct touch_search {
    integer_pool *pool;
    const configuration *configuration;
    double toi;
} touch_search;

/* Tries one time. Its cell becomes that of the first touch if the features touch then and no touch so far is
 * in an earlier one. */
static void try_root(touch_search *s, algebraic *root) {
    if (!algebraic_locate(s->pool, root)) return;
    if (root->cell < s->toi && touch_at(s->pool, s->configuration, root)) s->toi = root->cell;
}

static void try_roots(touch_search *s, const polynomial *p) {
    algebraic roots[3];
    uint32_t mark = s->pool->used;
    if (polynomial_sign_on_interval(s->pool, p) == 0) {
        int count = algebraic_roots(s->pool, p, roots);
        for (int i = 0; i < count; i++) try_root(s, &roots[i]);
    }
    s->pool->used = mark;
}

/* For points that are coplanar all the time: tries every time at which one of the signs may change. */
static void try_coplanar(touch_search *s) {
    const configuration *c = s->configuration;
    polynomial start = polynomial_linear((integer){0}, integer_from_int(s->pool, 1));
    try_roots(s, &start);
    for (int i = 0; i < 4 && s->toi > 0.0; i++) {
        for (int k = 0; k < 3; k++) try_roots(s, &c->area[i][k]);
    }
    for (int k = 0; k < 3 && s->toi > 0.0; k++) {
        uint32_t mark = s->pool->used;
        polynomial sum = radon_sum(s->pool, c, k);
        try_roots(s, &sum);
        s->pool->used = mark;
        int first = points_of_first(c->kind);
        for (int i = 0; i < first; i++) {
            for (int j = first; j < 4; j++) {
                polynomial between = polynomial_subtract(s->pool, &c->offset[i][k], &c->offset[j][k]);
                try_roots(s, &between);
                s->pool->used = mark;
            }
        }
    }
}

bool exact_touch_in(integer_pool *pool, const elementary_query *query, cscd_contact_kind kind, double *toi) {
    configuration c;
    integer_pool_start(pool);
    find_configuration(pool, query, kind, &c);
    touch_search s = {pool, &c, 2.0};
    if (c.volume.degree >= 0)
        try_roots(&s, &c.volume);
    else
        try_coplanar(&s);
    if (s.toi > 1.0) return false;
    *toi = s.toi;
    return true;
}

bool exact_touch(const elementary_query *query, cscd_contact_kind kind, double *toi) {
    integer_pool pool;
    return exact_touch_in(&pool, query, kind, toi);
}
