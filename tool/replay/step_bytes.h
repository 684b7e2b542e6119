/* An interval and a frame of a replay, from the detector or from the file of a shard, and their bytes in such
 * a file. */
#pragma once

#include "cscd/cscd.h"
#include "tool/io/io.h"
#include "tool/report/report.h"

#include <stdint.h>

/* ---- intervals and frames ------------------------------------------------------------------------------ */

/* The findings of an interval. Pointers lead to what lives until the next interval or frame is read. */
typedef struct interval_step {
    cscd_contacts contacts;
    size_t unlisted; /* contacts, where a list of them does not fit the memory: then nothing else is known */
    cscd_counters counters;
    cscd_timings timings;             /* of the step; check_ms is that of an earlier frame */
    const cscd_guarantee *guarantees; /* per component; NULL: contacts are unlisted */
    const orientation_row *orientations;
} interval_step;

/* The findings of a frame. */
typedef struct frame_check {
    bool checked; /* else nothing was looked for, and found and ms are 0 */
    cscd_intersections found;
    double ms;
    const bool *turned;     /* per component, as in cscd_patches; NULL: nothing is */
    const uint64_t *hashes; /* of the positions, per object (recording_hash_frame) */
} frame_check;

/* ---- bytes --------------------------------------------------------------------------------------------- */

typedef struct packed_bytes {
    growable bytes; /* of one byte each */
    bool failed;    /* out of memory: nothing more was added */
} packed_bytes;

packed_bytes packed_bytes_create(void);
void packed_bytes_free(packed_bytes *p); /* a zeroed struct is fine */
void packed_bytes_clear(packed_bytes *p);

void packed_bytes_add(packed_bytes *p, const void *data, size_t size);
/* The count, and the elements. */
void packed_bytes_add_array(packed_bytes *p, const void *items, size_t count, size_t element_size);

/* Takes them out again in the same order. */
typedef struct packed_reader {
    const unsigned char *at, *end; /* at: on a multiple of 8 bytes */
    bool torn;                     /* what was asked for goes past the end; NULL is returned from then on */
} packed_reader;

const void *packed_reader_take(packed_reader *r, size_t size);
bool packed_reader_copy(packed_reader *r, void *out, size_t size);
const void *packed_reader_take_array(packed_reader *r, size_t *count, size_t element_size);

/* The layout of all structs that are written: it tells builds and machines apart. */
uint64_t step_bytes_layout(void);

void step_bytes_add_interval(packed_bytes *out, const interval_step *step, uint32_t component_count);
/* Patches are left out: nothing that is written of a recording in shards needs them. */
void step_bytes_add_frame(packed_bytes *out, const frame_check *check, uint32_t object_count,
                          uint32_t component_count);

/* The memory, beside the bytes, to which an interval and a frame that were taken point. The triangle count of
 * the orientations is set by the caller. */
typedef struct step_place {
    orientation_row orientations;
    cscd_curves curves;
    cscd_depths depths;
    cscd_part_pairs parts;
} step_place;

/* Takes one. It points into the bytes and to the place. False: these are other bytes. */
bool step_bytes_take_interval(packed_reader *in, step_place *place, interval_step *out,
                              uint32_t component_count);
bool step_bytes_take_frame(packed_reader *in, step_place *place, frame_check *out, uint32_t object_count,
                           uint32_t component_count);
