/* Which jobs of a list are whose: a function of the list alone, so that machines need not talk to each other. */
#pragma once

#include "tool/jobs/job_list.h"

/* i/n of --shard: i from 1 to n. Zeroed: all jobs are one shard. */
typedef struct shard_choice {
    uint32_t index, count;
} shard_choice;

enum { SHARD_COUNT_MAX = 1000 * 1000 };

/* The reader of --shard (options.h); place: shard_choice. */
bool read_shard(const char *text, void *place);

/* The jobs of the shard, ascending, to be freed. Of jobs with a size, the largest goes first to the shard with the least
 * (Graham 1969, largest processing time first; of equals the first); the others go round, job i to shard i modulo n. */
bool job_shard_choose(const job_list *list, shard_choice shard, uint32_t **jobs, uint32_t *count,
                      io_error *error);
