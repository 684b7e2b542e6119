/* The options of `cscd untangle`, a run with them, its outputs, and its answers. */
#pragma once

#include "cscd/cscd.h"
#include "cscd/untangle.h"
#include "tool/answers/answers.h"
#include "tool/common/command.h"
#include "tool/common/frame_range.h"
#include "tool/common/ignore_pairs.h"
#include "tool/common/options.h"
#include "tool/common/recording.h"
#include "tool/common/terminal.h"
#include "tool/io/mesh_copy.h"
#include "tool/io/point_cache.h"

/* ---- options ------------------------------------------------------------------------------------------- */

typedef struct untangle_options {
    recording_options source;
    frame_range frames;
    const char *output_path, *json_path, *report_path, *rest_path;
    length_given gap, spread, bending;
    length_unit unit;       /* its name is NULL: what the files say */
    part_pairs_list pinned; /* each a list of names */
    double steady, seconds; /* seconds: 0 for no limit */
    ignore_options ignored;
    bool partial, quiet;
} untangle_options;

extern const option_table untangle_table;

/* Runs the command. Returns the exit code. */
int untangle_run_on(const untangle_options *options);

/* Reads positions at rest: those of the model from a file with the same faces. */
bool rest_shape_read(const char *path, const recording *r, double *positions, io_error *error);

/* ---- outputs ------------------------------------------------------------------------------------------- */

/* The file of positions: one frame as a mesh, or all of them as a point cache. */
typedef struct untangle_output {
    const char *path;
    mesh_copy *copy; /* of the model, whose vertices move; NULL: its triangles are written */
    point_cache_writer *cache;
    bool is_cache;
    bool holds_floats;      /* positions are rounded to floats */
    double *file_positions; /* of the model's file */
} untangle_output;

/* Can a file of this name be written, of some model? The error says which can. */
bool untangle_output_named(const char *path, io_error *error);

/* The same of this model. frame_count: how many frames are chosen. */
bool untangle_output_fits(const char *path, const recorded_object *model, uint32_t frame_count,
                          io_error *error);

/* Begins the file. On false untangle_output_abandon is due. */
bool untangle_output_open(const char *path, const recording *r, const frame_choice *frames,
                          untangle_output *out, io_error *error);

/* Writes the i-th frame of those chosen. positions: of the mesh; moved: false for each vertex of the mesh that
 * is where the file has it. The model's file positions of the frame were read last. A mesh is whole then. */
bool untangle_output_write(untangle_output *out, const recording *r, uint32_t i, const double *positions,
                           const bool *moved, io_error *error);

/* Keeps the frames that were written, count of those chosen from the first on; 0: none, and an older file
 * stays. A zeroed struct is fine. */
bool untangle_output_close(untangle_output *out, uint32_t first, uint32_t count, io_error *error);

/* ---- answers ------------------------------------------------------------------------------------------- */

/* Why pairs are left. */
typedef enum left_reason {
    LEFT_NO_WAY,   /* no way out of each other was found */
    LEFT_FLUSH,    /* the same, and they lie on each other only: none of them crosses */
    LEFT_TIME,     /* the time was up */
    LEFT_STOPPED,  /* the run was interrupted */
    LEFT_IMMOBILE, /* neither of the two may move */
    LEFT_REASONS
} left_reason;

/* Pairs of triangles of two parts that are left in a frame. */
typedef struct left_pairs {
    uint32_t a, b; /* parts */
    size_t pairs;
    left_reason reason;
} left_pairs;

/* What has become of a frame. */
typedef struct untangled_frame {
    bool done;
    cscd_untangled found;
    left_pairs *left; /* by parts, most pairs first; to be freed */
    size_t left_count;
    bool crosses_as_floats; /* it is clean, and would not be if its numbers were rounded to floats */
} untangled_frame;

typedef struct untangle_answer {
    const recording *recording;
    const ignore_pairs *ignored;
    length_unit unit;
    double gap, seconds;
    frame_choice choice;
    untangled_frame *frames; /* of those chosen, in their order */
    uint32_t count;          /* of them */
    uint32_t first, end;     /* those that are done follow each other */
    const char *stopped_by;  /* why not all are done; NULL: they are */
    const char *written;     /* where the positions are; NULL: nowhere */
} untangle_answer;

/* Every frame that is done is clean, and one is. */
bool untangle_answer_clean(const untangle_answer *a);

/* Prints the sentence, and what is not clean. */
void untangle_answer_print(const untangle_answer *a);

void untangle_answer_write_json(const untangle_answer *a, json *out);

/* ---- the page ------------------------------------------------------------------------------------------- */

/* The frames that the report draws: as many as it has room for. Zeroed: there is no report. */
typedef struct untangle_pages {
    const char *path;
    uint32_t frame_count, vertex_count, stride, place_count;
    double *before, *after; /* of each place */
    int32_t *numbers;       /* of frames that are drawn */
} untangle_pages;

/* path: NULL for no report. On false untangle_pages_close is due. */
bool untangle_pages_open(const char *path, uint32_t frame_count, uint32_t vertex_count, untangle_pages *out,
                         io_error *error);
void untangle_pages_close(untangle_pages *pages); /* a zeroed struct is fine */

/* The i-th frame of those chosen, in any order. */
void untangle_pages_add(untangle_pages *pages, uint32_t i, const double *before, const double *after);

/* Writes the page of the frames that are done. */
bool untangle_pages_write(untangle_pages *pages, const untangle_answer *answer, cscd_detector *detector,
                          io_error *error);
