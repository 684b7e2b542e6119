/* One frame: what was found in it, joined to groups. */
#pragma once

#include "runtime/events/event_history.h"
#include "src/core/memory_budget.h"
#include "src/mesh/given_contacts.h"

/* What counts of a contact for events. */
typedef struct tracked_contact {
    double toi, point[3];
    uint32_t a, b;
    cscd_contact_kind kind;
} tracked_contact;

/* What a frame has, checked: all numbers are of the mesh. */
typedef struct frame_input {
    const cscd_intersection_pairs *found; /* NULL: nothing */
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

/* How good a place is that a group is to be looked at. */
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
    uint32_t *
        stamped_places; /* per triangle: where it is among those that were stamped, if it is; else anything */
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

/* INVALID_ARGUMENT names what is not of the mesh. */
cscd_status frame_input_check(const cscd_mesh *mesh, const cscd_intersection_pairs *found);

/* The straight way from a piece's first point to the second one. */
double curve_piece_length(const cscd_curves *curves, const cscd_curve *curve, size_t piece);
