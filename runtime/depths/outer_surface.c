/* The outer surfaces of bodies: what they do not bury in themselves, its point that is nearest to another one, points that are
 * near, which are found faster, and whether a point lies on a surface, exactly. */
#include "runtime/depths/outer_surface.h"

#include "runtime/ccd/ccd.h"
#include "src/core/vec3.h"
#include "src/mesh/predicates.h"
#include "src/mesh/surface.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- the outer surface --------------------------------------------------------------------------------- */

static array_list list_of_cuts(outer_surface *o, size_t count) {
    return (array_list){
        {ARRAY(o->cut_triangles, count), ARRAY(o->part_begins, count + 1), ARRAY(o->boxes, count)}};
}

static array_list list_of_places(outer_surface *o, size_t count) {
    return (array_list){{ARRAY(o->places, count)}};
}

void outer_surface_free(outer_surface *o) {
    if (o->context == NULL) return;
    triangle_cuts_free(&o->cuts);
    context_free_all(o->context, list_of_cuts(o, 0));
    context_free_all(o->context, list_of_places(o, 0));
    context_free(o->context, o->parts);
    context_free(o->context, o->part_boxes);
    context_free(o->context, o->run_boxes);
    *o = (outer_surface){.context = o->context, .cuts = {.context = o->context}};
}

/* A triangle whose parts are taken. */
typedef struct part_taker {
    outer_surface *outer;
    const loaded_cut *cut;
    cut_lift lift;
    cut_part open_part; /* a part that may go on upwards */
    bool is_open, out_of_memory;
} part_taker;

static outer_box box_of_part(const outer_part *part) {
    const double(*p)[3] = part->corners;
    outer_box box;
    for (int k = 0; k < 3; k++) {
        double low = p[0][k] < p[1][k] ? p[0][k] : p[1][k], high = p[0][k] < p[1][k] ? p[1][k] : p[0][k];
        box.low[k] = p[2][k] < low ? p[2][k] : low;
        box.high[k] = p[2][k] > high ? p[2][k] : high;
    }
    return box;
}

static outer_box empty_box(void) {
    const double most = (double)INFINITY;
    return (outer_box){{most, most, most}, {-most, -most, -most}};
}

static void box_parts(outer_box *box, const outer_box *parts, size_t count) {
    *box = empty_box();
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            box->low[k] = min_of(box->low[k], parts[i].low[k]);
            box->high[k] = max_of(box->high[k], parts[i].high[k]);
        }
    }
}

static bool add_part(outer_surface *o, const outer_part *part) {
    if (!memory_budget_take(o->budget, 1, MEMORY_WHILE_DOUBLING * (sizeof *part + sizeof *o->part_boxes)))
        return false;
    if (o->part_count == o->part_capacity) {
        size_t larger = o->part_capacity == 0 ? 64 : 2 * o->part_capacity;
        outer_part *parts = context_grow(o->context, o->parts, o->part_count, larger, sizeof *parts);
        if (parts != NULL) o->parts = parts;
        outer_box *boxes = context_grow(o->context, o->part_boxes, o->part_count, larger, sizeof *boxes);
        if (boxes != NULL) o->part_boxes = boxes;
        if (parts == NULL || boxes == NULL) return false;
        o->part_capacity = larger;
    }
    o->part_boxes[o->part_count] = box_of_part(part);
    o->parts[o->part_count++] = *part;
    return true;
}

static void scale_point(const outer_surface *o, const double x[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = x[k] * o->scale;
}

/* Adds the two triangles of the open trapezoid. */
static void add_open(part_taker *taker) {
    outer_part halves[2];
    if (!taker->is_open) return;
    taker->is_open = false;
    cut_lift_part(&taker->lift, &taker->open_part, halves[0].corners, halves[1].corners);
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) scale_point(taker->outer, halves[i].corners[k], halves[i].corners[k]);
        taker->out_of_memory |= !add_part(taker->outer, &halves[i]);
    }
}

static bool goes_on(const cut_part *below, const cut_part *part) {
    return below->x[0] == part->x[0] && below->x[1] == part->x[1] && below->high[0] == part->low[0] &&
           below->high[1] == part->low[1];
}

/* Parts of one slab come from below; those that are outer are put together. */
static void take_part(void *data, const cut_part *part) {
    part_taker *taker = data;
    if (part->numbers[0] >= 1 || taker->out_of_memory) return;
    if (taker->is_open && goes_on(&taker->open_part, part)) {
        memcpy(taker->open_part.high, part->high, sizeof part->high);
        return;
    }
    add_open(taker);
    taker->open_part = *part;
    taker->is_open = true;
}

