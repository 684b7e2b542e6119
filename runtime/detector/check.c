/* The static check of the public API: which triangles intersect at one moment? */
#include "runtime/detector/check.h"

#include "runtime/detector/list_cap.h"
#include "runtime/detector/waiting.h"
#include "src/core/sort.h"
#include "src/core/timer.h"
#include "src/mesh/positions.h"
#include "src/mesh/views.h"

/* Joins the lists of all lanes, without the pairs that the caller ignores, and sorts them. */
static cscd_status collect_intersections(cscd_detector *d, const double *positions, cscd_intersections *out) {
    const static_check *check = &d->check;
    size_t found = 0, kept = 0;
    for (uint32_t i = 0; i < check->lane_count; i++) found += check->lanes[i].count;
    cscd_status status = result_buffer_reserve(d->context, &d->intersections, found,
                                               sizeof(cscd_intersection), sizeof(uint64_t));
    if (status != CSCD_OK) return status;

    uint64_t *pairs = d->intersections.keys; /* a in the upper half, b in the lower one */
    cscd_intersections result = {.items = d->intersections.items, .first_zero_area = UINT32_MAX};
    for (uint32_t i = 0; i < check->lane_count; i++) {
        const intersection_lane *lane = &check->lanes[i];
        for (size_t j = 0; j < lane->count; j++) {
            found_pair pair = lane->items[j];
            if (j < lane->settled ||
                !exclusions_cover(&d->exclusions, CSCD_CONTACT_TT, pair.a, pair.b, positions))
                pairs[kept++] = (uint64_t)pair.a << 32 | pair.b;
        }
        result.zero_area_triangles += lane->zero_area_triangles;
        if (lane->first_zero_area < result.first_zero_area) result.first_zero_area = lane->first_zero_area;
    }
    result.waiting = d->waiting.pairs.triangle_pairs;
    result.collapsed = d->collapsed.count;
    result.count = d->cap.counted + kept;
    if (d->options.longest_list > 0 && result.count > d->options.longest_list) {
        result.items = NULL;
        *out = result;
        return list_cap_fail(d, result.count);
    }
    sort_by_number(pairs, d->intersections.spare_keys, kept, sizeof *pairs);
    cscd_intersection *items = d->intersections.items;
    for (size_t i = 0; i < kept; i++)
        items[i] = (cscd_intersection){(uint32_t)(pairs[i] >> 32), (uint32_t)pairs[i]};
    *out = result;
    return CSCD_OK;
}

/* The answer of the check is its list. */
static cscd_status check_moment(cscd_detector *d, const double *positions, void *out) {
    list_cap_begin_check(d, positions);
    cscd_status status = static_check_all(&d->check, &d->space.traversal, &d->space.bvh, positions);
    list_cap_end_check(d);
    return status == CSCD_OK ? collect_intersections(d, positions, out) : status;
}

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

static cscd_status check_views(cscd_detector *detector, const cscd_view *positions, cscd_intersections *out) {
    cscd_context *context = detector->context;
    if (out == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "cscd_detector_check: out is NULL");
    const double *x = NULL;
    cscd_intersections found;
    const moment_question question = {check_moment, &found, true};
    cscd_status status =
        views_read(context, detector->mesh, positions, "positions", &detector->unpacked[0], &x);
    if (status == CSCD_OK) status = detector_ask_moment(detector, x, &question);
    if (status == CSCD_OK || status == CSCD_LIST_TOO_LONG) *out = found;
    return status;
}

cscd_status cscd_detector_check(cscd_detector *detector, const cscd_view *positions,
                                cscd_intersections *out) {
    if (detector == NULL) return CSCD_NULL_OBJECT;
    context_entry entry;
    if (!object_enter(detector, &entry)) return entry.status;
    return context_leave(&entry, check_views(detector, positions, out));
}
