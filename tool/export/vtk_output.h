/* Frames as .vtp files of VTK, surfaces and curves, with a .pvd over time of each, as ParaView opens them. */
#pragma once

#include "tool/export/export_values.h"
#include "tool/io/growable.h"

typedef struct vtk_choice {
    double fps; /* frames a second; 0: times are frame numbers */
    bool curves;
} vtk_choice;

/* Curves have files of their own, because an array of VTK says something of every cell of its file, and what is said of curves and
 * of triangles differs; in ParaView they are then an object of their own, with its own width, colour and eye. */
typedef struct vtk_output {
    char *stem; /* NULL: nothing was asked for */
    vtk_choice choice;
    const recording *recording;
    const export_values *values;
    int64_t *corners, *ends; /* of all triangles */
    growable part_texts, object_texts;
    uint32_t part_count;
    growable frames; /* int32_t, the numbers of those that are written */
} vtk_output;

/* On false *out holds nothing to free. */
bool vtk_output_open(const char *path, vtk_choice choice, const recording *r, const part_names *parts,
                     const export_values *values, vtk_output *out, io_error *error);
/* curves: if they were chosen. */
bool vtk_output_add_frame(vtk_output *v, int32_t number, const double *positions, const cscd_curves *curves,
                          io_error *error);

/* Writes the .pvd files of the frames that are there. */
bool vtk_output_finish(vtk_output *v, io_error *error);
void vtk_output_free(vtk_output *v);
