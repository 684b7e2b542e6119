/* Intervals in chunks of fixed length, which one run and all its shards have in common: at the beginning of each a new detector
 * starts, so that what it finds, and what that took, does not depend on who has done the chunks before. */
#pragma once

#include "tool/jobs/job_shards.h"

#include <stdbool.h>

/* A new detector builds its trees anew. At every 32nd interval that took 5 % of a replay's time in the middle of eight cases, and 20 %
 * at most. */
enum { CHUNK_INTERVALS = 32 };

/* Does a chunk begin with this frame? first: that of the whole replay. */
bool chunk_begins(uint32_t first, uint32_t frame);

/* The frames of a shard, of a replay of the frames first to last: whole chunks. Of more shards than chunks some are empty, and
 * have *shard_first == *shard_last. */
void chunks_of_shard(uint32_t first, uint32_t last, shard_choice shard, uint32_t *shard_first,
                     uint32_t *shard_last);
