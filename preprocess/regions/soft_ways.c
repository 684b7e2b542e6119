/* Finds the shortest ways through soft material from the points of regions, by relaxation. */
#include "preprocess/regions/soft_ways.h"

#include "preprocess/regions/stiffness.h"
#include "src/mesh/surface.h"

#include <math.h>

enum { NO_SEAT = UINT32_MAX };

typedef struct way_walk {
    const region_scene *scene;
    double *shares, *ways; /* of triangles */
    double *areas;         /* of components */
    bool *soft;            /* of components: something is */
    uint32_t *seats;       /* of regions */
    double *nearest;       /* of regions: the square of the distance from its point to its seat */
    uint32_t *queue;       /* triangles: a ring */
    bool *waiting;         /* in the queue */
} way_walk;

static array_list list_arrays(way_walk *w) {
    const cscd_mesh *mesh = w->scene->mesh;
    const size_t triangles = mesh->triangle_count, components = mesh->component_count,
                 regions = w->scene->region_count;
    return (array_list){{ARRAY(w->shares, triangles), ARRAY(w->areas, components), ARRAY(w->soft, components),
                         ARRAY(w->seats, regions), ARRAY(w->nearest, regions), ARRAY(w->queue, triangles),
                         ARRAY(w->waiting, triangles)}};
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
    const bool joins = !w->waiting[to];
    w->waiting[to] = true;
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
        w->waiting[seat] = true;
        w->queue[queued++] = seat;
    }
    for (; queued > 0; queued--, first = (first + 1) % count) {
        const uint32_t t = w->queue[first];
        w->waiting[t] = false;
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
