/* Finds the first pairs of triangles that intersect. Tasks are done in rounds, larger and larger ones; after each round
 * the pairs are counted in the order of the tasks. A task that alone has enough pairs makes all later ones needless. */
#include "runtime/intersections/first_pairs.h"

#include <stdatomic.h>
#include <string.h>

/* The pairs of a task: so many from begin on in the list of a lane. */
typedef struct task_pairs {
    uint32_t lane;
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

/* ---- a round ------------------------------------------------------------------------------------------- */

/* Removes the pairs from first on that do not count. */
static void keep_counting(const pair_hunt *hunt, intersection_lane *lane, size_t first) {
    size_t kept = first;
    for (size_t i = first; i < lane->count; i++) {
        intersection_lane_move(lane, i, kept);
        kept += hunt->quest->counts(hunt->quest->data, lane->items[i], lane->notes[i]);
    }
    lane->count = kept;
}

static void lower_last(pair_hunt *hunt, uint32_t task) {
    uint32_t last = atomic_load(&hunt->last);
    while (task < last && !atomic_compare_exchange_weak(&hunt->last, &last, task)) {
    }
}

/* Nothing that is found later can take pairs of this task away, unless they are asked for once more. */
static bool task_is_enough(const pair_hunt *hunt, size_t count) {
    return hunt->quest->stays == NULL && count >= hunt->quest->enough;
}

static void search_task(pair_hunt *hunt, uint32_t index, uint32_t task) {
    traversal *t = hunt->work.traversal;
    intersection_lane *lane = &hunt->work.check->lanes[index];
    size_t begin = lane->count;
    bool enough = false;
    traversal_begin_task(t, index, task);
    while (!enough && task <= atomic_load(&hunt->last) && !lane->out_of_memory &&
           traversal_fill_from_task(t, index)) {
        size_t before = lane->count;
        static_check_test_batch(&hunt->work, index);
        keep_counting(hunt, lane, before);
        enough = task_is_enough(hunt, lane->count - begin);
    }
    hunt->tasks[task] = (task_pairs){index, begin, lane->count - begin};
    if (enough) lower_last(hunt, hunt->quest->any ? 0 : task);
}

/* A lane does one task after the other. */
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
    parallel_run(context->threads, c->lane_count, search_tasks, hunt);
    for (uint32_t i = 0; i < c->lane_count; i++) {
        if (c->lanes[i].out_of_memory) return CSCD_OUT_OF_MEMORY;
    }
    cscd_status status = traversal_status(hunt->work.traversal);
    return status == CSCD_OK ? context_progress_status(context) : status;
}

/* ---- after a round ------------------------------------------------------------------------------------- */

/* Removes the pairs of a task that do not stay, and those beyond the number that is still wanted. */
static void settle_task(pair_hunt *hunt, task_pairs *task, size_t wanted) {
    intersection_lane *lane = &hunt->work.check->lanes[task->lane];
    const pair_quest *quest = hunt->quest;
    size_t kept = 0;
    for (size_t i = 0; i < task->count && kept < wanted; i++) {
        if (quest->stays != NULL && !quest->stays(quest->data, lane->items[task->begin + i])) continue;
        intersection_lane_move(lane, task->begin + i, task->begin + kept++);
    }
    task->count = kept;
}

/* Moves the pairs of the tasks together. A lane has done its tasks in ascending order. */
static void close_gaps(pair_hunt *hunt, uint32_t task_count) {
    static_check *c = hunt->work.check;
    for (uint32_t i = 0; i < c->lane_count; i++) c->lanes[i].count = 0;
    for (uint32_t i = 0; i < task_count; i++) {
        const task_pairs *task = &hunt->tasks[i];
        intersection_lane *lane = &c->lanes[task->lane];
        for (size_t j = 0; j < task->count; j++) intersection_lane_move(lane, task->begin + j, lane->count++);
    }
    for (uint32_t i = 0; i < c->lane_count; i++) c->lanes[i].settled = c->lanes[i].count;
}

/* With one lane, no task is begun that is not needed. */
static cscd_status run_rounds(pair_hunt *hunt) {
    uint32_t lanes = hunt->work.check->lane_count, all = hunt->work.traversal->share_count;
    uint32_t size = lanes, end = 0;
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
        if (lanes > 1) size *= 2;
    }
    close_gaps(hunt, end);
    return CSCD_OK;
}

cscd_status first_pairs_find(static_check *c, traversal *t, bvh *f, const double *positions,
                             const uint32_t *names, const pair_quest *quest) {
    pair_hunt hunt = {.quest = quest};
    hunt.work = (check_work){.check = c, .traversal = t, .bvh = f, .positions = positions, .names = names};
    atomic_store(&hunt.last, UINT32_MAX);
    memset(c->unproven, true, c->mesh->triangle_count * sizeof *c->unproven);
    static_check_begin(&hunt.work);
    if (c->mesh->triangle_count == 0) return CSCD_OK;
    bvh_skip_adjacent(f, NULL);
    cscd_status status = traversal_begin_tasks(t, f, TRAVERSAL_KEPT);
    c->kinds = true;
    if (status == CSCD_OK) status = run_rounds(&hunt);
    c->kinds = false;
    return status;
}
