/* The piece of an intersection curve that lies in two triangles, under a symbolic perturbation of the vertices, and where its
 * ends are: docs/theory/curves.md, whose lemmas are cited here. */
#include "runtime/intersections/named_surface.h"

#include "src/core/integer.h"

#include <math.h>
#include <string.h>

/* ---- two triangles ------------------------------------------------------------------------------------- */

/* A triangle of the pair, with its corners as points and by their numbers. */
typedef struct pair_corners {
    uint32_t triangle, vertices[3];
    symbolic_point points[3];
} pair_corners;

static bool load_corners(const named_surface *s, uint32_t triangle, pair_corners *out) {
    out->triangle = triangle;
    for (int i = 0; i < 3; i++) {
        out->vertices[i] = s->mesh->triangles[triangle][i];
        out->points[i] = surface_point(s, out->vertices[i]);
    }
    const symbolic_point *p = out->points;
    return p[0].name != p[1].name && p[1].name != p[2].name && p[2].name != p[0].name;
}

/* Returns the direction in which the edge (p, q) passes through the triangle: 1 towards the side of its
 * normal, -1 the other way, 0 not at all. from and to are the sides on which p and q lie. */
static int ends_pass(symbolic_point p, symbolic_point q, int from, int to, const pair_corners *face) {
    const symbolic_point *f = face->points;
    if (from == to) return 0;
    int turn = symbolic_orient3d(p, q, f[0], f[1]);
    if (symbolic_orient3d(p, q, f[1], f[2]) != turn || symbolic_orient3d(p, q, f[2], f[0]) != turn) return 0;
    return to;
}

/* The same of edge i of another triangle. */
static int edge_passes(const pair_corners *t, int i, int from, int to, const pair_corners *face) {
    return ends_pass(t->points[i], t->points[(i + 1) % 3], from, to, face);
}

/* Lemma 2: an edge of a that passes towards the normal of b begins the piece, one of b towards that of a ends it. */
static void set_end(const named_surface *s, const pair_corners *t, int i, const pair_corners *face, int end,
                    curve_piece *piece) {
    piece->ends[end] = (surface_piercing){s->mesh->triangle_edges[t->triangle][i], face->triangle};
}

static void find_sides(const pair_corners *t, const pair_corners *face, int sides[3]) {
    const symbolic_point *f = face->points;
    for (int i = 0; i < 3; i++) sides[i] = symbolic_orient3d(f[0], f[1], f[2], t->points[i]);
}

static bool all_on_one_side(const int sides[3]) {
    return sides[0] == sides[1] && sides[1] == sides[2];
}

/* Looks for ends on the edges of one of the triangles; towards is 0 for a and 1 for b. Returns their number. */
static int find_ends(const named_surface *s, const pair_corners *t, const int sides[3],
                     const pair_corners *face, int towards, curve_piece *piece) {
    int found = 0;
    for (int i = 0; i < 3; i++) {
        int passes = edge_passes(t, i, sides[i], sides[(i + 1) % 3], face);
        if (passes == 0) continue;
        set_end(s, t, i, face, passes > 0 ? towards : 1 - towards, piece);
        found++;
    }
    return found;
}

static bool piece_of_strangers(const named_surface *s, const pair_corners *a, const pair_corners *b,
                               curve_piece *piece) {
    int sides_a[3], sides_b[3];
    find_sides(a, b, sides_a);
    if (all_on_one_side(sides_a)) return false;
    find_sides(b, a, sides_b);
    if (all_on_one_side(sides_b)) return false;
    return find_ends(s, a, sides_a, b, 0, piece) + find_ends(s, b, sides_b, a, 1, piece) == 2;
}

/* The edge opposite to a corner, against the other triangle, with which it has no vertex in common. */
static int pass_of_opposite(const pair_corners *t, int corner, const pair_corners *face) {
    const symbolic_point *f = face->points;
    int i = (corner + 1) % 3, j = (corner + 2) % 3;
    int from = symbolic_orient3d(f[0], f[1], f[2], t->points[i]);
    int to = symbolic_orient3d(f[0], f[1], f[2], t->points[j]);
    return edge_passes(t, i, from, to, face);
}

