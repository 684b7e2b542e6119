/* Cuts a component: regions are found on some thousand tiles, and their borders then on finer ones. */
#include "preprocess/regions/body_regions.h"

#include "preprocess/regions/cover.h"
#include "preprocess/regions/region_motion.h"
#include "preprocess/regions/visibility.h"
#include "src/mesh/surface.h"

#include <string.h>

/* Found with the bodies of models/shapes: docs/theory/charge.md. */
static const labelling_prices usual_prices = {.region = 0.008, .border = 0.01};

static cscd_status add_point(body_regions *regions, cscd_context *context, const double point[3]) {
    if (regions->count == regions->capacity) {
        const uint32_t capacity = regions->capacity * 2 + 16;
        double(*points)[3] = context_grow(context, regions->points, regions->count, capacity, sizeof *points);
        if (points == NULL) return context_out_of_memory(context);
        regions->points = points;
        regions->capacity = capacity;
    }
    memcpy(regions->points[regions->count++], point, sizeof regions->points[0]);
    return CSCD_OK;
}

cscd_status body_regions_add_whole(body_regions *regions, const tile_surface *surface, const uint32_t *list,
                                   uint32_t count) {
    double sums[2][3] = {{0.0}}, area = 0.0, point[3]; /* weighted by area, and plain */
    for (uint32_t i = 0; i < count; i++) {
        const double weight = surface_area(surface->mesh, surface->positions, list[i]);
        area += weight;
        for (int k = 0; k < 3; k++) {
            double middle = 0.0;
            for (uint32_t corner = 0; corner < 3; corner++)
                middle += surface_corner(surface->mesh, surface->positions, list[i], corner)[k] / 3.0;
            sums[0][k] += weight * middle;
            sums[1][k] += middle;
        }
        regions->of_triangle[list[i]] = regions->count;
    }
    for (int k = 0; k < 3; k++) point[k] = area > 0.0 ? sums[0][k] / area : sums[1][k] / count;
    return add_point(regions, surface->mesh->context, point);
}

/* ---- a component on its tiles ---------------------------------------------------------------------------- */

typedef struct body_work {
    const tile_surface *surface;
    const body_room *room;
    tile_component component;
    uint32_t tile_count;
    tile_graph g;
    tile_labelling l;
} body_work;

static cscd_status create_labelling(body_work *w) {
    const cscd_status status =
        tiles_create(w->surface, &w->component, w->room->tile_of, w->tile_count, &w->g);
    return status == CSCD_OK ? labelling_create(&w->g, &usual_prices, &w->l) : status;
}

/* Also after a failure. */
static void destroy_labelling(body_work *w) {
    labelling_destroy(&w->l);
    tiles_destroy(&w->g);
}

/* Marks the tiles at the borders of regions, and those beside them. */
static bool mark_borders(body_work *w) {
    const tile_graph *g = &w->g;
    bool *marked = w->room->marked, any = false;
    memset(marked, 0, g->count * sizeof *marked);
    for (uint32_t t = 0; t < g->count; t++) {
        bool at_border = false;
        for (uint32_t j = g->offsets[t]; j < g->offsets[t + 1]; j++)
            at_border |= w->l.of_tile[g->neighbours[j]] != w->l.of_tile[t];
        for (uint32_t j = g->offsets[t]; j < g->offsets[t + 1] && at_border; j++)
            marked[g->neighbours[j]] = true;
        any |= at_border;
    }
    return any;
}

/* Halves the tiles at the borders, and moves the borders. */
static cscd_status refine_borders(body_work *w, body_regions *regions, uint32_t first) {
    const tile_component *c = &w->component;
    const labelled_regions found = w->l.regions;
    for (uint32_t i = 0; i < c->count; i++)
        regions->of_triangle[c->list[i]] = first + w->l.of_tile[w->room->tile_of[c->list[i]]];
    destroy_labelling(w);
    w->tile_count =
        tiles_halve(w->surface, &w->component, w->room->marked, w->room->tile_of, w->room->scratch);
    const cscd_status status = create_labelling(w);
    if (status != CSCD_OK) return status;
    for (uint32_t i = 0; i < c->count; i++)
        w->l.of_tile[w->room->tile_of[c->list[i]]] = regions->of_triangle[c->list[i]] - first;
    w->l.regions = found;
    labelling_touch(&w->l);
    labelling_share_out(&w->l);
    labelling_connect(&w->l);
    return CSCD_OK;
}

