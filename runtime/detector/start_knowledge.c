/* A detector's knowledge of the start of its next interval: the snapshot that a call which is cancelled or fails puts back. */
#include "runtime/detector/start_knowledge.h"

#include <string.h>

cscd_status rollback_create(const cscd_mesh *mesh, rollback *out) {
    cscd_context *context = mesh->context;
    if (!progress_wanted(&context->progress)) return CSCD_OK;
    return rollback_reserve(mesh, out);
}

cscd_status rollback_reserve(const cscd_mesh *mesh, rollback *r) {
    cscd_context *context = mesh->context;
    if (r->triangles != NULL) return CSCD_OK;
    uint8_t *triangles = context_allocate(context, mesh->triangle_count, sizeof *triangles);
    component_start *components = context_allocate(context, mesh->component_count, sizeof *components);
    if (triangles == NULL || components == NULL) {
        context_free(context, triangles);
        context_free(context, components);
        return CSCD_OUT_OF_MEMORY;
    }
    r->triangles = triangles;
    r->components = components;
    return CSCD_OK;
}

void rollback_free(cscd_context *context, rollback *r) {
    context_free(context, r->triangles);
    context_free(context, r->components);
}

void rollback_save(rollback *r, const start_states *starts, const bvh_rebuild *trees) {
    if (r->triangles == NULL) return;
    memcpy(r->triangles, starts->triangles, starts->mesh->triangle_count * sizeof *r->triangles);
    memcpy(r->components, starts->of, starts->mesh->component_count * sizeof *r->components);
    r->vouched = starts->vouched;
    r->intervals_unmeasured = trees->intervals_unmeasured;
}

void rollback_restore(const rollback *r, start_states *starts, bvh_rebuild *trees) {
    if (r->triangles == NULL) return;
    memcpy(starts->triangles, r->triangles, starts->mesh->triangle_count * sizeof *r->triangles);
    memcpy(starts->of, r->components, starts->mesh->component_count * sizeof *r->components);
    starts->vouched = r->vouched;
    starts->counted = false;
    trees->intervals_unmeasured = r->intervals_unmeasured;
}