/* Lemma 3: corner i of a is corner j of b. */
static bool piece_at_vertex(const named_surface *s, const pair_corners *a, int i, const pair_corners *b,
                            int j, curve_piece *piece) {
    piece->ends[0] = piece->ends[1] = (surface_piercing){NO_EDGE, a->vertices[i]};
    int of_a = pass_of_opposite(a, i, b), of_b = of_a != 0 ? 0 : pass_of_opposite(b, j, a);
    if (of_a != 0) set_end(s, a, (i + 1) % 3, b, of_a > 0 ? 0 : 1, piece);
    if (of_b != 0) set_end(s, b, (j + 1) % 3, a, of_b > 0 ? 1 : 0, piece);
    return of_a != 0 || of_b != 0;
}

bool curve_piece_of_pair(const named_surface *s, uint32_t a, uint32_t b, curve_piece *out) {
    pair_corners of_a, of_b;
    int shared = 0, at_a = 0, at_b = 0;
    if (!load_corners(s, a, &of_a) || !load_corners(s, b, &of_b)) return false;
    for (int i = 0; i < 9; i++) {
        if (of_a.points[i / 3].name != of_b.points[i % 3].name) continue;
        at_a = i / 3;
        at_b = i % 3;
        shared++;
    }
    out->a = a;
    out->b = b;
    if (shared == 0) return piece_of_strangers(s, &of_a, &of_b, out);
    return shared == 1 && piece_at_vertex(s, &of_a, at_a, &of_b, at_b, out);
}

/* ---- one piercing -------------------------------------------------------------------------------------- */

/* Does the edge have a triangle whose corners are different vertices? Others have no pieces. */
static bool edge_has_sheet(const named_surface *s, uint32_t edge) {
    const cscd_mesh *mesh = s->mesh;
    pair_corners corners;
    for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++) {
        if (load_corners(s, mesh->edge_stars[i], &corners)) return true;
    }
    return false;
}

bool surface_piercing_happens(const named_surface *s, surface_piercing piercing) {
    pair_corners face;
    if (!load_corners(s, piercing.triangle, &face) || !edge_has_sheet(s, piercing.edge)) return false;
    const symbolic_point *f = face.points;
    const uint32_t *vertices = s->mesh->edges[piercing.edge];
    symbolic_point p = surface_point(s, vertices[0]), q = surface_point(s, vertices[1]);
    for (int i = 0; i < 3; i++) {
        if (f[i].name == p.name || f[i].name == q.name) return false;
    }
    int from = symbolic_orient3d(f[0], f[1], f[2], p), to = symbolic_orient3d(f[0], f[1], f[2], q);
    return ends_pass(p, q, from, to, &face) != 0;
}

/* ---- where a piercing is, by doubles ------------------------------------------------------------------- */

/* Numbers are sums of two doubles, high + low, with |low| at most half a unit in the last place of high. Sums
 * and products of such numbers are off by less than 2^-100 of the sum of what they add, or of the product
 * (Joldes, Muller and Popescu 2017: at most 2^-103 for these), and each value comes with a bound of its
 * error, in which all roundings of the bound itself are a share of 2^-50. Coordinates are 0 or below 2^150,
 * and weights above 2^-500, so nothing overflows, and underflow loses less than 2^-560 of a result. */

static const double largest_coordinate = 0x1p150, least_weight = 0x1p-500, lost = 0x1p-560;

typedef struct pair_sum {
    double high, low;
} pair_sum;

static inline pair_sum sum_exactly(double a, double b) {
    double sum = a + b, of_b = sum - a;
    return (pair_sum){sum, (a - (sum - of_b)) + (b - of_b)};
}

/* |a| >= |b| or a = 0. */
static inline pair_sum sum_ordered(double a, double b) {
    double sum = a + b;
    return (pair_sum){sum, b - (sum - a)};
}

static inline pair_sum multiply_exactly(double a, double b) {
    double product = a * b, big_a = 0x1.0000002p27 * a, big_b = 0x1.0000002p27 * b;
    double a_high = big_a - (big_a - a), b_high = big_b - (big_b - b);
    double a_low = a - a_high, b_low = b - b_high;
    double error = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
    return (pair_sum){product, error};
}

