/* The star test. Seen from the middle of a contour every edge goes forward at every moment, and all of them go around once: then the
 * projection is simple. Where the contour turns inwards, triangles that need not be of the mesh fill it up before. */
#include "runtime/baselines/iccd/star.h"

#include "runtime/baselines/iccd/contour_plane.h"

#include <math.h>

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
 * these may be lower bounds. Divided by (1 - t)^2 it is b0 + 2 b1 s + b2 s^2, with s from 0 to infinity, whose least value is
 * positive exactly if b0 and b2 are, and b1 is not below -sqrt(b0 b2) (cones.md, lemma 1). */
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
