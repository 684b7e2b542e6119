/* Pairs that wait on a live detector: what a change of seams, ignored pairs or rules uncovers while it touches. */
#include "runtime/detector/waiting.h"

#include "runtime/ccd/ccd.h"
#include "runtime/loose/loose.h"
#include "src/mesh/mesh.h"
#include "src/mesh/predicates.h"

#include <string.h>

/* The positions that pairs are looked at, and what is left out there without those that wait. */
typedef struct settling {
    const waiting_place *at;
    const double *x;
    interval_search search; /* at rest */
    exclusions others;      /* without the caller's function, which decides about lists only */
    named_pair_set *set;
    bool touching; /* distances do not count */
} settling;

/* Pairs wait whether their vertices are active or not. */
static settling settle_at(const waiting_place *at, const double *x, named_pair_set *set) {
    settling s = {at,
                  x,
                  config_search_begin(at->config, at->space, x, x),
                  exclusions_listed(&at->config->exclusions),
                  set,
                  false};
    s.search.interval.filter.active = NULL;
    return s;
}

/* ---- pairs that wait already ---------------------------------------------------------------------------- */

/* The number of pairs that one thread looks at at a time. */
enum { PAIRS_PER_TASK = 1024 };

static bool is_left_out(const settling *s, const named_pair *pair) {
    cscd_contact_kind kind = (cscd_contact_kind)pair->kind;
    uint32_t objects[2];
    mesh_objects_of_pair(s->at->space->mesh, kind, pair->a, pair->b, objects);
    return !pair_filter_admits_objects(&s->search.interval.filter, objects[0], objects[1]) ||
           exclusions_cover(&s->others, kind, pair->a, pair->b, s->x);
}

/* Points have no exact test against wires and each other: those whose floor is 0 count as touching. */
static bool points_touch(const settling *s, const named_pair *pair) {
    const floor_ladder ladder = {1.0, 0.5, 0.0};
    double points[4][3];
    cscd_stencil stencil =
        mesh_stencil(s->at->space->mesh, (cscd_contact_kind)pair->kind, pair->a, pair->b, 0.5, 0.5);
    uint32_t ends[4] = {stencil.vertices[0], stencil.vertices[1], stencil.vertices[2], stencil.vertices[3]};
    if (pair->kind == CSCD_CONTACT_VV) ends[1] = ends[0];
    for (int i = 0; i < 4; i++) memcpy(points[i], s->x + (size_t)ends[i] * 3, sizeof points[i]);
    return separation_floor_at((const double(*)[3])points, CSCD_CONTACT_EE, &ladder) == 0.0;
}

static void test_at_rest(const settling *s, named_pair *pair, contact_worker *worker) {
    const swept_interval *interval = &s->search.interval;
    const uint32_t(*triangles)[3] = (const uint32_t(*)[3])interval->mesh->triangles;
    pair->marked = 0;
    if (is_left_out(s, pair)) return;
    bool of_points = pair->kind == CSCD_CONTACT_VV || pair->kind == CSCD_CONTACT_EV;
    if (of_points && s->touching)
        pair->marked = points_touch(s, pair);
    else if (pair->kind != CSCD_CONTACT_TT)
        loose_search_test_pair(interval, (cscd_contact_kind)pair->kind, pair->a, pair->b, worker);
    else
        pair->marked = triangles_intersect(triangles[pair->a], triangles[pair->b], s->x);
}

/* A worker tests its share of the pairs, and marks those that are not apart. */
static void mark_share(void *data, uint32_t index) {
    const settling *s = data;
    const search_space *space = s->at->space;
    contact_worker *worker = &space->workers[index];
    size_t begin = parallel_share(s->set->count, index, space->traversal.worker_count);
    size_t end = parallel_share(s->set->count, index + 1, space->traversal.worker_count);
    for (size_t i = begin; i < end && !worker->out_of_memory; i++) {
        if ((i - begin) % PAIRS_PER_TASK == 0 && !progress_go_on(&space->context->progress, 0.0)) return;
        test_at_rest(s, &s->set->items[i], worker);
    }
    narrow_phase_finish(&s->search.interval, worker);
    for (size_t i = 0; i < worker->count; i++) {
        const cscd_contact *c = contact_worker_at(worker, i);
        named_pair_set_find(s->set, c->kind, c->a, c->b)->marked = 1;
    }
}

static void mark_all(settling *s) {
    progress *watched = &s->at->space->context->progress;
    progress_outer outer = progress_enter(watched, "waiting pairs");
    parallel_run(s->at->space->context->threads, s->at->space->traversal.worker_count, mark_share, s);
    progress_leave(watched, outer);
}

/* Lets go of the pairs that are apart now, or that are left out otherwise. */
static cscd_status let_go(const waiting_place *at, const double *x, named_pair_set *set) {
    settling s = settle_at(at, x, set);
    mark_all(&s);
    cscd_status status = search_space_status(at->space);
    if (status == CSCD_OK) status = context_progress_status(at->space->context);
    if (status == CSCD_OK) named_pair_set_keep_marked(set);
    return status;
}

cscd_status waiting_only_touching(const waiting_place *at, const double *x) {
    if (at->config->waiting.pairs.count == 0 ||
        (at->config->limit.distance == 0.0 && !config_is_thick(at->config)))
        return CSCD_OK;
    settling s = settle_at(at, x, &at->config->waiting.pairs);
    s.search = interval_search_begin(at->space, x, x, (separation){0.0, 0.0});
    s.touching = true;
    mark_all(&s);
    cscd_status status = search_space_status(at->space);
    if (status == CSCD_OK) status = context_progress_status(at->space->context);
    at->config->exclusions.marked_wait = status == CSCD_OK;
    return status;
}

