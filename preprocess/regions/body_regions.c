/* Cuts a component into regions, each of which a point sees: as few as pay, with borders that are short and run where the charge is
 * low. Regions are found on some thousand tiles, and their borders then on finer ones. docs/theory/charge.md explains the rules. */
#include "preprocess/regions/labelling.h"

#include "src/core/vec3.h"
#include "src/mesh/surface.h"

#include <math.h>
#include <string.h>

/* ---- candidates ---------------------------------------------------------------------------------------- */

/* Points in the middle of a body: the centres of balls that touch it from inside (Ma, Bae, Choi 2012). Balls shrink until no tile lies
 * in them. */
typedef struct medial_points {
    uint32_t count;
    sight_point *points;
    uint32_t *tiles; /* that the balls touch */
} medial_points;

enum { POINTS_MOST = 256 };

/* Returns the tile whose centroid is nearest to the point, except one tile. */
static uint32_t nearest_tile(const tile_graph *g, const double point[3], uint32_t except) {
    uint32_t nearest = except;
    double least = INFINITY;
    for (uint32_t i = 0; i < g->count; i++) {
        const double square = vec3_squared_distance(g->items[i].centroid, point);
        if (i == except || square >= least) continue;
        least = square;
        nearest = i;
    }
    return nearest;
}

/* False: the tile has no clear normal. */
static bool shrink_ball(const tile_graph *g, uint32_t seed, double out[3]) {
    enum { SHRINKS_MOST = 20 };
    const tile *p = &g->items[seed];
    const double length =
        sqrt(p->normal[0] * p->normal[0] + p->normal[1] * p->normal[1] + p->normal[2] * p->normal[2]);
    double radius = 1.0;
    if (!(length > 0.5 * p->area)) return false;
    for (int shrink = 0; shrink < SHRINKS_MOST; shrink++) {
        for (int k = 0; k < 3; k++) out[k] = p->centroid[k] - radius * p->normal[k] / length;
        const tile *q = &g->items[nearest_tile(g, out, seed)];
        const double square = vec3_squared_distance(p->centroid, q->centroid);
        double depth = 0.0; /* of q under the plane of p */
        for (int k = 0; k < 3; k++) depth += (p->centroid[k] - q->centroid[k]) * p->normal[k] / length;
        if (!(depth > 0.0) || square >= 2.0 * radius * depth * (1.0 - 1e-3)) return true;
        radius = square / (2.0 * depth);
    }
    return true;
}

/* Lets the point move with the tiles that its ball nearly touches. */
static void follow_tiles(const tile_graph *g, uint32_t seed, sight_point *point) {
    const double reach = 1.5 * 1.5 * vec3_squared_distance(g->items[seed].centroid, point->rest);
    double area = 0.0, ways[FRAMES_MOST][3] = {{0.0}};
    for (uint32_t i = 0; i < g->count && g->frame_count > 0; i++) {
        const tile *t = &g->items[i];
        if (vec3_squared_distance(t->centroid, point->rest) > reach) continue;
        area += t->area;
        for (uint32_t f = 0; f < g->frame_count; f++)
            for (int k = 0; k < 3; k++)
                ways[f][k] += t->area * (g->moved[(size_t)f * g->count + i].centroid[k] - t->centroid[k]);
    }
    for (uint32_t f = 0; f < g->frame_count; f++)
        for (int k = 0; k < 3; k++)
            point->moved[f][k] = point->rest[k] + ways[f][k] / (area > 0.0 ? area : 1.0);
}

static void find_points(const tile_graph *g, const double from[3], double *distances, medial_points *out) {
    for (uint32_t i = 0; i < g->count; i++) distances[i] = vec3_squared_distance(g->items[i].centroid, from);
    for (int round = 0; round < POINTS_MOST; round++) {
        uint32_t farthest = 0;
        for (uint32_t i = 1; i < g->count; i++)
            if (distances[i] > distances[farthest]) farthest = i;
        if (distances[farthest] == 0.0 || !progress_go_on(&g->context->progress, 0.0)) return;
        for (uint32_t i = 0; i < g->count; i++) {
            const double square = vec3_squared_distance(g->items[i].centroid, g->items[farthest].centroid);
            distances[i] = round == 0 ? square : fmin(distances[i], square);
        }
        out->tiles[out->count] = farthest;
        if (!shrink_ball(g, farthest, out->points[out->count].rest)) continue;
        follow_tiles(g, farthest, &out->points[out->count++]);
    }
}

static array_list list_candidates(medial_points *m) {
    return (array_list){{ARRAY(m->points, POINTS_MOST), ARRAY(m->tiles, POINTS_MOST)}};
}

static void free_candidates(const tile_graph *g, medial_points *m) {
    context_free_all(g->context, list_candidates(m));
}

