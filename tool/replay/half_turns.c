/* What turns by about half a turn from one frame to the next: on straight ways it shrinks to next to nothing half-way. */
#include "tool/replay/half_turns.h"

#include "tool/common/command.h"
#include "tool/io/growable.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* The corners of a component's triangles, from its first one on, as x is far from 0 where a scene is. */
typedef struct spread {
    uint32_t first; /* a vertex; the sums are of differences to it */
    double count, sum0[3], sum1[3];
    double square0, square1, product;
} spread;

static void add_corner(spread *s, uint32_t vertex, const double *x0, const double *x1) {
    if (s->count == 0.0) s->first = vertex;
    s->count += 1.0;
    for (size_t i = 0; i < 3; i++) {
        const double a = x0[3 * (size_t)vertex + i] - x0[3 * (size_t)s->first + i],
                     b = x1[3 * (size_t)vertex + i] - x1[3 * (size_t)s->first + i];
        s->sum0[i] += a;
        s->sum1[i] += b;
        s->square0 += a * a;
        s->square1 += b * b;
        s->product += a * b;
    }
}

/* Half-way each corner is the mean of its ends: its square is (square0 + square1 + 2 product) / 4, about the means. */
static double size_half_way(const spread *s) {
    double square0 = s->square0, square1 = s->square1, product = s->product;
    for (int i = 0; i < 3; i++) {
        square0 -= s->sum0[i] * s->sum0[i] / s->count;
        square1 -= s->sum1[i] * s->sum1[i] / s->count;
        product -= s->sum0[i] * s->sum1[i] / s->count;
    }
    const double ends = (square0 + square1) / 2.0;
    return ends > 0.0 ? sqrt(fmax((ends + product) / 2.0 / ends, 0.0)) : 1.0;
}

#define SHRINKS_BELOW 0.59

bool half_turn_find(const cscd_mesh *mesh, const double *x0, const double *x1, half_turn *out) {
    const uint32_t components = cscd_mesh_component_count(mesh);
    spread *spreads = io_zeroed(((size_t)components + 1) * sizeof *spreads);
    *out = (half_turn){.size = SHRINKS_BELOW};
    if (spreads == NULL) return false;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh); t++) {
        uint32_t corners[3];
        cscd_mesh_triangle(mesh, t, corners);
        for (int i = 0; i < 3; i++)
            add_corner(&spreads[cscd_mesh_triangle_component(mesh, t)], corners[i], x0, x1);
    }
    bool found = false;
    for (uint32_t c = 0; c < components; c++) {
        const double size = size_half_way(&spreads[c]);
        if (!(size < out->size)) continue;
        *out = (half_turn){c, size};
        found = true;
    }
    free(spreads);
    return found;
}

static void name_component(const recording *r, const part_names *parts, uint32_t component, char *text,
                           size_t size) {
    uint32_t t = 0;
    while (cscd_mesh_triangle_component(r->mesh, t) != component) t++;
    if (parts->named && parts->labels[t] != NO_PART)
        snprintf(text, size, "part %.80s", part_names_at(parts, parts->labels[t]));
    else
        snprintf(text, size, "component %u", component);
}

void half_turn_tell(const recording *r, const part_names *parts, uint32_t k, const half_turn *found) {
    char name[120];
    name_component(r, parts, found->component, name, sizeof name);
    note(
        "%s shrinks to %.0f %% of its size half-way from frame %d to %d, as straight ways do to what turns far between "
        "two frames: it may touch itself for that reason alone, and hits of its true way can be missed; record more "
        "frames",
        name, found->size * 100.0, r->frame_numbers[k], r->frame_numbers[k + 1]);
}
