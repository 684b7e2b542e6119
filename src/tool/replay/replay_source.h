/* Where a replay has its intervals and frames from, one after the other: the detector finds them, or the files of shards have
 * them already. */
#pragma once

#include "src/tool/replay/replay_detector.h"

typedef struct replay_source {
    recording *recording;
    replay_detector detector;
    uint32_t first;  /* frame of the whole replay: chunks are counted from it */
    double *x0, *x1; /* positions at the start and at the end of the interval */
    uint64_t hashes[RECORDING_OBJECTS_MAX + 1];
} replay_source;

/* The members of the detector that it needs are set, and nothing else is. Whatever this returns, replay_source_close is due. */
bool replay_source_open(replay_source *s, recording *r, uint32_t first, io_error *error);
void replay_source_close(replay_source *s); /* a zeroed struct is fine */

/* The first frame; its positions are in x0. */
bool replay_source_begin(replay_source *s, uint32_t frame, frame_check *out, io_error *error);

/* The interval that begins with frame k; x1 has the positions at its end. */
bool replay_source_step(replay_source *s, uint32_t k, interval_step *out, io_error *error);

/* The frame at its end, after which x0 has its positions. */
bool replay_source_check(replay_source *s, uint32_t k, frame_check *out, io_error *error);
