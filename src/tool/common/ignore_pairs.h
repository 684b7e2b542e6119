/* Triangle pairs that the user wants left out: those that intersect or touch in the first frame, and those of a
 * list file. */
#pragma once

#include "src/tool/common/recording.h"

typedef struct ignore_pairs {
    const cscd_mesh *mesh;
    cscd_intersection *triangles; /* sorted by (a, b) */
    size_t triangle_count, triangle_capacity;
    cscd_intersection *components; /* a <= b; few */
    size_t component_count, component_capacity;
} ignore_pairs;

/* Each line of a list file is `A B` (two triangles), `components A B` (all pairs between two components, or
 * within one), blank, or a comment from # on. Triangles are numbered from 0 in the order of the model file, a polygon
 * counting as many as it is cut into; with several objects they are `NAME:A`, of the first one `A` as well. Components
 * are numbered as `cscd info` lists them. */
bool ignore_pairs_read(ignore_pairs *pairs, const recording *r, const char *path, io_error *error);

/* Adds the pairs that intersect or touch in the first frame. */
bool ignore_pairs_add_rest(ignore_pairs *pairs, recording *r, io_error *error);

/* Makes a detector leave out the pairs, which live until it has been destroyed. */
void ignore_pairs_choose(ignore_pairs *pairs, cscd_detector_options *options);

void ignore_pairs_free(ignore_pairs *pairs);
