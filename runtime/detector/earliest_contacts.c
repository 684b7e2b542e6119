/* Mode EARLIEST: of the contacts of a component with itself, only the earliest are listed. */
#include "runtime/detector/earliest_contacts.h"

#include "runtime/culling/culling.h"
#include "runtime/detector/list_cap.h"

#include <math.h>

void earliest_begin(cscd_detector *d) {
    for (uint32_t c = 0; c < d->mesh->component_count; c++) d->earliest[c] = INFINITY;
}

void earliest_note(cscd_detector *d) {
    for (uint32_t i = 0; i < d->space.traversal.lane_count; i++) {
        const contact_lane *lane = &d->space.lanes[i];
        for (size_t j = d->contacts_seen[i]; j < lane->count; j++)
            tainting_note(d->mesh, contact_lane_at(lane, j), d->earliest);
    }
}

static bool is_later(const cscd_detector *d, const cscd_contact *contact, double within) {
    uint32_t component = tainting_component(d->mesh, contact);
    return component != UINT32_MAX && contact->toi - within > d->earliest[component];
}

/* Contacts stay in order, so those that were seen are still the first ones. */
static void drop_from_lane(cscd_detector *d, uint32_t index, double within) {
    contact_lane *lane = &d->space.lanes[index];
    size_t kept = 0, seen = 0;
    for (size_t i = 0; i < lane->count; i++) {
        if (is_later(d, contact_lane_at(lane, i), within)) continue;
        seen += i < d->contacts_seen[index];
        *contact_lane_at(lane, kept++) = *contact_lane_at(lane, i);
    }
    lane->count = kept;
    d->contacts_seen[index] = seen;
}

void earliest_drop_later(cscd_detector *d, double within) {
    for (uint32_t i = 0; i < d->space.traversal.lane_count; i++) drop_from_lane(d, i, within);
}

/* The least toi only falls from here on, so what is dropped would neither be listed nor taint later either. What is left
 * counts towards the cap when all contacts are known. */
void earliest_spill(void *data) {
    cscd_detector *d = data;
    earliest_note(d);
    earliest_drop_later(d, earliest_tainting);
    for (uint32_t i = 0; i < d->space.traversal.lane_count; i++)
        d->space.lanes[i].limit = d->space.lanes[i].count + list_cap_lane(d);
}