/* Keeps what changes the own number. Says whether a line is left. */
static bool keep_own_cuts(cut_triangle *cut) {
    size_t lines = 0, borders = 0;
    for (size_t i = 0; i < cut->line_count; i++) {
        if (cut->lines[i].slot == 0) cut->lines[lines++] = cut->lines[i];
    }
    for (size_t i = 0; i < cut->border_count; i++) {
        if (cut->borders[i].slot == 0) cut->borders[borders++] = cut->borders[i];
    }
    cut->line_count = lines;
    cut->border_count = borders;
    return lines > 0;
}

static bool divide_triangle(outer_surface *o, const surface_cuts *found, loaded_cut *cut) {
    part_taker taker = {.outer = o, .cut = cut, .lift = cut_lift_of(found->surface, cut)};
    if (!keep_own_cuts(&cut->cut)) return true;
    o->cut_triangles[o->cut_count] = cut->triangle;
    o->part_begins[o->cut_count++] = o->part_count;
    if (!cut_triangle_divide(o->context, &cut->cut, &o->cuts.memory, take_part, &taker)) return false;
    add_open(&taker);
    size_t first = o->part_begins[o->cut_count - 1];
    box_parts(&o->boxes[o->cut_count - 1], o->part_boxes + first, o->part_count - first);
    return !taker.out_of_memory;
}

/* Triangles of open components are outer nowhere. */
static uint32_t place_uncut(const surface_cuts *found, uint32_t triangle) {
    const cscd_mesh *mesh = found->surface->mesh;
    const patch_finder *p = found->patches;
    uint32_t patch = p->triangle_patches[triangle];
    if (patch == UINT32_MAX) patch = p->corner_patches[(size_t)triangle * 3];
    bool outer =
        mesh->components[mesh->triangle_components[triangle]].closed_manifold && p->patches[patch].own < 1;
    return outer ? OUTER_AS_A_WHOLE : OUTER_NOWHERE;
}

static bool find_places(outer_surface *o, const surface_cuts *found) {
    const cscd_mesh *mesh = found->surface->mesh;
    size_t count = mesh->triangle_count;
    if (!context_renew_all(o->context, list_of_places(o, count), &o->place_capacity, count)) return false;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) o->places[i] = place_uncut(found, i);
    for (size_t i = 0; i < o->cut_count; i++) {
        if (mesh->components[mesh->triangle_components[o->cut_triangles[i]]].closed_manifold)
            o->places[o->cut_triangles[i]] = (uint32_t)i;
    }
    return true;
}

/* Does the triangle's own body cut it? */
static bool cuts_itself(const triangle_cuts *c, const surface_cuts *found, size_t begin, size_t end) {
    for (size_t i = begin; i < end; i++) {
        const curve_piece *piece = &found->curves->found[c->keys[i].end / 2];
        if (surface_body(found->surface, piece->a) == surface_body(found->surface, piece->b)) return true;
    }
    return false;
}

static bool box_runs(outer_surface *o) {
    const size_t count = (o->part_count + OUTER_RUN - 1) / OUTER_RUN;
    const array_list list = {{ARRAY(o->run_boxes, room_with_spare(count))}};
    if (!memory_budget_take_all(o->budget, list)) return false;
    if (!context_renew_all(o->context, list, &o->run_capacity, count)) return false;
    for (size_t i = 0; i < count; i++) {
        const size_t first = i * OUTER_RUN, left = o->part_count - first;
        box_parts(&o->run_boxes[i], o->part_boxes + first, left < OUTER_RUN ? left : OUTER_RUN);
    }
    return true;
}

bool outer_surface_find(outer_surface *o, const surface_cuts *found, const bvh *hierarchy) {
    triangle_cuts *c = &o->cuts;
    o->scale = hierarchy->scale;
    o->budget = found->budget;
    if (!triangle_cuts_sort(c, found)) return false;
    size_t triangles = found->surface->mesh->triangle_count;
    size_t most = c->key_count < triangles ? c->key_count : triangles, room = room_with_spare(most);
    if (!memory_budget_take_all(found->budget, list_of_cuts(o, room))) return false;
    if (!context_renew_all(o->context, list_of_cuts(o, room), &o->cut_capacity, most)) return false;
    o->part_count = o->cut_count = 0;
    for (size_t begin = 0, end = 0; begin < c->key_count; begin = end) {
        loaded_cut cut;
        while (end < c->key_count && c->keys[end].number == c->keys[begin].number) end++;
        if (!cuts_itself(c, found, begin, end)) continue;
        if (!triangle_cuts_load(c, found, begin, end, &cut)) return false;
        if (cut.stretch > 0.0 && !divide_triangle(o, found, &cut)) return false;
    }
    o->part_begins[o->cut_count] = o->part_count;
    return box_runs(o) && find_places(o, found);
}

