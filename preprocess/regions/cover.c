/* Covers a component by regions: points are chosen one by one, tiles are shared out, points move, regions join. */
#include "preprocess/regions/cover.h"

#include "preprocess/regions/medial_points.h"

#include <string.h>

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

/* ---- one point after the other --------------------------------------------------------------------------- */

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

/* What is left to see, by the points as they are. */
static void find_left(cover_work *w) {
    const tile_labelling *l = w->l;
    for (uint32_t t = 0; t < l->g->count; t++) w->left[t] = labelling_blindness(l, t, l->of_tile[t]);
}

/* ---- steps ----------------------------------------------------------------------------------------------- */

static void settle_cover(cover_work *w, int rounds) {
    for (int round = 0; round < rounds; round++) {
        labelling_share_out(w->l);
        labelling_connect(w->l);
        labelling_move_points(w->l);
    }
}

/* What a region does not see. */
static double unseen_of(tile_labelling *l, uint32_t region) {
    const tile_set set = labelling_tiles(l, region, region);
    const sight_point *point = &l->regions.points[region];
    return tiles_unseen(&set, point) + soft_paths_unseen(&l->paths, region, &set, point);
}

/* What two regions as one cost. */
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
    cscd_status status = medial_points_find(l->g, l->regions.points[0].rest, &w->candidates);
    if (status == CSCD_OK) status = soft_paths_create(l->g, w->candidates.count, &w->paths);
    for (uint32_t c = 0; c < w->candidates.count && status == CSCD_OK; c++)
        soft_paths_set(&w->paths, c, w->candidates.tiles[c]);
    return status;
}

cscd_status cover_find(tile_labelling *l) {
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
        medial_points_free(l->g, &w.candidates);
    }
    context_free_all(context, list_arrays(&w));
    return status == CSCD_OK ? context_progress_status(context) : status;
}
