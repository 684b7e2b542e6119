/* Intervals and frames as bytes. */
#pragma once

#include "tool/replay/interval_step.h"
#include "tool/replay/packed_bytes.h"

/* The layout of all structs that are written: it tells builds and machines apart. */
uint64_t step_bytes_layout(void);

void step_bytes_add_interval(packed_bytes *out, const interval_step *step, uint32_t component_count);
/* Patches are left out: nothing that is written of a recording in shards needs them. */
void step_bytes_add_frame(packed_bytes *out, const frame_check *check, uint32_t object_count,
                          uint32_t component_count);

/* What an interval and a frame that were taken point to beside the bytes. The triangle count of the orientations is set by the
 * caller. */
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
