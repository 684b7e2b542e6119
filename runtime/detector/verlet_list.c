/* Answers intervals in which nothing touches, and little moves, from a list of the pairs that may touch in them. */
#include "runtime/detector/verlet_list.h"

#include <math.h>
#include <string.h>

/* In mean lengths of edges: a skin is so thin at least, and so thick at most, for beyond that more pairs are listed than it
 * saves. It is made for this many intervals like the first one; where a motion is too fast for the least number of them,
 * there is no list. Measured: docs/theory/coherence.md. */
static const double thinnest = 0.1, thickest = 0.15, intervals_wanted = 16.0, intervals_least = 8.0;

/* A list that served fewer intervals was of no use. Then, or where a motion is too fast, there is a pause before the next one, twice as
 * long each time. A list of more pairs for each triangle costs more than it saves. */
enum { SERVED_LEAST = 8, BACKOFF_FIRST = 4, BACKOFF_MOST = 64, EDGE_SAMPLES = 4096 };
static const double most_pairs = 0.5;

static double mean_edge(const cscd_mesh *mesh, const double *x) {
    uint32_t step = mesh->edge_count / EDGE_SAMPLES + 1, count = 0;
    double sum = 0.0;
    for (uint32_t i = 0; i < mesh->edge_count; i += step, count++) {
        const double *a = x + (size_t)mesh->edges[i][0] * 3, *b = x + (size_t)mesh->edges[i][1] * 3;
        double squares = 0.0;
        for (int k = 0; k < 3; k++) squares += (b[k] - a[k]) * (b[k] - a[k]);
        sum += sqrt(squares);
    }
    return count > 0 ? sum / count : 0.0;
}

/* Chooses how far vertices may go for a motion like this, and what signs have to last for at least: the stretch of one
 * interval, since those that last no longer are hardly worth to be computed again in each. False: the motion is too fast. */
static bool choose_skin(const verlet_list *v, const bvh *trees, const double *x0, const double *x1,
                        skin_motion *out) {
    double edge = v->now.edge, most = thickest * edge;
    *out = bvh_skin_estimate(trees, x0, x1);
    if (!(out->distance * intervals_least <= most && most > 0.0 && isfinite(most))) return false;
    out->distance = fmin(most, fmax(intervals_wanted * out->distance, thinnest * edge));
    return true;
}

/* Orients all triangles by signs that last within the skin. */
static void orient_lastingly(verlet_list *v, const verlet_place *at, const skin_motion *skin) {
    bvh *trees = &at->space->bvh;
    culling *c = &at->interval->culling;
    const orientation_lasting lasting = bvh_skin_lasting(&v->skin, trees, skin->distance, skin->stretch);
    const orientation_query query = {.culled = at->interval->culled,
                                     .detector_offsets = (const double(*)[3])c->detector_offsets,
                                     .lasting = &lasting};
    culling_clear(c);
    bvh_orient(trees, &query, c->facing);
    culling_begin(c);
}

/* Two features, each of which moves by no more than the skin, were within two of them at the start if they touch. */
static cscd_status collect_pairs(verlet_list *v, const verlet_place *at, const double *x,
                                 const skin_motion *skin) {
    search_space *space = at->space;
    double apart = 2.0 * skin->distance * (1.0 + 0x1p-20);
    cscd_status status = bvh_rebuild_move_to(at->rebuild, &space->bvh, x, uniform_growth(apart), at->growth);
    if (status != CSCD_OK) return status;
    orient_lastingly(v, at, skin);
    interval_search search = interval_search_begin(space, x, x, (separation){0.0, 0.0});
    search.interval.collecting = true;
    search.interval.beyond = apart;
    search.interval.culling = &at->interval->culling;
    search.interval.culled = at->interval->culled;
    for (uint32_t i = 0; i < space->traversal.worker_count; i++) space->workers[i].kept = NULL;
    interval_search_skip_adjacent(&search, false);
    status = interval_search_traverse(&search, TRAVERSAL_KEPT);
    return status == CSCD_OK ? candidates_take(space, &v->pairs) : status;
}

