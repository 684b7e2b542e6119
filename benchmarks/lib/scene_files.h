/* Recordings that benchmarks replay: all frames in memory, and a new plan by charge. */
#pragma once

#include "cscd/cscd.h"
#include "tool/io/io.h"
#include "tool/io/mesh_file.h"

typedef struct recording_data {
    char name[64];
    cscd_context *context;
    cscd_mesh *mesh;
    mesh_file model;
    uint32_t frame_count;
    double *frames;    /* frame_count * vertex_count * 3 */
    cscd_plan *charge; /* by charge; NULL when no component is closed */
    double made_ms;    /* time spent making what was missing: recording, plan */
} recording_data;

/* Reads folder/name.obj and .pc2, which are recorded first when they are missing and name is a scene of models/softbody. */
bool recording_data_open(const char *folder, const char *name, uint32_t thread_count, recording_data *out,
                         io_error *error);

/* Two frames as mesh files, one interval; closed components or not, it has no plan. */
bool recording_data_open_frames(const char *name, const char *start, const char *end, uint32_t thread_count,
                                recording_data *out, io_error *error);
void recording_data_close(recording_data *r);

const double *recording_data_frame(const recording_data *r, uint32_t frame);
