/* The tracker of the public API. */
#pragma once

#include "runtime/events/frame_groups.h"

struct cscd_event_tracker {
    reference_count references;
    cscd_context *context;
    cscd_mesh mesh; /* as objects of the context see it */
    part_labels parts;
    mesh_rings rings;

    event_history history;
    frame_groups groups;
    size_t max_memory; /* of a frame */

    /* Of the interval that ends in the next frame. */
    tracked_contact *contacts;
    size_t contact_count, contact_capacity;

    /* Memory of what was given out last. */
    cscd_event *given;
    tracked_event *spare_closed; /* for sorting */
    size_t given_capacity;
};
