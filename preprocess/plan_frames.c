/* Reads the frames of a motion. */
#include "preprocess/plan_frames.h"

#include "src/mesh/positions.h"
#include "src/mesh/views.h"

#include <stdio.h>

static cscd_status read_frame(cscd_context *context, const cscd_mesh *mesh, const cscd_plan_options *options,
                              uint32_t number, plan_frames *out) {
    char name[32];
    snprintf(name, sizeof name, "frames[%u]", number);
    if (options->frames[number] == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%s is NULL", name);
    const uint32_t i = out->count++;
    const cscd_status status =
        views_read(context, mesh, options->frames[number], name, &out->buffers[i], &out->items[i]);
    return status == CSCD_OK ? positions_check(context, out->items[i], mesh->vertex_count, name) : status;
}

cscd_status plan_frames_read(cscd_context *context, const cscd_mesh *mesh, const cscd_plan_options *options,
                             plan_frames *out) {
    const uint32_t given = options->frame_count, wanted = given < FRAMES_MOST ? given : FRAMES_MOST;
    cscd_status status = CSCD_OK;
    *out = (plan_frames){0};
    if (given > 0 && options->frames == NULL)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "frame_count is %u, but frames is NULL", given);
    for (uint32_t i = 0; i < wanted && status == CSCD_OK; i++) {
        const uint32_t number = wanted == given ? i : (uint32_t)((uint64_t)i * (given - 1) / (wanted - 1));
        status = read_frame(context, mesh, options, number, out);
    }
    return status;
}

void plan_frames_free(cscd_context *context, plan_frames *frames) {
    for (uint32_t i = 0; i < frames->count; i++) context_free(context, frames->buffers[i]);
    *frames = (plan_frames){0};
}
