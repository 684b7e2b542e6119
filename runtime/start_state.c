/* Is the start of an interval embedded? What is known of each component, and from where. */
#include "runtime/start_state.h"

#include <string.h>

enum { PATIENCE_MAX = 16 };

cscd_status start_states_create(const cscd_mesh *mesh, start_states *out) {
    start_states s = {.context = mesh->context, .mesh = mesh};
    s.positions = context_allocate(mesh->context, mesh->vertex_count, sizeof(double[3]));
    s.moved = context_allocate(mesh->context, mesh->component_count, sizeof *s.moved);
    s.of = context_allocate(mesh->context, mesh->component_count, sizeof *s.of);
    if (s.positions == NULL || s.moved == NULL || s.of == NULL) {
        start_states_destroy(&s);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = s;
    return CSCD_OK;
}

void start_states_destroy(start_states *s) {
    context_free(s->context, s->positions);
    context_free(s->context, s->moved);
    context_free(s->context, s->of);
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
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        if (s->moved[c]) s->of[c].state = START_UNKNOWN;
    }
    remember(s, x);
}

bool start_states_want_check(start_states *s) {
    bool wanted = false;
    for (uint32_t c = 0; c < s->mesh->component_count; c++) {
        component_start *start = &s->of[c];
        if (start->state != START_UNKNOWN || !s->mesh->components[c].closed_manifold) continue;
        if (start->waiting > 0)
            start->waiting--;
        else
            wanted = true;
    }
    return wanted;
}

void start_states_checked(start_states *s, const double *x, const bool *crossing) {
    for (uint32_t c = 0; c < s->mesh->component_count; c++) {
        component_start *start = &s->of[c];
        start->state = crossing[c] ? START_CROSSING : START_EMBEDDED;
        if (!crossing[c]) {
            start->patience = start->waiting = 0;
        } else if (start->waiting == 0) {
            start->patience = start->patience == 0             ? 1
                              : start->patience < PATIENCE_MAX ? start->patience * 2
                                                               : PATIENCE_MAX;
            start->waiting = start->patience;
        }
    }
    remember(s, x);
}

void start_states_vouch(start_states *s) {
    for (uint32_t c = 0; c < s->mesh->component_count; c++) {
        if (s->of[c].state == START_UNKNOWN) s->of[c].state = START_EMBEDDED;
    }
}

void start_states_end(start_states *s, const double *x, const bool *touched) {
    for (uint32_t c = 0; c < s->mesh->component_count; c++) {
        if (touched == NULL || touched[c] || s->of[c].state == START_CROSSING) s->of[c].state = START_UNKNOWN;
    }
    remember(s, x);
}
