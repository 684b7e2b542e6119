/* Contour tests: whether the projection of a patch's contour stays a simple closed curve, by sweeps, and whether it stays
 * star-shaped. */
#include "runtime/baselines/patches.h"
#include "src/core/vec3.h"

#include <float.h>
#include <math.h>

/* ---- the plane --------------------------------------------------------------------------------------------- */

/* The plane across the axis, and how far computed coordinates may be from those of the exact projection. Its
 * origin moves with a vertex, because a motion that all vertices share does not bring them together. */
typedef struct plane {
    double origin[2][3], right[3], up[3];
    double error;
} plane;

/* right and up are perpendicular to the axis up to rounding: the exact projection, along right x up, is along
 * an axis that is off by 1e-14 or so, which normal_cone_limit allows for. */
static inline plane plane_across(const float axis[3], const double *start, const double *end) {
    plane p = {.error = 0.0};
    double direction[3], helper[3] = {0.0, 0.0, 0.0}, least = INFINITY, length = 0.0;
    int smallest = 0;
    for (int k = 0; k < 3; k++) {
        direction[k] = (double)axis[k];
        p.origin[0][k] = start[k];
        p.origin[1][k] = end[k];
        if (fabs(direction[k]) < least) {
            least = fabs(direction[k]);
            smallest = k;
        }
    }
    helper[smallest] = 1.0;
    vec3_cross(direction, helper, p.right);
    for (int k = 0; k < 3; k++) length += p.right[k] * p.right[k];
    for (int k = 0; k < 3; k++) p.right[k] /= sqrt(length);
    vec3_cross(direction, p.right, p.up);
    return p;
}

/* A projected coordinate is a sum of three products of differences, so it is off by less than 8 u times their sum. */
static inline void plane_project(plane *p, const double *x, int time, double out[2]) {
    double size = 0.0, from[3];
    for (int k = 0; k < 3; k++) {
        from[k] = x[k] - p->origin[time][k];
        size += fabs(from[k]);
    }
    out[0] = p->right[0] * from[0] + p->right[1] * from[1] + p->right[2] * from[2];
    out[1] = p->up[0] * from[0] + p->up[1] * from[1] + p->up[2] * from[2];
    p->error = max_of(p->error, 8.0 * DBL_EPSILON * size);
}

static inline double plane_cross(const double a[2], const double b[2]) {
    return a[0] * b[1] - a[1] * b[0];
}

/* The error of a coefficient of a product of two such differences. With eps the error of a coordinate, each
 * factor is off by 2 eps (and by rounding, 2^-52 of it, which is less), so each of two terms by 4 eps L + 4
 * eps^2; halving the interval up to eight times adds 16 u L^2, which is less than 4 eps L. */
static inline double plane_product_error(const plane *p, double length) {
    return 24.0 * p->error * length + 16.0 * p->error * p->error;
}

/* ---- sweeps ------------------------------------------------------------------------------------------------ */

/* Planar edges touch when an end of one comes to lie on the other (four planar vertex-edge tests), or when they cross from the
 * start. */

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

/* ---- stars ------------------------------------------------------------------------------------------------- */

/* Seen from the middle of a contour every edge goes forward at every moment, and all of them go around once: then the
 * projection is simple. Where the contour turns inwards, triangles that need not be of the mesh fill it up before. */

/* A linear motion in the plane: [time][axis]. */
typedef struct planar_motion {
    double at[2][2];
} planar_motion;

static planar_motion motion_of(const star_vertex *v) {
    return (planar_motion){{{v->at[0][0], v->at[0][1]}, {v->at[1][0], v->at[1][1]}}};
}

static planar_motion motion_between(const star_vertex *from, const star_vertex *to) {
    return (planar_motion){{{to->at[0][0] - from->at[0][0], to->at[0][1] - from->at[0][1]},
                            {to->at[1][0] - from->at[1][0], to->at[1][1] - from->at[1][1]}}};
}

/* Is the cross product of two motions positive at every moment? It is quadratic, and grows with each Bernstein coefficient, so
 * these may be lower bounds. Divided by (1 - t)^2 it is b0 + 2 b1 s + b2 s^2, with s from 0 to infinity (docs/theory/iccd.md,
 * lemma 1): positive exactly if b0, b2 > 0 and b1 > -sqrt(b0 b2), of which the product of roots is off by 3 times 2^-53. */
static bool stays_positive(const planar_motion *a, const planar_motion *b, double error) {
    const double b0 = plane_cross(a->at[0], b->at[0]) - error, b2 = plane_cross(a->at[1], b->at[1]) - error;
    if (!(b0 > 0.0 && b2 > 0.0)) return false;
    const double b1 = 0.5 * (plane_cross(a->at[0], b->at[1]) + plane_cross(a->at[1], b->at[0])) - error;
    return b1 >= 0.0 || -b1 < sqrt(b0) * sqrt(b2) * (1.0 - 0x1p-50);
}

/* The plane through the mean of a loop's vertices, which moves with them. Whatever doubles come out, they are its middle. */
static plane plane_of_loop(const contour_query *query) {
    double sums[2][3] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    for (uint32_t i = 0; i < query->edge_count; i++) {
        const size_t first = (size_t)query->loop[i] * 3;
        for (int k = 0; k < 3; k++) {
            sums[0][k] += query->x0[first + (size_t)k];
            sums[1][k] += query->x1[first + (size_t)k];
        }
    }
    for (int k = 0; k < 6; k++) sums[k / 3][k % 3] /= query->edge_count;
    return plane_across(query->axis, sums[0], sums[1]);
}

