/* Intervals in chunks of fixed length, which one run and all its shards have in common. */
#include "tool/replay/replay_chunks.h"

bool chunk_begins(uint32_t first, uint32_t frame) {
    return (frame - first) % CHUNK_INTERVALS == 0;
}

static uint32_t frame_of_chunk(uint32_t first, uint32_t last, uint64_t chunk) {
    const uint64_t frame = first + chunk * CHUNK_INTERVALS;
    return frame < last ? (uint32_t)frame : last;
}

void chunks_of_shard(uint32_t first, uint32_t last, shard_choice shard, uint32_t *shard_first,
                     uint32_t *shard_last) {
    const uint64_t intervals = last - first, chunks = (intervals + CHUNK_INTERVALS - 1) / CHUNK_INTERVALS;
    *shard_first = frame_of_chunk(first, last, chunks * (shard.index - 1) / shard.count);
    *shard_last = frame_of_chunk(first, last, chunks * shard.index / shard.count);
}