bool outer_surface_take_work(const outer_surface *o, size_t points) {
    const size_t parts = o->cut_count > 0 ? o->part_count / o->cut_count : 0;
    return memory_budget_work(o->budget, points, 1 + (uint64_t)parts);
}

void outer_surface_whole(const outer_surface *o, const surface_cuts *found, uint32_t triangle,
                         outer_part *out) {
    const named_surface *s = found->surface;
    for (uint32_t i = 0; i < 3; i++)
        scale_point(o, surface_corner(s->mesh, s->positions, triangle, i), out->corners[i]);
}

/* ---- distances ----------------------------------------------------------------------------------------- */

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

/* The place of a point near x in its triangle. */
typedef struct reach_point {
    int sides;        /* which it lies on */
    bool well_shaped; /* the triangle is not thin */
    double size;      /* the sum of two squared sides */
} reach_point;

/* In a thin triangle rounding chooses the side, so all three count. */
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

/* Returns the squared distance from a point of the triangle: up to rounding, the nearest one. (Ericson,
 * Real-Time Collision Detection, 5.1.5.) Rounded u and v still lie in the triangle, so the nearest point is
 * no farther; in thin triangles it may be nearer by an unknown amount. */
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

/* ---- the nearest point --------------------------------------------------------------------------------- */

typedef struct nearest_search {
    const outer_surface *outer;
    const surface_cuts *found;
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

/* If several parts are at the same distance, that of the first triangle is the answer, whatever the trees'
 * order is. */
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
    uint32_t place = s->outer->places[triangle];
    if (place == OUTER_NOWHERE) return;
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

outer_point outer_surface_nearest(const outer_surface *o, const surface_cuts *found, const bvh *hierarchy,
                                  uint32_t body, const double x[3], const outer_point *near) {
    nearest_search s = {.outer = o, .found = found, .best = {.squared = (double)INFINITY, UINT32_MAX}};
    const surface_bodies *bodies = found->surface->bodies;
    const near_quest quest = {object_of_body(bodies, body), body, bodies != NULL ? bodies->components : NULL};
    scale_point(o, x, s.x);
    if (near != NULL && near->triangle != UINT32_MAX) s.best.squared = squared_beyond(s.x, &near->part);
    bvh_visit_near(hierarchy, &quest, x, &s.best.squared, try_triangle, &s);
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

/* The same for its neighbours. */
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

outer_point outer_surface_search(const outer_surface *o, const surface_cuts *found, const bvh *hierarchy,
                                 uint32_t body, const double x[3], const outer_point *near, double enough) {
    outer_point begin = {.squared = (double)INFINITY, .triangle = UINT32_MAX};
    if (near != NULL && near->triangle != UINT32_MAX) begin = walk_near(o, found, near->triangle, x, -1.0);
    if (sqrt(begin.squared) <= enough) return begin;
    return outer_surface_nearest(o, found, hierarchy, body, x, &begin);
}

/* ---- points of it -------------------------------------------------------------------------------------- */

typedef struct body_point_search {
    const named_surface *surface;
    uint32_t body;
    const double *x;
    bool found;
} body_point_search;

/* In every projection the point turns the same way about all sides, or lies on them. */
static bool lies_in_projections(const double *x, const double *const corners[3]) {
    bool flat = true;
    for (int k = 0; k < 3; k++) {
        const int u = (k + 1) % 3, v = (k + 2) % 3;
        bool left = false, right = false;
        for (int i = 0; i < 3; i++) {
            const double *a = corners[i], *b = corners[(i + 1) % 3];
            int turn = orient2d(a[u], a[v], b[u], b[v], x[u], x[v]);
            left |= turn > 0;
            right |= turn < 0;
        }
        if (left && right) return false;
        flat &= !left && !right;
    }
    return !flat || vec3_squared_distance(x, corners[0]) == 0.0;
}

static void look_for_point(void *data, uint32_t triangle) {
    body_point_search *s = data;
    const named_surface *surface = s->surface;
    if (s->found || surface_body(surface, triangle) != s->body) return;
    const double *corners[3];
    for (uint32_t i = 0; i < 3; i++)
        corners[i] = surface_corner(surface->mesh, surface->positions, triangle, i);
    s->found = orient3d(corners[0], corners[1], corners[2], s->x) == 0 && lies_in_projections(s->x, corners);
}

bool body_has_point(const named_surface *s, const bvh *hierarchy, uint32_t body, const double x[3]) {
    body_point_search search = {s, body, x, false};
    const query_box box = {{x[0], x[1], x[2]}, {x[0], x[1], x[2]}};
    bvh_visit_box(hierarchy, &box, true, look_for_point, &search);
    return search.found;
}
