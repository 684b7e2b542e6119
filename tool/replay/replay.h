/* The parts of replay that other commands use: merging the shards of one recording, and telling their files
 * from others. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* An output of cscd replay, by its option. */
typedef struct merged_output {
    const char *option, *value; /* value NULL: not asked for */
} merged_output;

typedef struct merge_request {
    const char *const *paths; /* of the shards' files */
    size_t path_count;
    const merged_output *outputs;
    size_t output_count;
    bool quiet, reproducible;
    int argument_count; /* the command line, for the provenance */
    char **arguments;
} merge_request;

/* Says and writes what one run of the whole recording says and writes, byte for byte except its times and
 * its command line. Returns the exit code, that of such a run. */
int replay_merge(const merge_request *request);

/* True if it is the file of a shard of one recording. A file that cannot be read is none. */
bool shard_file_recognise(const char *path);
