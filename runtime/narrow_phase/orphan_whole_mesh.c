/* The search for the orphan pairs of a whole mesh, on all threads. */
#include "runtime/narrow_phase/orphan_edges.h"

enum { TRIANGLES_PER_ASK = 256, TRIANGLES_PER_TASK = 1 << 14, EDGES_PER_TASK = 3 * TRIANGLES_PER_TASK / 2 };

/* Each task looks at some triangles. What it knows is the same for all tasks, and its lists are its own. */
typedef struct whole_search {
    const cscd_mesh *mesh;
    orphan_search *tasks;
    bool *uneven;
    uint32_t task_count;
    atomic_size_t grown, looks;
} whole_search;

typedef struct feature_range {
    uint32_t begin, end;
} feature_range;

static feature_range range_of_task(uint32_t task, uint32_t each, uint32_t count) {
    uint32_t begin = task * each < count ? task * each : count;
    return (feature_range){begin, count - begin < each ? count : begin + each};
}

static void find_features(void *data, uint32_t task) {
    const whole_search *whole = data;
    feature_range range = range_of_task(task, TRIANGLES_PER_TASK, whole->mesh->triangle_count);
    for (uint32_t t = range.begin; t < range.end; t++)
        whole->tasks[0].features[t] = (uint8_t)orphan_search_features(whole->mesh, t);
}

static void find_corners(void *data, uint32_t task) {
    const whole_search *whole = data;
    feature_range range = range_of_task(task, EDGES_PER_TASK, whole->mesh->edge_count);
    for (uint32_t e = range.begin; e < range.end; e++)
        orphan_search_opposites(whole->mesh, e, whole->tasks[0].opposites[e]);
}

static void search_triangles(void *data, uint32_t task) {
    const whole_search *whole = data;
    orphan_search *f = &whole->tasks[task];
    feature_range range = range_of_task(task, TRIANGLES_PER_TASK, whole->mesh->triangle_count);
    progress *p = &whole->mesh->context->progress;
    for (uint32_t t = range.begin; t < range.end && !orphan_search_has_enough(f); t++) {
        if ((t - range.begin) % TRIANGLES_PER_ASK == 0 && !progress_go_on(p, 0.0)) return;
        if (triangle_of_obstacle(whole->mesh, t)) continue;
        if (orphan_edges_near(whole->mesh, whole->uneven, t))
            orphan_search_around(f, t);
        else
            orphan_edges_vertices(f, t);
        orphan_edges_of(f, t);
    }
}

static void append_list(growing_list *list, uint32_t (*all)[2], size_t *count) {
    for (size_t i = 0; i < list->count; i++) copy_vertices(list->items[i], 2, all[(*count)++]);
}

/* Joins the lists in the order of the tasks. */
static cscd_status join_lists(const whole_search *whole, orphan_pairs *out) {
    orphan_pairs all = {.vf = NULL};
    size_t vf = 0, ee = 0;
    for (uint32_t i = 0; i < whole->task_count; i++) {
        vf += whole->tasks[i].vf.count;
        ee += whole->tasks[i].ee.count;
    }
    array_list lists = {{ARRAY(all.vf, vf), ARRAY(all.ee, ee)}};
    if (!context_reserve_all(whole->mesh->context, lists)) return CSCD_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < whole->task_count; i++) {
        append_list(&whole->tasks[i].vf, all.vf, &all.vf_count);
        append_list(&whole->tasks[i].ee, all.ee, &all.ee_count);
    }
    *out = all;
    return CSCD_OK;
}

static cscd_status end_whole(const whole_search *whole, orphan_pairs *out, bool *too_many) {
    cscd_context *context = whole->mesh->context;
    size_t count = 0, looks = 0;
    bool failed = false, enough = false;
    for (uint32_t i = 0; i < whole->task_count; i++) {
        const orphan_search *f = &whole->tasks[i];
        count += f->vf.count + f->ee.count;
        looks += f->looks;
        failed |= f->out_of_memory;
        enough |= orphan_search_has_enough(f);
    }
    *too_many = !failed && (enough || count > whole->tasks[0].most || looks > whole->tasks[0].looks_most);
    cscd_status status = failed ? CSCD_OUT_OF_MEMORY : CSCD_OK;
    if (status == CSCD_OK && !*too_many) status = join_lists(whole, out);
    for (uint32_t i = 0; i < whole->task_count; i++) {
        context_free(context, whole->tasks[i].vf.items);
        context_free(context, whole->tasks[i].ee.items);
    }
    return status;
}

static void search_whole(whole_search *whole, const orphan_search *known) {
    parallel *threads = whole->mesh->context->threads;
    uint32_t edge_tasks = (whole->mesh->edge_count + EDGES_PER_TASK - 1) / EDGES_PER_TASK;
    for (uint32_t i = 0; i < whole->task_count; i++) whole->tasks[i] = *known;
    parallel_run(threads, whole->task_count, find_features, whole);
    parallel_run(threads, edge_tasks, find_corners, whole);
    orphan_edges_mark(known, whole->uneven);
    parallel_run(threads, whole->task_count, search_triangles, whole);
}

cscd_status orphan_pairs_create(const cscd_mesh *mesh, orphan_pairs *out, bool *too_many) {
    whole_search whole = {.mesh = mesh, .task_count = mesh->triangle_count / TRIANGLES_PER_TASK + 1};
    orphan_search known = {.mesh = mesh,
                           .most = (size_t)mesh->triangle_count * ORPHANS_PER_TRIANGLE,
                           .looks_most = (size_t)mesh->triangle_count * LOOKS_PER_TRIANGLE,
                           .grown = &whole.grown,
                           .all_looks = &whole.looks};
    atomic_init(&whole.grown, 0);
    atomic_init(&whole.looks, 0);
    *out = (orphan_pairs){.vf = NULL};
    array_list arrays = {{ARRAY(known.features, mesh->triangle_count),
                          ARRAY(known.opposites, mesh->edge_count), ARRAY(known.even, mesh->edge_count),
                          ARRAY(whole.uneven, mesh->vertex_count), ARRAY(whole.tasks, whole.task_count)}};
    /* Zeros say of a triangle or an edge that a host's loop has left out that nothing is to be found there. */
    if (!context_allocate_all(mesh->context, arrays)) return CSCD_OUT_OF_MEMORY;
    progress_outer outer = progress_enter(&mesh->context->progress, "orphan pairs");
    search_whole(&whole, &known);
    progress_leave(&mesh->context->progress, outer);
    cscd_status status = end_whole(&whole, out, too_many);
    if (status == CSCD_OK) status = context_progress_status(mesh->context);
    if (status != CSCD_OK) orphan_pairs_free(mesh->context, out);
    context_free_all(mesh->context, arrays);
    return status;
}
