/* Pairs of features that may come near each other on a motion, kept for every shorter motion. */
#include "runtime/detector/candidates.h"

#include "runtime/detector/detector.h"
#include "runtime/loose/loose.h"
#include "runtime/narrow_phase/narrow_phase.h"

#include <string.h>

/* Joins the lists of all lanes. False: no memory. */
static bool join_lists(const search_space *s, cscd_contact_kind kind, candidate_list *list) {
    size_t count = 0;
    for (uint32_t i = 0; i < s->traversal.lane_count; i++) count += s->lanes[i].candidates[kind].count;
    list->count = 0;
    if (count > list->capacity) {
        size_t capacity = count + count / 2;
        uint32_t(*grown)[2] = context_grow(s->context, list->pairs, 0, capacity, sizeof *grown);
        if (grown == NULL) return false;
        list->pairs = grown;
        list->capacity = capacity;
    }
    for (uint32_t i = 0; i < s->traversal.lane_count; i++) {
        const candidate_list *found = &s->lanes[i].candidates[kind];
        if (found->count > 0)
            memcpy(list->pairs + list->count, found->pairs, found->count * sizeof *found->pairs);
        list->count += found->count;
    }
    return true;
}

cscd_status candidates_take(const search_space *s, candidates *out) {
    bool taken = join_lists(s, CSCD_CONTACT_VF, &out->lists[CSCD_CONTACT_VF]) &&
                 join_lists(s, CSCD_CONTACT_EE, &out->lists[CSCD_CONTACT_EE]);
    return taken ? CSCD_OK : CSCD_OUT_OF_MEMORY;
}

cscd_status candidates_collect(cscd_detector *d, const double *x0, const double *x1, double reach,
                               double margin, candidates *out) {
    interval_search search = interval_search_begin(&d->space, x0, x1, (separation){reach, reach});
    volume_growth growth = {reach, detector_growth(d).of_objects, margin};
    search.interval.collecting = true;
    search.interval.thick = detector_thick(d);
    search.interval.beyond = margin;
    cscd_status status = bvh_rebuild_move(&d->rebuild, &d->space.bvh, x0, x1, growth, detector_growth(d));
    if (status == CSCD_OK) status = interval_search_everything(&search);
    if (status == CSCD_OK) status = interval_search_loose(&search);
    return status == CSCD_OK ? candidates_take(&d->space, out) : status;
}

void candidates_free(cscd_context *context, candidates *c) {
    context_free(context, c->lists[CSCD_CONTACT_VF].pairs);
    context_free(context, c->lists[CSCD_CONTACT_EE].pairs);
    *c = (candidates){{{NULL, 0, 0}, {NULL, 0, 0}}};
}

/* ---- tests --------------------------------------------------------------------------------------------- */

typedef struct testing {
    const candidates *candidates;
    interval_search *search;
} testing;

static void test_vf(const swept_interval *interval, const uint32_t pair[2], contact_lane *lane) {
    swept_box vertex = swept_box_of(interval, &pair[0], 1);
    swept_box face = swept_box_of(interval, interval->mesh->triangles[pair[1]], 3);
    if (!swept_boxes_within(&vertex, &face, pair_reach(interval, CSCD_CONTACT_VF, pair[0], pair[1]))) return;
    lane->feature_pairs++;
    narrow_phase_test_vf(interval, pair[0], pair[1], lane);
}

static void test_ee(const swept_interval *interval, const uint32_t pair[2], contact_lane *lane) {
    if (!loose_edges_meet(interval, pair[0], pair[1])) return;
    swept_box a = swept_box_of(interval, interval->mesh->edges[pair[0]], 2);
    swept_box b = swept_box_of(interval, interval->mesh->edges[pair[1]], 2);
    if (!swept_boxes_within(&a, &b, pair_reach(interval, CSCD_CONTACT_EE, pair[0], pair[1]))) return;
    lane->feature_pairs++;
    narrow_phase_test_ee(interval, pair[0], pair[1], lane);
}

/* After so many candidates the host is asked whether to go on. */
enum { CANDIDATES_AT_ONCE = 1024 };

/* Tests a lane's share of both lists; the cursor counts the candidates of the two. */
static void test_share(void *data, uint32_t index) {
    const testing *t = data;
    const swept_interval *interval = &t->search->interval;
    const search_space *space = t->search->space;
    contact_lane *lane = &space->lanes[index];
    size_t done = 0;
    lane->suspended = false;
    for (int kind = 0; kind < 2; kind++) {
        const candidate_list *list = &t->candidates->lists[kind];
        size_t begin = parallel_share(list->count, index, space->traversal.lane_count);
        size_t end = parallel_share(list->count, index + 1, space->traversal.lane_count);
        uint64_t left = lane->cursor - done;
        size_t skipped = left < end - begin ? (size_t)left : end - begin;
        for (size_t i = begin + skipped; i < end && !lane->out_of_memory; i++) {
            double share = 0.5 * (kind + (double)(i - begin) / (double)(end - begin));
            if ((i - begin) % CANDIDATES_AT_ONCE == 0 && !progress_go_on(&space->context->progress, share))
                return;
            (kind == CSCD_CONTACT_VF ? test_vf : test_ee)(interval, list->pairs[i], lane);
            if (contact_lane_suspend(lane, lane->cursor + 1)) return;
        }
        done += end - begin;
    }
    narrow_phase_finish(interval, lane);
}

cscd_status candidates_test(const candidates *c, interval_search *search) {
    search_space *space = search->space;
    testing t = {c, search};
    progress_stage(&space->context->progress, "candidates", 0.0, 1.0);
    interval_search_run(search, space->traversal.lane_count, test_share, &t);
    interval_search_half_spaces(search);
    cscd_status status = search_space_status(space);
    return status == CSCD_OK ? context_progress_status(space->context) : status;
}
