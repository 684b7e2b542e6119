/* A cap on the length of lists: contacts that find no room are counted, and leave nothing behind but taint. */
#include "runtime/detector/list_cap.h"

#include "runtime/detector/earliest_contacts.h"

#include <string.h>

/* Room that a lane has beside its share of the cap, so that lanes are seldom suspended. */
enum { CONTACTS_BESIDE = 2048 };

cscd_status list_cap_set(cscd_detector *d, size_t longest) {
    if (longest > 0 && d->cap.tainted == NULL) {
        bool *tainted = context_allocate(d->context, d->mesh->triangle_count, sizeof *tainted);
        if (tainted == NULL) return context_out_of_memory(d->context);
        d->cap.tainted = tainted;
    }
    if (longest > 0 && rollback_reserve(d->mesh, &d->before) != CSCD_OK)
        return context_out_of_memory(d->context);
    d->options.longest_list = longest;
    d->cap.beside = CONTACTS_BESIDE;
    return CSCD_OK;
}

cscd_status list_cap_fail(const cscd_detector *d, size_t count) {
    return context_fail(d->context, CSCD_LIST_TOO_LONG,
                        "the list would have %zu items, more than longest_list, which is %zu: call "
                        "cscd_detector_set_longest_list, or look at less",
                        count, d->options.longest_list);
}

size_t list_cap_lane(const cscd_detector *d) {
    return d->options.longest_list / d->space.traversal.lane_count + d->cap.beside;
}

/* ---- contacts ------------------------------------------------------------------------------------------ */

/* Drops what is left out, then says that the rest is in the list. */
static void settle_lane(cscd_detector *d, contact_lane *lane) {
    const exclusions *e = &d->exclusions;
    bool left_out_alone = d->cap.taint == CAP_TAINTS_LEFT_OUT;
    size_t kept = lane->settled;
    for (size_t i = lane->settled; i < lane->count; i++) {
        const cscd_contact *c = contact_lane_at(lane, i);
        bool left_out = exclusions_cover(e, c->kind, c->a, c->b, NULL);
        if (left_out || !left_out_alone) tainting_mark(d->mesh, c, d->cap.tainted, d->touched);
        if (!left_out) *contact_lane_at(lane, kept++) = *c;
    }
    lane->settled = lane->count = kept;
}

static void empty_lanes(cscd_detector *d) {
    for (uint32_t i = 0; i < d->space.traversal.lane_count; i++)
        d->space.lanes[i].settled = d->space.lanes[i].count = 0;
}

/* Called between two runs of the lanes, on the calling thread. Once the list is too long, no contact is kept. */
static void spill_lanes(void *data) {
    cscd_detector *d = data;
    search_space *s = &d->space;
    size_t count = s->counted;
    for (uint32_t i = 0; i < s->traversal.lane_count; i++) {
        contact_lane *lane = &s->lanes[i];
        settle_lane(d, lane);
        count += lane->settled;
    }
    if (count > s->longest) {
        s->counted = count;
        empty_lanes(d);
    }
    for (uint32_t i = 0; i < s->traversal.lane_count; i++) {
        s->lanes[i].limit = s->lanes[i].settled + list_cap_lane(d);
        d->contacts_seen[i] = s->lanes[i].settled;
    }
    d->cap.any_tainted = true;
}

void list_cap_begin(cscd_detector *d, interval_search *search, cap_taint taint) {
    if (d->options.longest_list == 0) return;
    d->space.longest = d->options.longest_list;
    d->cap.taint = (int)taint;
    d->cap.any_tainted = false;
    memset(d->cap.tainted, false, d->mesh->triangle_count * sizeof *d->cap.tainted);
    search->spill = taint == CAP_KEEPS_EARLIEST ? earliest_spill : spill_lanes;
    search->spill_data = d;
    for (uint32_t i = 0; i < d->space.traversal.lane_count; i++) d->space.lanes[i].limit = list_cap_lane(d);
}

uint32_t list_cap_taint(cscd_detector *d, const tainting *t) {
    uint32_t newly_kept = 0;
    if (d->options.longest_list == 0 || !d->cap.any_tainted) return 0;
    for (uint32_t i = 0; i < d->mesh->triangle_count; i++) {
        if (!d->cap.tainted[i]) continue;
        newly_kept += tainting_triangle(t, i);
        d->cap.tainted[i] = false;
    }
    d->cap.any_tainted = false;
    return newly_kept;
}

/* ---- pairs of triangles -------------------------------------------------------------------------------- */

void list_cap_begin_pairs(cscd_detector *d, size_t longest, void (*spill)(void *data), void *data) {
    d->check.limit = longest / d->space.traversal.lane_count + d->cap.beside;
    d->check.spill = spill;
    d->check.spill_data = data;
}

void list_cap_end_check(cscd_detector *d) {
    d->check.limit = SIZE_MAX;
}