static inline pair_sum pair_add(pair_sum a, pair_sum b) {
    pair_sum high = sum_exactly(a.high, b.high);
    return sum_ordered(high.high, high.low + (a.low + b.low));
}

static inline pair_sum pair_negate(pair_sum a) {
    return (pair_sum){-a.high, -a.low};
}

static inline pair_sum pair_multiply(pair_sum a, pair_sum b) {
    pair_sum high = multiply_exactly(a.high, b.high);
    return sum_ordered(high.high, high.low + (a.high * b.low + a.low * b.high));
}

static inline pair_sum pair_scale(pair_sum a, double by) {
    pair_sum high = multiply_exactly(a.high, by);
    return sum_ordered(high.high, high.low + a.low * by);
}

/* inverse: 1 / b.high, rounded. The first product leaves less than 2^-50 of the quotient; it is off by 3 *
 * 2^-103 of it, and the second product by 5 * 2^-53 of itself, so that both are off by less than 2^-99 of the
 * quotient. */
static inline pair_sum pair_divide(pair_sum a, pair_sum b, double inverse) {
    double first = a.high * inverse;
    pair_sum rest = pair_add(a, pair_negate(pair_scale(b, first)));
    return sum_ordered(first, rest.high * inverse);
}

/* A value that is not negative, and what it may be off by. */
typedef struct bounded_sum {
    pair_sum value;
    double error;
} bounded_sum;

/* The plane of three points, the first of which is a. */
typedef struct weight_plane {
    const double *a;
    pair_sum normal[3];
    double sizes[3];
} weight_plane;

/* Each coordinate of the normal is off by 3 * 2^-100 of the sum of its two products, its size. */
static weight_plane plane_of_points(const double *a, const double *b, const double *c) {
    weight_plane plane = {.a = a};
    pair_sum u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = sum_exactly(b[k], -a[k]);
        v[k] = sum_exactly(c[k], -a[k]);
    }
    for (int k = 0; k < 3; k++) {
        int x = (k + 1) % 3, y = (k + 2) % 3;
        pair_sum left = pair_multiply(u[x], v[y]), right = pair_multiply(u[y], v[x]);
        plane.normal[k] = pair_add(left, pair_negate(right));
        plane.sizes[k] = fabs(left.high) + fabs(right.high);
    }
    return plane;
}

/* The magnitude of the volume of a plane's points and another one. It is off by 10 * 2^-100 of the sum of its six products.
 * False: it may be 0. */
static bool find_weight(const weight_plane *plane, const double *d, bounded_sum *out) {
    pair_sum sum = {0.0, 0.0};
    double size = 0.0;
    for (int k = 0; k < 3; k++) {
        pair_sum w = sum_exactly(d[k], -plane->a[k]);
        sum = pair_add(sum, pair_multiply(plane->normal[k], w));
        size += plane->sizes[k] * fabs(w.high);
    }
    *out = (bounded_sum){sum.high < 0.0 ? pair_negate(sum) : sum, 0x1p-95 * size};
    return out->value.high > 16.0 * out->error && out->value.high > least_weight;
}

static bounded_sum add_weights(bounded_sum a, bounded_sum b) {
    pair_sum sum = pair_add(a.value, b.value);
    return (bounded_sum){sum, 2.0 * (a.error + b.error) + 0x1p-98 * sum.high};
}

/* A sum of weights, by which numbers are divided. */
typedef struct divisor {
    bounded_sum sum;
    double inverse;
} divisor;

/* Rounds the quotient of a number, which may be off by error, and a sum of weights. False: it is not certain how. */
static bool round_quotient(pair_sum above, double error, const divisor *below, double *out) {
    pair_sum q = pair_divide(above, below->sum.value, below->inverse);
    double size = fabs(q.high);
    double bound = 2.0 * (error + size * below->sum.error) * below->inverse + 0x1p-96 * size + lost;
    *out = q.high + (q.low + bound);
    return *out == q.high + (q.low - bound);
}

