/* From clean positions towards the goal, by motions that are made safe. */
#include "runtime/untangle/untangle.h"

#include "src/core/vec3.h"

#include <string.h>

enum { APPROACHES = 8 };

/* A motion in which no vertex goes farther than this, in edge lengths, is the last one. */
static const double least_way = 1e-3;

static double longest_way(const untangle_work *w, const double *from, const double *to) {
    double squared = 0.0;
    for (size_t v = 0; v < w->mesh->vertex_count; v++)
        squared = max_of(squared, vec3_squared_distance(from + 3 * v, to + 3 * v));
    return sqrt(squared);
}

cscd_status approach_once(untangle_work *w, double *x, const double *to, bool *moved) {
    const size_t size = 3 * (size_t)w->mesh->vertex_count * sizeof *x;
    const cscd_response_options options = {.struct_size = sizeof options,
                                           .inverse_masses = w->inverse_masses};
    cscd_safe_motion motion;
    cscd_status status = solver_make_safe(w->detector, WORK_VIEW(w, x), WORK_VIEW(w, to), &options,
                                          WORK_MUTABLE(w, w->reached), &motion);
    *moved = status == CSCD_OK && memcmp(x, w->reached, size) != 0;
    if (*moved) memcpy(x, w->reached, size);
    return status;
}

static cscd_status go_safely(untangle_work *w, double *x, double *before) {
    const size_t size = 3 * (size_t)w->mesh->vertex_count * sizeof *x;
    for (int i = 0; i < APPROACHES && work_goes_on(w); i++) {
        bool moved;
        memcpy(before, x, size);
        cscd_status status = approach_once(w, x, w->goal, &moved);
        if (status != CSCD_OK) return status;
        if (!(longest_way(w, before, x) > least_way * w->graph.edge_length)) break;
    }
    return CSCD_OK;
}

cscd_status approach_goal(untangle_work *w, double *x) {
    double *before = context_reserve(w->context, 3 * (size_t)w->mesh->vertex_count, sizeof *before);
    if (before == NULL) return CSCD_OUT_OF_MEMORY;
    cscd_status status = work_settle(w, go_safely(w, x, before));
    context_free(w->context, before);
    return status;
}