static cscd_status place_borders(body_work *w, body_regions *regions, uint32_t first) {
    const tile_component *c = &w->component;
    cscd_status status = CSCD_OK;
    while (status == CSCD_OK && c->side > c->least_side && mark_borders(w))
        status = refine_borders(w, regions, first);
    if (status == CSCD_OK) labelling_move_points(&w->l);
    for (uint32_t i = 0; i < c->count && status == CSCD_OK; i++)
        regions->of_triangle[c->list[i]] = first + w->l.of_tile[w->room->tile_of[c->list[i]]];
    return status;
}

static cscd_status add_points(const body_work *w, body_regions *regions) {
    const tile_component *c = &w->component;
    cscd_status status = CSCD_OK;
    for (uint32_t r = 0; r < w->l.regions.count && status == CSCD_OK; r++) {
        double point[3];
        for (int k = 0; k < 3; k++) point[k] = w->l.regions.points[r].rest[k] / c->scale + c->middle[k];
        status = add_point(regions, w->surface->mesh->context, point);
    }
    return status;
}

/* The area at rest of the triangles that the points of their regions see in one frame. */
static double seen_in_frame(const body_work *w, const region_scene *scene, const double *frame,
                            const double (*points)[3]) {
    double seen = 0.0;
    for (uint32_t i = 0; i < scene->count; i++) {
        const uint32_t t = scene->list[i];
        const double value =
            orientation_value(scene->mesh, frame, t, points[scene->of_triangle[t] - scene->first]);
        if (w->g.turned ? value < 0.0 : value > 0.0) seen += surface_area(scene->mesh, scene->positions, t);
    }
    return seen;
}

/* The sum of what is seen at rest and in all frames. */
static double seen_area(const body_work *w, const body_regions *regions, uint32_t first) {
    const tile_surface *s = w->surface;
    const region_scene scene = {s->mesh,
                                s->positions,
                                w->component.list,
                                w->component.count,
                                regions->of_triangle,
                                first,
                                regions->count - first,
                                (const double(*)[3])regions->points + first};
    region_way ways[REGIONS_MOST + 1];
    double moved[REGIONS_MOST + 1][3], seen = seen_in_frame(w, &scene, s->positions, scene.points);
    for (uint32_t f = 0; f < s->frame_count; f++) {
        region_points_move(&scene, s->frames[f], ways, moved);
        seen += seen_in_frame(w, &scene, s->frames[f], (const double(*)[3])moved);
    }
    return seen;
}

/* Takes the regions back where the centroid of the whole sees as much; where the material is soft in places, only where it sees more. */
static cscd_status keep_better(const body_work *w, body_regions *regions, uint32_t first) {
    const tile_component *c = &w->component;
    const uint32_t count = regions->count - first;
    const double seen = seen_area(w, regions, first);
    for (uint32_t i = 0; i < c->count; i++) w->room->scratch[c->list[i]] = regions->of_triangle[c->list[i]];
    const cscd_status status = body_regions_add_whole(regions, w->surface, c->list, c->count);
    if (status != CSCD_OK) return status;
    const double seen_whole = seen_area(w, regions, first);
    const uint32_t whole = --regions->count;
    if (seen > seen_whole || (seen == seen_whole && (count == 1 || w->g.stiffness != NULL))) {
        for (uint32_t i = 0; i < c->count; i++)
            regions->of_triangle[c->list[i]] = w->room->scratch[c->list[i]];
        return CSCD_OK;
    }
    memcpy(regions->points[first], regions->points[whole], sizeof regions->points[0]);
    for (uint32_t i = 0; i < c->count; i++) regions->of_triangle[c->list[i]] = first;
    regions->count = first + 1;
    return CSCD_OK;
}

static cscd_status find_regions(body_work *w, body_regions *regions) {
    const uint32_t first = regions->count;
    cscd_status status = cover_find(&w->l);
    if (status == CSCD_OK) status = place_borders(w, regions, first);
    if (status == CSCD_OK) status = add_points(w, regions);
    return status == CSCD_OK ? keep_better(w, regions, first) : status;
}

cscd_status body_regions_add(body_regions *regions, const tile_surface *surface, const uint32_t *list,
                             uint32_t count, const body_room *room) {
    enum { TRIANGLES_LEAST = 32 }; /* fewer are not worth a cut */
    body_work w = {.surface = surface, .room = room, .component = tiles_component(surface, list, count)};
    if (count < TRIANGLES_LEAST || !(w.component.area > 0.0))
        return body_regions_add_whole(regions, surface, list, count);
    w.tile_count = tiles_number(surface, &w.component, room->tile_of, room->scratch);
    cscd_status status = create_labelling(&w);
    if (status == CSCD_OK) status = find_regions(&w, regions);
    destroy_labelling(&w);
    return status;
}
