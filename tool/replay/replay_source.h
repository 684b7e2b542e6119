/* The source of the intervals and frames of a replay, one after the other: the files of shards, as far as
 * these have them, and the detector, for which a thread reads frames ahead. */
#pragma once

#include "tool/answers/answers.h"
#include "tool/common/plans.h"
#include "tool/common/recording.h"
#include "tool/replay/replay_options.h"
#include "tool/replay/shard_file.h"
#include "tool/replay/step_bytes.h"

/* ---- frames -------------------------------------------------------------------------------------------- */

/* Reads the frames of a recording on a thread of its own, one ahead: while one interval is computed, the next
 * frame is read, parsed, welded and hashed. */
typedef struct read_ahead read_ahead;

/* Begins with frame `first`, which must not be after `last`. Nobody else reads the recording until it is
 * closed. On false *out is NULL. */
bool read_ahead_open(recording *r, uint32_t first, uint32_t last, read_ahead **out, io_error *error);
void read_ahead_close(read_ahead *a); /* NULL is fine */

/* The next frame, which the caller must not ask for after the last one. *positions are exchanged for others
 * of the same size. */
bool read_ahead_take(read_ahead *a, double **positions, uint64_t hashes[RECORDING_OBJECTS_MAX + 1],
                     io_error *error);

/* ---- the detector -------------------------------------------------------------------------------------- */

/* The detector of a replay: steps, checks, and a new one for each chunk. */
typedef struct replay_detector {
    /* All of these outlive it. */
    const replay_options *options;
    const recording *recording;
    const cscd_plan *plan; /* NULL: none */
    cscd_method method;
    ignore_pairs *ignored;
    const answers *answers;
    bool takes_orientations; /* else steps come without */
    bool told_half_turn;     /* one note is enough */

    cscd_detector *detector;
    cscd_guarantee *guarantees;
    orientation_row orientations;
} replay_detector;

/* Makes the first detector; the members above are set. Whatever this returns, replay_detector_close is
 * due. */
bool replay_detector_open(replay_detector *d, io_error *error);
void replay_detector_close(replay_detector *d); /* a zeroed struct is fine */

/* Puts a new detector in its place, which knows nothing of what was before. */
bool replay_detector_renew(replay_detector *d, io_error *error);

/* True if its method has detector points. */
bool replay_detector_is_oriented(const replay_detector *d);

/* The interval from frame k on. Contacts are the detector's. */
bool replay_detector_step(replay_detector *d, uint32_t k, const double *x0, const double *x1,
                          interval_step *out, io_error *error);

/* Finds what intersects in a frame, unless the options say not to look. out->hashes is the caller's. */
bool replay_detector_check(replay_detector *d, uint32_t frame, const double *positions, frame_check *out,
                           io_error *error);

/* ---- shards -------------------------------------------------------------------------------------------- */

typedef struct shard_entry {
    const char *path;
    shard_identity identity;
} shard_entry;

/* Shards of a recording one after the other: the intervals that their files have. */
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

/* The intervals of one file up to the frame `until`. */
bool shard_series_open_part(const char *path, uint32_t until, shard_series *out, io_error *error);

void shard_series_close(shard_series *s); /* a zeroed struct is fine */

/* The first frame. */
bool shard_series_begin(shard_series *s, frame_check *out, io_error *error);
/* The next interval, and then the frame at its end. */
bool shard_series_step(shard_series *s, interval_step *out, io_error *error);
bool shard_series_check(shard_series *s, frame_check *out, io_error *error);

/* ---- the source ---------------------------------------------------------------------------------------- */

typedef struct replay_source {
    /* These are set by whoever opens it. */
    recording *recording;
    uint32_t first;       /* frame of the whole replay: chunks are counted from it */
    uint32_t last;        /* frame of the replay */
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
