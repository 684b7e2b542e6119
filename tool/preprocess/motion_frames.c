/* Reads frames of a recording, evenly spaced. */
#include "tool/preprocess/motion_frames.h"

#include <stdlib.h>

static uint32_t frame_of(const frame_choice *choice, uint32_t i, uint32_t wanted) {
    const uint32_t last = frame_choice_count(choice) - 1;
    return choice->first + choice->step * (uint32_t)((uint64_t)i * last / (wanted > 1 ? wanted - 1 : 1));
}

bool motion_frames_read(recording *r, const frame_range *range, motion_frames *out, io_error *error) {
    const uint32_t vertices = cscd_mesh_vertex_count(r->mesh);
    frame_choice choice;
    *out = (motion_frames){0};
    if (!frame_range_choose(range, r->frame_numbers, r->frame_count, &choice, error)) return false;
    const uint32_t found = frame_choice_count(&choice),
                   wanted = found < MOTION_FRAMES_MOST ? found : MOTION_FRAMES_MOST;
    out->positions = malloc((size_t)wanted * vertices * sizeof(double[3]));
    bool read = out->positions != NULL || io_fail(error, "out of memory");
    for (uint32_t i = 0; i < wanted && read; i++) {
        double *positions = out->positions + (size_t)i * vertices * 3;
        read = recording_read(r, frame_of(&choice, i, wanted), positions, error);
        out->views[i] = *CSCD_DOUBLES(positions, vertices);
        out->items[i] = &out->views[i];
        out->count++;
    }
    if (!read) motion_frames_free(out);
    return read;
}

void motion_frames_free(motion_frames *frames) {
    free(frames->positions);
    *frames = (motion_frames){0};
}
