/* The detector's inside: trees, lanes and buffers that live from one interval to the next. */
#ifndef CSCD_DETECTOR_H
#define CSCD_DETECTOR_H

#include "runtime/narrow_phase.h"
#include "runtime/static_check.h"
#include "runtime/traversal.h"

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

    bvh tree;             /* built from the first positions seen */
    kdop *vertex_volumes; /* of the interval or moment at hand */
    uint8_t *representatives;
    traversal traversal;
    contact_lane *contact_lanes; /* one per thread, as are the traversal's */
    intersection_lane *intersection_lanes;

    result_buffer contacts, intersections;

    cscd_timings timings;
    cscd_counters counters;
};

/* Volumes of all vertices over x0 -> x1 (the same array twice for a moment) and a refitted tree, which is
 * built first when there is none yet. */
cscd_status detector_update(cscd_detector *detector, const double *x0, const double *x1);

/* Makes room for count results of size bytes; what the buffer held is dropped. */
cscd_status result_buffer_reserve(cscd_context *context, result_buffer *buffer, size_t count, size_t size);

#endif
