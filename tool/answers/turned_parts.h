/* Parts whose triangles are not what they seem: those that are inside out, and taken as turned around, and those without a surface. */
#pragma once

#include "tool/common/frame_range.h"
#include "tool/common/part_names.h"
#include "tool/io/json.h"

/* In so many frames, from the first to the last one, by their indices. */
typedef struct turned_frames {
    uint32_t count, first, last;
} turned_frames;

typedef struct turned_parts {
    const recording *recording;
    const part_names *names;
    turned_frames *components; /* of each component */
    uint32_t *parts;           /* of each component: that of its first triangle */
    turned_frames any;         /* frames in which some component was */
    uint32_t frame_count;      /* that were looked at */
} turned_parts;

/* False: out of memory, and *out holds nothing. names outlive it. */
bool turned_parts_open(const recording *r, const part_names *names, turned_parts *out);
void turned_parts_close(turned_parts *t); /* a zeroed struct is fine */

/* Adds a frame, of which the library says per component what was turned; NULL: nothing. */
void turned_parts_add(turned_parts *t, uint32_t frame, const bool *turned);

/* A note for people, if there was something: "part wheel is inside out; it was taken as turned around". */
void turned_parts_tell(const turned_parts *t);

/* The member "inside_out": an item for each component that ever was. */
void turned_parts_write(const turned_parts *t, json *out);

/* The frames of a part: in `whole` all of its triangles had no area, in `partly` those of some pieces of it. */
typedef struct collapsed_part {
    frame_list whole, partly;
} collapsed_part;

typedef struct collapsed_parts {
    const recording *recording;
    const part_names *names;
    collapsed_part *parts; /* per part; NULL: no frame has any */
    uint32_t *sizes;       /* per part: so many triangles, */
    uint32_t *without;     /* and so many in collapsed components of the present frame */
    bool *components;      /* per component: it is collapsed in the present frame */
} collapsed_parts;

collapsed_parts collapsed_parts_of(const recording *r, const part_names *names);
void collapsed_parts_free(collapsed_parts *c);

/* Adds what was found in a frame. frame: a number of the caller's, above those before. False: no memory. */
bool collapsed_parts_add(collapsed_parts *c, uint32_t frame, const cscd_intersection_pairs *found);

/* The frames of a part; NULL: it always had a surface. */
const collapsed_part *collapsed_parts_at(const collapsed_parts *c, uint32_t part);
