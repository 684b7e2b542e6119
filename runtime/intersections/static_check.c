/* Finds the pairs of triangles that intersect at one moment, all of them or the first ones, by exact predicates. */
#include "runtime/intersections/static_check.h"

#include "src/mesh/predicates.h"

#include <assert.h>
#include <stdatomic.h>
#include <string.h>

/* ---- workers --------------------------------------------------------------------------------------------- */

/* A worker grows by half: with the room that it leaves meanwhile, 27.5 bytes for each pair that it has. */
enum { ROOM_LEAST = 256, EVEN_ROOM_MOST = 1 << 16 };

static bool grow_items(cscd_context *context, intersection_worker *worker, size_t capacity) {
    found_pair *grown = context_grow(context, worker->items, worker->count, capacity, sizeof *worker->items);
    if (grown == NULL) return false;
    worker->items = grown;
    worker->capacity = capacity;
    return true;
}

static bool make_room(cscd_context *context, intersection_worker *worker) {
    return grow_items(context, worker,
                      worker->capacity == 0 ? ROOM_LEAST : worker->capacity + worker->capacity / 2);
}

static bool make_room_for_notes(cscd_context *context, intersection_worker *worker) {
    pair_note *grown =
        context_grow(context, worker->notes, worker->count, worker->capacity, sizeof *worker->notes);
    if (grown == NULL) return false;
    worker->notes = grown;
    worker->note_capacity = worker->capacity;
    return true;
}

/* Adds a pair of triangles in any order. No memory: out_of_memory is set. */
static void add_pair(cscd_context *context, intersection_worker *worker, triangle_pair t) {
    if (worker->count == worker->capacity && !make_room(context, worker))
        worker->out_of_memory = true;
    else
        worker->items[worker->count++] = (found_pair){t.a < t.b ? t.a : t.b, t.a < t.b ? t.b : t.a};
}

static void add_noted_pair(cscd_context *context, intersection_worker *worker, triangle_pair t,
                           pair_note note) {
    bool room = worker->count < worker->capacity || make_room(context, worker);
    if (room && worker->note_capacity < worker->capacity) room = make_room_for_notes(context, worker);
    if (room) worker->notes[worker->count] = note;
    if (room)
        add_pair(context, worker, t);
    else
        worker->out_of_memory = true;
}

/* The pairs that a thread finds depend on the moments at which threads come for work, so its worker might need
 * more room in any call. Once a call has found its pairs, each worker has room for all of them, unless they are
 * very many. False: no memory. */
static bool even_out_workers(cscd_context *context, intersection_worker *workers, uint32_t count,
                             bool notes) {
    size_t total = 0;
    for (uint32_t i = 0; i < count; i++) total += workers[i].count;
    const size_t room = total <= EVEN_ROOM_MOST ? ROOM_LEAST + total + total / 4 : 0;
    for (uint32_t i = 0; i < count && total > 0; i++) {
        intersection_worker *worker = &workers[i];
        if (worker->capacity < room && !grow_items(context, worker, room)) return false;
        if (notes && worker->note_capacity < worker->capacity && !make_room_for_notes(context, worker))
            return false;
    }
    return true;
}

static void free_worker(cscd_context *context, intersection_worker *worker) {
    context_free(context, worker->items);
    context_free(context, worker->notes);
}

/* ---- memory -------------------------------------------------------------------------------------------- */

static array_list list_arrays(static_check *c) {
    return (array_list){{ARRAY(c->unproven, c->mesh->triangle_count),
                         ARRAY(c->crossing, c->mesh->triangle_count), ARRAY(c->workers, c->worker_count)}};
}

cscd_status static_check_create(const cscd_mesh *mesh, uint32_t worker_count, static_check *out) {
    static_check c = {.mesh = mesh, .worker_count = worker_count, .limit = SIZE_MAX};
    cscd_status status = vertex_stars_create(mesh, &c.stars);
    if (status == CSCD_OK && !context_allocate_all(mesh->context, list_arrays(&c))) {
        vertex_stars_destroy(&c.stars);
        status = CSCD_OUT_OF_MEMORY;
    }
    if (status == CSCD_OK) *out = c;
    return status;
}

void static_check_destroy(static_check *c) {
    if (c->mesh == NULL) return;
    cscd_context *context = c->mesh->context;
    for (uint32_t i = 0; i < c->worker_count; i++) free_worker(context, &c->workers[i]);
    context_free_all(context, list_arrays(c));
    vertex_stars_destroy(&c->stars);
    *c = (static_check){0};
}

