/* The detector's inside: trees, lanes and buffers that live from one interval to the next. */
#pragma once

#include "runtime/bvh/bvh_rebuild.h"
#include "runtime/bvh/traversal.h"
#include "runtime/culling/culling.h"
#include "runtime/culling/start_state.h"
#include "runtime/detector/method_table.h"
#include "runtime/detector/rollback.h"
#include "runtime/intersections/static_check.h"
#include "runtime/narrow_phase/exclusions.h"
#include "runtime/narrow_phase/narrow_phase.h"
#include "runtime/narrow_phase/representatives.h"
#include "src/core/methods.h"

/* What a call returns, and as much room again for sorting it. */
typedef struct result_buffer {
    void *items, *scratch;
    size_t capacity;
} result_buffer;

struct cscd_detector {
    cscd_context *context;
    const cscd_mesh *mesh;
    cscd_detector_options options;
    separation limit; /* of the options, the default tolerance filled in */
    const method_traits *traits;
    const method_stages *stages;
    culling_rules rules;

    exclusions exclusions;
    culling culling;
    start_states starts;
    /* Per component, in the current interval: */
    bool *culled;             /* its pairs are culled */
    bool *wants_all_contacts; /* it is culled, and the closing pass finds all its contacts */
    bool *touched;            /* it has a contact with itself */
    bool *skipped;            /* its pairs of adjacent triangles are not traversed */
    bool *incomplete;         /* some of its contacts may be missing */

    size_t *contacts_seen;      /* per lane: those that have tainted triangles */
    cscd_guarantee *guarantees; /* per component, of the last step */

    void *hider_state; /* of stages->hider */
    bvh bvh;           /* of the current interval or moment */
    bvh_rebuild rebuild;
    call_memory before;
    representatives representatives;
    orphan_pairs orphans; /* once an interval without culling has come, unless there are too many */
    bool orphans_known, orphans_usable;
    traversal traversal;
    contact_lane *contact_lanes; /* one per thread, as are the traversal's */
    static_check check;

    result_buffer contacts, intersections;
    double *reached; /* positions, of the step that cscd_detector_max_step tries; NULL before the first */

    cscd_timings timings;
    cscd_counters counters;
};

/* With a minimum separation no pair is culled. */
static inline bool detector_culls(const cscd_detector *d) {
    return d->rules.by_orientation && d->limit.distance == 0.0;
}

static inline bool detector_hides_pairs(const cscd_detector *d) {
    return d->stages->hider != NULL && d->limit.distance == 0.0;
}

/* The number of regions that triangles are oriented by; 0 where they are not oriented. */
static inline uint32_t detector_region_count(const cscd_detector *d) {
    return detector_culls(d) ? d->culling.region_count : 0;
}

/* Makes room for count results of size bytes; what the buffer held is dropped. */
cscd_status result_buffer_reserve(cscd_context *context, result_buffer *buffer, size_t count, size_t size);
