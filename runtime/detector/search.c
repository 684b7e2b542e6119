/* The searches of a detector: their data; one interval, from the trees, refitted to it, to the workers' contacts; candidates,
 * which serve every shorter motion. */
#include "runtime/detector/search.h"

#include "src/core/timer.h"

#include <string.h>

/* ---- the data ------------------------------------------------------------------------------------------ */

cscd_status search_space_create(const cscd_mesh *mesh, search_space *out) {
    search_space s = {.context = mesh->context, .mesh = mesh, .moves_from = LONG_LIST};
    cscd_status status = traversal_create(s.context, &s.traversal);
    if (status == CSCD_OK) status = representatives_create(mesh, &s.representatives);
    if (status == CSCD_OK) status = loose_elements_create(mesh, &s.loose);
    if (status == CSCD_OK) {
        s.workers = context_allocate(s.context, s.traversal.worker_count, sizeof *s.workers);
        s.skipped = context_allocate(s.context, mesh->component_count, sizeof *s.skipped);
        if (s.workers == NULL || s.skipped == NULL) status = CSCD_OUT_OF_MEMORY;
    }
    if (status != CSCD_OK) {
        search_space_destroy(&s);
        return status;
    }
    *out = s;
    return CSCD_OK;
}

static void free_workers(search_space *s) {
    for (uint32_t i = 0; s->workers != NULL && i < s->traversal.worker_count; i++) {
        contact_worker_free(s->context, &s->workers[i]);
        context_free(s->context, s->workers[i].candidates[CSCD_CONTACT_VF].pairs);
        context_free(s->context, s->workers[i].candidates[CSCD_CONTACT_EE].pairs);
    }
    context_free(s->context, s->workers);
}

void search_space_destroy(search_space *s) {
    if (s->context == NULL) return;
    free_workers(s);
    if (s->traversal.workers != NULL) traversal_destroy(&s->traversal);
    bvh_free(&s->bvh);
    active_set_free(s->context, &s->active);
    representatives_free(s->context, &s->representatives);
    orphan_pairs_free(s->context, &s->orphans);
    loose_elements_destroy(&s->loose);
    context_free(s->context, s->skipped);
    *s = (search_space){.context = NULL};
}

cscd_status search_space_status(const search_space *s) {
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) {
        if (s->workers[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
    }
    return CSCD_OK;
}

bool search_space_found_any(const search_space *s) {
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) {
        if (s->workers[i].count > 0) return true;
    }
    return false;
}

/* ---- one interval -------------------------------------------------------------------------------------- */

interval_search interval_search_begin(search_space *space, const double *x0, const double *x1,
                                      separation limit) {
    for (uint32_t i = 0; i < space->traversal.worker_count; i++) contact_worker_reset(&space->workers[i]);
    space->longest = 0;
    space->counted = 0;
    return (interval_search){
        .space = space,
        .interval = {.mesh = space->mesh,
                     .x0 = x0,
                     .x1 = x1,
                     .bvh = &space->bvh,
                     .representatives = &space->representatives,
                     .filter = {.mesh = space->mesh,
                                .rules = space->rules,
                                .active = space->active.vertices != NULL ? &space->active : NULL},
                     .limit = limit}};
}

static bool any_suspended(const search_space *s) {
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) {
        if (s->workers[i].suspended) return true;
    }
    return false;
}

void interval_search_run(interval_search *search, uint32_t workers, parallel_task *task, void *data) {
    search_space *s = search->space;
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) {
        s->workers[i].cursor = 0;
        s->workers[i].suspended = false;
    }
    for (;;) {
        parallel_run(s->context->threads, workers, task, data);
        if (!any_suspended(s)) return;
        search->spill(search->spill_data);
    }
}

/* A worker with a limit looks at it after this many pairs, which narrow_phase_test takes at once. */
enum { PAIRS_BETWEEN_LOOKS = 256 };

/* Tests the rest of the batch. False: the worker is suspended before its end. */
static bool test_found(const interval_search *search, const traversal_worker *batch, contact_worker *worker) {
    const uint32_t most = worker->limit == SIZE_MAX ? TRAVERSAL_BATCH_SIZE : PAIRS_BETWEEN_LOOKS;
    while (worker->cursor < batch->pair_count) {
        uint32_t begin = (uint32_t)worker->cursor, rest = batch->pair_count - begin;
        uint32_t count = rest < most ? rest : most;
        narrow_phase_test(&search->interval, batch->pairs + begin, count, worker);
        if (contact_worker_suspend(worker, begin + count)) return false;
    }
    return true;
}

