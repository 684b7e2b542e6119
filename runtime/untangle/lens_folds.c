/* Skin that is folded through itself: where both traces of a curve bound one wrong patch, it is halved between them. */
#include "runtime/untangle/lenses.h"

#include <string.h>

/* Distances, in edges within the patch, from its vertices on a trace. Returns whether there are any. */
static bool measure_from_trace(lens_finder *f, const cscd_curves *curves, const cscd_curve *c, int sheet,
                               uint32_t patch, uint32_t *distances) {
    const cscd_mesh *mesh = f->w->mesh;
    const vertex_graph *g = &f->w->graph;
    uint32_t count = 0;
    for (size_t i = c->first_piece; i < c->first_piece + c->piece_count; i++) {
        for (int k = 0; k < 3; k++) {
            const uint32_t v = g->names[mesh->triangles[curve_piece_triangle(curves, i, sheet)][k]];
            if (!f->wrong[v] || f->patches[v] != patch || distances[v] != UINT32_MAX) continue;
            distances[v] = 0;
            f->queue[count++] = v;
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t v = f->queue[i];
        for (size_t n = g->begins[v]; n < g->begins[v + 1]; n++) {
            const uint32_t other = g->neighbours[n];
            if (f->patches[other] != patch || !f->wrong[other] || distances[other] != UINT32_MAX) continue;
            distances[other] = distances[v] + 1;
            f->queue[count++] = other;
        }
    }
    return count > 0;
}

/* Is the vertex on both traces? Then it is the start of none. */
static void halve_patch(lens_finder *f, const cscd_curves *curves, const cscd_curve *c, uint32_t patch) {
    const uint32_t n = f->w->mesh->vertex_count;
    uint32_t *from_first = f->distances, *from_second = f->distances + n;
    memset(from_first, 0xff, 2 * (size_t)n * sizeof *from_first);
    const bool first = measure_from_trace(f, curves, c, 0, patch, from_first);
    const bool second = measure_from_trace(f, curves, c, 1, patch, from_second);
    uint32_t half = 0, all = 0;
    for (uint32_t v = 0; first && second && v < n; v++) {
        if (f->patches[v] != patch || !f->wrong[v]) continue;
        all++;
        half += from_second[v] < from_first[v];
    }
    if (all < 4 || half == 0 || half == all) return;
    for (uint32_t v = 0; v < n; v++) {
        if (f->patches[v] != patch || !f->wrong[v]) continue;
        f->folded[v] = true;
        if (from_second[v] < from_first[v]) f->patches[v] = f->next_patch;
    }
    f->next_patch++;
}

/* Returns a patch that both traces bound and that comes after `last`; UINT32_MAX: there is none. */
static uint32_t folded_patch(const lens_finder *f, const cscd_curves *curves, const cscd_curve *c,
                             uint32_t last, bool any) {
    const cscd_mesh *mesh = f->w->mesh;
    uint32_t best = UINT32_MAX;
    for (size_t i = c->first_piece; i < c->first_piece + c->piece_count; i++) {
        for (int k = 0; k < 3; k++) {
            const uint32_t v = mesh->triangles[curves->pieces[i].a][k], patch = f->patches[v];
            if (!f->wrong[v] || patch >= best || (any && patch <= last)) continue;
            for (size_t j = c->first_piece; j < c->first_piece + c->piece_count; j++) {
                const uint32_t *other = mesh->triangles[curves->pieces[j].b];
                for (int l = 0; l < 3; l++) {
                    if (f->wrong[other[l]] && f->patches[other[l]] == patch) best = patch;
                }
                if (best == patch) break;
            }
        }
    }
    return best;
}

void lens_folds_halve(lens_finder *f, const cscd_curves *curves) {
    memset(f->folded, 0, f->w->mesh->vertex_count * sizeof *f->folded);
    for (size_t i = 0; i < curves->count; i++) {
        const cscd_curve *c = &curves->items[i];
        if (c->components[0] != c->components[1]) continue;
        const uint32_t end = f->next_patch;
        uint32_t patch = folded_patch(f, curves, c, 0, false);
        while (patch < end) {
            halve_patch(f, curves, c, patch);
            patch = folded_patch(f, curves, c, patch, true);
        }
    }
}
