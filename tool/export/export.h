/* Results in the files of other programs: ParaView's, coloured PLY meshes, and lists of what to select. */
#pragma once

#include "tool/common/options.h"
#include "tool/common/part_names.h"

typedef struct export_request {
    const char *vtk_path, *ply_path, *select_path; /* NULL: not asked for */
    bool contacts;                                 /* each vertex has its number of contacts */
    bool no_depths; /* frames come without curves, patches and depths, so neither is written */
} export_request;

/* The rows of --vtk, --ply and --select. Places count from export_request. */
extern const option_list export_rows;

/* Files of both kinds have the frame's number in their names: out, out.pvd and out.ply all stand for
 * out_0017. False, with the reason, if a path has the ending of another format or is the standard output. */
bool export_request_fits(const export_request *request, io_error *error);

/* True if anything was asked for. */
bool export_request_any(const export_request *request);

typedef struct exports {
    struct export_run *run; /* NULL: nothing was asked for, and the functions below do nothing */
} exports;

/* recording, parts and plan (NULL: none) outlive the exports. On false *out holds nothing to close. No file
 * of the recording is ever written over. */
bool exports_open(const export_request *request, recording *r, const part_names *parts, const cscd_plan *plan,
                  exports *out, io_error *error);

/* The contacts of an interval, before the frame at its end. */
void exports_add_contacts(exports *e, const cscd_contacts *contacts);

/* Writes a frame, by its index from 0; frames ascend. positions: of the mesh. */
bool exports_add_frame(exports *e, uint32_t frame, const double *positions, const cscd_intersections *found,
                       io_error *error);

/* Writes what names the frames, of which there may be fewer than planned, and frees everything. Without a
 * frame older files stay. A zeroed struct is fine. */
bool exports_close(exports *e, io_error *error);
