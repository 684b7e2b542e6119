/* Frames as binary PLY files, whose vertices and faces have the arrays of an export as properties. */
#pragma once

#include "tool/export/export_values.h"

typedef struct ply_output {
    char *stem; /* NULL: nothing was asked for */
    const recording *recording;
    const part_names *parts;
    const export_values *values;
} ply_output;

/* No file that a frame would be written to may be a mesh that this module has not written. On false *out holds nothing to
 * free. */
bool ply_output_open(const char *path, const recording *r, const part_names *parts,
                     const export_values *values, ply_output *out, io_error *error);
bool ply_output_add_frame(const ply_output *p, int32_t number, const double *positions, io_error *error);
void ply_output_free(ply_output *p);
