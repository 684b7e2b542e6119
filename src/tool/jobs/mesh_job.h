/* One mesh among many: how it is read and checked, and what was found. */
#pragma once

#include "src/tool/common/ignore_pairs.h"
#include "src/tool/common/recording.h"

typedef struct mesh_job {
    const char *path;
    weld_choice weld;
    const ignore_options *ignored; /* pairs of parts that are left out */
} mesh_job;

typedef struct mesh_answer {
    bool checked;                          /* else the error says why not, and all else is 0 */
    char *error;                           /* NULL: no memory was left for it */
    uint32_t triangle_count, vertex_count; /* welded, if that was asked for */
    size_t crossing, coplanar, folded, duplicate, touching; /* so many pairs of triangles of each kind */
    uint32_t crossing_faces; /* so many triangles are in a pair that crosses, */
    double crossing_share;   /* and that share of all */
    uint32_t zero_area_triangles;
    mesh_repairs repairs;
    char *unread; /* as in mesh_file */
    double read_ms, check_ms;
} mesh_answer;

/* Reads a mesh and finds what intersects in it. False: the context's progress has cancelled the search, and *out holds
 * nothing to free. A mesh that cannot be read or checked is an answer, too: its error says why. */
bool mesh_job_run(const mesh_job *job, cscd_context *context, mesh_answer *out);
void mesh_answer_free(mesh_answer *answer);

/* Why the mesh was not checked. */
const char *mesh_answer_reason(const mesh_answer *answer);
