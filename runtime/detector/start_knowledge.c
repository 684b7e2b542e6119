/* What is known of starts: of the positions seen last, of the public API, and what a step hands on to the next. */
#include "runtime/detector/adaptive.h"
#include "runtime/detector/step.h"

_Static_assert((int)TRIANGLE_UNKNOWN == (int)CSCD_START_STATE_UNKNOWN &&
                   (int)TRIANGLE_CROSSING == (int)CSCD_START_STATE_CROSSING &&
                   (int)TRIANGLE_FREE == (int)CSCD_START_STATE_FREE &&
                   (int)TRIANGLE_CLEAN == (int)CSCD_START_STATE_CLEAN,
               "states have the numbers of the public API");

cscd_start_knowledge cscd_detector_start_knowledge(const cscd_detector *detector, uint32_t component) {
    const cscd_mesh *mesh = detector->mesh;
    uint32_t counts[4] = {0};
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        counts[detector->starts.triangles[t]] += mesh->triangle_components[t] == component;
    const cscd_start_knowledge found = {.clean = counts[TRIANGLE_CLEAN],
                                        .free = counts[TRIANGLE_FREE],
                                        .crossing = counts[TRIANGLE_CROSSING],
                                        .unknown = counts[TRIANGLE_UNKNOWN]};
    return found;
}

cscd_start_state cscd_detector_start_state(const cscd_detector *detector, uint32_t triangle) {
    return (cscd_start_state)detector->starts.triangles[triangle];
}

void step_take(cscd_detector *d, const double *end) {
    if (!detector_culls(d)) {
        start_states_forget(&d->starts); /* contacts have tainted nothing */
        return;
    }
    for (uint32_t c = 0; c < d->mesh->component_count; c++) {
        const cscd_guarantee *g = &d->guarantees[c];
        d->incomplete[c] = !g->complete && g->reason != CSCD_REASON_OBSTACLE;
    }
    if (!d->verlet.serving) adaptive_learn(d);
    start_states_end(&d->starts, end, d->incomplete);
    verlet_list_take(d);
}

void step_withdraw(cscd_detector *d) {
    if (detector_culls(d)) start_states_restore(&d->starts);
}