/* ---- one batch ----------------------------------------------------------------------------------------- */

/* Data that the threads of a check share. */
typedef struct check_work {
    static_check *check;
    traversal *traversal;
    const bvh *bvh;
    const double *positions;
    bool own_component_only; /* pairs of triangles of two components do not count */
    bool by_stars;           /* pairs that share a vertex come from the stars, and not from the traversal */
    const uint32_t *names;   /* where kinds are asked for; NULL: each vertex has its own */
} check_work;

static const uint32_t (*triangles_of(const check_work *work))[3] {
    return (const uint32_t(*)[3])work->check->mesh->triangles;
}

static bool same_triangle(const uint32_t a[3], const uint32_t b[3]) {
    return triangle_contains(a, b[0]) && triangle_contains(a, b[1]) && triangle_contains(a, b[2]);
}

static void test_kind(const check_work *work, intersection_worker *worker, triangle_pair t) {
    const uint32_t(*triangles)[3] = triangles_of(work);
    const uint32_t *a = triangles[t.a], *b = triangles[t.b];
    pair_kind found;
    if (!pair_kind_find(a, b, work->names, work->positions, &found)) return;
    const pair_note note = {(uint8_t)found.kind, (uint8_t)found.shared,
                            found.kind == CSCD_INTERSECTION_DUPLICATE && same_triangle(a, b)};
    add_noted_pair(work->check->mesh->context, worker, t, note);
}

static bool pair_counts(const check_work *work, uint32_t a, uint32_t b) {
    const static_check *c = work->check;
    if (work->own_component_only && a != b) return false;
    return c->collapsed == NULL || !(c->collapsed[a] || c->collapsed[b]);
}

/* Replaces the slots of a batch by triangles, and drops the pairs that do not count. */
static void name_triangles(const check_work *work, traversal_worker *batch) {
    const uint32_t *components = work->check->mesh->triangle_components;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < batch->pair_count; i++) {
        triangle_pair slots = batch->pairs[i];
        triangle_pair pair = {bvh_triangle(work->bvh, slots.a), bvh_triangle(work->bvh, slots.b)};
        batch->pairs[kept] = pair;
        kept += pair_counts(work, components[pair.a], components[pair.b]);
    }
    batch->pair_count = kept;
}

/* An edge of one certainly passes through the inside of the other: if both have an area, they cross. */
static void add_crossing(const check_work *work, intersection_worker *worker, triangle_pair t) {
    cscd_context *context = work->check->mesh->context;
    const uint8_t *normals = work->check->stars.normals;
    if (!work->check->kinds) {
        add_pair(context, worker, t);
    } else if (normals[t.a] == 0 || normals[t.b] == 0) {
        test_kind(work, worker, t);
    } else {
        const uint32_t(*triangles)[3] = triangles_of(work);
        uint32_t shared = pair_kind_count_shared(triangles[t.a], triangles[t.b], work->names);
        const pair_note note = {CSCD_INTERSECTION_CROSSING, (uint8_t)shared, false};
        add_noted_pair(context, worker, t, note);
    }
}

static void test_pair(const check_work *work, intersection_worker *worker, triangle_pair t) {
    const uint32_t(*triangles)[3] = triangles_of(work);
    if (work->check->kinds)
        test_kind(work, worker, t);
    else if (triangles_intersect(triangles[t.a], triangles[t.b], work->positions))
        add_pair(work->check->mesh->context, worker, t);
}

enum { PAIRS_AT_ONCE = 1024 };

/* Adds those pairs of triangles of a batch that intersect to the worker of the same number. */
static void test_pairs(const check_work *work, uint32_t index) {
    const intersection_kernels *kernels = intersection_kernels_of(work->check->mesh->context);
    traversal_worker *batch = &work->traversal->workers[index];
    intersection_worker *worker = &work->check->workers[index];
    for (uint32_t begin = 0; begin < batch->pair_count; begin += PAIRS_AT_ONCE) {
        triangle_pair *pairs = batch->pairs + begin, crossing[PAIRS_AT_ONCE];
        uint32_t rest = batch->pair_count - begin, crossing_count;
        uint32_t undecided = kernels->reject_disjoint(triangles_of(work), work->positions, pairs,
                                                      rest < PAIRS_AT_ONCE ? rest : PAIRS_AT_ONCE,
                                                      work->check->kinds, crossing, &crossing_count);
        for (uint32_t i = 0; i < crossing_count; i++) add_crossing(work, worker, crossing[i]);
        for (uint32_t i = 0; i < undecided; i++) test_pair(work, worker, pairs[i]);
    }
}

