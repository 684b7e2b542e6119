/* Shards of a recording one after the other: the intervals that their files have. */
#pragma once

#include "tool/common/recording.h"
#include "tool/replay/interval_step.h"
#include "tool/replay/shard_file.h"
#include "tool/replay/step_bytes.h"

typedef struct shard_entry {
    const char *path;
    shard_identity identity;
} shard_entry;

typedef struct shard_series {
    shard_entry *entries; /* ascending; each has intervals */
    size_t count;
    uint32_t until;   /* the frame at the end of their intervals */
    char **arguments; /* the command line of one of them, from `replay` on */
    int argument_count;

    /* The place in them. */
    size_t current;
    shard_reader reader; /* of it; closed before the first */
    packed_reader rest;  /* of the record, behind its interval */
    step_place place;
    uint64_t hashes[RECORDING_OBJECTS_MAX + 1]; /* of the frame taken last */
} shard_series;

/* All shards of a recording. False, with the reason, which names those that are missing, there twice, not
 * done, or of something else. On false *out holds nothing to close. The paths outlive the series. */
bool shard_series_open(const char *const *paths, size_t count, shard_series *out, io_error *error);

/* What one file has up to the frame `until`. */
bool shard_series_open_part(const char *path, uint32_t until, shard_series *out, io_error *error);

void shard_series_close(shard_series *s); /* a zeroed struct is fine */

/* The first frame. */
bool shard_series_begin(shard_series *s, frame_check *out, io_error *error);
/* The next interval, and then the frame at its end. */
bool shard_series_step(shard_series *s, interval_step *out, io_error *error);
bool shard_series_check(shard_series *s, frame_check *out, io_error *error);