/* ---- pairs that the mesh has parted ---------------------------------------------------------------------- */

static bool add_all(cscd_context *context, const named_pair_set *from, named_pair_set *to) {
    for (size_t i = 0; i < from->count; i++) {
        const named_pair *p = &from->items[i];
        if (!named_pair_set_add(context, to, (cscd_contact_kind)p->kind, p->a, p->b)) return false;
    }
    return true;
}

/* Those that are not apart begin to wait. */
static cscd_status take_torn(const waiting_place *at, const double *x) {
    waiting_pairs *w = &at->config->waiting;
    if (w->torn.count == 0) return CSCD_OK;
    cscd_status status = let_go(at, x, &w->torn);
    if (status != CSCD_OK) return status;
    named_pair_set all = {.items = NULL};
    bool made = add_all(at->space->context, &w->pairs, &all) && add_all(at->space->context, &w->torn, &all) &&
                named_pair_set_sort(at->space->context, &all);
    named_pair_set_free(at->space->context, made ? &w->pairs : &all);
    if (!made) return CSCD_OUT_OF_MEMORY;
    named_pair_set_free(at->space->context, &w->torn);
    w->pairs = all;
    return CSCD_OK;
}

/* ---- pairs that a change has uncovered ------------------------------------------------------------------ */

/* Should this pair, which touches, wait from now on? */
static bool should_wait(const settling *s, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const waiting_place *at = s->at;
    return !exclusions_cover(&s->others, kind, a, b, s->x) &&
           (named_pair_set_has(&at->config->waiting.pairs, kind, a, b) ||
            waiting_pairs_uncovered(at->space->mesh, &at->config->waiting, kind, a, b, s->x));
}

static cscd_status add_features(settling *s) {
    const waiting_place *at = s->at;
    for (uint32_t i = 0; i < at->space->traversal.worker_count; i++) {
        const contact_worker *worker = &at->space->workers[i];
        for (size_t j = 0; j < worker->count; j++) {
            const cscd_contact *c = contact_worker_at(worker, j);
            if (should_wait(s, c->kind, c->a, c->b) &&
                !named_pair_set_add(at->space->context, s->set, c->kind, c->a, c->b))
                return CSCD_OUT_OF_MEMORY;
        }
    }
    return CSCD_OK;
}

static cscd_status add_triangles(settling *s) {
    const waiting_place *at = s->at;
    for (uint32_t i = 0; i < at->check->worker_count; i++) {
        const intersection_worker *worker = &at->check->workers[i];
        for (size_t j = 0; j < worker->count; j++) {
            found_pair c = worker->items[j];
            if (should_wait(s, CSCD_CONTACT_TT, c.a, c.b) &&
                !named_pair_set_add(at->space->context, s->set, CSCD_CONTACT_TT, c.a, c.b))
                return CSCD_OUT_OF_MEMORY;
        }
    }
    return CSCD_OK;
}

static cscd_status search_at_rest(settling *s) {
    const waiting_place *at = s->at;
    cscd_status status = bvh_rebuild_move_to(at->rebuild, &at->space->bvh, s->x, config_growth(at->config),
                                             config_growth(at->config));
    if (status != CSCD_OK) return status;
    if (at->config->stages->brute_force) return interval_search_by_brute_force(&s->search);
    status = interval_search_everything(&s->search);
    return status == CSCD_OK ? interval_search_loose(&s->search) : status;
}

static cscd_status find_touching(settling *s) {
    const waiting_place *at = s->at;
    at->space->traversal.whole = true;
    cscd_status status = search_at_rest(s);
    if (status == CSCD_OK) status = add_features(s);
    if (status == CSCD_OK) status = static_check_all(at->check, &at->space->traversal, &at->space->bvh, s->x);
    at->space->traversal.whole = false;
    if (status == CSCD_OK) status = add_triangles(s);
    if (status == CSCD_OK && !named_pair_set_sort(at->space->context, s->set)) status = CSCD_OUT_OF_MEMORY;
    return status;
}

/* The search finds the pairs that wait already, too, unless they are apart. */
static cscd_status take_uncovered(const waiting_place *at, const double *x, bool letting_go) {
    named_pair_set set = {.items = NULL};
    settling s = settle_at(at, x, &set);
    progress_part(&at->space->context->progress, 0.0, 0.2);
    cscd_status status = CSCD_OK;
    if (!letting_go && !add_all(at->space->context, &at->config->waiting.pairs, &set))
        status = CSCD_OUT_OF_MEMORY;
    if (status == CSCD_OK) status = find_touching(&s);
    progress_part(&at->space->context->progress, 0.2, 1.0);
    if (status != CSCD_OK) {
        named_pair_set_free(at->space->context, &set);
        return status;
    }
    named_pair_set_free(at->space->context, &at->config->waiting.pairs);
    at->config->waiting.pairs = set;
    waiting_pairs_settled(at->space->mesh, &at->config->waiting);
    return CSCD_OK;
}

/* ---- either --------------------------------------------------------------------------------------------- */

cscd_status waiting_settle(const waiting_place *at, const double *x) {
    cscd_status status = take_torn(at, x);
    if (status != CSCD_OK) return status;
    if (at->config->waiting.former != NULL) return take_uncovered(at, x, true);
    return at->config->waiting.pairs.count > 0 ? let_go(at, x, &at->config->waiting.pairs) : CSCD_OK;
}

cscd_status waiting_look(const waiting_place *at, const double *x) {
    cscd_status status = take_torn(at, x);
    if (status != CSCD_OK) return status;
    return at->config->waiting.former != NULL ? take_uncovered(at, x, false) : CSCD_OK;
}
