/* Runs every call of the API that may take long, one after the other, and computes a digest of each
 * result. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/scenes.h"

/* Makes a closed tube whose upper part comes down on the lower one after some frames. */
void workload_tube(sequence *out, int rings, int segments, uint32_t frame_count);

typedef struct workload {
    const sequence *sequence;
    cscd_method plan; /* AUTO: none */
    cscd_detector_options options;
    /* Called after each call; the call is repeated when it returns true. NULL: no call is repeated. */
    bool (*again)(void *user, cscd_context *context, cscd_status status);
    void *user;
} workload;

enum { WORKLOAD_CALLS_MAX = 400 };

typedef struct workload_result {
    bool failed; /* failed in a way that should not happen */
    uint32_t call_count;
    uint64_t digests[WORKLOAD_CALLS_MAX];
    uint64_t contacts, rebuilds, culled; /* sums over all steps */
} workload_result;

/* Makes a plan and a detector; then, over the intervals of the sequence, takes steps and now and then runs
 * a static check, proximity queries, the longest step, and line searches. It asserts nothing, so that any
 * thread may run it. */
workload_result workload_run(cscd_context *context, const workload *w);
