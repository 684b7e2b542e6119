/* Reads the frames of a recording on a thread of its own, one ahead of those that are asked for: while one
 * interval is computed, the next frame is read, parsed, welded and hashed. */
#pragma once

#include "tool/common/recording.h"

typedef struct read_ahead read_ahead;

/* Begins with frame `first`, which must not be after `last`. Nobody else reads the recording until it is
 * closed. On false *out is NULL. */
bool read_ahead_open(recording *r, uint32_t first, uint32_t last, read_ahead **out, io_error *error);
void read_ahead_close(read_ahead *a); /* NULL is fine */

/* The next frame, which the caller must not ask for after the last one. *positions are exchanged for others
 * of the same size. */
bool read_ahead_take(read_ahead *a, double **positions, uint64_t hashes[RECORDING_OBJECTS_MAX + 1],
                     io_error *error);