/* Projects the loop. Returns the most that a product of two differences of its coordinates may be off by. */
static double project_loop(const contour_query *query, plane *p, star_vertex *vertices) {
    double largest = 0.0;
    for (uint32_t i = 0; i < query->edge_count; i++) {
        const size_t first = (size_t)query->loop[i] * 3;
        star_vertex *v = &vertices[i];
        plane_project(p, query->x0 + first, 0, v->at[0]);
        plane_project(p, query->x1 + first, 1, v->at[1]);
        v->kept = i;
        for (int k = 0; k < 4; k++) largest = max_of(largest, fabs(v->at[k / 2][k % 2]));
    }
    return plane_product_error(p, 2.0 * largest);
}

static bool edges_go_forward(const star_vertex *vertices, uint32_t count, double error) {
    planar_motion last = motion_of(&vertices[vertices[count - 1].kept]);
    for (uint32_t i = 0; i < count; i++) {
        const planar_motion next = motion_of(&vertices[vertices[i].kept]);
        if (!stays_positive(&last, &next, error)) return false;
        last = next;
    }
    return true;
}

/* Do the edges, which all go forward by less than half a turn, go around once at the start? Then one of them alone
 * comes to the upper side of a line through the middle. False also where rounding leaves a side open. */
static bool goes_around_once(const star_vertex *vertices, uint32_t count, const double line[2],
                             double error) {
    uint32_t turns = 0;
    bool above = plane_cross(line, vertices[vertices[count - 1].kept].at[0]) > 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const double side = plane_cross(line, vertices[vertices[i].kept].at[0]);
        if (!(fabs(side) > error)) return false;
        turns += !above && side > 0.0;
        above = side > 0.0;
    }
    return turns == 1;
}

static bool is_star(const plane *p, const star_vertex *vertices, uint32_t count, double error) {
    /* No vertex of a regular grid lies on these lines. A side is off by less than twice what coordinates are. */
    static const double lines[2][2] = {{0.8191, 0.5736}, {-0.4383, 0.8988}};
    if (!edges_go_forward(vertices, count, error)) return false;
    return goes_around_once(vertices, count, lines[0], 4.0 * p->error) ||
           goes_around_once(vertices, count, lines[1], 4.0 * p->error);
}

/* Twice a position half way, where it is guessed which ears there are. */
static double half_way(const star_vertex *v, int axis) {
    return v->at[0][axis] + v->at[1][axis];
}

static bool turns_inwards(const star_vertex *a, const star_vertex *b, const star_vertex *c) {
    const double to[2] = {half_way(b, 0) - half_way(a, 0), half_way(b, 1) - half_way(a, 1)};
    const double on[2] = {half_way(c, 0) - half_way(b, 0), half_way(c, 1) - half_way(b, 1)};
    return plane_cross(to, on) < 0.0;
}

static uint32_t farthest_vertex(const star_vertex *vertices, uint32_t count) {
    uint32_t found = 0;
    double most = -1.0;
    for (uint32_t i = 0; i < count; i++) {
        const double x = half_way(&vertices[i], 0), y = half_way(&vertices[i], 1);
        if (x * x + y * y <= most) continue;
        most = x * x + y * y;
        found = i;
    }
    return found;
}

/* Does the triangle c, b, a keep its orientation? Then it can be glued to the edges a b and b c. */
static bool is_ear(const star_vertex *a, const star_vertex *b, const star_vertex *c, double error) {
    const planar_motion to_b = motion_between(c, b), to_a = motion_between(c, a);
    return stays_positive(&to_b, &to_a, error);
}

/* Graham's scan from a vertex of the convex hull: cuts off vertices at which the contour turns inwards, by ears that hold during the
 * whole interval. Returns how many vertices are kept. */
static uint32_t cut_ears(star_vertex *vertices, uint32_t count, double error) {
    const uint32_t first = farthest_vertex(vertices, count);
    uint32_t kept = 0;
    for (uint32_t i = 0; i <= count; i++) {
        const uint32_t at = i < count - first ? first + i : first + i - count;
        const star_vertex *c = &vertices[i < count ? at : first];
        while (kept >= 2) {
            const star_vertex *a = &vertices[vertices[kept - 2].kept],
                              *b = &vertices[vertices[kept - 1].kept];
            if (!turns_inwards(a, b, c) || !is_ear(a, b, c, error)) break;
            kept--;
        }
        if (i < count) vertices[kept++].kept = at;
    }
    return kept;
}

bool contour_stays_star(const contour_query *query, star_vertex *vertices) {
    const uint32_t count = query->edge_count;
    if (count <= 4) return true;
    plane p = plane_of_loop(query);
    const double error = project_loop(query, &p, vertices);
    if (is_star(&p, vertices, count, error)) return true;
    const uint32_t kept = cut_ears(vertices, count, error);
    return kept >= 3 && kept < count && is_star(&p, vertices, kept, error);
}

static bool star_passes(const contour_query *query, void *scratch) {
    return contour_stays_star(query, scratch);
}

const contour_test star_test = {
    .by_loops = true,
    .leaf_height = 3,
    .scratch_size = sizeof(star_vertex),
    .passes = star_passes,
};
