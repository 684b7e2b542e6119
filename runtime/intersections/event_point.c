/* Where an edge passes through a triangle, in the limit of a symbolic perturbation that goes to 0: docs/theory/curves.md,
 * lemma 4. Ratios of determinants are ratios of their coefficients where these belong to one power of epsilon, and 0 where
 * not. */
#include "runtime/intersections/event_point.h"

#include "runtime/ccd/exact/integer.h"
#include "runtime/intersections/rounded_point.h"

#include <string.h>

enum { EDGE_POINTS = 2, ALL_POINTS = 5 };

/* The edge's points, then the triangle's; coordinates are multiples of 2^unit. */
typedef struct event_corners {
    symbolic_point points[ALL_POINTS];
    integer x[ALL_POINTS][3];
    int unit;
} event_corners;

static void load_event(const named_surface *s, surface_event event, integer_pool *pool, event_corners *out) {
    const uint32_t *edge = s->mesh->edges[event.edge], *triangle = s->mesh->triangles[event.triangle];
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
static integer find_coefficient(integer_pool *pool, const event_corners *c, const uint8_t corners[4],
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
static void find_weights(integer_pool *pool, const event_corners *c, const uint8_t (*corners)[4], int count,
                         integer *weights) {
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

void event_point_find_exactly(const named_surface *s, surface_event event, event_point *out) {
    static const uint8_t OF_ENDS[2][4] = {{2, 3, 4, 1}, {2, 3, 4, 0}};
    static const uint8_t OF_CORNERS[3][4] = {{0, 1, 3, 4}, {0, 1, 4, 2}, {0, 1, 2, 3}};
    integer_pool pool;
    event_corners c;
    integer ends[2], corners[3];
    *out = (event_point){0};
    if (event.edge == NO_EDGE) {
        memcpy(out->x, s->positions + (size_t)event.triangle * 3, sizeof out->x);
        return;
    }
    integer_pool_start(&pool);
    load_event(s, event, &pool, &c);
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

void event_point_find(const named_surface *s, surface_event event, event_point *out) {
    const double *points[ALL_POINTS];
    if (event.edge != NO_EDGE) {
        const uint32_t *edge = s->mesh->edges[event.edge], *triangle = s->mesh->triangles[event.triangle];
        for (int i = 0; i < ALL_POINTS; i++)
            points[i] = surface_point(s, i < EDGE_POINTS ? edge[i] : triangle[i - EDGE_POINTS]).x;
        if (rounded_point_find(points, out)) return;
    }
    event_point_find_exactly(s, event, out);
}
