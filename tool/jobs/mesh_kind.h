/* Jobs that check a mesh each, as `check --each` has them: pairs of triangles, and how deep the worst of them is. */
#pragma once

#include "tool/answers/answer_options.h"
#include "tool/jobs/job_work.h"

typedef struct mesh_kind_options {
    const recording_options *source; /* how meshes are read */
    const ignore_options *ignored;   /* pairs of parts */
    const answer_options *answers;   /* rules, unit, depths */
    bool reproducible;               /* lines come without times */
} mesh_kind_options;

/* The options outlive the kind. */
job_kind mesh_kind_of(const mesh_kind_options *options);
