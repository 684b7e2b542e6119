/* Knowledge about the triangles at the start of an interval: which are clean, and at which positions. */
#include "runtime/culling/culling.h"

#include <assert.h>
#include <stdatomic.h>
#include <string.h>

/* The share of a component that has to be clean, so that culling pays. Measured. */
static const double share_worth_it = 0.9;

enum { BACKOFF_MAX = 16, VERTICES_PER_TASK = 2048 };

array_list start_states_arrays(start_states *s) {
    size_t triangles = s->mesh->triangle_count, components = s->mesh->component_count;
    return (array_list){{ARRAY(s->positions, (size_t)s->mesh->vertex_count * 3),
                         ARRAY(s->triangles, triangles), ARRAY(s->saved, triangles),
                         ARRAY(s->clean, triangles), ARRAY(s->queue, triangles), ARRAY(s->of, components),
                         ARRAY(s->component_scratch, components), ARRAY(s->largest, components)}};
}

void component_start_begin(component_start *start) {
    *start = (component_start){.moved = true, .culls = true};
}

cscd_status start_states_create(const cscd_mesh *mesh, start_states *out) {
    start_states s = {.context = mesh->context, .mesh = mesh, .share_worth_it = share_worth_it};
    if (!context_allocate_all(s.context, start_states_arrays(&s))) return CSCD_OUT_OF_MEMORY;
    for (uint32_t c = 0; c < mesh->component_count; c++) component_start_begin(&s.of[c]);
    *out = s;
    return CSCD_OK;
}

void start_states_destroy(start_states *s) {
    context_free_all(s->context, start_states_arrays(s));
    *s = (start_states){0};
}

/* ---- the positions seen last --------------------------------------------------------------------------- */

/* Data that the tasks of a comparison with x, or of a copy of x, share. */
typedef struct position_work {
    start_states *s;
    const double *x;
    atomic_bool differ;
} position_work;

static size_t task_begin(uint32_t index) {
    return (size_t)index * VERTICES_PER_TASK * 3;
}

static size_t task_bytes(const start_states *s, uint32_t index) {
    uint32_t rest = s->mesh->vertex_count - index * VERTICES_PER_TASK;
    return (rest < VERTICES_PER_TASK ? rest : VERTICES_PER_TASK) * sizeof(double[3]);
}

static void compare_task(void *data, uint32_t index) {
    position_work *work = data;
    size_t begin = task_begin(index);
    if (memcmp(work->s->positions + begin, work->x + begin, task_bytes(work->s, index)) != 0)
        atomic_store(&work->differ, true);
}

static void copy_task(void *data, uint32_t index) {
    position_work *work = data;
    size_t begin = task_begin(index);
    memcpy(work->s->positions + begin, work->x + begin, task_bytes(work->s, index));
}

static void run_over_vertices(parallel_task *task, position_work *work) {
    uint32_t tasks = work->s->mesh->vertex_count / VERTICES_PER_TASK;
    tasks += work->s->mesh->vertex_count % VERTICES_PER_TASK != 0;
    parallel_run(work->s->context->threads, tasks, task, work);
}

static void remember_positions(start_states *s, const double *x) {
    position_work work = {.s = s, .x = x};
    run_over_vertices(copy_task, &work);
    s->revision++;
    s->known = true;
    s->partly = false;
}

bool start_states_hold(start_states *s, const double *x) {
    if (!s->known || s->partly) return false;
    position_work work = {.s = s, .x = x};
    run_over_vertices(compare_task, &work);
    return !atomic_load(&work.differ);
}

/* 0 and -0 are the same place; otherwise every bit counts. */
static bool vertex_moved(const start_states *s, const double *x, uint32_t vertex) {
    const double *a = s->positions + (size_t)vertex * 3, *b = x + (size_t)vertex * 3;
    return a[0] != b[0] || a[1] != b[1] || a[2] != b[2];
}

