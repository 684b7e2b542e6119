/* How deep the points of whole triangles may be: docs/theory/curves.md, Lemma 9. */
#include "runtime/intersections/depth_bounds.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <string.h>

/* ---- one triangle --------------------------------------------------------------------------------------- */

/* A point of a triangle, and for each of the triangle's corners: its depth + the distance from it. */
typedef struct bound_point {
    double x[3], reach[3];
} bound_point;

typedef struct bound_cell {
    bound_point corners[3];
    double above; /* no point of the cell is deeper */
    int level;
} bound_cell;

typedef struct bound_search {
    double corners[3][3], depths[3]; /* from the first corner as origin */
    double deepest;                  /* of all points that cells have as corners */
    double slack;                    /* a cell that promises no more than this above it is not divided */
} bound_search;

/* 48 halvings of the longest side leave a cell 2^24 times smaller. */
enum { LEVELS_MAX = 48, CELLS_MAX = 4000 };

static bound_point reach_point(bound_search *s, const double x[3]) {
    bound_point p;
    memcpy(p.x, x, sizeof p.x);
    for (int i = 0; i < 3; i++) {
        double way[3];
        vec3_subtract(x, s->corners[i], way);
        p.reach[i] = s->depths[i] + surface_norm(way);
    }
    s->deepest = fmax(s->deepest, fmin(p.reach[0], fmin(p.reach[1], p.reach[2])));
    return p;
}

static double greatest_of(double a, double b, double c) {
    return fmax(a, fmax(b, c));
}

/* The distance from a corner is convex, and so is the mean of two, so in a cell they are greatest at one of its corners. The
 * least of two is no more than their mean, which changes little where one grows as the other falls. */
static double bound_above(const bound_cell *c) {
    const double *p = c->corners[0].reach, *q = c->corners[1].reach, *r = c->corners[2].reach;
    double least = (double)INFINITY;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        least = fmin(least, greatest_of(p[i], q[i], r[i]));
        least = fmin(least, 0.5 * greatest_of(p[i] + p[j], q[i] + q[j], r[i] + r[j]));
    }
    return least;
}

/* The side from this corner to the next is the longest. */
static int longest_side(const bound_cell *c) {
    int longest = 0;
    double most = -1.0;
    for (int i = 0; i < 3; i++) {
        double squared = vec3_squared_distance(c->corners[i].x, c->corners[(i + 1) % 3].x);
        if (squared <= most) continue;
        most = squared;
        longest = i;
    }
    return longest;
}

static void divide_cell(bound_search *s, const bound_cell *c, bound_cell halves[2]) {
    int i = longest_side(c), j = (i + 1) % 3;
    double x[3];
    for (int k = 0; k < 3; k++) x[k] = 0.5 * (c->corners[i].x[k] + c->corners[j].x[k]);
    bound_point middle = reach_point(s, x);
    halves[0] = halves[1] = *c;
    halves[0].corners[j] = halves[1].corners[i] = middle;
    for (int h = 0; h < 2; h++) {
        halves[h].level++;
        halves[h].above = fmin(c->above, bound_above(&halves[h]));
    }
}

/* The one that promises more comes first. */
static double search_cells(bound_search *s, const bound_cell *whole) {
    bound_cell waiting[LEVELS_MAX + 2];
    double bound = s->deepest;
    int count = 0, divided = 0;
    waiting[count++] = *whole;
    while (count > 0) {
        bound_cell cell = waiting[--count];
        bool divide = cell.level < LEVELS_MAX && cell.above > s->deepest + s->slack && divided < CELLS_MAX;
        if (!divide) {
            bound = fmax(bound, cell.above);
            continue;
        }
        divided++;
        divide_cell(s, &cell, &waiting[count]);
        if (waiting[count].above > waiting[count + 1].above) {
            cell = waiting[count];
            waiting[count] = waiting[count + 1];
            waiting[count + 1] = cell;
        }
        count += 2;
    }
    return bound;
}

/* Rounding, in units of 2^-53: corners less the first one 1 of the sides; midpoints 1 in each of 48 halvings, and a cell's
 * points are that far from their places; a norm 5, a sum 1. So 64 times the greatest reach, and the sides, are enough. The
 * corners' depths are those from points that are rounded themselves, by no more than 8 of the greatest coordinate and 8 of
 * the depth. */
double triangle_depth_bound(const double *const corners[3], const double depths[3]) {
    bound_search s = {.deepest = 0.0};
    bound_cell whole = {.level = 0};
    double size = 0.0, coordinate = 0.0;
    for (int i = 0; i < 3; i++) {
        vec3_subtract(corners[i], corners[0], s.corners[i]);
        s.depths[i] = depths[i];
        for (int k = 0; k < 3; k++) coordinate = fmax(coordinate, fabs(corners[i][k]));
        size = fmax(size, surface_norm(s.corners[i]));
    }
    s.slack = 1e-6 * size;
    for (int i = 0; i < 3; i++) whole.corners[i] = reach_point(&s, s.corners[i]);
    whole.above = bound_above(&whole);
    double bound = search_cells(&s, &whole);
    return bound + 0x1p-46 * (bound + 2.0 * size) + 0x1p-49 * coordinate;
}

/* ---- which triangles ------------------------------------------------------------------------------------- */