/* Each worker searches and tests in turn. It tests what it has found itself, so no worker waits for another one. */
static void search_and_test(void *data, uint32_t index) {
    interval_search *search = data;
    cscd_context *context = search->space->context;
    traversal *t = &search->space->traversal;
    traversal_worker *batch = &t->workers[index];
    contact_worker *worker = &search->space->workers[index];
    double begin = timer_now_ms(), spent = 0.0, searched = batch->search_ms;
    worker->suspended = false;
    bool done = test_found(search, batch, worker);
    while (done && !worker->out_of_memory && progress_go_on(&context->progress, traversal_done(t)) &&
           traversal_fill(t, index)) {
        batch->pairs_found += batch->pair_count;
        worker->cursor = 0;
        done = test_found(search, batch, worker);
    }
    if (done) narrow_phase_finish(&search->interval, worker);
    timer_lap(&begin, &spent);
    batch->consume_ms += spent - (batch->search_ms - searched);
}

/* Divides the time that the workers took together between the two stages, in the proportion of the workers' own times. */
static void divide_time(interval_search *search, double together_ms) {
    const traversal *t = &search->space->traversal;
    double searched = 0.0, tested = 0.0;
    for (uint32_t i = 0; i < t->busy_workers; i++) {
        searched += t->workers[i].search_ms;
        tested += t->workers[i].consume_ms;
        search->counters.pcp += t->workers[i].pairs_found + t->workers[i].adjacent;
        search->counters.adjacent += t->workers[i].adjacent;
    }
    double share = searched + tested > 0.0 ? searched / (searched + tested) : 0.0;
    search->timings.traversal_ms += share * together_ms;
    search->timings.contact_ms += (1.0 - share) * together_ms;
}

cscd_status interval_search_traverse(interval_search *search, traversal_pass pass) {
    search_space *space = search->space;
    double since = timer_now_ms(), together = 0.0;
    bool last = pass == TRAVERSAL_NEWLY_KEPT;
    if (space->bvh.mesh == NULL) return CSCD_OK; /* there are no triangles */
    progress_stage(&space->context->progress, last ? "further passes" : "traversal", last ? 0.9 : 0.3,
                   last ? 1.0 : 0.9);
    traversal_begin(&space->traversal, &space->bvh, pass);
    timer_lap(&since, &search->timings.traversal_ms);
    interval_search_run(search, space->traversal.busy_workers, search_and_test, search);
    timer_lap(&since, &together);
    divide_time(search, together);
    search->counters.boxes_tested += traversal_boxes_tested(&space->traversal);
    cscd_status status = traversal_status(&space->traversal);
    if (status == CSCD_OK) status = search_space_status(space);
    return status == CSCD_OK ? context_progress_status(space->context) : status;
}

/* ---- without pairs of adjacent triangles --------------------------------------------------------------- */

static void test_orphan_pairs(void *data, uint32_t index) {
    interval_search *search = data;
    search_space *space = search->space;
    contact_worker *worker = &space->workers[index];
    worker->suspended = false;
    narrow_phase_test_orphan_pairs(&search->interval, &space->orphans, index, space->traversal.busy_workers,
                                   worker);
    if (!worker->suspended) narrow_phase_finish(&search->interval, worker);
}

/* Skips pairs of adjacent triangles everywhere except in culled components (NULL: there are none), or
 * nowhere. */
static void skip_adjacent_pairs(search_space *space, bool everywhere, const bool *culled) {
    for (uint32_t c = 0; c < space->mesh->component_count; c++)
        space->skipped[c] = everywhere && (culled == NULL || !culled[c]);
    bvh_skip_adjacent(&space->bvh, space->skipped);
}

void interval_search_skip_adjacent(interval_search *search, bool everywhere) {
    skip_adjacent_pairs(search->space, everywhere, NULL);
}

static cscd_status skip_where_not_culled(interval_search *search) {
    search_space *space = search->space;
    if (!space->orphans_known) {
        bool too_many;
        cscd_status status = orphan_pairs_create(space->mesh, &space->orphans, &too_many);
        if (status != CSCD_OK) return status;
        space->orphans_known = true;
        space->orphans_usable = !too_many;
    }
    search->interval.skip_adjacent = space->orphans_usable;
    skip_adjacent_pairs(space, space->orphans_usable,
                        search->interval.culling != NULL ? search->interval.culled : NULL);
    return CSCD_OK;
}

