/* Parts without a surface, frame by frame: hidden by a scale of 0, or squashed to a line. */
#pragma once

#include "tool/common/frame_list.h"
#include "tool/common/part_names.h"

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
