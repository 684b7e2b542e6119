/* What is known of the triangles at the start of an interval: which are clean, and from where. */
#include "runtime/start_state.h"

#include "runtime/clean_patch.h"

#include <string.h>

enum { PATIENCE_MAX = 16 };

cscd_status start_states_create(const cscd_mesh *mesh, start_states *out) {
    start_states s = {.context = mesh->context, .mesh = mesh};
    s.positions = context_allocate(mesh->context, mesh->vertex_count, sizeof(double[3]));
    s.moved = context_allocate(mesh->context, mesh->component_count, sizeof *s.moved);
    s.triangles = context_allocate(mesh->context, mesh->triangle_count, sizeof *s.triangles);
    s.of = context_allocate(mesh->context, mesh->component_count, sizeof *s.of);
    s.queue = context_allocate(mesh->context, mesh->triangle_count, sizeof *s.queue);
    s.largest = context_allocate(mesh->context, mesh->component_count, sizeof *s.largest);
    if (s.positions == NULL || s.moved == NULL || s.triangles == NULL || s.of == NULL || s.queue == NULL ||
        s.largest == NULL) {
        start_states_destroy(&s);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = s;
    return CSCD_OK;
}

void start_states_destroy(start_states *s) {
    void *blocks[] = {s->positions, s->moved, s->triangles, s->of, s->queue, s->largest};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(s->context, blocks[i]);
    *s = (start_states){0};
}

static void remember(start_states *s, const double *x) {
    memcpy(s->positions, x, s->mesh->vertex_count * sizeof(double[3]));
    s->known = true;
}

/* Bit for bit, but for the sign of zero. */
static bool vertex_moved(const start_states *s, const double *x, uint32_t vertex) {
    const double *a = s->positions + (size_t)vertex * 3, *b = x + (size_t)vertex * 3;
    return a[0] != b[0] || a[1] != b[1] || a[2] != b[2];
}

void start_states_begin(start_states *s, const double *x) {
    const cscd_mesh *mesh = s->mesh;
    if (s->known && memcmp(s->positions, x, mesh->vertex_count * sizeof(double[3])) == 0) return;
    for (uint32_t c = 0; c < mesh->component_count; c++) s->moved[c] = !s->known;
    for (uint32_t t = 0; s->known && t < mesh->triangle_count; t++) {
        for (int i = 0; i < 3; i++)
            s->moved[mesh->triangle_components[t]] |= vertex_moved(s, x, mesh->triangles[t][i]);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (s->moved[mesh->triangle_components[t]]) s->triangles[t] = TRIANGLE_UNKNOWN;
    }
    remember(s, x);
}

void start_states_count(start_states *s) {
    for (uint32_t c = 0; c < s->mesh->component_count; c++)
        s->of[c].unknown = s->of[c].crossing = s->of[c].clean = 0;
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        component_start *start = &s->of[s->mesh->triangle_components[t]];
        start->unknown += s->triangles[t] == TRIANGLE_UNKNOWN;
        start->crossing += s->triangles[t] == TRIANGLE_CROSSING;
        start->clean += s->triangles[t] == TRIANGLE_CLEAN;
    }
}

uint32_t start_states_suspect(start_states *s, bool *suspects) {
    const cscd_mesh *mesh = s->mesh;
    bool *wanted = s->moved, any = false;
    uint32_t count = 0;
    start_states_count(s);
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        component_start *start = &s->of[c];
        wanted[c] = start->unknown > 0 && mesh->components[c].closed_manifold && start->waiting == 0;
        if (start->unknown > 0 && start->waiting > 0) start->waiting--;
        any |= wanted[c];
    }
    for (uint32_t t = 0; any && t < mesh->triangle_count; t++) {
        suspects[t] = wanted[mesh->triangle_components[t]] && s->triangles[t] < TRIANGLE_FREE;
        count += suspects[t];
    }
    return count;
}

/* Does the next check pay? One whose outcome leaves most to be tested costs about half of what culling saves.
 */
static void lose_patience(component_start *start, uint32_t triangle_count) {
    if (start->clean >= triangle_count - start->clean) {
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
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        if (checked[c]) lose_patience(&s->of[c], mesh->components[c].triangle_count);
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
}

void start_states_end(start_states *s, const double *x, const bool *lost) {
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        if (lost[s->mesh->triangle_components[t]] || s->triangles[t] == TRIANGLE_CROSSING)
            s->triangles[t] = TRIANGLE_UNKNOWN;
    }
    remember(s, x);
}