typedef struct bound_work {
    depth_bounder *bounder;
    const surface_cuts *found;
    const cscd_depths *depths;
    size_t key_count, item_count;
} bound_work;

static array_list list_of_keys(depth_bounder *b, size_t count) {
    return (array_list){{ARRAY(b->keys, count), ARRAY(b->spare_keys, count)}};
}

static array_list list_of_items(depth_bounder *b, size_t count) {
    return (array_list){{ARRAY(b->items, count)}};
}

void depth_bounder_free(depth_bounder *b) {
    if (b->context == NULL) return;
    cscd_context *context = b->context;
    context_free_all(context, list_of_keys(b, 0));
    context_free_all(context, list_of_items(b, 0));
    *b = (depth_bounder){.context = context};
}

static void add_key(bound_work *work, uint32_t triangle, uint32_t object) {
    work->bounder->keys[work->key_count++] = (uint64_t)triangle << 32 | object;
}

static size_t count_keys(const bound_work *work) {
    const cscd_mesh *mesh = work->found->surface->mesh;
    size_t count = 2 * work->found->curves->piece_count;
    for (size_t i = 0; i < work->depths->vertex_count; i++) {
        uint32_t vertex = work->depths->items[i].vertex;
        count += mesh->vertex_star_offsets[vertex + 1] - mesh->vertex_star_offsets[vertex];
    }
    return count;
}

/* A curve with an open component leads into nothing. */
static void add_cut(bound_work *work, uint32_t triangle, uint32_t other) {
    const cscd_mesh *mesh = work->found->surface->mesh;
    if (mesh->components[mesh->triangle_components[other]].closed_manifold)
        add_key(work, triangle, cscd_mesh_vertex_object(mesh, mesh->triangles[other][0]));
}

static void list_keys(bound_work *work) {
    const cscd_mesh *mesh = work->found->surface->mesh;
    const curve_joiner *curves = work->found->curves;
    for (size_t i = 0; i < work->depths->vertex_count; i++) {
        const cscd_depth *at = &work->depths->items[i];
        uint32_t end = mesh->vertex_star_offsets[at->vertex + 1];
        for (uint32_t k = mesh->vertex_star_offsets[at->vertex]; k < end; k++)
            add_key(work, mesh->vertex_stars[k], at->object);
    }
    for (size_t i = 0; i < curves->piece_count; i++) {
        add_cut(work, curves->found[i].a, curves->found[i].b);
        add_cut(work, curves->found[i].b, curves->found[i].a);
    }
}

static void sort_keys(bound_work *work) {
    uint64_t *keys = work->bounder->keys;
    sort_by_number(keys, work->bounder->spare_keys, work->key_count, sizeof *keys);
    for (size_t i = 0; i < work->key_count; i++) {
        if (i == 0 || keys[i] != keys[i - 1]) keys[work->item_count++] = keys[i];
    }
}

/* ---- all of them ----------------------------------------------------------------------------------------- */

/* 0, unless the object contains the vertex. */
static double depth_of_vertex(const cscd_depths *depths, uint32_t vertex, uint32_t object) {
    size_t first = 0, end = depths->vertex_count;
    while (first < end) {
        size_t middle = first + (end - first) / 2;
        const cscd_depth *at = &depths->items[middle];
        if (at->vertex < vertex || (at->vertex == vertex && at->object < object))
            first = middle + 1;
        else
            end = middle;
    }
    if (first == depths->vertex_count) return 0.0;
    const cscd_depth *at = &depths->items[first];
    return at->vertex == vertex && at->object == object ? at->depth : 0.0;
}

enum { BOUNDS_A_TASK = 64 };

static void bound_some(void *data, uint32_t task) {
    const bound_work *work = data;
    const named_surface *s = work->found->surface;
    size_t first = (size_t)task * BOUNDS_A_TASK, end = first + BOUNDS_A_TASK;
    for (size_t i = first; i < end && i < work->item_count; i++) {
        uint32_t triangle = (uint32_t)(work->bounder->keys[i] >> 32);
        uint32_t object = (uint32_t)work->bounder->keys[i];
        const double *corners[3];
        double depths[3];
        for (uint32_t k = 0; k < 3; k++) {
            corners[k] = surface_corner(s->mesh, s->positions, triangle, k);
            depths[k] = depth_of_vertex(work->depths, s->mesh->triangles[triangle][k], object);
        }
        work->bounder->items[i] =
            (cscd_triangle_depth){triangle, object, triangle_depth_bound(corners, depths)};
    }
}

cscd_status depth_bounder_run(depth_bounder *b, const surface_cuts *found, cscd_depths *depths) {
    bound_work work = {.bounder = b, .found = found, .depths = depths};
    size_t keys = count_keys(&work);
    if (!context_renew_all(b->context, list_of_keys(b, room_with_spare(keys)), &b->key_capacity, keys))
        return CSCD_OUT_OF_MEMORY;
    list_keys(&work);
    sort_keys(&work);
    if (!context_renew_all(b->context, list_of_items(b, room_with_spare(work.item_count)), &b->item_capacity,
                           work.item_count))
        return CSCD_OUT_OF_MEMORY;
    parallel_run(b->context->threads, (uint32_t)((work.item_count + BOUNDS_A_TASK - 1) / BOUNDS_A_TASK),
                 bound_some, &work);
    depths->triangles = b->items;
    depths->triangle_count = work.item_count;
    return context_progress_status(b->context);
}
