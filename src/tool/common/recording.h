/* A model file and its recorded frames, welded if the user asks for it, as a mesh and an array of
 * positions for each frame. */
#pragma once

#include "cscd/cscd.h"
#include "src/io/animation.h"
#include "src/io/contact_file.h"
#include "src/io/mesh_file.h"
#include "src/io/weld.h"
#include "src/tool/common/option_table.h"

/* A number that may not be given. */
typedef struct frame_number {
    bool given;
    int32_t value;
} frame_number;

typedef struct recording_options {
    const char *model_path;
    const char *const *frame_paths; /* none: the model is the only frame */
    size_t frame_path_count;
    bool allow_gaps;          /* of a series of mesh files, some may be missing */
    frame_number first_frame; /* what the first frame is called; not given: what its file says */
    bool weld;
    double weld_epsilon;
    uint32_t thread_count;
    cscd_simd simd;
    cscd_progress progress; /* of the context; NULL: none */
} recording_options;

/* MODEL and FRAMES: the first input and the others. There is one at least. */
void recording_options_take(recording_options *options, const given_options *given);

typedef struct recording {
    cscd_context *context;
    cscd_mesh *mesh; /* of welded vertices and triangles */
    mesh_file file;
    animation *frames; /* NULL: the model is the only frame */
    uint32_t frame_count;
    int32_t *frame_numbers; /* frame_count, ascending: what the artist calls each frame */
    bool welded;
    weld weld;
    double *file_positions;            /* of the frame read last */
    uint32_t (*edge_file_vertices)[2]; /* per edge of mesh; NULL when not welded */
    uint64_t model_hash, frames_hash;
} recording;

/* On false *out holds nothing to close. */
bool recording_open(const recording_options *options, recording *out, io_error *error);
void recording_close(recording *r);

/* Reads a frame, by its index from 0. positions: cscd_mesh_vertex_count(mesh) * 3. The error names the frame, and vertices as
 * the file numbers them. */
bool recording_read(recording *r, uint32_t frame, double *positions, io_error *error);

/* Copies the positions of the model file itself, unchecked; positions as above. */
void recording_rest(const recording *r, double *positions);

/* Adds the file's positions of the frame read last to frames_hash. */
void recording_hash_frame(recording *r);

/* A contact, with the vertices that the model file numbers. */
contact_record recording_contact(const recording *r, uint32_t frame, const cscd_contact *contact);

/* The model file's own number of a triangle of the mesh. */
uint32_t recording_file_triangle(const recording *r, uint32_t triangle);

/* The number of the edge between two vertices of the mesh, which must have it. */
uint32_t recording_find_edge(const cscd_mesh *mesh, uint32_t a, uint32_t b);

/* Warns on stderr about triangles that welding has dropped, and about open, non-manifold and
 * inconsistently oriented components. */
void recording_warn(recording *r);
