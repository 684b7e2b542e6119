/* Every call of the API that takes long, one after the other, and a digest of what each gave. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/sequences.h"

/* A closed tube whose upper part comes down on the lower one after some frames. */
void workload_tube(sequence *out, int rings, int segments, uint32_t frame_count);

typedef struct workload {
    const sequence *sequence;
    cscd_method plan; /* AUTO: none */
    cscd_detector_options options;
    /* Called after each call; true: it is made once more. NULL: each is made once. */
    bool (*again)(void *user, cscd_context *context, cscd_status status);
    void *user;
} workload;

enum { WORKLOAD_CALLS_MAX = 400 };

typedef struct workload_result {
    bool failed; /* in a way that nothing here should */
    uint32_t call_count;
    uint64_t digests[WORKLOAD_CALLS_MAX];
    uint64_t contacts, rebuilds, culled; /* of all steps */
} workload_result;

/* Plan and detector, then over the sequence's intervals steps and, now and then, a static check, what is
 * near, the longest step, and lines. Asserts nothing, so any thread may run it. */
workload_result workload_run(cscd_context *context, const workload *w);
