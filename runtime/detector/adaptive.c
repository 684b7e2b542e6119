/* Counts the work of each component with itself, by which the next intervals choose between culling it or not. */
#include "runtime/detector/adaptive.h"

#include "runtime/culling/culling.h"

#include <string.h>

/* Pairs are counted in one of so many intervals, since that takes a twentieth of the time where few are left. */
enum { INTERVALS_BETWEEN_COUNTS = 4 };

void adaptive_begin(cscd_detector *d) {
    size_t components = d->mesh->component_count, lanes = d->space.traversal.lane_count;
    memset(d->touched, 0, components * sizeof *d->touched);
    d->passes = 0;
    if (!d->rules.where_it_pays) return;
    culling_choice_decide(&d->starts, d->options.start == CSCD_START_PROVE);
    d->counts_kept = d->intervals % INTERVALS_BETWEEN_COUNTS == 0 || culling_choice_begins(&d->starts);
    for (size_t i = 0; i < lanes; i++)
        d->space.lanes[i].kept = d->counts_kept ? d->kept_by_lanes + i * components : NULL;
    if (d->counts_kept) memset(d->kept_by_lanes, 0, lanes * components * sizeof *d->kept_by_lanes);
}

void adaptive_learn(cscd_detector *d) {
    size_t components = d->mesh->component_count, lanes = d->space.traversal.lane_count;
    if (!d->rules.where_it_pays) return;
    memset(d->kept, 0, components * sizeof *d->kept);
    for (size_t i = 0; d->counts_kept && i < lanes; i++) {
        const uint32_t *kept = d->kept_by_lanes + i * components;
        for (size_t c = 0; c < components; c++) d->kept[c] += kept[c];
    }
    const culling_outcome outcome = {d->culled, d->counts_kept ? d->kept : NULL, d->touched,
                                     d->lists_earliest, d->passes};
    culling_choice_learn(&d->starts, &outcome);
    d->intervals++;
}
