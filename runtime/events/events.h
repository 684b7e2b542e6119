/* The files of the events share this: what is near on a mesh, stamps on it, events, the history of frames, and groups of a frame. */
#pragma once

#include "src/core/memory.h"
#include "src/mesh/mesh.h"
#include "src/mesh/parts.h"

#include <cscd/events.h>

/* ---- what is near on a mesh -------------------------------------------------------------------------------- */

/* Two triangles are within k rings of each other if between their vertices lie at most k - 1 edges. Each triangle stamps
 * the vertices at most `radius` edges away from its own, and two of them are near if a vertex has the stamps of both or,
 * with `odd`, also if an edge has the stamp of one at one end and that of the other at the other end. With 0 rings,
 * triangles are stamped themselves. */
typedef struct mesh_rings {
    bool same;       /* 0 rings */
    uint32_t radius; /* with k rings (k - 1) / 2, */
    bool odd;        /* and k - 1 is odd */

    /* Unless `same`: */
    uint32_t *names;      /* per vertex: the least of those that it is one with */
    size_t *offsets;      /* per name: where its neighbours begin */
    uint32_t *neighbours; /* names at the other ends of edges */
} mesh_rings;

/* Seams are of existing vertices. OUT_OF_MEMORY has no sentence. */
cscd_status mesh_rings_create(const cscd_mesh *mesh, uint32_t rings, const uint32_t *seams, size_t seam_count,
                              mesh_rings *out);
void mesh_rings_free(cscd_context *context, mesh_rings *r);

/* The element of a vertex that no triangle has: itself, or with `same` a number from the end on. */
static inline uint32_t element_of_loose(const mesh_rings *r, uint32_t vertex) {
    return r->same ? UINT32_MAX - vertex : r->names[vertex];
}

/* ---- stamps ------------------------------------------------------------------------------------------------ */

typedef struct stamp {
    uint64_t parts;   /* the key of a pair of parts */
    uint64_t frame;   /* counted from the first one */
    uint32_t element; /* a vertex, or a triangle: see mesh_rings */
    uint32_t owner;   /* a number of the table's user */
} stamp;

/* Stamps in the order in which they were added, found by parts and element. Begins with zeros. */
typedef struct stamp_table {
    stamp *stamps;
    uint32_t *places; /* by hash: one more than the number of a stamp; 0: nothing */
    size_t count, capacity;
    uint32_t place_mask;
} stamp_table;

/* Makes room for this many more stamps. False: no memory, and nothing has changed. */
bool stamp_table_reserve(cscd_context *context, stamp_table *t, size_t more);
void stamp_table_free(cscd_context *context, stamp_table *t);

/* NULL: there is none. Stamps move when the table grows. */
stamp *stamp_table_find(const stamp_table *t, uint64_t parts, uint32_t element);

/* Adds a stamp that is not there yet; there is room. */
void stamp_table_add(stamp_table *t, stamp added);

void stamp_table_clear(stamp_table *t);

/* Stamps were taken out, so that the others stand at the beginning of the array. */
void stamp_table_shrink(stamp_table *t, size_t count);

/* ---- an event ---------------------------------------------------------------------------------------------- */

/* The worst group of an event: what is joined in one frame. */
typedef struct event_group {
    double depth, length;
    uint64_t pairs, contacts;
    uint64_t index;  /* of the frame, counted from the first one */
    uint64_t frame;  /* its number */
    uint64_t origin; /* see below; tells groups of one frame and pair of parts apart */
    uint64_t triangle;
    double x[3];
} event_group;

/* All members can be joined in any order: none needs to know which parts of an event were joined first. */
typedef struct tracked_event {
    uint64_t parts;       /* the key of a pair of parts */
    uint64_t first, last; /* frames, counted from the first one */
    uint64_t first_frame, last_frame;
    uint64_t origin; /* the least triangle of the first frame; 2^32 + the least vertex if there is none */
    uint64_t kinds, pairs, depths, contacts;
    double length;
    event_group worst;
} tracked_event;

/* The origin of a vertex that no triangle has. */
static inline uint64_t origin_of_loose(uint32_t vertex) {
    return UINT64_C(1) << 32 | vertex;
}

/* The two are one event: the first becomes it. */
void tracked_event_join(tracked_event *into, const tracked_event *from);

/* The order of events: for sorting, as qsort wants it. No two events are equal. */
int tracked_event_compare(const void *left, const void *right);

cscd_event tracked_event_describe(const tracked_event *event);

/* ---- all frames so far ------------------------------------------------------------------------------------- */

/* An event is a connected component: things of one pair of parts are joined if they are near in triangles and in time.
 * To join what comes later, the history remembers who was last at each stamped vertex, in its last gap + 1 frames. Older
 * stamps at one vertex are of the same event, or too old to matter, so one stamp is enough. */
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

/* ---- one frame --------------------------------------------------------------------------------------------- */

/* The members of a contact that events need. */
typedef struct tracked_contact {
    double toi, point[3];
    uint32_t a, b;
    cscd_contact_kind kind;
} tracked_contact;

/* The findings of a frame, checked: all numbers are of the mesh. */
typedef struct frame_input {
    const cscd_intersections *found; /* NULL: nothing */
    const tracked_contact *contacts;
    size_t contact_count;
    uint64_t frame;        /* its number */
    memory_budget *budget; /* of the frame */
} frame_input;

/* A triangle that was stamped, and the thing and the parts for which it was. */
typedef struct stamped_triangle {
    uint64_t parts;
    uint32_t triangle, thing;
} stamped_triangle;

/* The rank of a place for looking at a group. */
typedef enum place_rank { PLACE_OF_PAIR, PLACE_OF_CONTACT, PLACE_OF_CURVE, PLACE_OF_DEPTH } place_rank;

/* A thing is a pair, a piece of a curve, a depth or a contact, numbered in this order. */
typedef struct group_thing {
    uint64_t parts, origin;
    uint32_t parent; /* in the trees of things that are joined; then the group */
} group_thing;

/* The memory of all frames; begins with zeros. */
typedef struct frame_groups {
    group_thing *things;
    size_t thing_count, thing_capacity;
    stamped_triangle *stamped;
    size_t stamped_count, stamped_capacity;

    /* Per triangle: its place among those that were stamped, if it is one of them; else anything. */
    uint32_t *stamped_places;

    stamp_table stamps; /* owners are things, and groups at last */
    tracked_event *groups;
    double *times; /* of the earliest contact of a group */
    place_rank *ranks;
    size_t group_count, group_capacity;
} frame_groups;

/* Joins all that a frame has; *out is in the memory of g. Without memory, OUT_OF_MEMORY has no
 * sentence; so ends what does not fit the budget, too. */
cscd_status frame_groups_find(frame_groups *g, const cscd_mesh *mesh, const part_labels *parts,
                              const mesh_rings *rings, const frame_input *input, frame_row *out);
void frame_groups_free(cscd_context *context, frame_groups *g);

/* The straight way from a piece's first point to the second one. */
double curve_piece_length(const cscd_curves *curves, const cscd_curve *curve, size_t piece);