/* The balls touch tiles that are far from each other, beginning with the one farthest from a point; at most 256. */
static cscd_status find_candidates_from(const tile_graph *g, const double from[3], medial_points *out) {
    double *distances = context_reserve(g->context, g->count, sizeof *distances);
    *out = (medial_points){0};
    if (distances == NULL || !context_reserve_all(g->context, list_candidates(out))) {
        context_free(g->context, distances);
        free_candidates(g, out);
        return context_out_of_memory(g->context);
    }
    find_points(g, from, distances, out);
    context_free(g->context, distances);
    return context_progress_status(g->context);
}

/* ---- a cover ------------------------------------------------------------------------------------------- */

/* Points are chosen one by one, tiles are shared out, points move, regions join. */

typedef struct cover_work {
    tile_labelling *l;
    medial_points candidates;
    soft_paths paths;         /* from the tiles that candidates touch, a row for each */
    double *left;             /* of each tile: its blindness from the best point so far */
    uint32_t *queue, *before; /* tiles; their regions before a step */
    bool *reached;
} cover_work;

static array_list list_arrays(cover_work *w) {
    const size_t n = w->l->g->count;
    return (array_list){{ARRAY(w->left, n), ARRAY(w->queue, n), ARRAY(w->before, n), ARRAY(w->reached, n)}};
}

static bool goes_on(const cover_work *w, double share) {
    return progress_go_on(&w->l->g->context->progress, share);
}

/* Finds how much more is seen from a candidate, of what is seen from there without a gap around the tile that it lies under. takes:
 * the new region gets these tiles. */
static double gain_of(cover_work *w, uint32_t candidate, bool takes) {
    const tile_graph *g = w->l->g;
    const sight_point *point = &w->candidates.points[candidate];
    double gain = 0.0;
    uint32_t end = 0;
    memset(w->reached, 0, g->count * sizeof *w->reached);
    w->queue[end++] = w->candidates.tiles[candidate];
    w->reached[w->queue[0]] = true;
    for (uint32_t next = 0; next < end; next++) {
        const uint32_t t = w->queue[next];
        const double blindness = soft_paths_blindness(&w->paths, candidate, t, tile_blindness(g, t, point));
        if (blindness >= 1.0) continue;
        if (blindness < w->left[t]) {
            gain += g->items[t].area * (w->left[t] - blindness);
            if (takes) {
                w->left[t] = blindness;
                labelling_give(w->l, &t, 1, w->l->regions.count - 1);
            }
        }
        for (uint32_t j = g->offsets[t]; j < g->offsets[t + 1]; j++) {
            if (w->reached[g->neighbours[j]]) continue;
            w->reached[g->neighbours[j]] = true;
            w->queue[end++] = g->neighbours[j];
        }
    }
    return gain;
}

/* Adds the candidate that gains the most, if that is more than a region costs. */
static bool add_candidate(cover_work *w) {
    tile_labelling *l = w->l;
    double most = 0.0;
    uint32_t best = 0;
    for (uint32_t c = 0; c < w->candidates.count; c++) {
        const double gain = gain_of(w, c, false);
        if (gain <= most) continue;
        most = gain;
        best = c;
    }
    if (most < l->prices.region * l->g->area || l->regions.count == REGIONS_MOST) return false;
    labelling_add(l, &w->candidates.points[best], w->candidates.tiles[best]);
    gain_of(w, best, true);
    return true;
}

/* Finds what the present points leave to see, tile by tile. */
static void find_left(cover_work *w) {
    const tile_labelling *l = w->l;
    for (uint32_t t = 0; t < l->g->count; t++) w->left[t] = labelling_blindness(l, t, l->of_tile[t]);
}

static void settle_cover(cover_work *w, int rounds) {
    for (int round = 0; round < rounds; round++) {
        labelling_share_out(w->l);
        labelling_connect(w->l);
        labelling_move_points(w->l);
    }
}

/* Returns the area of a region that its point does not see. */
static double unseen_of(tile_labelling *l, uint32_t region) {
    const tile_set set = labelling_tiles(l, region, region);
    const sight_point *point = &l->regions.points[region];
    return tiles_unseen(&set, point) + soft_paths_unseen(&l->paths, region, &set, point);
}

/* Returns the cost of two regions as one. */
static double cost_of_both(tile_labelling *l, uint32_t a, uint32_t b) {
    const tile_set set = labelling_tiles(l, a, b);
    sight_point point;
    tiles_centroid(&set, &point);
    const double cost = tiles_best_point(&set, &point);
    soft_paths_set(&l->paths, REGIONS_MOST, tiles_nearest(&set, point.rest));
    return cost + soft_paths_unseen(&l->paths, REGIONS_MOST, &set, &point);
}

