/* Bodies shrunk around their middles until they are apart, from where they grow again. */
#include "runtime/untangle/untangle.h"

#include "src/core/sort.h"
#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

enum { SCALES = 9 };

/* What moves as one: components that seams join. */
typedef struct rigid_body {
    double middle[3], mass;
    bool fixed, tangled;
} rigid_body;

typedef struct shrink_work {
    untangle_work *w;
    uint32_t *of_components; /* the body, by its first component */
    rigid_body *bodies;      /* per component */
    double *x;
} shrink_work;

static array_list list_arrays(shrink_work *s) {
    const size_t n = s->w->mesh->component_count;
    return (array_list){{ARRAY(s->of_components, n), ARRAY(s->bodies, n)}};
}

/* UINT32_MAX: the vertex has no triangle. */
static uint32_t body_of(const shrink_work *s, uint32_t v) {
    const cscd_mesh *mesh = s->w->mesh;
    const uint32_t first = mesh->vertex_star_offsets[v];
    if (first == mesh->vertex_star_offsets[v + 1]) return UINT32_MAX;
    return s->of_components[mesh->triangle_components[mesh->vertex_stars[first]]];
}

static void find_bodies(shrink_work *s) {
    const untangle_work *w = s->w;
    const cscd_mesh *mesh = w->mesh;
    sets_begin(s->of_components, mesh->component_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const uint32_t name = w->graph.names[v];
        if (name == v) continue;
        const uint32_t a = body_of(s, v), b = body_of(s, name);
        if (a != UINT32_MAX && b != UINT32_MAX) set_unite(s->of_components, a, b);
    }
    for (uint32_t c = 0; c < mesh->component_count; c++) s->of_components[c] = set_root(s->of_components, c);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const uint32_t b = body_of(s, v);
        if (b == UINT32_MAX) continue;
        s->bodies[b].fixed |= w->graph.fixed[v];
        s->bodies[b].mass += w->graph.fixed[v] ? 0.0 : w->graph.masses[v];
        if (!w->graph.fixed[v])
            vec3_add_scaled(s->bodies[b].middle, w->graph.masses[v], w->input + 3 * (size_t)v,
                            s->bodies[b].middle);
    }
    for (uint32_t c = 0; c < mesh->component_count; c++) {
        for (int k = 0; k < 3 && s->bodies[c].mass > 0.0; k++) s->bodies[c].middle[k] /= s->bodies[c].mass;
    }
}

/* Marks the bodies of pairs. Returns whether shrinking may part them: no body crosses itself, and of each pair one can move. */
static bool mark_tangled(shrink_work *s, const cscd_intersections *found) {
    for (size_t i = 0; i < found->count; i++) {
        const uint32_t a = s->of_components[found->items[i].components[0]],
                       b = s->of_components[found->items[i].components[1]];
        if (a == b || (s->bodies[a].fixed && s->bodies[b].fixed)) return false;
        s->bodies[a].tangled = s->bodies[b].tangled = true;
    }
    return true;
}

static void scale_bodies(const shrink_work *s, double scale) {
    const untangle_work *w = s->w;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        const uint32_t b = body_of(s, v);
        if (b == UINT32_MAX || !s->bodies[b].tangled || s->bodies[b].fixed) continue;
        for (size_t k = 0; k < 3; k++) {
            const double middle = s->bodies[b].middle[k];
            s->x[3 * (size_t)v + k] = middle + scale * (w->input[3 * (size_t)v + k] - middle);
        }
    }
    work_flush(w, s->x);
}

static cscd_status shrink_bodies(shrink_work *s, bool *clean) {
    untangle_work *w = s->w;
    cscd_intersections found;
    find_bodies(s);
    cscd_status status = detector_find_intersections(w->detector, WORK_VIEW(w, w->input), NULL, &found);
    if (status != CSCD_OK || !mark_tangled(s, &found)) return status;
    for (int i = SCALES; i > 0 && work_goes_on(w); i--) {
        tangle_count count;
        scale_bodies(s, 0.1 * i);
        status = work_count(w, s->x, &count);
        if (status != CSCD_OK) return status;
        *clean = count.pairs == 0 && count.near == 0;
        if (*clean) break;
    }
    return CSCD_OK;
}

cscd_status shrink_apart(untangle_work *w, double *x, bool *clean) {
    shrink_work s = {.w = w, .x = x};
    cscd_status status = CSCD_OUT_OF_MEMORY;
    *clean = false;
    memcpy(x, w->input, 3 * (size_t)w->mesh->vertex_count * sizeof *x);
    if (context_allocate_all(w->context, list_arrays(&s))) status = work_settle(w, shrink_bodies(&s, clean));
    context_free_all(w->context, list_arrays(&s));
    return status;
}