/* Mostly an object rests as a whole or moves as a whole. */
static void begin_object(start_states *s, const double *x, const cscd_object *object, bool *moved) {
    const cscd_mesh *mesh = s->mesh;
    const uint32_t *components = mesh->triangle_components;
    size_t first = (size_t)object->first_vertex * 3, size = object->vertex_count * sizeof(double[3]);
    uint32_t begin = object->first_triangle, end = begin + object->triangle_count;
    if (memcmp(s->positions + first, x + first, size) == 0) return;
    for (uint32_t t = begin; t < end; t++) {
        bool *whole = &moved[components[t]];
        for (int i = 0; i < 3 && !*whole; i++) *whole = vertex_moved(s, x, mesh->triangles[t][i]);
    }
    for (uint32_t t = begin; t < end; t++) {
        if (moved[components[t]]) s->triangles[t] = TRIANGLE_UNKNOWN;
    }
}

void start_states_begin(start_states *s, const double *x) {
    const cscd_mesh *mesh = s->mesh;
    bool *moved = s->component_scratch;
    for (uint32_t c = 0; c < mesh->component_count; c++) moved[c] = !s->known;
    if (!s->known) memset(s->triangles, TRIANGLE_UNKNOWN, mesh->triangle_count);
    for (uint32_t i = 0; s->known && i < mesh->object_count; i++)
        begin_object(s, x, &mesh->objects[i], moved);
    for (uint32_t c = 0; c < mesh->component_count; c++) s->of[c].moved |= moved[c];
    s->counted = false;
    remember_positions(s, x);
}

/* ---- numbers per component ----------------------------------------------------------------------------- */

static void count_run(component_start *start, const uint8_t *states, uint32_t count) {
    uint32_t unknown = 0, crossing = 0, clean = 0;
    for (uint32_t i = 0; i < count; i++) {
        unknown += states[i] == TRIANGLE_UNKNOWN;
        crossing += states[i] == TRIANGLE_CROSSING;
        clean += states[i] == TRIANGLE_CLEAN;
    }
    start->unknown += unknown;
    start->crossing += crossing;
    start->clean += clean;
}

/* Counts run by run, because most triangles follow one of their own component. */
void start_states_count(start_states *s) {
    const uint32_t *components = s->mesh->triangle_components;
    uint32_t count = s->mesh->triangle_count;
    if (s->counted) return;
    for (uint32_t c = 0; c < s->mesh->component_count; c++)
        s->of[c].unknown = s->of[c].crossing = s->of[c].clean = 0;
    for (uint32_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && components[end] == components[begin];) end++;
        count_run(&s->of[components[begin]], s->triangles + begin, end - begin);
    }
    s->counted = true;
}

static void count_again(start_states *s) {
    s->counted = false;
    start_states_count(s);
}

const bool *start_states_clean(const start_states *s) {
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) s->clean[t] = s->triangles[t] == TRIANGLE_CLEAN;
    return s->clean;
}

/* ---- which free triangles are clean -------------------------------------------------------------------- */

/* The state of a triangle while its patch is gathered; no triangle has it when a function below returns to the
 * outside. */
enum { TRIANGLE_GATHERED = TRIANGLE_CLEAN + 1 };

/* Appends the free triangles across the edges of one to the queue, in their new state. */
static uint32_t append_neighbours(start_states *s, uint32_t triangle, uint8_t state, uint32_t end) {
    const cscd_mesh *mesh = s->mesh;
    for (int i = 0; i < 3; i++) {
        uint32_t edge = mesh->triangle_edges[triangle][i];
        for (uint32_t j = mesh->edge_star_offsets[edge]; j < mesh->edge_star_offsets[edge + 1]; j++) {
            uint32_t neighbour = mesh->edge_stars[j];
            if (s->triangles[neighbour] != TRIANGLE_FREE) continue;
            s->triangles[neighbour] = state;
            s->queue[end++] = neighbour;
        }
    }
    return end;
}

/* Gives all free triangles that can be reached from the queue's triangles begin to end - 1 a new state; returns
 * the queue's new end. */
