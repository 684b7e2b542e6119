/* The tracker of the public API. */
#pragma once

#include "runtime/events/frame_groups.h"

struct cscd_event_tracker {
    reference_count references;
    cscd_context *context;
    cscd_mesh mesh; /* as objects of the context see it */
    uint32_t rings_wanted;
    part_labels parts;
    mesh_rings rings;
    uint64_t options_hash; /* of the mesh and of all options but later_chunk */

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
    uint8_t *bytes;
    size_t byte_capacity;
};

/* Writes the state of a tracker that has no contacts waiting to tracker->bytes. OUT_OF_MEMORY has no sentence. */
cscd_status event_state_write(cscd_event_tracker *tracker, size_t *byte_count);

/* Reads a state. On failure *out is untouched; INVALID_ARGUMENT has a sentence. */
cscd_status event_state_read(const cscd_event_tracker *tracker, const uint8_t *bytes, size_t byte_count,
                             event_history *out);
