/* What is known of the triangles at the start of an interval: which are clean, and from where. */
#include "runtime/culling/start_state.h"

#include "runtime/culling/clean_patch.h"

#include <stdatomic.h>
#include <string.h>

/* By measurement (docs/theory/culling.md). */
static const double share_worth_it = 0.9;

enum { PATIENCE_MAX = 16, VERTICES_PER_TASK = 2048 };

cscd_status start_states_create(const cscd_mesh *mesh, start_states *out) {
    start_states s = {.context = mesh->context, .mesh = mesh, .share_worth_it = share_worth_it};
    s.positions = context_allocate(mesh->context, mesh->vertex_count, sizeof(double[3]));
    s.moved = context_allocate(mesh->context, mesh->component_count, sizeof *s.moved);
    s.triangles = context_allocate(mesh->context, mesh->triangle_count, sizeof *s.triangles);
    s.saved = context_allocate(mesh->context, mesh->triangle_count, sizeof *s.saved);
    s.of = context_allocate(mesh->context, mesh->component_count, sizeof *s.of);
    s.queue = context_allocate(mesh->context, mesh->triangle_count, sizeof *s.queue);
    s.largest = context_allocate(mesh->context, mesh->component_count, sizeof *s.largest);
    if (s.positions == NULL || s.moved == NULL || s.triangles == NULL || s.saved == NULL || s.of == NULL ||
        s.queue == NULL || s.largest == NULL) {
        start_states_destroy(&s);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = s;
    return CSCD_OK;
}

void start_states_destroy(start_states *s) {
    void *blocks[] = {s->positions, s->moved, s->triangles, s->saved, s->of, s->queue, s->largest};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(s->context, blocks[i]);
    *s = (start_states){0};
}

/* ---- the positions seen last ------------------------------------------------------------------------ */

typedef struct comparison {
    start_states *s;
    const double *x;
    atomic_bool differ;
} comparison;

static size_t task_begin(uint32_t index) {
    return (size_t)index * VERTICES_PER_TASK * 3;
}

static size_t task_bytes(const start_states *s, uint32_t index) {
    uint32_t rest = s->mesh->vertex_count - index * VERTICES_PER_TASK;
    return (rest < VERTICES_PER_TASK ? rest : VERTICES_PER_TASK) * sizeof(double[3]);
}

static void compare_task(void *data, uint32_t index) {
    comparison *c = data;
    size_t begin = task_begin(index);
    if (memcmp(c->s->positions + begin, c->x + begin, task_bytes(c->s, index)) != 0)
        atomic_store(&c->differ, true);
}

static void copy_task(void *data, uint32_t index) {
    comparison *c = data;
    size_t begin = task_begin(index);
    memcpy(c->s->positions + begin, c->x + begin, task_bytes(c->s, index));
}

static void run_over_vertices(parallel_task *task, comparison *c) {
    uint32_t tasks = c->s->mesh->vertex_count / VERTICES_PER_TASK;
    tasks += c->s->mesh->vertex_count % VERTICES_PER_TASK != 0;
    parallel_run(c->s->context->threads, tasks, task, c);
}

static void remember(start_states *s, const double *x) {
    comparison c = {.s = s, .x = x};
    run_over_vertices(copy_task, &c);
    s->known = true;
}

bool start_states_hold(start_states *s, const double *x) {
    if (!s->known) return false;
    comparison c = {.s = s, .x = x};
    run_over_vertices(compare_task, &c);
    return !atomic_load(&c.differ);
}

/* Bit for bit, but for the sign of zero. */
static bool vertex_moved(const start_states *s, const double *x, uint32_t vertex) {
    const double *a = s->positions + (size_t)vertex * 3, *b = x + (size_t)vertex * 3;
    return a[0] != b[0] || a[1] != b[1] || a[2] != b[2];
}

void start_states_begin(start_states *s, const double *x) {
    const cscd_mesh *mesh = s->mesh;
    for (uint32_t c = 0; c < mesh->component_count; c++) s->moved[c] = !s->known;
    for (uint32_t t = 0; s->known && t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3; i++)
            s->moved[mesh->triangle_components[t]] |= vertex_moved(s, x, mesh->triangles[t][i]);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (s->moved[mesh->triangle_components[t]]) s->triangles[t] = TRIANGLE_UNKNOWN;
    }
    s->counted = false;
    remember(s, x);
}