static uint32_t spread_state(start_states *s, uint8_t state, uint32_t begin, uint32_t end) {
    while (begin < end) end = append_neighbours(s, s->queue[begin++], state, end);
    assert(end <= s->mesh->triangle_count);
    return end;
}

/* Makes all triangles of a component clean if all of them are free. */
static void settle_embedded(start_states *s) {
    count_again(s);
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        const component_start *start = &s->of[s->mesh->triangle_components[t]];
        if (start->unknown == 0 && start->crossing == 0) s->triangles[t] = TRIANGLE_CLEAN;
    }
}

static void spread_clean(start_states *s) {
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        bool reached = false;
        for (int i = 0; i < 3 && s->triangles[t] == TRIANGLE_FREE; i++) {
            uint32_t edge = s->mesh->triangle_edges[t][i];
            for (uint32_t j = s->mesh->edge_star_offsets[edge]; j < s->mesh->edge_star_offsets[edge + 1]; j++)
                reached |= s->triangles[s->mesh->edge_stars[j]] == TRIANGLE_CLEAN;
        }
        if (!reached) continue;
        s->triangles[t] = TRIANGLE_CLEAN;
        s->queue[0] = t;
        spread_state(s, TRIANGLE_CLEAN, 0, 1);
    }
    count_again(s);
}

static bool mostly_clean(const start_states *s, uint32_t component) {
    return s->of[component].clean >= s->mesh->components[component].triangle_count - s->of[component].clean;
}

/* Gathers the patches of free triangles that are not clean, and notes the largest one of each component, the
 * first of these if there are several. */
static void gather_patches(start_states *s) {
    uint32_t end = 0;
    for (uint32_t c = 0; c < s->mesh->component_count; c++) s->largest[c] = (free_patch){0, 0};
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        uint32_t component = s->mesh->triangle_components[t], begin = end;
        if (s->triangles[t] != TRIANGLE_FREE || mostly_clean(s, component)) continue;
        s->triangles[t] = TRIANGLE_GATHERED;
        s->queue[end] = t;
        end = spread_state(s, TRIANGLE_GATHERED, begin, begin + 1);
        if (end - begin > s->largest[component].count)
            s->largest[component] = (free_patch){begin, end - begin};
    }
}

/* In each component whose largest patch has more triangles than were clean, makes this patch clean instead of those. */
static void choose_patches(start_states *s) {
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        uint32_t component = s->mesh->triangle_components[t];
        bool demoted = s->largest[component].count > s->of[component].clean;
        if (s->triangles[t] == TRIANGLE_GATHERED || (demoted && s->triangles[t] == TRIANGLE_CLEAN))
            s->triangles[t] = TRIANGLE_FREE;
    }
    for (uint32_t c = 0; c < s->mesh->component_count; c++) {
        free_patch patch = s->largest[c];
        if (patch.count <= s->of[c].clean) continue;
        for (uint32_t i = 0; i < patch.count; i++) s->triangles[s->queue[patch.begin + i]] = TRIANGLE_CLEAN;
        s->of[c].clean = patch.count;
    }
}

/* Free triangles become clean where they are connected, over edges and through free triangles, to clean ones. If
 * less than half of a component is clean then, and its largest patch of other free triangles is larger than its
 * clean part, that patch becomes clean instead. If a component has no crossing and no unknown triangles, all its
 * triangles become clean. Takes linear time. */
static void find_clean_patches(start_states *s) {
    bool all_mostly_clean = true;
    settle_embedded(s);
    spread_clean(s);
    for (uint32_t c = 0; c < s->mesh->component_count; c++) all_mostly_clean &= mostly_clean(s, c);
    if (!all_mostly_clean) {
        gather_patches(s);
        choose_patches(s);
    }
    s->counted = false;
}

/* ---- static checks ------------------------------------------------------------------------------------- */