static bool round_coordinate(const bounded_sum weights[2], const divisor *sum, double from, double to,
                             double *out) {
    *out = from + 0.0; /* 0 has no sign */
    if (from == to) return true;
    pair_sum first = pair_scale(weights[0].value, from);
    pair_sum second = pair_scale(weights[1].value, to);
    double error = 2.0 * (weights[0].error * fabs(from) + weights[1].error * fabs(to)) +
                   0x1p-97 * (fabs(first.high) + fabs(second.high));
    return round_quotient(pair_add(first, second), error, sum, out);
}

/* The weights of the triangle's corners add up to what those of the edge's ends add up to: the magnitude of the product of
 * the edge and the triangle's normal. So that of the first corner is not needed, and may be 0. */
bool rounded_point_find(const double *const p[5], piercing_point *out) {
    bounded_sum ends[2], corners[2]; /* of the second and the third corner */
    for (int i = 0; i < 15; i++) {
        if (!(fabs(p[i / 3][i % 3]) < largest_coordinate)) return false;
    }
    weight_plane triangle = plane_of_points(p[2], p[3], p[4]), edge = plane_of_points(p[0], p[1], p[2]);
    if (!find_weight(&triangle, p[1], &ends[0]) || !find_weight(&triangle, p[0], &ends[1]) ||
        !find_weight(&edge, p[4], &corners[0]) || !find_weight(&edge, p[3], &corners[1]))
        return false;
    divisor below = {.sum = add_weights(ends[0], ends[1])};
    below.inverse = 1.0 / below.sum.value.high;
    if (!round_quotient(ends[1].value, ends[1].error, &below, &out->s)) return false;
    for (int k = 0; k < 3; k++) {
        if (!round_coordinate(ends, &below, p[0][k], p[1][k], &out->x[k])) return false;
    }
    return round_quotient(corners[0].value, corners[0].error, &below, &out->u) &&
           round_quotient(corners[1].value, corners[1].error, &below, &out->v);
}

/* ---- where a piercing is, by integers ------------------------------------------------------------------ */

/* Lemma 4: ratios of determinants are ratios of their coefficients where these belong to one power of epsilon, and 0 where
 * not. */

enum { EDGE_POINTS = 2, ALL_POINTS = 5 };

/* The edge's points, then the triangle's; coordinates are multiples of 2^unit. */
typedef struct piercing_corners {
    symbolic_point points[ALL_POINTS];
    integer x[ALL_POINTS][3];
    int unit;
} piercing_corners;

static void load_piercing(const named_surface *s, surface_piercing piercing, integer_pool *pool,
                          piercing_corners *out) {
    const uint32_t *edge = s->mesh->edges[piercing.edge], *triangle = s->mesh->triangles[piercing.triangle];
    for (int i = 0; i < ALL_POINTS; i++)
        out->points[i] = surface_point(s, i < EDGE_POINTS ? edge[i] : triangle[i - EDGE_POINTS]);
    out->unit = INT32_MAX;
    for (int i = 0; i < 3 * ALL_POINTS; i++) {
        double x = out->points[i / 3].x[i % 3];
        if (x != 0.0 && integer_lowest_bit(x) < out->unit) out->unit = integer_lowest_bit(x);
    }
    if (out->unit == INT32_MAX) out->unit = 0; /* all points are the origin */
    for (int i = 0; i < 3 * ALL_POINTS; i++)
        out->x[i / 3][i % 3] = integer_from_double(pool, out->points[i / 3].x[i % 3], out->unit);
}

static integer minor_of_two(integer_pool *pool, const integer u[3], const integer v[3], int x, int y) {
    return integer_subtract(pool, integer_multiply(pool, u[x], v[y]), integer_multiply(pool, u[y], v[x]));
}

