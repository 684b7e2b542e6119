/* A recording for an event tracker: a mesh, and what each of its frames has, random or copied from a detector; and
 * its events by an oracle. */
#pragma once

#include "cscd/cscd.h"

enum { RECORDED_FRAMES_MAX = 64 };

typedef struct recorded_frame {
    uint64_t number;
    bool looked; /* found is given to the tracker */
    cscd_intersections found;
    cscd_curves curves;
    cscd_depths depths;
    cscd_contact *contacts;
    size_t contact_count;
} recorded_frame;

typedef struct recorded_frames {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_event_options options; /* labels and seams lie in the arrays below */
    uint32_t *labels;
    uint32_t seams[16];
    uint32_t frame_count;
    recorded_frame frames[RECORDED_FRAMES_MAX];
} recorded_frames;

/* Random things on two sheets, wires, points and a half-space, joined by random options. */
void recorded_frames_create(recorded_frames *r, const cscd_allocator *allocator, uint32_t frame_count);

/* Copies what was found, and contacts of the interval before, to a frame that has nothing yet. found may be NULL. */
void recorded_frames_copy(recorded_frame *to, const cscd_intersections *found, const cscd_contacts *contacts);

/* Frees everything; of one that was not created, what was copied. */
void recorded_frames_free(recorded_frames *r);

/* A tracker with the recording's options, and frames that go into it. */
cscd_event_tracker *recorded_tracker(const recorded_frames *r);
void recorded_frames_add(const recorded_frames *r, cscd_event_tracker *tracker, uint32_t begin, uint32_t end);

/* The events by comparing everything with everything: the truth of the tests. It shares no code with the tracker. Returns a sorted list, to be freed by the caller. */
cscd_event *recording_oracle(const recorded_frames *r, size_t *count);
