/* The nearest point of an outer surface, and points that are near, which are found faster. */
#include "runtime/depths/near_surface.h"

#include "runtime/ccd/closest.h"
#include "src/core/vec3.h"
#include "src/mesh/surface.h"

#include <float.h>
#include <math.h>

static void scale_point(const outer_surface *o, const double x[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = x[k] * o->scale;
}

/* ---- one triangle ---------------------------------------------------------------------------------------- */

/* The squared distance from a + u ab + v ac, where ax leads from a to the point. */
static double squared_from(const double ax[3], const double ab[3], const double ac[3], double u, double v) {
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const double offset = ax[k] - u * ab[k] - v * ac[k];
        sum += offset * offset;
    }
    return sum;
}

enum { SIDE_AB = 1, SIDE_BC = 2, SIDE_CA = 4, ALL_SIDES = 7 };

static double share_of_side(double along, double squared) {
    return along <= 0.0 ? 0.0 : along >= squared ? 1.0 : along / squared;
}

/* What is known of a point of a triangle that is near to x. */
typedef struct reach_point {
    int sides;        /* which it lies on */
    bool well_shaped; /* the triangle is not thin */
    double size;      /* the sum of two squared sides */
} reach_point;

/* In a thin triangle rounding chooses, so all three sides are asked. */
static double squared_thin(const double ax[3], const double ab[3], const double ac[3], double inside) {
    const double bb = vec3_dot(ab, ab), cc = vec3_dot(ac, ac), bc = vec3_dot(ab, ac);
    const double xb = vec3_dot(ax, ab), xc = vec3_dot(ax, ac);
    const double s = share_of_side(xb, bb), t = share_of_side(xc, cc);
    const double r = share_of_side(xc - xb - bc + bb, bb - bc - bc + cc);
    const double sides =
        min_of(squared_from(ax, ab, ac, s, 0.0),
               min_of(squared_from(ax, ab, ac, 0.0, t), squared_from(ax, ab, ac, 1.0 - r, r)));
    return min_of(inside, sides);
}

/* Shares of a triangle's squared size. Rounding moves u and v by more than what points within thin bodies are deep: squared
 * distances below the first are computed with care, or no cell of such a body would ever be bounded. Those below the second are
 * of points on the triangle, as most corners of cells are, and good enough. */
#define REACH_NEAR 0x1p-40
#define REACH_ON   0x1p-90

/* The squared distance from a point of the triangle: the nearest one, but for rounding. (Ericson, Real-Time Collision
 * Detection, 5.1.5.) Whatever rounding makes of u and v, they lie in the triangle, so the nearest point is no farther; how much
 * nearer it may be in thin triangles, nobody knows. */
static double squared_reach(const double x[3], const double p[3][3], reach_point *at) {
    double ab[3], ac[3], ax[3], u, v;
    vec3_subtract(p[1], p[0], ab);
    vec3_subtract(p[2], p[0], ac);
    vec3_subtract(x, p[0], ax);
    const double bb = vec3_dot(ab, ab), cc = vec3_dot(ac, ac), bc = vec3_dot(ab, ac);
    const double xb = vec3_dot(ax, ab), xc = vec3_dot(ax, ac), yb = xb - bb, yc = xc - bc, zb = xb - bc,
                 zc = xc - cc;
    const double area = bb * cc - bc * bc, in_u = cc * xb - bc * xc, in_v = bb * xc - bc * xb;
    at->well_shaped = area > 0x1p-20 * bb * cc;
    at->size = bb + cc;
    if (xb <= 0.0 && xc <= 0.0) {
        at->sides = SIDE_AB | SIDE_CA;
        u = v = 0.0;
    } else if (yb >= 0.0 && yc <= yb) {
        at->sides = SIDE_AB | SIDE_BC;
        u = 1.0, v = 0.0;
    } else if (zc >= 0.0 && zb <= zc) {
        at->sides = SIDE_BC | SIDE_CA;
        u = 0.0, v = 1.0;
    } else if (in_v <= 0.0 && xb >= 0.0 && yb <= 0.0) {
        at->sides = SIDE_AB;
        u = share_of_side(xb, bb), v = 0.0;
    } else if (in_u <= 0.0 && xc >= 0.0 && zc <= 0.0) {
        at->sides = SIDE_CA;
        u = 0.0, v = share_of_side(xc, cc);
    } else if (in_u + in_v >= area) {
        at->sides = SIDE_BC;
        v = share_of_side(yc - yb, (yc - yb) + (zb - zc)), u = 1.0 - v;
    } else {
        at->sides = 0;
        u = in_u / area, v = in_v / area;
    }
    double squared = squared_from(ax, ab, ac, u, v);
    if (!at->well_shaped) squared = squared_thin(ax, ab, ac, squared);
    if (squared >= REACH_NEAR * at->size || squared <= REACH_ON * at->size) return squared;
    return min_of(squared, closest_point_triangle(x, p[0], p[1], p[2], &u, &v));
}

/* ---- the nearest point ----------------------------------------------------------------------------------- */

