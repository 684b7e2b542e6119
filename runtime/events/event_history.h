/* The events of all frames so far, and how those of the next frame join them.
 *
 * An event is a connected component: things of one pair of parts are joined if they are near in triangles and in time.
 * To join what comes later, the history remembers who was last at each stamped vertex, in its last gap + 1 frames. Older
 * stamps at one vertex are of the same event, or too old to matter, so one stamp is enough. */
#pragma once

#include "runtime/events/mesh_rings.h"
#include "runtime/events/stamp_table.h"
#include "runtime/events/tracked_event.h"

typedef struct event_history {
    uint64_t frame_count;
    uint64_t last_frame; /* its number, if there is any */
    uint32_t gap;

    /* Events that may go on. Those that were joined form trees: parents lead to the event that has it all, whose
     * parent is itself. */
    tracked_event *events;
    uint32_t *parents; /* NO_EVENT: it is closed */
    size_t event_count, event_capacity;
    size_t open_count; /* events that are their own parents */

    stamp_table last; /* owners are events; it also has some that are too old */

    tracked_event *closed; /* in no order */
    size_t closed_count, closed_capacity;
} event_history;

enum { NO_EVENT = UINT32_MAX };

/* The events of one frame by themselves: counted from this frame, and so is the frame of each stamp. */
typedef struct frame_row {
    uint64_t frame; /* its number */
    const tracked_event *events;
    size_t event_count;
    stamp_table stamps; /* owners are events of the row */
} frame_row;

/* Adds the next frame. OUT_OF_MEMORY has no sentence; nothing has changed then. */
cscd_status event_history_append(cscd_context *context, event_history *h, const mesh_rings *rings,
                                 const frame_row *next);

/* Makes room for this many more events, and this many more closed ones. False: no memory. */
bool event_history_reserve(cscd_context *context, event_history *h, size_t events, size_t closed);

/* Closes all events. There is room. */
void event_history_close(event_history *h);

/* Forgets all frames, and keeps memory and gap. */
void event_history_clear(event_history *h);
void event_history_free(cscd_context *context, event_history *h);
