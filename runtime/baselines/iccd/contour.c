/* The continuous contour test. Planar edges touch when an end of one comes to lie on the other (four planar
 * vertex-edge tests), or when they cross from the start. */
#include "runtime/baselines/iccd/contour.h"

#include "runtime/baselines/iccd/contour_plane.h"

#include <math.h>

enum { DEPTH_MAX = 8 };

/* Bernstein coefficients of a quadratic in time. */
typedef struct quadratic {
    double b[3];
} quadratic;

static void set_box(contour_edge *e, double error) {
    for (int k = 0; k < 2; k++) {
        e->low[k] = min_of(min_of(e->a[0][k], e->b[0][k]), min_of(e->a[1][k], e->b[1][k])) - error;
        e->high[k] = max_of(max_of(e->a[0][k], e->b[0][k]), max_of(e->a[1][k], e->b[1][k])) + error;
    }
}

/* Shell sort by the left ends of the boxes. */
static void sort_keys(contour_key *keys, uint32_t count) {
    uint32_t gap = 1;
    while (gap < count / 3) gap = 3 * gap + 1;
    for (; gap > 0; gap /= 3) {
        for (uint32_t i = gap; i < count; i++) {
            contour_key moved = keys[i];
            uint32_t at = i;
            for (; at >= gap && keys[at - gap].low > moved.low; at -= gap) keys[at] = keys[at - gap];
            keys[at] = moved;
        }
    }
}

static double dot_planar(const double a[2], const double b[2]) {
    return a[0] * b[0] + a[1] * b[1];
}

/* Linear motions, [time][axis], of the difference of two points. */
static void subtract_motions(double a[2][2], double b[2][2], double out[2][2]) {
    for (int i = 0; i < 4; i++) out[i / 2][i % 2] = a[i / 2][i % 2] - b[i / 2][i % 2];
}

static quadratic product_of(double a[2][2], double b[2][2], double (*of)(const double *, const double *)) {
    return (quadratic){{of(a[0], b[0]), 0.5 * (of(a[0], b[1]) + of(a[1], b[0])), of(a[1], b[1])}};
}

static double largest_coordinate(double a[2][2]) {
    return max_of(max_of(fabs(a[0][0]), fabs(a[0][1])), max_of(fabs(a[1][0]), fabs(a[1][1])));
}

static bool all_above(const quadratic *q, double bound) {
    return q->b[0] > bound && q->b[1] > bound && q->b[2] > bound;
}

static bool all_below(const quadratic *q, double bound) {
    return q->b[0] < -bound && q->b[1] < -bound && q->b[2] < -bound;
}

static void halve_quadratic(const quadratic *q, quadratic *first, quadratic *second) {
    double left = 0.5 * (q->b[0] + q->b[1]), right = 0.5 * (q->b[1] + q->b[2]);
    *first = (quadratic){{q->b[0], left, 0.5 * (left + right)}};
    *second = (quadratic){{0.5 * (left + right), right, q->b[2]}};
}

/* True if at every moment `area` is not zero or `outside` is positive. Halves the interval where signs do not tell. */
static bool is_excluded(quadratic area, quadratic outside, double error) {
    quadratic areas[DEPTH_MAX + 1], outsides[DEPTH_MAX + 1];
    int depths[DEPTH_MAX + 1], count = 1;
    areas[0] = area;
    outsides[0] = outside;
    depths[0] = 0;
    while (count > 0) {
        count--;
        quadratic a = areas[count], o = outsides[count];
        int depth = depths[count];
        if (all_above(&a, error) || all_below(&a, error) || all_above(&o, error)) continue;
        if (depth == DEPTH_MAX) return false;
        halve_quadratic(&a, &areas[count], &areas[count + 1]);
        halve_quadratic(&o, &outsides[count], &outsides[count + 1]);
        depths[count] = depths[count + 1] = depth + 1;
        count += 2;
    }
    return true;
}