cscd_status interval_search_everything(interval_search *search) {
    search_space *space = search->space;
    cscd_status status = skip_where_not_culled(search);
    if (status == CSCD_OK) status = interval_search_traverse(search, TRAVERSAL_KEPT);
    if (status != CSCD_OK || !search->interval.skip_adjacent) return status;
    double since = timer_now_ms();
    interval_search_run(search, space->traversal.busy_workers, test_orphan_pairs, search);
    timer_lap(&since, &search->timings.contact_ms);
    return search_space_status(space);
}

/* ---- loose features ------------------------------------------------------------------------------------ */

static void test_loose_elements(void *data, uint32_t index) {
    interval_search *search = data;
    const search_space *space = search->space;
    contact_worker *worker = &space->workers[index];
    const loose_search loose = {&search->interval, &space->loose, space->traversal.worker_count};
    worker->suspended = false;
    loose_search_test(&loose, index, worker);
    if (!worker->suspended) narrow_phase_finish(&search->interval, worker);
}

static void test_half_spaces(void *data, uint32_t index) {
    interval_search *search = data;
    contact_worker *worker = &search->space->workers[index];
    worker->suspended = false;
    half_spaces_test(&search->interval, index, search->space->traversal.worker_count, worker);
}

/* Tests all vertices against the half-spaces. */
static void search_half_spaces(interval_search *search) {
    if (search->space->mesh->loose.half_space_count > 0)
        interval_search_run(search, search->space->traversal.worker_count, test_half_spaces, search);
}

cscd_status interval_search_loose(interval_search *search) {
    search_space *space = search->space;
    if (!mesh_has_loose_objects(space->mesh)) return CSCD_OK;
    double since = timer_now_ms();
    loose_elements_move(&space->loose, &search->interval);
    timer_lap(&since, &search->timings.update_ms);
    progress_stage(&space->context->progress, "loose features", 0.9, 1.0);
    interval_search_run(search, space->traversal.worker_count, test_loose_elements, search);
    search_half_spaces(search);
    timer_lap(&since, &search->timings.contact_ms);
    cscd_status status = search_space_status(space);
    return status == CSCD_OK ? context_progress_status(space->context) : status;
}

/* ---- without trees ------------------------------------------------------------------------------------- */

static void test_share_of_pairs(void *data, uint32_t index) {
    interval_search *search = data;
    brute_force_test(&search->interval, index, search->space->traversal.worker_count,
                     &search->space->workers[index]);
}

static void test_all_loose_elements(void *data, uint32_t index) {
    interval_search *search = data;
    const search_space *space = search->space;
    contact_worker *worker = &space->workers[index];
    const loose_search loose = {&search->interval, &space->loose, space->traversal.worker_count};
    worker->suspended = false;
    loose_search_test_all(&loose, index, worker);
    if (!worker->suspended) narrow_phase_finish(&search->interval, worker);
}

cscd_status interval_search_all_loose(interval_search *search) {
    search_space *space = search->space;
    double since = timer_now_ms();
    if (mesh_has_loose_objects(space->mesh))
        interval_search_run(search, space->traversal.worker_count, test_all_loose_elements, search);
    search_half_spaces(search);
    timer_lap(&since, &search->timings.contact_ms);
    cscd_status status = search_space_status(space);
    return status == CSCD_OK ? context_progress_status(space->context) : status;
}

cscd_status interval_search_by_brute_force(interval_search *search) {
    search_space *space = search->space;
    double since = timer_now_ms();
    progress_stage(&space->context->progress, "brute force", 0.0, 1.0);
    interval_search_run(search, space->traversal.worker_count, test_share_of_pairs, search);
    timer_lap(&since, &search->timings.contact_ms);
    return interval_search_all_loose(search);
}

/* ---- candidates ---------------------------------------------------------------------------------------- */

/* Joins the lists of all workers. False: no memory. */
static bool join_lists(const search_space *s, cscd_contact_kind kind, candidate_list *list) {
    size_t count = 0;
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) count += s->workers[i].candidates[kind].count;
    list->count = 0;
    if (count > list->capacity) {
        size_t capacity = count + count / 2;
        uint32_t(*grown)[2] = context_grow(s->context, list->pairs, 0, capacity, sizeof *grown);
        if (grown == NULL) return false;
        list->pairs = grown;
        list->capacity = capacity;
    }
    for (uint32_t i = 0; i < s->traversal.worker_count; i++) {
        const candidate_list *found = &s->workers[i].candidates[kind];
        if (found->count > 0)
            memcpy(list->pairs + list->count, found->pairs, found->count * sizeof *found->pairs);
        list->count += found->count;
    }
    return true;
}