/* The magnitude of a term's coefficient. corners: the four points of its determinant. */
static integer find_coefficient(integer_pool *pool, const piercing_corners *c, const uint8_t corners[4],
                                const symbolic_term *term) {
    symbolic_minor m = symbolic_minor_of(term);
    int n = m.point_count - 1;
    integer rows[3][3], value = integer_from_int(pool, 1);
    for (int i = 0; i < n; i++) {
        const integer *from = c->x[corners[m.points[0]]], *to = c->x[corners[m.points[i + 1]]];
        for (int k = 0; k < n; k++) rows[i][k] = integer_subtract(pool, to[m.columns[k]], from[m.columns[k]]);
    }
    if (n == 1) value = rows[0][0];
    if (n == 2) value = minor_of_two(pool, rows[0], rows[1], 0, 1);
    for (int k = 0; n == 3 && k < 3; k++) {
        integer part = integer_multiply(pool, rows[2][k],
                                        minor_of_two(pool, rows[0], rows[1], (k + 1) % 3, (k + 2) % 3));
        value = k == 0 ? part : integer_add(pool, value, part);
    }
    return integer_sign(value) < 0 ? integer_negate(value) : value;
}

/* Finds the ratio to which determinants of one sign go: the coefficients of those with the largest power, and 0 for the
 * others. Each determinant is that of four of the corners. */
static void find_weights(integer_pool *pool, const piercing_corners *c, const uint8_t (*corners)[4],
                         int count, integer *weights) {
    symbolic_term terms[3];
    symbolic_point points[3][4];
    int largest = 0;
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < 4; j++) points[i][j] = c->points[corners[i][j]];
        terms[i] = symbolic_orient3d_term(points[i]);
        if (symbolic_compare_terms(&terms[i], points[i], &terms[largest], points[largest]) < 0) largest = i;
    }
    for (int i = 0; i < count; i++) {
        bool counts = symbolic_compare_terms(&terms[i], points[i], &terms[largest], points[largest]) == 0;
        weights[i] = counts ? find_coefficient(pool, c, corners[i], &terms[i]) : integer_from_int(pool, 0);
    }
}

void piercing_point_find_exactly(const named_surface *s, surface_piercing piercing, piercing_point *out) {
    static const uint8_t OF_ENDS[2][4] = {{2, 3, 4, 1}, {2, 3, 4, 0}};
    static const uint8_t OF_CORNERS[3][4] = {{0, 1, 3, 4}, {0, 1, 4, 2}, {0, 1, 2, 3}};
    integer_pool pool;
    piercing_corners c;
    integer ends[2], corners[3];
    *out = (piercing_point){0};
    if (piercing.edge == NO_EDGE) {
        memcpy(out->x, s->positions + (size_t)piercing.triangle * 3, sizeof out->x);
        return;
    }
    integer_pool_start(&pool);
    load_piercing(s, piercing, &pool, &c);
    find_weights(&pool, &c, OF_ENDS, 2, ends);
    integer sum = integer_add(&pool, ends[0], ends[1]);
    out->s = integer_nearest_quotient(&pool, ends[1], sum, 0);
    for (int k = 0; k < 3; k++) {
        integer x = integer_add(&pool, integer_multiply(&pool, ends[0], c.x[0][k]),
                                integer_multiply(&pool, ends[1], c.x[1][k]));
        out->x[k] = integer_nearest_quotient(&pool, x, sum, c.unit);
    }
    find_weights(&pool, &c, OF_CORNERS, 3, corners);
    sum = integer_add(&pool, integer_add(&pool, corners[0], corners[1]), corners[2]);
    out->u = integer_nearest_quotient(&pool, corners[1], sum, 0);
    out->v = integer_nearest_quotient(&pool, corners[2], sum, 0);
}

void piercing_point_find(const named_surface *s, surface_piercing piercing, piercing_point *out) {
    const double *points[ALL_POINTS];
    if (piercing.edge != NO_EDGE) {
        const uint32_t *edge = s->mesh->edges[piercing.edge],
                       *triangle = s->mesh->triangles[piercing.triangle];
        for (int i = 0; i < ALL_POINTS; i++)
            points[i] = surface_point(s, i < EDGE_POINTS ? edge[i] : triangle[i - EDGE_POINTS]).x;
        if (rounded_point_find(points, out)) return;
    }
    piercing_point_find_exactly(s, piercing, out);
}