/* True if the vertex never lies on the edge. *start is the side on which it starts, 0 where that is not certain. */
static bool vertex_stays_off(const plane *p, double vertex[2][2], contour_edge *edge, int *start) {
    double along[2][2], from_a[2][2], from_b[2][2];
    subtract_motions(edge->b, edge->a, along);
    subtract_motions(vertex, edge->a, from_a);
    subtract_motions(vertex, edge->b, from_b);
    double error = plane_product_error(
        p, max_of(largest_coordinate(along), max_of(largest_coordinate(from_a), largest_coordinate(from_b))));
    quadratic area = product_of(along, from_a, plane_cross);
    *start = area.b[0] > error ? 1 : area.b[0] < -error ? -1 : 0;
    return is_excluded(area, product_of(from_a, from_b, dot_planar), error);
}

/* Do the boxes of two edges overlap at the start? */
static bool begin_together(const plane *p, contour_edge *e, contour_edge *f) {
    for (int k = 0; k < 2; k++) {
        double gap = max_of(min_of(e->a[0][k], e->b[0][k]) - max_of(f->a[0][k], f->b[0][k]),
                            min_of(f->a[0][k], f->b[0][k]) - max_of(e->a[0][k], e->b[0][k]));
        if (gap > 3.0 * p->error) return false;
    }
    return true;
}

/* Do two planar edges without a common vertex stay apart? Whether they cross changes only when an end of one comes
 * to lie on the other. At the start they do not cross if both ends of one are on the same side of the other. */
static bool stay_apart(const plane *p, contour_edge *e, contour_edge *f, bool published) {
    int sides[4];
    if (!vertex_stays_off(p, e->a, f, &sides[0]) || !vertex_stays_off(p, e->b, f, &sides[1]) ||
        !vertex_stays_off(p, f->a, e, &sides[2]) || !vertex_stays_off(p, f->b, e, &sides[3]))
        return false;
    if (published || !begin_together(p, e, f)) return true;
    return sides[0] * sides[1] > 0 || sides[2] * sides[3] > 0;
}

/* Edges with a common vertex need no test of their own: where they fold onto each other, the other end of the
 * shorter one lies on the longer one, and the edge that begins there has no vertex in common with the longer one. */
bool contour_stays_simple(const contour_query *query, contour_edge *edges, contour_key *keys) {
    const cscd_mesh *mesh = query->mesh;
    uint32_t count = query->edge_count;
    if (count == 0) return true;
    size_t first = (size_t)mesh->edges[query->edges[0]][0] * 3;
    plane p = plane_across(query->axis, query->x0 + first, query->x1 + first);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *v = mesh->edges[query->edges[i]];
        contour_edge *e = &edges[i];
        plane_project(&p, query->x0 + (size_t)v[0] * 3, 0, e->a[0]);
        plane_project(&p, query->x1 + (size_t)v[0] * 3, 1, e->a[1]);
        plane_project(&p, query->x0 + (size_t)v[1] * 3, 0, e->b[0]);
        plane_project(&p, query->x1 + (size_t)v[1] * 3, 1, e->b[1]);
        e->vertices[0] = v[0];
        e->vertices[1] = v[1];
    }
    for (uint32_t i = 0; i < count; i++) {
        set_box(&edges[i], p.error);
        keys[i] = (contour_key){edges[i].low[0], i};
    }
    sort_keys(keys, count);
    for (uint32_t i = 0; i < count; i++) {
        contour_edge *e = &edges[keys[i].edge];
        for (uint32_t j = i + 1; j < count && keys[j].low <= e->high[0]; j++) {
            contour_edge *f = &edges[keys[j].edge];
            if (f->low[1] > e->high[1] || e->low[1] > f->high[1]) continue;
            if (keys[i].edge < query->skipped && keys[j].edge < query->skipped) continue;
            if (edges_share_vertex(e->vertices, f->vertices)) continue;
            if (!stay_apart(&p, e, f, query->published)) return false;
        }
    }
    return true;
}

static bool sweep_passes(const contour_query *query, void *scratch) {
    contour_edge *edges = scratch;
    return contour_stays_simple(query, edges, (contour_key *)(edges + query->edge_count));
}

const contour_test sweep_test = {
    .scratch_size = sizeof(contour_edge) + sizeof(contour_key),
    .passes = sweep_passes,
};