static void back_off(verlet_list *v) {
    v->now.edge = 0.0; /* which may have changed by then */
    v->now.backoff = v->now.backoff == 0             ? BACKOFF_FIRST
                     : v->now.backoff < BACKOFF_MOST ? v->now.backoff * 2
                                                     : BACKOFF_MOST;
    v->now.pause = v->now.backoff;
}

static bool is_short(const verlet_list *v, const cscd_mesh *mesh) {
    const candidate_list *lists = v->pairs.lists;
    return (double)(lists[0].count + lists[1].count) <= most_pairs * (double)mesh->triangle_count;
}

/* Notes for how long the pairs, and the signs by which others were left out, are good. False: no memory. */
static bool keep_list(verlet_list *v, const verlet_place *at, double distance) {
    const culling *c = &at->interval->culling;
    size_t triangles = c->mesh->triangle_count;
    if (v->facing == NULL) v->facing = context_allocate(c->context, triangles, sizeof *v->facing);
    if (v->facing == NULL) return false;
    memcpy(v->facing, c->facing, triangles);
    v->plus = c->plus;
    v->minus = c->minus;
    bvh_skin_set(&v->skin, &at->space->bvh, distance);
    return true;
}

/* Makes a list at the start of an interval, if it promises to be of use. */
static cscd_status make_list(verlet_list *v, const verlet_place *at, const double *x0, const double *x1) {
    const cscd_mesh *mesh = at->space->mesh;
    if (!v->now.was_quiet || (v->now.pause > 0 && v->now.pause-- > 0)) return CSCD_OK;
    if (v->now.edge == 0.0) v->now.edge = mean_edge(mesh, x0);
    skin_motion skin;
    v->remade = true;
    if (!choose_skin(v, &at->space->bvh, x0, x1, &skin) || !bvh_skin_reserve(&v->skin, &at->space->bvh)) {
        back_off(v);
        return CSCD_OK;
    }
    interval_cull_everything(at->interval);
    cscd_status status = collect_pairs(v, at, x0, &skin);
    if (status != CSCD_OK && status != CSCD_OUT_OF_MEMORY) return status;
    v->now.served = 0;
    v->now.revision = at->revision;
    v->now.exists = status == CSCD_OK && is_short(v, mesh) && keep_list(v, at, skin.distance);
    if (!v->now.exists) back_off(v);
    return CSCD_OK;
}

/* Ends a list that does not hold any longer, and notes whether it was of use. */
static void end_list(verlet_list *v) {
    v->now.exists = false;
    if (v->now.served >= SERVED_LEAST)
        v->now.backoff = 0;
    else
        back_off(v);
}

cscd_status verlet_list_find(verlet_list *v, const verlet_place *at, const double *x0, const double *x1,
                             bool *holds) {
    *holds = v->now.exists && v->now.revision == at->revision && bvh_skin_holds(&v->skin, x0, x1);
    if (*holds) return CSCD_OK;
    if (v->now.exists) end_list(v); /* it has ended now, or in an interval that was not answered from it */
    cscd_status status = make_list(v, at, x0, x1);
    *holds = v->now.exists && bvh_skin_holds(&v->skin, x0, x1);
    return status;
}

void verlet_list_begin_call(verlet_list *v) {
    v->before = v->now;
    v->remade = false;
}

void verlet_list_undo(verlet_list *v) {
    v->now = v->before;
    if (v->remade) v->now.revision = UINT64_MAX; /* that of no positions */
    v->serving = false;
}

void verlet_list_take(verlet_list *v, uint64_t revision) {
    if (!v->serving) return;
    v->now.served++;
    v->now.revision = revision;
    bvh_skin_take(&v->skin);
}

void verlet_list_free(cscd_context *context, verlet_list *v) {
    candidates_free(context, &v->pairs);
    bvh_skin_free(&v->skin);
    context_free(context, v->facing);
    *v = (verlet_list){.serving = false};
}
