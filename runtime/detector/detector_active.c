/* The active vertices of a live detector, and that all others stay where they are. */
#include "runtime/detector/detector.h"

/* 0 and -0 are the same place. */
cscd_status detector_check_still(const cscd_detector *d, const double *x0, const double *x1) {
    const bool *active = d->space.active.vertices;
    for (size_t i = 0; active != NULL && i < (size_t)d->mesh->vertex_count * 3; i++) {
        if (x0[i] == x1[i] || active[i / 3]) continue;
        return context_fail(
            d->context, CSCD_INVALID_ARGUMENT,
            "vertex %zu is not active, but has %c = %g in x0 and %g in x1: leave it where it is, "
            "or name it in cscd_detector_set_active",
            i / 3, "xyz"[i % 3], x0[i], x1[i]);
    }
    return CSCD_OK;
}

static cscd_status check_vertices(const cscd_detector *d, const uint32_t *vertices, size_t count) {
    if (vertices == NULL && count > 0)
        return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                            "cscd_detector_set_active: vertices is NULL, but there are to be %zu", count);
    for (size_t i = 0; i < count; i++) {
        if (vertices[i] < d->mesh->vertex_count) continue;
        return context_fail(d->context, CSCD_INVALID_ARGUMENT,
                            "cscd_detector_set_active: vertices[%zu] is %u, but there are %u vertices", i,
                            vertices[i], d->mesh->vertex_count);
    }
    return CSCD_OK;
}

/* Every set that was there has its marks in the trees, so memory is short only where there was none. */
static cscd_status take_vertices(cscd_detector *d, const uint32_t *vertices, size_t count) {
    search_space *s = &d->space;
    cscd_status status = active_set_reserve(d->mesh, &s->active);
    if (status != CSCD_OK) return context_out_of_memory(d->context);
    active_set_fill(d->mesh, vertices, count, &s->active);
    if (s->bvh.mesh != NULL && !bvh_set_active(&s->bvh, s->active.triangles)) {
        active_set_free(d->context, &s->active);
        return context_out_of_memory(d->context);
    }
    d->rebuild.active = s->active.triangles;
    d->rules_revision++;
    return CSCD_OK;
}

static void drop_vertices(cscd_detector *d) {
    search_space *s = &d->space;
    if (s->active.vertices == NULL) return;
    if (s->bvh.mesh != NULL) bvh_set_active(&s->bvh, NULL);
    active_set_free(d->context, &s->active);
    d->rebuild.active = NULL;
    d->rules_revision++;
}

static cscd_status set_active(cscd_detector *d, const uint32_t *vertices, size_t count) {
    cscd_status status = check_vertices(d, vertices, count);
    if (status != CSCD_OK) return status;
    if (vertices != NULL) return take_vertices(d, vertices, count);
    drop_vertices(d);
    return CSCD_OK;
}

cscd_status cscd_detector_set_active(cscd_detector *detector, const uint32_t *vertices, size_t count) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, set_active(detector, vertices, count));
}