typedef struct nearest_search {
    const outer_surface *outer;
    const surface_cuts *found;
    uint32_t body;
    double x[3]; /* scaled, as all that is found */
    outer_point best;
} nearest_search;

/* Is the box further away than what was found? Computed distances from points of a triangle are off by less than 2^-47 of
 * the sum of the distance and the triangle's size, which the margins cover, so that nothing is left out that would be
 * nearer as computed. If a box is far, so is each that lies in it. */
static bool box_is_far(const nearest_search *s, const outer_box *box) {
    double squared = 0.0, size = 0.0;
    for (int k = 0; k < 3; k++) {
        double low = box->low[k], high = box->high[k];
        double gap = low > s->x[k] ? low - s->x[k] : s->x[k] > high ? s->x[k] - high : 0.0;
        squared += gap * gap;
        size += (high - low) * (high - low);
    }
    return squared * (1.0 - 0x1p-20) > s->best.squared + 0x1p-70 * size;
}

/* Is a part that is not thin farther away than what was found? The sine of the angle between ab and ac is above 2^-10, so the
 * point of which the distance is taken is off by less than 2^-30 of the distance from a corner; and as the squared distance
 * changes by the square of that around the nearest point, the margins cover it. */
static bool part_is_far(const nearest_search *s, const double corners[3][3]) {
    reach_point at;
    const double squared = squared_reach(s->x, corners, &at);
    return at.well_shaped && squared * (1.0 - 0x1p-20) > s->best.squared + 0x1p-40 * at.size;
}

/* Of several parts at the same distance, that of the first triangle is the answer, whatever the trees' order is. */
static void try_part(nearest_search *s, uint32_t triangle, const outer_part *part) {
    double u, v;
    const double(*p)[3] = part->corners;
    double squared = closest_point_triangle(s->x, p[0], p[1], p[2], &u, &v);
    if (!(squared < s->best.squared || (squared == s->best.squared && triangle < s->best.triangle))) return;
    s->best.squared = squared;
    s->best.triangle = triangle;
    s->best.part = *part;
    for (int k = 0; k < 3; k++) s->best.x[k] = p[0][k] + u * (p[1][k] - p[0][k]) + v * (p[2][k] - p[0][k]);
}

/* The first part from i on that is in a run which is not far, or has begun before i; end: none. */
static size_t skip_far_runs(const nearest_search *s, size_t i, size_t end) {
    while (i < end && i % OUTER_RUN == 0 && box_is_far(s, &s->outer->run_boxes[i / OUTER_RUN]))
        i += OUTER_RUN;
    return i < end ? i : end;
}

static void try_parts(nearest_search *s, uint32_t triangle, size_t cut) {
    const outer_surface *o = s->outer;
    const size_t end = o->part_begins[cut + 1];
    if (o->part_begins[cut] == end || box_is_far(s, &o->boxes[cut])) return;
    for (size_t i = o->part_begins[cut]; (i = skip_far_runs(s, i, end)) < end; i++) {
        if (!box_is_far(s, &o->part_boxes[i]) && !part_is_far(s, o->parts[i].corners))
            try_part(s, triangle, &o->parts[i]);
    }
}

static void try_triangle(void *data, uint32_t triangle) {
    nearest_search *s = data;
    const named_surface *surface = s->found->surface;
    uint32_t place = s->outer->places[triangle];
    if (place == OUTER_NOWHERE) return;
    if (surface_body(surface, triangle) != s->body) return;
    outer_part whole;
    outer_surface_whole(s->outer, s->found, triangle, &whole);
    if (part_is_far(s, whole.corners)) return;
    if (place == OUTER_AS_A_WHOLE)
        try_part(s, triangle, &whole);
    else
        try_parts(s, triangle, place);
}

/* A squared distance that is a little more than that of a part, so that the part itself is found, and all others at the same
 * distance. */
static double squared_beyond(const double x[3], const outer_part *part) {
    const double(*p)[3] = part->corners;
    double u, v, size = vec3_squared_distance(p[0], p[1]) + vec3_squared_distance(p[0], p[2]);
    double squared = closest_point_triangle(x, p[0], p[1], p[2], &u, &v);
    return squared * (1.0 + 0x1p-20) + 0x1p-70 * size + DBL_MIN;
}

outer_point outer_surface_nearest(const outer_surface *o, const surface_cuts *found, const bvh *f,
                                  uint32_t body, const double x[3], const outer_point *near) {
    nearest_search s = {
        .outer = o, .found = found, .body = body, .best = {.squared = (double)INFINITY, UINT32_MAX}};
    const surface_bodies *bodies = found->surface->bodies;
    const near_quest quest = {object_of_body(bodies, body), body, bodies != NULL ? bodies->components : NULL};
    scale_point(o, x, s.x);
    if (near != NULL && near->triangle != UINT32_MAX) s.best.squared = squared_beyond(s.x, &near->part);
    bvh_visit_near(f, &quest, x, &s.best.squared, try_triangle, &s);
    for (int k = 0; k < 3; k++) s.best.x[k] /= o->scale;
    return s.best;
}

/* ---- points that are near ------------------------------------------------------------------------------ */