/* Adds the pairs of a batch that intersect to the worker of the same number. */
static void find_pairs_of_batch(const check_work *work, uint32_t index) {
    name_triangles(work, &work->traversal->workers[index]);
    test_pairs(work, index);
}

static void test_batch(void *data, uint32_t index) {
    find_pairs_of_batch(data, index);
}

/* ---- pairs that share a vertex ------------------------------------------------------------------------- */

/* Is a component looked at with itself? The traversal asks the same of trees. */
static bool component_counts(const check_work *work, uint32_t component) {
    const static_check *c = work->check;
    if (c->collapsed != NULL && c->collapsed[component]) return false;
    if (c->objects == NULL) return !component_is_obstacle(c->mesh, component);
    const object_set *own = &c->objects[c->component_objects[component]];
    return object_sets_may_meet(own, own);
}

static bool is_inactive(const bvh *hierarchy, uint32_t triangle) {
    uint32_t slot = hierarchy->slots[triangle];
    return (hierarchy->leaf_inactive[slot / LANES] >> slot % LANES & 1) != 0;
}

static bool adjacent_pair_counts(const check_work *work, const uint32_t pair[2]) {
    const static_check *c = work->check;
    if (!c->unproven[pair[0]] || !c->unproven[pair[1]]) return false;
    return !work->traversal->skips_inactive || !is_inactive(work->bvh, pair[0]) ||
           !is_inactive(work->bvh, pair[1]);
}

static void test_stars(void *data, uint32_t index) {
    const check_work *work = data;
    traversal_worker *batch = &work->traversal->workers[index];
    star_cursor *cursor = &work->check->workers[index].stars;
    uint32_t pair[2];
    batch->pair_count = 0;
    while (batch->pair_count < TRAVERSAL_BATCH_SIZE &&
           vertex_stars_next_pair(&work->check->stars, cursor, pair)) {
        batch->pairs[batch->pair_count] = (triangle_pair){pair[0], pair[1]};
        batch->pair_count += adjacent_pair_counts(work, pair);
    }
    test_pairs(work, index);
}

/* Does any pair of a star count? */
static bool star_counts(const check_work *work, uint32_t vertex) {
    const cscd_mesh *mesh = work->check->mesh;
    uint32_t begin = mesh->vertex_star_offsets[vertex], end = mesh->vertex_star_offsets[vertex + 1];
    if (begin == end || !component_counts(work, mesh->triangle_components[mesh->vertex_stars[begin]]))
        return false;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t t = mesh->vertex_stars[i];
        if (work->check->unproven[t] && (!work->traversal->skips_inactive || !is_inactive(work->bvh, t)))
            return true;
    }
    return false;
}

/* Pairs that nobody asks for are not listed either. */
static void mark_clear_stars(void *data, uint32_t index) {
    const check_work *work = data;
    static_check *check = work->check;
    uint64_t count = check->mesh->vertex_count, workers = check->worker_count;
    uint32_t begin = (uint32_t)(count * index / workers), end = (uint32_t)(count * (index + 1) / workers);
    check->workers[index].stars = star_cursor_over(begin, end);
    vertex_stars_mark_clear(&check->stars, begin, end);
    for (uint32_t v = begin; v < end; v++) {
        if (!check->stars.clear[v] && !star_counts(work, v)) check->stars.clear[v] = true;
    }
}

/* ---- triangles without area ---------------------------------------------------------------------------- */

static bool has_no_area(const check_work *work, uint32_t triangle) {
    const double *corners[3];
    for (int i = 0; i < 3; i++)
        corners[i] = work->positions + (size_t)work->check->mesh->triangles[triangle][i] * 3;
    return collinear(corners[0], corners[1], corners[2]);
}

enum { AREA_BATCH = 512 };

/* Finds the signs of the triangles begin to end - 1, at most AREA_BATCH, and marks those of the unproven ones that have no
 * area. */
static void mark_zero_area(const check_work *work, intersection_worker *worker, uint32_t begin,
                           uint32_t end) {
    const static_check *check = work->check;
    const vertex_stars *stars = &check->stars;
    uint32_t list[AREA_BATCH], count = 0;
    assert(end - begin <= AREA_BATCH);
    for (uint32_t t = begin; t < end; t++) {
        list[count] = t;
        count += check->unproven[t] || work->by_stars;
    }
    memset(check->crossing + begin, false, (end - begin) * sizeof *check->crossing);
    intersection_kernels_of(check->mesh->context)
        ->sign_normals(triangles_of(work), work->positions, list, count, stars->normals, stars->rises);
    for (uint32_t i = 0; i < count; i++) {
        if (stars->normals[list[i]] != 0 || !check->unproven[list[i]] || !has_no_area(work, list[i]))
            continue;
        check->crossing[list[i]] = true;
        if (worker->zero_area_triangles++ == 0) worker->first_zero_area = list[i];
    }
}

