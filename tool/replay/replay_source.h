/* Where a replay has its intervals and frames from, one after the other: from the files of shards, as far as
 * these have them, and from the detector. */
#pragma once

#include "tool/replay/read_ahead.h"
#include "tool/replay/replay_detector.h"
#include "tool/replay/shard_series.h"

typedef struct replay_source {
    /* These are set by whoever opens it. */
    recording *recording;
    uint32_t first;       /* frame of the whole replay: chunks are counted from it */
    uint32_t last;        /* frame that is asked for */
    shard_series *shards; /* what they have is not found again; NULL: nothing is there */
    bool reads_frames;    /* positions are wanted of what shards have, too */
    append_file *results; /* what is found is added to it; NULL: to nothing */
    replay_detector detector;

    read_ahead *frames; /* NULL: none was read yet */
    double *x0, *x1;    /* positions at the start and at the end of the interval */
    uint64_t hashes[RECORDING_OBJECTS_MAX + 1];
    packed_bytes bytes; /* of the record to come */
} replay_source;

/* Whatever this returns, replay_source_close is due. */
bool replay_source_open(replay_source *s, io_error *error);
void replay_source_close(replay_source *s); /* a zeroed struct is fine */

/* The first frame; its positions are in x0. */
bool replay_source_begin(replay_source *s, uint32_t frame, frame_check *out, io_error *error);

/* The interval that begins with frame k; x1 has the positions at its end. */
bool replay_source_step(replay_source *s, uint32_t k, interval_step *out, io_error *error);

/* The frame at its end, after which x0 has its positions. */
bool replay_source_check(replay_source *s, uint32_t k, frame_check *out, io_error *error);