double outer_part_reach(const outer_surface *o, const double x[3], const outer_part *part) {
    double scaled[3];
    reach_point at;
    scale_point(o, x, scaled);
    return sqrt(squared_reach(scaled, part->corners, &at));
}

double outer_part_reach_of_all(const outer_surface *o, const double *const x[3], const outer_part *part,
                               double enough) {
    double greatest = 0.0;
    for (int i = 0; i < 3 && greatest < enough; i++)
        greatest = max_of(greatest, outer_part_reach(o, x[i], part));
    return greatest;
}

static double squared_gap(const double x[3], const outer_box *box) {
    double squared = 0.0;
    for (int k = 0; k < 3; k++) {
        const double below = box->low[k] - x[k], above = x[k] - box->high[k];
        const double gap = below > above ? below : above;
        squared += gap > 0.0 ? gap * gap : 0.0;
    }
    return squared;
}

/* A part of a triangle is no nearer than all of it, whose squared distance is given. Is one as near? */
static bool reach_parts(nearest_search *s, uint32_t triangle, double squared, size_t cut) {
    const outer_surface *o = s->outer;
    reach_point at;
    const size_t end = o->part_begins[cut + 1];
    for (size_t i = o->part_begins[cut]; (i = skip_far_runs(s, i, end)) < end; i++) {
        if (squared_gap(s->x, &o->part_boxes[i]) >= s->best.squared) continue;
        const double here = squared_reach(s->x, o->parts[i].corners, &at);
        if (!(here < s->best.squared)) continue;
        s->best.squared = here;
        s->best.triangle = triangle;
        s->best.part = o->parts[i];
        if (here <= squared * (1.0 + 0x1p-20)) return true;
    }
    return false;
}

/* Returns over which sides of the triangle there may be something nearer. */
static int reach_triangle(nearest_search *s, uint32_t triangle) {
    const uint32_t place = s->outer->places[triangle];
    outer_part whole;
    reach_point at;
    if (place == OUTER_NOWHERE) return ALL_SIDES;
    outer_surface_whole(s->outer, s->found, triangle, &whole);
    const double squared = squared_reach(s->x, whole.corners, &at);
    if (!(squared < s->best.squared)) return 0;
    if (place != OUTER_AS_A_WHOLE) return reach_parts(s, triangle, squared, place) ? at.sides : ALL_SIDES;
    s->best.squared = squared;
    s->best.triangle = triangle;
    s->best.part = whole;
    return at.sides;
}

/* The same for those beside it. */
static int reach_neighbours(nearest_search *s, uint32_t triangle, int sides, uint32_t before) {
    const cscd_mesh *mesh = s->found->surface->mesh;
    int next = 0;
    for (int side = 0; side < 3; side++) {
        if ((sides >> side & 1) == 0) continue;
        const uint32_t edge = mesh->triangle_edges[triangle][side];
        for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++) {
            const uint32_t other = mesh->edge_stars[i];
            if (other == triangle || other == before) continue;
            const int there = reach_triangle(s, other);
            if (s->best.triangle == other) next = there;
        }
    }
    return next;
}

static nearest_search begin_near(const outer_surface *o, const surface_cuts *found, const double x[3]) {
    nearest_search s = {
        .outer = o, .found = found, .best = {.squared = (double)INFINITY, .triangle = UINT32_MAX}};
    scale_point(o, x, s.x);
    return s;
}

outer_point outer_surface_near_on(const outer_surface *o, const surface_cuts *found, uint32_t triangle,
                                  const double x[3]) {
    nearest_search s = begin_near(o, found, x);
    reach_triangle(&s, triangle);
    return s.best;
}

enum { STEPS_MAX = 16 };

static outer_point walk_near(const outer_surface *o, const surface_cuts *found, uint32_t triangle,
                             const double x[3], double enough) {
    nearest_search s = begin_near(o, found, x);
    int sides = reach_triangle(&s, triangle);
    uint32_t at = triangle, before = UINT32_MAX;
    for (int step = 0; step < STEPS_MAX && s.best.squared > enough; step++) {
        sides = reach_neighbours(&s, at, sides, before);
        if (s.best.triangle == at || s.best.triangle == UINT32_MAX) break;
        before = at;
        at = s.best.triangle;
    }
    return s.best;
}

outer_point outer_surface_near(const outer_surface *o, const surface_cuts *found, uint32_t triangle,
                               const double x[3], double enough) {
    const double scaled = enough * o->scale;
    return walk_near(o, found, triangle, x, enough >= 0.0 ? scaled * scaled : -1.0);
}

outer_point outer_surface_search(const outer_surface *o, const surface_cuts *found, const bvh *f,
                                 uint32_t body, const double x[3], const outer_point *near, double enough) {
    outer_point begin = {.squared = (double)INFINITY, .triangle = UINT32_MAX};
    if (near != NULL && near->triangle != UINT32_MAX) begin = walk_near(o, found, near->triangle, x, -1.0);
    if (sqrt(begin.squared) <= enough) return begin;
    return outer_surface_nearest(o, found, f, body, x, &begin);
}
