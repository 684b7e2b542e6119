/* A replay of a shard: which frames it has, and the file of its results. */
#pragma once

#include "tool/replay/replay_run.h"

/* Chooses the frames of the shard that the options ask for, and opens its file; what that has already is not found again. Without
 * --shard nothing happens. The recording, what is ignored and the plan are there. */
bool replay_shard_prepare(replay *r, io_error *error);

/* Are the shards that are merged those of this very recording? */
bool replay_shard_matches(const replay *r, io_error *error);

bool replay_shard_close(replay *r, io_error *error);
