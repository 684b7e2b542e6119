/* What a step knows of its end, which is the start of the next one. */
#include "runtime/detector/adaptive.h"
#include "runtime/detector/step.h"

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
