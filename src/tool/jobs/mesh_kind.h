/* Jobs that check a mesh each, as `check --each` has them: pairs of triangles, and nothing of parts and depths. */
#pragma once

#include "src/tool/common/ignore_pairs.h"
#include "src/tool/common/recording.h"
#include "src/tool/jobs/job_work.h"

typedef struct mesh_kind_options {
    weld_choice weld;
    ignore_options ignored;                  /* pairs of parts */
    bool fail_on_crossing, fail_on_touching; /* found is what crosses; or touches as well */
    bool reproducible;                       /* lines come without times */
} mesh_kind_options;

/* The options outlive the kind. */
job_kind mesh_kind_of(const mesh_kind_options *options);