/* Empties a worker, and looks for triangles without area in its share of the mesh. */
static void count_zero_area(void *data, uint32_t index) {
    const check_work *work = data;
    const static_check *check = work->check;
    intersection_worker *worker = &check->workers[index];
    uint64_t count = check->mesh->triangle_count, workers = check->worker_count;
    uint32_t begin = (uint32_t)(count * index / workers), end = (uint32_t)(count * (index + 1) / workers);
    *worker = (intersection_worker){.items = worker->items,
                                    .notes = worker->notes,
                                    .capacity = worker->capacity,
                                    .note_capacity = worker->note_capacity,
                                    .first_zero_area = UINT32_MAX};
    for (uint32_t t = begin; t < end; t += AREA_BATCH)
        mark_zero_area(work, worker, t, end - t < AREA_BATCH ? end : t + AREA_BATCH);
}

/* ---- all of it ----------------------------------------------------------------------------------------- */

static void mark_crossing(static_check *c) {
    const uint32_t *components = c->mesh->triangle_components;
    for (uint32_t i = 0; i < c->worker_count; i++) {
        const intersection_worker *worker = &c->workers[i];
        for (size_t j = 0; j < worker->count; j++) {
            found_pair pair = worker->items[j];
            if (components[pair.a] != components[pair.b] || (c->kinds && worker->notes[j].unlisted)) continue;
            c->crossing[pair.a] = c->crossing[pair.b] = true;
        }
    }
}

static void spill_pairs(static_check *c) {
    bool full = false;
    for (uint32_t i = 0; i < c->worker_count; i++)
        full |= c->workers[i].count - c->workers[i].settled >= c->limit;
    if (!full) return;
    mark_crossing(c);
    if (c->spill != NULL) c->spill(c->spill_data);
    for (uint32_t i = 0; c->spill == NULL && i < c->worker_count; i++) c->workers[i].count = 0;
}

/* Empties the workers, and looks for triangles without area. */
static void begin_check(check_work *work) {
    parallel_run(work->check->mesh->context->threads, work->check->worker_count, count_zero_area, work);
}

static bool any_pairs(const traversal *t, uint32_t worker_count) {
    for (uint32_t i = 0; i < worker_count; i++) {
        if (t->workers[i].pair_count > 0) return true;
    }
    return false;
}

