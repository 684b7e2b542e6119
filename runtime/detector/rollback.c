/* Snapshot of what a call that is cancelled or fails must restore. */
#include "runtime/detector/rollback.h"

#include <string.h>

cscd_status rollback_create(const cscd_mesh *mesh, rollback *out) {
    cscd_context *context = mesh->context;
    if (!progress_wanted(&context->progress)) return CSCD_OK;
    out->triangles = context_allocate(context, mesh->triangle_count, sizeof *out->triangles);
    out->components = context_allocate(context, mesh->component_count, sizeof *out->components);
    return out->triangles != NULL && out->components != NULL ? CSCD_OK : CSCD_OUT_OF_MEMORY;
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
