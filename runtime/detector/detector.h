/* The detector's inside: trees, lanes and buffers that live from one interval to the next. */
#pragma once

#include "runtime/baselines/iccd/patch.h"
#include "runtime/bvh/traversal.h"
#include "runtime/culling/culling.h"
#include "runtime/culling/start_state.h"
#include "runtime/detector/rollback.h"
#include "runtime/intersections/static_check.h"
#include "runtime/narrow_phase/exclusions.h"
#include "runtime/narrow_phase/narrow_phase.h"
#include "runtime/narrow_phase/representatives.h"

/* What a call returns, and as much room again for sorting it. */
typedef struct result_buffer {
    void *items, *scratch;
    size_t capacity;
} result_buffer;

/* What method PUBLISHED does otherwise; benchmarks switch single rules off. */
enum {
    PUBLISHED_UNPROVEN = 1,        /* culls also where the start is not known to be embedded */
    PUBLISHED_STILL = 2,           /* the detector point stays where it is at the start */
    PUBLISHED_REPRESENTATIVES = 4, /* a feature's first triangle answers for it, whatever the flags */
    PUBLISHED_ADJACENT = 8,        /* triangles that share a vertex are not tested */
    PUBLISHED_ALL = 15
};

/* How far leaves extend, as a multiple of their triangles, and blocks of parts, of their parts. */
typedef struct tree_spread {
    double leaves, parts;
} tree_spread;

struct cscd_detector {
    cscd_context *context;
    const cscd_mesh *mesh;
    cscd_detector_options options;
    separation limit; /* of the options, the default tolerance filled in */
    uint8_t published_rules;

    exclusions exclusions;
    culling culling;
    start_states starts;
    bool *culled;               /* per component, in the interval at hand: pairs are culled in it, */
    bool *touched;              /* it has a contact with itself, */
    bool *skipped;              /* its pairs of adjacent triangles are left out, */
    bool *finished;             /* it is culled, and all its contacts are wanted */
    bool *suspects, *crossing;  /* per triangle, at the moment checked last */
    size_t *contacts_seen;      /* per lane: those that have tainted triangles */
    cscd_guarantee *guarantees; /* per component, of the last step */

    patches patches;               /* of the BVH, with ICCD */
    bvh bvh;                       /* of the interval or moment at hand */
    tree_spread spread_when_built; /* and how good it is: see upkeep.h */
    uint32_t intervals_unlooked, useless_rebuilds;
    bool rebuilt; /* in the interval at hand */
    call_memory before;
    representatives representatives;
    orphan_pairs orphans; /* once an interval without culling has come, unless there are too many */
    bool orphans_known, orphans_usable;
    traversal traversal;
    contact_lane *contact_lanes; /* one per thread, as are the traversal's */
    intersection_lane *intersection_lanes;

    result_buffer contacts, intersections;
    double *reached; /* positions, of the step that cscd_detector_max_step tries; NULL before the first */

    cscd_timings timings;
    cscd_counters counters;
};

/* Does the method cull pairs by orientation? */
static inline bool detector_culls(const cscd_detector *d) {
    cscd_method method = d->options.method;
    bool by_orientation = method == CSCD_METHOD_SINGLE || method == CSCD_METHOD_KMEANS ||
                          method == CSCD_METHOD_CHARGE || method == CSCD_METHOD_PUBLISHED;
    return by_orientation && d->limit.distance == 0.0;
}

/* The regions that orientations are of; 0: there are none. */
static inline uint32_t detector_region_count(const cscd_detector *d) {
    return detector_culls(d) ? d->culling.region_count : 0;
}

/* Does it look for patches that cannot touch themselves? */
static inline bool detector_seals(const cscd_detector *d) {
    cscd_method method = d->options.method;
    return (method == CSCD_METHOD_ICCD || method == CSCD_METHOD_ICCD_PUBLISHED) && d->limit.distance == 0.0;
}

/* Makes room for count results of size bytes; what the buffer held is dropped. */
cscd_status result_buffer_reserve(cscd_context *context, result_buffer *buffer, size_t count, size_t size);
