/* What a replay learns of an interval and of a frame, from the detector or from the file of a shard. What
 * pointers lead to lives until the next interval or frame is asked for. */
#pragma once

#include "cscd/cscd.h"
#include "tool/report/report.h"

/* An interval. */
typedef struct interval_step {
    cscd_contacts contacts;
    size_t
        unlisted; /* so many contacts, where a list of them does not fit the memory: then nothing else is known */
    cscd_counters counters;
    cscd_timings timings;             /* of the step; check_ms is that of an earlier frame */
    const cscd_guarantee *guarantees; /* per component; NULL: contacts are unlisted */
    const orientation_row *orientations;
} interval_step;

/* A frame. */
typedef struct frame_check {
    bool checked; /* else nothing was looked for, and found and ms are 0 */
    cscd_intersection_pairs found;
    double ms;
    const bool *turned;     /* per component, as in cscd_patches; NULL: nothing is */
    const uint64_t *hashes; /* of the positions, per object (recording_hash_frame) */
} frame_check;
