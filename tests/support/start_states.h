/* What a detector knows of the start of its next step. */
#pragma once

#include "runtime/detector/detector.h"

static inline triangle_state start_state_of(const cscd_detector *detector, uint32_t triangle) {
    return (triangle_state)detector->known.starts.triangles[triangle];
}

/* How many triangles of a component are in a state. */
static inline uint32_t start_states_in(const cscd_detector *detector, uint32_t component,
                                       triangle_state state) {
    const cscd_mesh *mesh = detector->mesh;
    uint32_t count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        count += mesh->triangle_components[t] == component && start_state_of(detector, t) == state;
    return count;
}
