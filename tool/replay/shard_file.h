/* The file of a shard of a recording: who it is, then a record for each of its intervals, in order
 * (docs/artist/formats.md). Shards consist of chunks of fixed length, which one run and all its shards have
 * in common. */
#pragma once

#include "tool/io/io.h"
#include "tool/io/output_file.h"
#include "tool/jobs/jobs.h"
#include "tool/replay/step_bytes.h"

#include <stdbool.h>
#include <stdio.h>

/* The identity of a shard. Shards of one replay differ in `shard` and its frames alone. */
typedef struct shard_identity {
    uint64_t build, model, plan, options; /* hashes */
    uint32_t first, last;                 /* frames of the whole replay, */
    uint32_t shard_first, shard_last;     /* and of the shard; equal: it has no interval */
    shard_choice shard;
    uint32_t object_count, component_count, triangle_count, reserved;
} shard_identity;

/* Says what the second of two shards is of, if not of the same replay: "another model"; NULL: it is of the
 * same. */
const char *shard_identity_difference(const shard_identity *a, const shard_identity *b);

typedef enum shard_record {
    SHARD_IDENTITY, /* and the command line */
    SHARD_FRAME,    /* the first frame */
    SHARD_INTERVAL  /* an interval and the frame at its end */
} shard_record;

/* ---- reading ------------------------------------------------------------------------------------------- */

typedef struct shard_reader {
    const char *path;
    FILE *file;
    unsigned char *record; /* the record taken last */
    size_t capacity;
    off_t whole_size; /* bytes up to its end */
    shard_identity identity;
    char **arguments; /* of the command line, from `replay` on */
    int argument_count;
} shard_reader;

/* Reads who the shard is. On false *out holds nothing to close. */
bool shard_reader_open(const char *path, shard_reader *out, io_error *error);
void shard_reader_close(shard_reader *r); /* a zeroed struct is fine */

typedef enum shard_end { SHARD_GOES_ON, SHARD_ENDS, SHARD_IS_TORN } shard_end;

/* The next record, whose bytes live until the next call. Torn: the file ends within a record, or its sum is
 * wrong. */
shard_end shard_reader_next(shard_reader *r, shard_record *kind, packed_reader *bytes);

/* ---- writing ------------------------------------------------------------------------------------------- */

/* Opens a file and locks it. It must be new or empty, unless it is to be resumed: then what does not make up
 * a whole chunk is cut off from its end, and *next is the frame to go on with; else it is shard_first. On
 * false *out holds nothing to close. */
bool shard_file_open(const char *path, bool resume, const shard_identity *identity, int argument_count,
                     char **arguments, append_file *out, uint32_t *next, io_error *error);
/* After an error the file ends with the record before. The bytes were begun by shard_file_begin. */
bool shard_file_add(append_file *f, shard_record kind, packed_bytes *bytes, io_error *error);

/* Begins the bytes of a record. */
void shard_file_begin(packed_bytes *bytes);

/* A new detector builds its trees from scratch. At every 32nd interval that took 5 % of a replay's time in
 * the middle of eight cases, and 20 % at most. */
enum { CHUNK_INTERVALS = 32 };

/* True if a chunk begins with this frame. first: that of the whole replay. */
bool chunk_begins(uint32_t first, uint32_t frame);

/* The frames of a shard, of a replay of the frames first to last: whole chunks. Of more shards than chunks
 * some are empty, and have *shard_first == *shard_last. */
void chunks_of_shard(uint32_t first, uint32_t last, shard_choice shard, uint32_t *shard_first,
                     uint32_t *shard_last);
