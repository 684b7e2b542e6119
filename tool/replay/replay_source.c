/* The source of a replay's intervals and frames, one after the other. */
#include "tool/replay/replay_source.h"

#include "tool/replay/shard_file.h"

#include <stdlib.h>
#include <string.h>

bool replay_source_open(replay_source *s, io_error *error) {
    const size_t size = (size_t)(cscd_mesh_vertex_count(s->recording->mesh) + 1) * 3 * sizeof *s->x0;
    s->bytes = packed_bytes_create();
    s->x0 = io_zeroed(size);
    s->x1 = io_zeroed(size);
    if (s->x0 == NULL || s->x1 == NULL) return io_fail(error, "out of memory");
    return replay_detector_open(&s->detector, error);
}

void replay_source_close(replay_source *s) {
    read_ahead_close(s->frames);
    replay_detector_close(&s->detector);
    packed_bytes_free(&s->bytes);
    free(s->x0);
    free(s->x1);
    *s = (replay_source){.recording = NULL};
}

/* ---- what the detector finds ------------------------------------------------------------------------------- */

static bool check_frame(replay_source *s, uint32_t frame, const double *positions, frame_check *out,
                        io_error *error) {
    if (!replay_detector_check(&s->detector, frame, positions, out, error)) return false;
    out->hashes = s->hashes;
    return true;
}

/* Frames are read one after the other, from the first that is wanted on. */
static bool read_frame(replay_source *s, uint32_t frame, double **positions, io_error *error) {
    if (s->frames == NULL && !read_ahead_open(s->recording, frame, s->last, &s->frames, error)) return false;
    return read_ahead_take(s->frames, positions, s->hashes, error);
}

static bool add_record(replay_source *s, shard_record kind, const frame_check *check, io_error *error) {
    if (s->results == NULL) return true;
    step_bytes_add_frame(&s->bytes, check, s->recording->object_count,
                         cscd_mesh_component_count(s->recording->mesh));
    return shard_file_add(s->results, kind, &s->bytes, error);
}

static bool begin_anew(replay_source *s, uint32_t frame, frame_check *out, io_error *error) {
    if (!read_frame(s, frame, &s->x0, error) || !check_frame(s, frame, s->x0, out, error)) return false;
    shard_file_begin(&s->bytes);
    return add_record(s, SHARD_FRAME, out, error);
}

static bool step_anew(replay_source *s, uint32_t k, interval_step *out, io_error *error) {
    if (!read_frame(s, k + 1, &s->x1, error) ||
        !replay_detector_step(&s->detector, k, s->x0, s->x1, out, error))
        return false;
    shard_file_begin(&s->bytes);
    if (s->results != NULL)
        step_bytes_add_interval(&s->bytes, out, cscd_mesh_component_count(s->recording->mesh));
    return true;
}

/* The frame is checked after the step, so that the detector knows it when the next interval starts there: the
 * old one, or the new one of the next chunk. */
static bool check_anew(replay_source *s, uint32_t k, frame_check *out, io_error *error) {
    if (chunk_begins(s->first, k + 1) && !replay_detector_renew(&s->detector, error)) return false;
    return check_frame(s, k + 1, s->x0, out, error) && add_record(s, SHARD_INTERVAL, out, error);
}

/* ---- what shards have -------------------------------------------------------------------------------------- */

static bool have_interval(const replay_source *s, uint32_t k) {
    return s->shards != NULL && k < s->shards->until;
}

static bool read_wanted(replay_source *s, uint32_t frame, double **positions, io_error *error) {
    return !s->reads_frames || read_frame(s, frame, positions, error);
}

/* Where the file ends that a shard goes on with, the detector goes on, as if it had been there: at the
 * beginning of a chunk it knows nothing but the frame. */
static bool go_on(replay_source *s, uint32_t frame, const uint64_t *hashes, io_error *error) {
    frame_check known;
    if (have_interval(s, frame) || s->results == NULL) return true;
    if (!s->reads_frames && !read_frame(s, frame, &s->x0, error)) return false;
    if (memcmp(hashes, s->hashes, s->recording->object_count * sizeof *hashes) != 0)
        return io_fail(
            error, "frame %d: its file has changed since the results were written, so they cannot be resumed",
            s->recording->frame_numbers[frame]);
    return check_frame(s, frame, s->x0, &known, error);
}

/* ---- either ------------------------------------------------------------------------------------------------ */

bool replay_source_begin(replay_source *s, uint32_t frame, frame_check *out, io_error *error) {
    if (!have_interval(s, frame)) return begin_anew(s, frame, out, error);
    return read_wanted(s, frame, &s->x0, error) && shard_series_begin(s->shards, out, error);
}

bool replay_source_step(replay_source *s, uint32_t k, interval_step *out, io_error *error) {
    if (!have_interval(s, k)) return step_anew(s, k, out, error);
    return read_wanted(s, k + 1, &s->x1, error) && shard_series_step(s->shards, out, error);
}

bool replay_source_check(replay_source *s, uint32_t k, frame_check *out, io_error *error) {
    double *end = s->x1;
    s->x1 = s->x0;
    s->x0 = end;
    if (!have_interval(s, k)) return check_anew(s, k, out, error);
    return shard_series_check(s->shards, out, error) && go_on(s, k + 1, out->hashes, error);
}
