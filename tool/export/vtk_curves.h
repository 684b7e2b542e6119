/* Intersection curves as polylines of a .vtp file. */
#pragma once

#include "cscd/cscd.h"
#include "tool/export/vtp_file.h"

typedef struct vtk_curves {
    uint64_t count, point_count, corner_count;
    double *points;
    int64_t *corners, *ends; /* a closed curve has its first point at its end, too */
    double *lengths;
    uint32_t *objects[2];
    uint8_t *closed, *touching;
} vtk_curves;

/* Copies what a file needs. On false *out holds nothing to free. */
bool vtk_curves_collect(const cscd_curves *curves, vtk_curves *out);
void vtk_curves_free(vtk_curves *lines);

/* Adds points, lines, and their arrays: length, closed, touching, object_a and object_b. */
void vtk_curves_add(const vtk_curves *lines, vtp_file *file);
