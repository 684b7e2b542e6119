/* The events of a row of frames, and how two rows that follow each other become one. A single frame is a row, too, so
 * tracking a recording and merging chunks of it are the same thing.
 *
 * An event is a connected component: things of one pair of parts are joined if they are near in triangles and in time.
 * To join what comes later, a row remembers who was last at each stamped vertex, in its last gap + 1 frames; to be joined
 * to what came before, who was first there, in its first gap + 1 frames. Older stamps at one vertex are of the same event,
 * or too old to matter, so one stamp is enough. */
#pragma once

#include "runtime/events/mesh_rings.h"
#include "runtime/events/stamp_table.h"
#include "runtime/events/tracked_event.h"

typedef struct event_history {
    uint64_t frame_count;
    uint64_t first_frame, last_frame; /* their numbers, if there are any */
    uint32_t gap;
    bool keeps_first; /* there may be frames before: `first` is kept, and what touches it stays open */

    /* Events that may go on, or may have begun before. Those that were joined form trees: parents lead to the event that
     * has it all, whose parent is itself. */
    tracked_event *events;
    uint32_t *parents; /* NO_EVENT: it is closed, or was moved */
    size_t event_count, event_capacity;
    size_t open_count; /* events that are their own parents */

    stamp_table first, last; /* owners are events; `last` also has some that are too old */

    tracked_event *closed; /* in no order */
    size_t closed_count, closed_capacity;
} event_history;

enum { NO_EVENT = UINT32_MAX };

/* Appends a row of frames to another one of the same gap. OUT_OF_MEMORY has no sentence; nothing has changed then. */
cscd_status event_history_append(cscd_context *context, event_history *h, const mesh_rings *rings,
                                 const event_history *next);

/* The event that has all of this one. It shortens the ways on which it goes, so that many calls take little time. */
uint32_t event_root(event_history *h, uint32_t event);

/* May a frame, counted from the first one, be joined to the next frame? */
static inline bool frame_is_last(const event_history *h, uint64_t frame) {
    return frame + h->gap + 1 >= h->frame_count;
}

/* May the frame be joined to one before the row? */
static inline bool frame_is_first(const event_history *h, uint64_t frame) {
    return h->keeps_first && frame <= h->gap;
}

/* Makes room for so many more events, and as many closed ones more. False: no memory. */
bool event_history_reserve(cscd_context *context, event_history *h, size_t events, size_t closed);

/* Closes all events. There is room. */
void event_history_close(event_history *h);

/* Forgets all frames, and keeps memory, gap and keeps_first. */
void event_history_clear(event_history *h);
void event_history_free(cscd_context *context, event_history *h);