/* The two regions that cost the least as one, against what they cost now; false: none cost less. */
static bool find_pair(cover_work *w, uint32_t *first, uint32_t *second) {
    tile_labelling *l = w->l;
    double least = 0.0;
    for (uint32_t a = 0; a < l->regions.count; a++) {
        for (uint32_t b = a + 1; b < l->regions.count; b++) {
            const double border = labelling_border(l, a, b);
            if (border < 0.0) continue;
            double change = -border - l->prices.region * l->g->area - unseen_of(l, a);
            change -= unseen_of(l, b);
            change += cost_of_both(l, a, b);
            if (change >= least) continue;
            least = change;
            *first = a;
            *second = b;
        }
    }
    return least < 0.0;
}

static bool join_pair(cover_work *w, uint32_t unused) {
    uint32_t first = 0, second = 0;
    (void)unused;
    if (!find_pair(w, &first, &second)) return false;
    labelling_join(w->l, first, second);
    labelling_move_points(w->l);
    return true;
}

static bool add_one(cover_work *w, uint32_t unused) {
    (void)unused;
    find_left(w);
    return add_candidate(w);
}

static bool leave_out(cover_work *w, uint32_t region) {
    labelling_leave_out(w->l, region);
    return true;
}

typedef bool cover_step(cover_work *w, uint32_t region);

/* Takes a step, and takes it back where the labelling does not cost less once all has settled. */
static bool try_step(cover_work *w, cover_step *step, uint32_t region) {
    tile_labelling *l = w->l;
    const double cost = labelling_cost(l);
    const labelled_regions regions = l->regions;
    memcpy(w->before, l->of_tile, l->g->count * sizeof *w->before);
    if (!step(w, region)) return false;
    settle_cover(w, 2);
    if (labelling_cost(l) < cost) return true;
    labelling_take_back(l, &regions);
    memcpy(l->of_tile, w->before, l->g->count * sizeof *w->before);
    return false;
}

/* Tries one more region, then to join some, then to do without each; true: something has become better. */
static bool improve_cover(cover_work *w) {
    const labelled_regions *regions = &w->l->regions;
    bool better = false;
    while (goes_on(w, 0.3) && try_step(w, add_one, 0)) better = true;
    while (goes_on(w, 0.4) && try_step(w, join_pair, 0)) better = true;
    for (uint32_t region = 0; region < regions->count && regions->count > 1;) {
        if (!goes_on(w, 0.5 + 0.5 * region / regions->count)) return false;
        if (try_step(w, leave_out, region))
            better = true;
        else
            region++;
    }
    return better;
}

static void choose_regions(cover_work *w) {
    enum { ROUNDS_MOST = 3 };
    find_left(w);
    while (goes_on(w, 0.1) && add_candidate(w)) continue;
    if (w->l->regions.count == 1) return;
    settle_cover(w, 4);
    for (int round = 0; round < ROUNDS_MOST && improve_cover(w); round++) continue;
}

static cscd_status find_candidates(cover_work *w) {
    tile_labelling *l = w->l;
    cscd_status status = find_candidates_from(l->g, l->regions.points[0].rest, &w->candidates);
    if (status == CSCD_OK) status = soft_paths_create(l->g, w->candidates.count, &w->paths);
    for (uint32_t c = 0; c < w->candidates.count && status == CSCD_OK; c++)
        soft_paths_set(&w->paths, c, w->candidates.tiles[c]);
    return status;
}

/* Starts from one region, and leaves the best labelling that it finds. CANCELLED: the labelling means nothing. */
static cscd_status find_cover(tile_labelling *l) {
    cscd_context *context = l->g->context;
    cover_work w = {.l = l};
    if (!context_reserve_all(context, list_arrays(&w))) return context_out_of_memory(context);
    const tile_set all = labelling_tiles(l, 0, 0);
    tiles_centroid(&all, &l->regions.points[0]);
    tiles_best_point(&all, &l->regions.points[0]);
    labelling_seat(l, 0);
    cscd_status status = CSCD_OK;
    if (unseen_of(l, 0) > l->prices.region * l->g->area) {
        status = find_candidates(&w);
        if (status == CSCD_OK) choose_regions(&w);
        soft_paths_destroy(&w.paths);
        free_candidates(l->g, &w.candidates);
    }
    context_free_all(context, list_arrays(&w));
    return status == CSCD_OK ? context_progress_status(context) : status;
}

/* ---- regions of a component ---------------------------------------------------------------------------- */

/* The prices of docs/theory/charge.md, found with the bodies of models/shapes. */
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

/* Marks the tiles at the borders of regions, and their neighbours. */
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
    cscd_status status = find_cover(&w->l);
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