cscd_status candidates_take(const search_space *s, candidates *out) {
    bool taken = join_lists(s, CSCD_CONTACT_VF, &out->lists[CSCD_CONTACT_VF]) &&
                 join_lists(s, CSCD_CONTACT_EE, &out->lists[CSCD_CONTACT_EE]);
    return taken ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

cscd_status candidates_collect(const candidate_quest *quest, const double *x0, const double *x1,
                               candidates *out) {
    search_space *space = quest->space;
    const bool thick = quest->growth.of_objects != NULL;
    const double same = quest->growth.distance + (thick ? 0.0 : quest->reach);
    interval_search search = interval_search_begin(space, x0, x1, (separation){same, same});
    volume_growth growth = {quest->growth.distance, quest->growth.of_objects, quest->reach + quest->margin};
    search.interval.collecting = true;
    search.interval.thick = thick;
    search.interval.activation = thick ? quest->reach : 0.0;
    search.interval.beyond = quest->margin;
    cscd_status status = bvh_rebuild_move(quest->rebuild, &space->bvh, x0, x1, growth, quest->growth);
    if (status == CSCD_OK) status = interval_search_everything(&search);
    if (status == CSCD_OK) status = interval_search_loose(&search);
    return status == CSCD_OK ? candidates_take(space, out) : status;
}

void candidates_free(cscd_context *context, candidates *c) {
    context_free(context, c->lists[CSCD_CONTACT_VF].pairs);
    context_free(context, c->lists[CSCD_CONTACT_EE].pairs);
    *c = (candidates){{{NULL, 0, 0}, {NULL, 0, 0}}};
}

/* ---- tests of candidates --------------------------------------------------------------------------------------------- */

typedef struct testing {
    const candidates *candidates;
    interval_search *search;
} testing;

static void test_vf(const swept_interval *interval, const uint32_t pair[2], contact_worker *worker) {
    swept_box vertex = swept_box_of(interval, &pair[0], 1);
    swept_box face = swept_box_of(interval, interval->mesh->triangles[pair[1]], 3);
    if (!swept_boxes_within(&vertex, &face, pair_reach(interval, CSCD_CONTACT_VF, pair[0], pair[1]))) return;
    worker->feature_pairs++;
    narrow_phase_test_vf(interval, pair[0], pair[1], worker);
}

static void test_ee(const swept_interval *interval, const uint32_t pair[2], contact_worker *worker) {
    if (!loose_edges_meet(interval, pair[0], pair[1])) return;
    swept_box a = swept_box_of(interval, interval->mesh->edges[pair[0]], 2);
    swept_box b = swept_box_of(interval, interval->mesh->edges[pair[1]], 2);
    if (!swept_boxes_within(&a, &b, pair_reach(interval, CSCD_CONTACT_EE, pair[0], pair[1]))) return;
    worker->feature_pairs++;
    narrow_phase_test_ee(interval, pair[0], pair[1], worker);
}

/* The host may cancel after this many candidates. */
enum { CANDIDATES_AT_ONCE = 1024 };

/* Tests a worker's share of both lists; the cursor counts the candidates of the two. */
static void test_share(void *data, uint32_t index) {
    const testing *t = data;
    const swept_interval *interval = &t->search->interval;
    const search_space *space = t->search->space;
    contact_worker *worker = &space->workers[index];
    size_t done = 0;
    worker->suspended = false;
    for (int kind = 0; kind < 2; kind++) {
        const candidate_list *list = &t->candidates->lists[kind];
        size_t begin = parallel_share(list->count, index, space->traversal.worker_count);
        size_t end = parallel_share(list->count, index + 1, space->traversal.worker_count);
        uint64_t left = worker->cursor - done;
        size_t skipped = left < end - begin ? (size_t)left : end - begin;
        for (size_t i = begin + skipped; i < end && !worker->out_of_memory; i++) {
            double share = 0.5 * (kind + (double)(i - begin) / (double)(end - begin));
            if ((i - begin) % CANDIDATES_AT_ONCE == 0 && !progress_go_on(&space->context->progress, share))
                return;
            (kind == CSCD_CONTACT_VF ? test_vf : test_ee)(interval, list->pairs[i], worker);
            if (contact_worker_suspend(worker, worker->cursor + 1)) return;
        }
        done += end - begin;
    }
    narrow_phase_finish(interval, worker);
}

cscd_status candidates_test(const candidates *c, interval_search *search) {
    search_space *space = search->space;
    testing t = {c, search};
    progress_stage(&space->context->progress, "candidates", 0.0, 1.0);
    interval_search_run(search, space->traversal.worker_count, test_share, &t);
    search_half_spaces(search);
    cscd_status status = search_space_status(space);
    return status == CSCD_OK ? context_progress_status(space->context) : status;
}
