/* One mesh among many: how it is read and checked, what was found in all frames that its file holds, and its line of results. */
#pragma once

#include "tool/answers/answer_options.h"
#include "tool/jobs/job_record.h"
#include "tool/jobs/job_work.h"

typedef struct mesh_job {
    const char *path;
    const recording_options *source; /* how it is read: welding, frames a second, which animation, rest */
    const ignore_options *ignored;   /* pairs of parts that are left out */
    const answer_options *answers;   /* rules, unit, whether depths are looked for */
} mesh_job;

typedef struct mesh_answer {
    bool checked;                          /* else the error says why not, and all else is 0 */
    char *error;                           /* NULL: no memory was left for it */
    uint32_t triangle_count, vertex_count; /* welded, if that was asked for */
    uint32_t frame_count;                  /* that were checked: 1, or those of the animation */
    size_t crossing, coplanar, folded, duplicate,
        touching; /* so many pairs of triangles of each kind, of all frames together */
    uint32_t
        crossing_faces;    /* so many triangles are in a pair that crosses, in the frame that has the most, */
    double crossing_share; /* and that share of all */
    double depth;          /* the greatest; 0: none is known */
    job_outcome outcome;
    bool found;     /* what the rules ask for */
    char *sentence; /* as `check` begins */
    uint32_t zero_area_triangles;
    mesh_repairs repairs;
    char *unread; /* as in mesh_file */
    double read_ms, check_ms;
} mesh_answer;

/* Reads a mesh and finds what intersects in it. False: the search was interrupted, and *out holds
 * nothing to free. A mesh that cannot be read or checked is an answer, too: its error says why. */
bool mesh_job_run(const mesh_job *job, cscd_context *context, mesh_answer *out);
void mesh_answer_free(mesh_answer *answer);

/* Why the mesh was not checked. */
const char *mesh_answer_reason(const mesh_answer *answer);

typedef struct mesh_kind_options {
    const recording_options *source; /* how meshes are read */
    const ignore_options *ignored;   /* pairs of parts */
    const answer_options *answers;   /* rules, unit, depths */
    bool reproducible;               /* lines come without times */
} mesh_kind_options;

/* The options outlive the kind. */
job_kind mesh_kind_of(const mesh_kind_options *options);