static cscd_status end_round(static_check *check) {
    for (uint32_t i = 0; i < check->worker_count; i++) {
        if (check->workers[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
    }
    spill_pairs(check);
    return CSCD_OK;
}

/* Workers whose batches are not full find nothing in the next round; in the last one nobody finds anything. */
static cscd_status compare_adjacent(check_work *work) {
    static_check *check = work->check;
    cscd_context *context = check->mesh->context;
    cscd_status status = CSCD_OK;
    parallel_run(context->threads, check->worker_count, mark_clear_stars, work);
    for (bool more = true; more && status == CSCD_OK;) {
        if (!progress_go_on(&context->progress, 0.0)) break;
        parallel_run(context->threads, check->worker_count, test_stars, work);
        more = any_pairs(work->traversal, check->worker_count);
        status = end_round(check);
    }
    return status;
}

static cscd_status compare_found(check_work *work) {
    static_check *check = work->check;
    cscd_context *context = check->mesh->context;
    cscd_status status = CSCD_OK;
    for (bool more = true; more && status == CSCD_OK;) {
        if (!progress_go_on(&context->progress, traversal_done(work->traversal))) break;
        status = traversal_round(work->traversal, &more);
        if (status != CSCD_OK) break;
        parallel_run(context->threads, check->worker_count, test_batch, work);
        status = end_round(check);
    }
    return status;
}

static cscd_status compare_triangles(check_work *work, bvh *hierarchy, traversal_pass pass) {
    static_check *check = work->check;
    assert(check->worker_count == work->traversal->worker_count);
    begin_check(work);
    if (check->mesh->triangle_count == 0) return CSCD_OK;
    if (work->by_stars)
        bvh_skip_all_adjacent(hierarchy);
    else
        bvh_skip_adjacent(hierarchy, NULL);
    traversal_begin(work->traversal, hierarchy, pass);
    cscd_status status = work->by_stars ? compare_adjacent(work) : CSCD_OK;
    if (status == CSCD_OK) status = compare_found(work);
    if (status != CSCD_OK) return status;
    if (!even_out_workers(check->mesh->context, check->workers, check->worker_count, check->kinds))
        return CSCD_OUT_OF_MEMORY;
    return context_progress_status(
        check->mesh->context); /* before the caller believes that nothing more was found */
}

/* Stars are seen as a whole, so that they pay where most triangles are compared. */
static bool most_are_unproven(const static_check *c) {
    uint32_t count = 0, all = c->mesh->triangle_count;
    for (uint32_t t = 0; t < all; t++) count += c->unproven[t];
    return count > all / 2;
}

cscd_status static_check_unproven(static_check *c, traversal *t, bvh *hierarchy, const double *positions) {
    check_work work = {
        .check = c, .traversal = t, .bvh = hierarchy, .positions = positions, .own_component_only = true};
    bvh_mark_unproven(hierarchy, c->unproven);
    work.by_stars = most_are_unproven(c);
    cscd_status status = compare_triangles(&work, hierarchy, TRAVERSAL_UNPROVEN);
    if (status == CSCD_OK) mark_crossing(c);
    return status;
}

static cscd_status compare_all(check_work *work, bvh *hierarchy) {
    static_check *c = work->check;
    memset(c->unproven, true, c->mesh->triangle_count * sizeof *c->unproven);
    work->by_stars = true;
    cscd_status status = compare_triangles(work, hierarchy, TRAVERSAL_KEPT);
    if (status == CSCD_OK) mark_crossing(c);
    return status;
}

cscd_status static_check_all(static_check *c, traversal *t, bvh *hierarchy, const double *positions) {
    check_work work = {.check = c, .traversal = t, .bvh = hierarchy, .positions = positions};
    return compare_all(&work, hierarchy);
}

cscd_status static_check_kinds(static_check *c, traversal *t, bvh *hierarchy, const double *positions,
                               const uint32_t *names) {
    check_work work = {.check = c, .traversal = t, .bvh = hierarchy, .positions = positions, .names = names};
    c->kinds = true;
    cscd_status status = compare_all(&work, hierarchy);
    c->kinds = false;
    return status;
}

/* ---- the first pairs ----------------------------------------------------------------------------------- */

/* Tasks are done in rounds, larger and larger ones; after each round the pairs are counted in the order of the tasks. A task
 * that alone has enough pairs makes all later ones needless. */

/* The pairs of a task: a range of the list of a worker. */
typedef struct task_pairs {
    uint32_t worker;
    size_t begin, count;
} task_pairs;

typedef struct pair_hunt {
    check_work work;
    const pair_quest *quest;
    atomic_uint next; /* task of the round */
    uint32_t end;     /* of the round */
    atomic_uint last; /* the last task that is needed */
    task_pairs tasks[TRAVERSAL_TASKS_MAX];
} pair_hunt;

/* Removes the pairs from first on that do not count. */
static void keep_counting(const pair_hunt *hunt, intersection_worker *worker, size_t first) {
    size_t kept = first;
    for (size_t i = first; i < worker->count; i++) {
        intersection_worker_move(worker, i, kept);
        kept += hunt->quest->counts(hunt->quest->data, worker->items[i], worker->notes[i]);
    }
    worker->count = kept;
}

static void lower_last(pair_hunt *hunt, uint32_t task) {
    uint32_t last = atomic_load(&hunt->last);
    while (task < last && !atomic_compare_exchange_weak(&hunt->last, &last, task)) {
    }
}

/* Later findings cannot take pairs of this task away, unless the caller asks for them once more. */
static bool task_is_enough(const pair_hunt *hunt, size_t count) {
    return hunt->quest->stays == NULL && count >= hunt->quest->enough;
}

static void search_task(pair_hunt *hunt, uint32_t index, uint32_t task) {
    traversal *t = hunt->work.traversal;
    intersection_worker *worker = &hunt->work.check->workers[index];
    size_t begin = worker->count;
    bool enough = false;
    traversal_begin_task(t, index, task);
    while (!enough && task <= atomic_load(&hunt->last) && !worker->out_of_memory &&
           traversal_fill_from_task(t, index)) {
        size_t before = worker->count;
        find_pairs_of_batch(&hunt->work, index);
        keep_counting(hunt, worker, before);
        enough = task_is_enough(hunt, worker->count - begin);
    }
    hunt->tasks[task] = (task_pairs){index, begin, worker->count - begin};
    if (enough) lower_last(hunt, hunt->quest->any ? 0 : task);
}

/* A worker does one task after the other. */
static void search_tasks(void *data, uint32_t index) {
    pair_hunt *hunt = data;
    progress *p = &hunt->work.check->mesh->context->progress;
    for (;;) {
        uint32_t task = atomic_fetch_add(&hunt->next, 1);
        if (task >= hunt->end || task > atomic_load(&hunt->last)) return;
        if (!progress_go_on(p, (double)task / hunt->work.traversal->share_count)) return;
        search_task(hunt, index, task);
    }
}

static cscd_status run_round(pair_hunt *hunt, uint32_t begin, uint32_t end) {
    static_check *c = hunt->work.check;
    cscd_context *context = c->mesh->context;
    for (uint32_t task = begin; task < end; task++) hunt->tasks[task] = (task_pairs){.count = 0};
    atomic_store(&hunt->next, begin);
    hunt->end = end;
    parallel_run(context->threads, c->worker_count, search_tasks, hunt);
    for (uint32_t i = 0; i < c->worker_count; i++) {
        if (c->workers[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
    }
    cscd_status status = traversal_status(hunt->work.traversal);
    return status == CSCD_OK ? context_progress_status(context) : status;
}

/* Removes the pairs of a task that do not stay, and those beyond the number that is still wanted. */
static void settle_task(pair_hunt *hunt, task_pairs *task, size_t wanted) {
    intersection_worker *worker = &hunt->work.check->workers[task->worker];
    const pair_quest *quest = hunt->quest;
    size_t kept = 0;
    for (size_t i = 0; i < task->count && kept < wanted; i++) {
        if (quest->stays != NULL && !quest->stays(quest->data, worker->items[task->begin + i])) continue;
        intersection_worker_move(worker, task->begin + i, task->begin + kept++);
    }
    task->count = kept;
}

/* Moves the pairs of the tasks together. A worker has done its tasks in ascending order. */
static void close_gaps(pair_hunt *hunt, uint32_t task_count) {
    static_check *c = hunt->work.check;
    for (uint32_t i = 0; i < c->worker_count; i++) c->workers[i].count = 0;
    for (uint32_t i = 0; i < task_count; i++) {
        const task_pairs *task = &hunt->tasks[i];
        intersection_worker *worker = &c->workers[task->worker];
        for (size_t j = 0; j < task->count; j++)
            intersection_worker_move(worker, task->begin + j, worker->count++);
    }
    for (uint32_t i = 0; i < c->worker_count; i++) c->workers[i].settled = c->workers[i].count;
}

/* With one worker, no task is begun that is not needed. */
static cscd_status run_rounds(pair_hunt *hunt) {
    uint32_t workers = hunt->work.check->worker_count, all = hunt->work.traversal->share_count;
    uint32_t size = workers, end = 0;
    size_t found = 0;
    while (end < all && found < hunt->quest->enough) {
        uint32_t begin = end;
        end = all - begin < size ? all : begin + size;
        cscd_status status = run_round(hunt, begin, end);
        if (status != CSCD_OK) return status;
        for (uint32_t i = begin; i < end; i++) {
            settle_task(hunt, &hunt->tasks[i], hunt->quest->enough - found);
            found += hunt->tasks[i].count;
        }
        if (workers > 1) size *= 2;
    }
    close_gaps(hunt, end);
    return CSCD_OK;
}

cscd_status first_pairs_find(static_check *c, traversal *t, bvh *hierarchy, const double *positions,
                             const uint32_t *names, const pair_quest *quest) {
    pair_hunt hunt = {.quest = quest};
    hunt.work =
        (check_work){.check = c, .traversal = t, .bvh = hierarchy, .positions = positions, .names = names};
    atomic_store(&hunt.last, UINT32_MAX);
    memset(c->unproven, true, c->mesh->triangle_count * sizeof *c->unproven);
    begin_check(&hunt.work);
    if (c->mesh->triangle_count == 0) return CSCD_OK;
    bvh_skip_adjacent(hierarchy, NULL);
    cscd_status status = traversal_begin_tasks(t, hierarchy, TRAVERSAL_KEPT);
    c->kinds = true;
    if (status == CSCD_OK) status = run_rounds(&hunt);
    c->kinds = false;
    return status;
}
