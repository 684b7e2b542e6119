/* Where a replay has its intervals and frames from, one after the other. */
#include "src/tool/replay/replay_source.h"

#include "src/tool/replay/replay_chunks.h"

#include <stdlib.h>

bool replay_source_open(replay_source *s, recording *r, uint32_t first, io_error *error) {
    const size_t size = (size_t)cscd_mesh_vertex_count(r->mesh) * 3 * sizeof *s->x0;
    s->recording = r;
    s->first = first;
    s->x0 = io_realloc(NULL, size);
    s->x1 = io_realloc(NULL, size);
    if (s->x0 == NULL || s->x1 == NULL) return io_fail(error, "out of memory");
    return replay_detector_open(&s->detector, error);
}

void replay_source_close(replay_source *s) {
    replay_detector_close(&s->detector);
    free(s->x0);
    free(s->x1);
    *s = (replay_source){.recording = NULL};
}

static bool check_frame(replay_source *s, uint32_t frame, const double *positions, frame_check *out,
                        io_error *error) {
    if (!replay_detector_check(&s->detector, frame, positions, out, error)) return false;
    out->hashes = s->hashes;
    return true;
}

static bool read_frame(replay_source *s, uint32_t frame, double *positions, io_error *error) {
    if (!recording_read(s->recording, frame, positions, error)) return false;
    recording_hash_frame(s->recording, s->hashes);
    return true;
}

bool replay_source_begin(replay_source *s, uint32_t frame, frame_check *out, io_error *error) {
    return read_frame(s, frame, s->x0, error) && check_frame(s, frame, s->x0, out, error);
}

bool replay_source_step(replay_source *s, uint32_t k, interval_step *out, io_error *error) {
    return read_frame(s, k + 1, s->x1, error) &&
           replay_detector_step(&s->detector, k, s->x0, s->x1, out, error);
}

/* The frame is checked after the step, so that the detector knows it when the next interval starts there: the old one, or the
 * new one of the next chunk. */
bool replay_source_check(replay_source *s, uint32_t k, frame_check *out, io_error *error) {
    double *end = s->x1;
    s->x1 = s->x0;
    s->x0 = end;
    if (chunk_begins(s->first, k + 1) && !replay_detector_renew(&s->detector, error)) return false;
    return check_frame(s, k + 1, end, out, error);
}
