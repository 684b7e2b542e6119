/* Lists of what to select in a modelling program: vertices and polygons of triangles that cross, part by part. */
#pragma once

#include "tool/common/part_names.h"
#include "tool/io/json.h"
#include "tool/io/output_file.h"

typedef struct selection_output {
    const char *path; /* NULL: nothing was asked for */
    recording *recording;
    const part_names *parts;
    output_file file;
    json out;
    uint8_t *now, *ever; /* per triangle: a set of what it is listed for, in this frame and in any one */
    uint32_t *listed;    /* the triangles of now, and at last of ever */
    uint32_t *numbers;   /* of one list */
} selection_output;

/* Opens the file, and writes what its numbers refer to. On false *out holds nothing to close. */
bool selection_output_open(const char *path, recording *r, const part_names *parts, selection_output *out,
                           io_error *error);
bool selection_output_add_frame(selection_output *s, int32_t number, const cscd_intersection_pairs *found,
                                io_error *error);

/* Writes the union of all frames, and puts the file in its place, if it is to be kept. */
bool selection_output_close(selection_output *s, bool kept, io_error *error);
