/* The static check of the public API: which triangles intersect at one moment? */
#include "runtime/detector/check.h"

#include "runtime/detector/list_cap.h"
#include "runtime/detector/waiting.h"
#include "src/core/sort.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"
#include "src/mesh/views.h"

static cscd_status answer_question(cscd_detector *d, const double *positions,
                                   const moment_question *question) {
    cscd_status status =
        bvh_rebuild_move_to(&d->rebuild, &d->space.bvh, positions, uniform_growth(0.0), detector_growth(d));
    detector_find_collapsed(d, positions, positions);
    if (status == CSCD_OK) status = detector_leave_collapsed(d, COLLAPSED_LEFT);
    d->check.collapsed = collapsed_marks(&d->collapsed);
    if (status == CSCD_OK) status = question->answer(d, positions, question->data);
    d->check.collapsed = NULL;
    detector_leave_collapsed(d, COLLAPSED_FOUND);
    return status == CSCD_OK ? context_progress_status(d->context) : status;
}

/* Inactive triangles have been compared with active ones only, so nothing is known of those that do not cross them. */
static void unmark_inactive(const cscd_detector *d, bool *triangles) {
    const bool *active = d->space.active.triangles;
    for (uint32_t t = 0; active != NULL && t < d->mesh->triangle_count; t++)
        triangles[t] = active[t] || d->check.crossing[t];
}

/* States and positions belong together, so both are written when all is found. If the call is cancelled even now, or the
 * host's loop leaves out a task, the states may be those of other positions, and nothing is known. */
static cscd_status keep_states(cscd_detector *d, const double *positions) {
    if (!start_states_hold(&d->starts, positions)) start_states_begin(&d->starts, positions);
    unmark_inactive(d, d->check.unproven);
    detector_unmark_masked(d, d->check.unproven);
    start_states_checked(&d->starts, d->check.unproven, d->check.crossing);
    cscd_status status = context_progress_status(d->context);
    if (status != CSCD_OK) start_states_forget(&d->starts);
    return status;
}

cscd_status detector_ask_moment(cscd_detector *d, const double *positions, const moment_question *question) {
    double since = timer_now_ms(), spent = 0.0;
    cscd_status status = positions_check(d->context, positions, d->mesh->vertex_count, "positions");
    if (status == CSCD_OK) status = seam_list_check(d->mesh, &d->exclusions.seams, positions);
    if (status != CSCD_OK) return status;

    detector_begin_call(d);
    progress_stage(&d->context->progress, "static check", 0.0, 1.0);
    status = waiting_settle(d, positions);
    if (status == CSCD_OK) status = answer_question(d, positions, question);
    if (status != CSCD_OK) return detector_fail_call(d, status);
    if (question->complete) status = keep_states(d, positions);
    if (status != CSCD_OK) return status;
    timer_lap(&since, &spent);
    d->timings.check_ms = spent;
    return CSCD_OK;
}