uint32_t start_states_mark_unproven(start_states *s, const bool *collapsed, bool *unproven) {
    const cscd_mesh *mesh = s->mesh;
    bool *wanted = s->component_scratch, any = false;
    uint32_t count = 0;
    start_states_count(s);
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        component_start *start = &s->of[c];
        bool may_be_culled = mesh->components[c].closed_manifold && !component_is_obstacle(mesh, c) &&
                             !(s->never_culled != NULL && s->never_culled[c]);
        if (s->adapts) may_be_culled &= start->chosen;
        if (collapsed != NULL) may_be_culled &= !collapsed[c];
        wanted[c] = may_be_culled && start->unknown > 0 && start->pause == 0;
        if (start->unknown > 0 && start->pause > 0) start->pause--;
        any |= wanted[c];
    }
    for (uint32_t t = 0; any && t < mesh->triangle_count; t++) {
        unproven[t] = wanted[mesh->triangle_components[t]] && s->triangles[t] < TRIANGLE_FREE;
        count += unproven[t];
    }
    return count;
}

/* Exponential backoff (1, 2, 4, 8, 16 intervals) while checks leave too few clean triangles for culling to
 * pay. */
static void back_off(const start_states *s, component_start *start, uint32_t triangle_count) {
    if (start_states_pay(s, start->clean, triangle_count)) {
        start->backoff = start->pause = 0;
    } else if (start->pause == 0) {
        start->backoff = start->backoff == 0            ? 1
                         : start->backoff < BACKOFF_MAX ? start->backoff * 2
                                                        : BACKOFF_MAX;
        start->pause = start->backoff;
    }
}

void start_states_checked(start_states *s, const bool *unproven, const bool *crossing) {
    const cscd_mesh *mesh = s->mesh;
    bool *checked = s->component_scratch;
    for (uint32_t c = 0; c < mesh->component_count; c++) checked[c] = false;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        /* The check ends the vouching of the caller; triangles that are not checked can be vouched for
         * again. */
        if (s->vouched && s->triangles[t] == TRIANGLE_CLEAN) s->triangles[t] = TRIANGLE_UNKNOWN;
        if (!unproven[t]) continue;
        checked[mesh->triangle_components[t]] = true;
        if (crossing[t])
            s->triangles[t] = TRIANGLE_CROSSING;
        else if (s->triangles[t] < TRIANGLE_FREE)
            s->triangles[t] = TRIANGLE_FREE;
    }
    s->vouched = false;
    find_clean_patches(s);
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        if (checked[c]) back_off(s, &s->of[c], mesh->components[c].triangle_count);
    }
}

void start_states_vouch(start_states *s) {
    start_states_count(s);
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        if (s->of[s->mesh->triangle_components[t]].crossing > 0 || s->triangles[t] == TRIANGLE_CLEAN)
            continue;
        s->triangles[t] = TRIANGLE_CLEAN;
        s->vouched = true;
    }
    s->counted = false;
}

/* ---- from one interval to the next --------------------------------------------------------------------- */

void start_states_end(start_states *s, const double *x, const bool *incomplete) {
    bool any = false;
    for (uint32_t c = 0; c < s->mesh->component_count; c++) any |= incomplete[c] || s->of[c].crossing > 0;
    for (uint32_t t = 0; any && t < s->mesh->triangle_count; t++) {
        if (incomplete[s->mesh->triangle_components[t]] || s->triangles[t] == TRIANGLE_CROSSING)
            s->triangles[t] = TRIANGLE_UNKNOWN;
    }
    s->counted &= !any;
    remember_positions(s, x);
}

void start_states_save(start_states *s) {
    memcpy(s->saved, s->triangles, s->mesh->triangle_count * sizeof *s->saved);
}

void start_states_restore(start_states *s) {
    memcpy(s->triangles, s->saved, s->mesh->triangle_count * sizeof *s->saved);
    s->counted = false;
}

void start_states_forget_component(start_states *s, uint32_t component) {
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        if (s->mesh->triangle_components[t] == component) s->triangles[t] = TRIANGLE_UNKNOWN;
    }
    s->counted = false;
}

void start_states_forget(start_states *s) {
    if (!s->known) return;
    memset(s->triangles, TRIANGLE_UNKNOWN, s->mesh->triangle_count * sizeof *s->triangles);
    s->known = s->counted = false;
}