/* ---- states ------------------------------------------------------------------------------------------ */

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

/* A component's triangles mostly follow each other. */
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

uint32_t start_states_suspect(start_states *s, bool *suspects) {
    const cscd_mesh *mesh = s->mesh;
    bool *wanted = s->moved, any = false;
    uint32_t count = 0;
    start_states_count(s);
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        component_start *start = &s->of[c];
        bool culled = mesh->components[c].closed_manifold && !component_is_obstacle(mesh, c);
        wanted[c] = culled && start->unknown > 0 && start->waiting == 0;
        if (start->unknown > 0 && start->waiting > 0) start->waiting--;
        any |= wanted[c];
    }
    for (uint32_t t = 0; any && t < mesh->triangle_count; t++) {
        suspects[t] = wanted[mesh->triangle_components[t]] && s->triangles[t] < TRIANGLE_FREE;
        count += suspects[t];
    }
    return count;
}

/* Does the next check pay? Not if its outcome leaves too much to be tested. */
static void lose_patience(const start_states *s, component_start *start, uint32_t triangle_count) {
    if (start_states_pay(s, start->clean, triangle_count)) {
        start->patience = start->waiting = 0;
    } else if (start->waiting == 0) {
        start->patience = start->patience == 0             ? 1
                          : start->patience < PATIENCE_MAX ? start->patience * 2
                                                           : PATIENCE_MAX;
        start->waiting = start->patience;
    }
}

void start_states_checked(start_states *s, const bool *suspects, const bool *crossing) {
    const cscd_mesh *mesh = s->mesh;
    bool *checked = s->moved;
    for (uint32_t c = 0; c < mesh->component_count; c++) checked[c] = false;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (s->vouched && s->triangles[t] == TRIANGLE_CLEAN) s->triangles[t] = TRIANGLE_FREE;
        if (!suspects[t]) continue;
        checked[mesh->triangle_components[t]] = true;
        if (crossing[t])
            s->triangles[t] = TRIANGLE_CROSSING;
        else if (s->triangles[t] < TRIANGLE_FREE)
            s->triangles[t] = TRIANGLE_FREE;
    }
    s->vouched = false;
    clean_patches_find(s);
    s->counted = false;
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        if (checked[c]) lose_patience(s, &s->of[c], mesh->components[c].triangle_count);
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

void start_states_end(start_states *s, const double *x, const bool *lost) {
    bool any = false;
    for (uint32_t c = 0; c < s->mesh->component_count; c++) any |= lost[c] || s->of[c].crossing > 0;
    for (uint32_t t = 0; any && t < s->mesh->triangle_count; t++) {
        if (lost[s->mesh->triangle_components[t]] || s->triangles[t] == TRIANGLE_CROSSING)
            s->triangles[t] = TRIANGLE_UNKNOWN;
    }
    s->counted &= !any;
    remember(s, x);
}

void start_states_save(start_states *s) {
    memcpy(s->saved, s->triangles, s->mesh->triangle_count * sizeof *s->saved);
}

void start_states_restore(start_states *s) {
    memcpy(s->triangles, s->saved, s->mesh->triangle_count * sizeof *s->saved);
    s->counted = false;
}

void start_states_forget(start_states *s) {
    if (!s->known) return;
    memset(s->triangles, TRIANGLE_UNKNOWN, s->mesh->triangle_count * sizeof *s->triangles);
    s->known = s->counted = false;
}
