/* The stiffness of the material, and sight that weakens on its way through soft material: over tiles, and
 * over triangles. */
#include "preprocess/regions/tiles.h"

#include "src/core/sort.h"
#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

/* ---- shares of stiffness ------------------------------------------------------------------------------- */

static const double least_share = 1e-6;

typedef struct stiff_triangle {
    uint32_t component, triangle;
    double stiffness, area;
} stiff_triangle;

static int by_stiffness(const void *left, const void *right) {
    const stiff_triangle *x = left, *y = right;
    if (x->component != y->component) return x->component < y->component ? -1 : 1;
    if (x->stiffness != y->stiffness) return x->stiffness < y->stiffness ? -1 : 1;
    return x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

/* The median, by area, of the triangles of a component, which are in order. */
static double find_median(const stiff_triangle *items, uint32_t count) {
    double area = 0.0, below = 0.0;
    for (uint32_t i = 0; i < count; i++) area += items[i].area;
    uint32_t i = 0;
    while (i + 1 < count && (below += items[i].area) < 0.5 * area) i++;
    return items[i].stiffness;
}

/* Finds the shares of the triangles that are in order. */
static void find_shares(const stiff_triangle *items, uint32_t count, double *shares) {
    for (uint32_t first = 0, end; first < count; first = end) {
        end = first + 1;
        while (end < count && items[end].component == items[first].component) end++;
        const double median = find_median(items + first, end - first);
        for (uint32_t i = first; i < end; i++) {
            const float share = (float)fmin(1.0, items[i].stiffness / median);
            shares[items[i].triangle] = fmax((double)share, least_share);
        }
    }
}

cscd_status stiffness_shares(const cscd_mesh *mesh, const double *positions, const double *given,
                             double *shares) {
    const uint32_t count = mesh->triangle_count;
    stiff_triangle *items = context_reserve(mesh->context, 2 * (size_t)count, sizeof *items);
    if (items == NULL) return context_out_of_memory(mesh->context);
    for (uint32_t t = 0; t < count; t++)
        items[t] =
            (stiff_triangle){mesh->triangle_components[t], t, given[t], surface_area(mesh, positions, t)};
    sort_items(items, items + count, count, sizeof *items, by_stiffness);
    find_shares(items, count, shares);
    context_free(mesh->context, items);
    return CSCD_OK;
}

double stiffness_beside(const cscd_mesh *mesh, const double *shares, uint32_t edge) {
    double sum = 0.0;
    for (uint32_t i = mesh->edge_star_offsets[edge]; i < mesh->edge_star_offsets[edge + 1]; i++)
        sum += shares[mesh->edge_stars[i]];
    return sum / edge_star_size(mesh, edge);
}

/* ---- ways over tiles ----------------------------------------------------------------------------------- */

/* The shortest ways are found by relaxation: the result does not depend on the order of the steps. */

enum { NO_SEAT = UINT32_MAX };

static array_list list_of_paths(soft_paths *p) {
    const size_t n = p->g->count;
    return (array_list){{ARRAY(p->steps, p->g->flow.link_count), ARRAY(p->rows, p->row_count * n),
                         ARRAY(p->seats, p->row_count), ARRAY(p->queue, n), ARRAY(p->in_queue, n)}};
}

static double find_step(const tile_graph *g, uint32_t a, uint32_t b) {
    const double *p = g->items[a].centroid, *q = g->items[b].centroid;
    const double d[3] = {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
    return soft_step(g->stiffness[a], g->stiffness[b],
                     sqrt((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / g->area));
}

cscd_status soft_paths_create(const tile_graph *g, uint32_t row_count, soft_paths *out) {
    *out = (soft_paths){.g = g, .row_count = row_count};
    if (g->stiffness == NULL) return CSCD_OK;
    if (!context_reserve_all(g->context, list_of_paths(out))) {
        *out = (soft_paths){0};
        return context_out_of_memory(g->context);
    }
    for (uint32_t t = 0; t < g->count; t++)
        for (uint32_t j = g->offsets[t]; j < g->offsets[t + 1]; j++)
            out->steps[j] = find_step(g, t, g->neighbours[j]);
    for (uint32_t row = 0; row < row_count; row++) out->seats[row] = NO_SEAT;
    memset(out->in_queue, 0, g->count * sizeof *out->in_queue);
    return CSCD_OK;
}

void soft_paths_destroy(soft_paths *p) {
    if (p->g != NULL) context_free_all(p->g->context, list_of_paths(p));
    *p = (soft_paths){0};
}

/* Takes the steps from a tile. Returns the number of tiles that have joined the queue, which begins at first
 * and holds `queued` already. */
static uint32_t relax_links(soft_paths *p, uint32_t t, double *row, uint32_t first, uint32_t queued) {
    const tile_graph *g = p->g;
    uint32_t joined = 0;
    for (uint32_t j = g->offsets[t]; j < g->offsets[t + 1]; j++) {
        const uint32_t other = g->neighbours[j];
        const double way = row[t] + p->steps[j];
        if (way >= row[other]) continue;
        row[other] = way;
        if (p->in_queue[other]) continue;
        p->in_queue[other] = true;
        p->queue[((size_t)first + queued + joined++) % g->count] = other;
    }
    return joined;
}

void soft_paths_set(soft_paths *p, uint32_t row, uint32_t seat) {
    if (p->rows == NULL || p->seats[row] == seat) return;
    const tile_graph *g = p->g;
    double *ways = p->rows + (size_t)row * g->count;
    p->seats[row] = seat;
    for (uint32_t t = 0; t < g->count; t++) ways[t] = BEYOND_BLINDNESS;
    ways[seat] = 0.0;
    p->queue[0] = seat;
    for (uint32_t first = 0, queued = 1; queued > 0; first = (first + 1) % g->count) {
        const uint32_t t = p->queue[first];
        p->in_queue[t] = false;
        queued += relax_links(p, t, ways, first, queued) - 1;
    }
}

double soft_paths_unseen(const soft_paths *p, uint32_t row, const tile_set *set, const sight_point *point) {
    double unseen = 0.0;
    for (uint32_t i = 0; i < set->count && p->rows != NULL; i++) {
        const uint32_t t = set->members[i];
        const double by_sight = tile_blindness(p->g, t, point);
        unseen += p->g->items[t].area * (soft_paths_blindness(p, row, t, by_sight) - by_sight);
    }
    return unseen;
}

/* ---- ways over triangles ------------------------------------------------------------------------------- */

typedef struct way_walk {
    const region_scene *scene;
    double *shares, *ways; /* of triangles */
    double *areas;         /* of components */
    bool *soft;            /* of components: something is */
    uint32_t *seats;       /* of regions */
    double *nearest;       /* of regions: the square of the distance from its point to its seat */
    uint32_t *queue;       /* triangles: a ring */
    bool *in_queue;        /* in the queue */
} way_walk;

static array_list list_arrays(way_walk *w) {
    const cscd_mesh *mesh = w->scene->mesh;
    const size_t triangles = mesh->triangle_count, components = mesh->component_count,
                 regions = w->scene->region_count;
    return (array_list){{ARRAY(w->shares, triangles), ARRAY(w->areas, components), ARRAY(w->soft, components),
                         ARRAY(w->seats, regions), ARRAY(w->nearest, regions), ARRAY(w->queue, triangles),
                         ARRAY(w->in_queue, triangles)}};
}

/* The square of the distance between a point and the centroid of a triangle. */
static double square_distance(const region_scene *s, uint32_t t, const double point[3]) {
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        double way = -point[k];
        for (uint32_t corner = 0; corner < 3; corner++)
            way += surface_corner(s->mesh, s->positions, t, corner)[k] / 3.0;
        sum += way * way;
    }
    return sum;
}

static double step_between(const way_walk *w, uint32_t a, uint32_t b) {
    const region_scene *s = w->scene;
    double middle[3] = {0.0, 0.0, 0.0};
    for (uint32_t corner = 0; corner < 3; corner++)
        for (int k = 0; k < 3; k++) middle[k] += surface_corner(s->mesh, s->positions, b, corner)[k] / 3.0;
    const double area = w->areas[s->mesh->triangle_components[a]];
    return soft_step(w->shares[a], w->shares[b],
                     area > 0.0 ? sqrt(square_distance(s, a, middle) / area) : 0.0);
}

static void find_seats(way_walk *w) {
    const region_scene *s = w->scene;
    for (uint32_t r = 0; r < s->region_count; r++) w->seats[r] = NO_SEAT;
    for (uint32_t t = 0; t < s->count; t++) {
        const uint32_t r = s->of_triangle[t], c = s->mesh->triangle_components[t];
        const double distance = square_distance(s, t, s->points[r]);
        w->areas[c] += surface_area(s->mesh, s->positions, t);
        w->soft[c] |= w->shares[t] < 1.0;
        if (w->seats[r] != NO_SEAT && w->nearest[r] <= distance) continue;
        w->seats[r] = t;
        w->nearest[r] = distance;
    }
}

/* Takes the steps to one neighbour and on: true, it joins the queue. */
static bool relax_step(way_walk *w, uint32_t from, uint32_t to) {
    if (w->scene->of_triangle[to] != w->scene->of_triangle[from]) return false;
    const double way = w->ways[from] + step_between(w, from, to);
    if (way >= w->ways[to]) return false;
    w->ways[to] = way;
    const bool joins = !w->in_queue[to];
    w->in_queue[to] = true;
    return joins;
}

static void walk_from_seats(way_walk *w) {
    const cscd_mesh *mesh = w->scene->mesh;
    const uint32_t count = mesh->triangle_count;
    uint32_t first = 0, queued = 0;
    for (uint32_t t = 0; t < count; t++)
        w->ways[t] = w->soft[mesh->triangle_components[t]] ? BEYOND_BLINDNESS : 0.0;
    for (uint32_t r = 0; r < w->scene->region_count; r++) {
        const uint32_t seat = w->seats[r];
        if (seat == NO_SEAT || w->ways[seat] == 0.0) continue;
        w->ways[seat] = 0.0;
        w->in_queue[seat] = true;
        w->queue[queued++] = seat;
    }
    for (; queued > 0; queued--, first = (first + 1) % count) {
        const uint32_t t = w->queue[first];
        w->in_queue[t] = false;
        for (int i = 0; i < 3; i++) {
            const uint32_t edge = mesh->triangle_edges[t][i];
            for (uint32_t j = mesh->edge_star_offsets[edge]; j < mesh->edge_star_offsets[edge + 1]; j++)
                if (relax_step(w, t, mesh->edge_stars[j]))
                    w->queue[((size_t)first + queued++) % count] = mesh->edge_stars[j];
        }
    }
}

cscd_status soft_ways_find(const region_scene *scene, const double *stiffness, double *ways) {
    cscd_context *context = scene->mesh->context;
    way_walk w = {.scene = scene, .ways = ways};
    if (!context_allocate_all(context, list_arrays(&w))) return context_out_of_memory(context);
    const cscd_status status = stiffness_shares(scene->mesh, scene->positions, stiffness, w.shares);
    if (status == CSCD_OK) {
        find_seats(&w);
        walk_from_seats(&w);
    }
    context_free_all(context, list_arrays(&w));
    return status;
}
