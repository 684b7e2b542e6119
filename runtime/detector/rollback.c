/* A call that takes long: it can be cancelled, and when it fails the detector is as it was, for a repetition.
 */
#include "runtime/detector/rollback.h"

#include "runtime/detector/detector.h"

#include <string.h>

cscd_status call_create(cscd_detector *d) {
    call_memory *before = &d->before;
    if (!progress_wanted(&d->context->progress)) return CSCD_OK;
    before->triangles = context_allocate(d->context, d->mesh->triangle_count, sizeof *before->triangles);
    before->of = context_allocate(d->context, d->mesh->component_count, sizeof *before->of);
    return before->triangles != NULL && before->of != NULL ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

void call_free(cscd_detector *d) {
    context_free(d->context, d->before.triangles);
    context_free(d->context, d->before.of);
}

void call_begin(cscd_detector *d) {
    const start_states *s = &d->starts;
    call_memory *before = &d->before;
    progress_begin(&d->context->progress);
    if (before->triangles == NULL) return;
    memcpy(before->triangles, s->triangles, d->mesh->triangle_count * sizeof *s->triangles);
    memcpy(before->of, s->of, d->mesh->component_count * sizeof *s->of);
    before->vouched = s->vouched;
    before->intervals_unmeasured = d->rebuild.intervals_unmeasured;
}

static void put_back(cscd_detector *d) {
    start_states *s = &d->starts;
    const call_memory *before = &d->before;
    memcpy(s->triangles, before->triangles, d->mesh->triangle_count * sizeof *s->triangles);
    memcpy(s->of, before->of, d->mesh->component_count * sizeof *s->of);
    s->vouched = before->vouched;
    s->counted = false;
    d->rebuild.intervals_unmeasured = before->intervals_unmeasured;
}

cscd_status call_fail(cscd_detector *d, cscd_status status) {
    if (status == CSCD_IN_CONTACT) return status;
    if (d->before.triangles != NULL) put_back(d);
    return context_explain(d->context, status);
}
