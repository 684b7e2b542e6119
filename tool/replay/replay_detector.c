/* The detector of a replay: steps, checks, and a new one for each chunk. */
#include "tool/replay/replay_detector.h"

#include "tool/common/methods.h"
#include "tool/replay/half_turns.h"

#include <stdlib.h>

static bool api_failed(const replay_detector *d, io_error *error) {
    return io_fail(error, "%s", cscd_context_detail(d->recording->context));
}

static bool create_detector(replay_detector *d, io_error *error) {
    const replay_options *o = d->options;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = d->method;
    options.mode = o->mode;
    options.start = o->start;
    options.ours = o->ours & ~ours_of_plans(o->ours);
    options.volume = o->volume;
    options.min_separation = o->min_separation;
    options.coherence = CSCD_COHERENCE_OFF; /* counters say what each interval costs by itself */
    ignore_pairs_choose(d->ignored, &options);
    if (cscd_detector_create(d->recording->context, d->recording->mesh, d->plan, &options, &d->detector) !=
        CSCD_OK)
        return api_failed(d, error);
    return answers_prepare(d->answers, d->detector, error);
}

bool replay_detector_open(replay_detector *d, io_error *error) {
    const size_t components = cscd_mesh_component_count(d->recording->mesh);
    if (!create_detector(d, error)) return false;
    d->guarantees = io_zeroed((components + 1) * sizeof *d->guarantees);
    return (d->guarantees != NULL &&
            orientation_row_create(d->detector, d->recording->mesh, &d->orientations)) ||
           io_fail(error, "out of memory");
}

void replay_detector_close(replay_detector *d) {
    cscd_detector_destroy(d->detector);
    free(d->guarantees);
    orientation_row_free(&d->orientations);
    *d = (replay_detector){0};
}

bool replay_detector_renew(replay_detector *d, io_error *error) {
    cscd_detector_destroy(d->detector);
    d->detector = NULL;
    return create_detector(d, error);
}

bool replay_detector_is_oriented(const replay_detector *d) {
    return d->orientations.region_count > 0;
}

/* What a contact takes in the library's lists, while they grow and are sorted, and in those of events. */
enum { CONTACT_SIZE = 512 };

/* The cap is for contacts alone: pairs of triangles have their own. */
static cscd_status step_within_memory(const replay_detector *d, const double *x0, const double *x1,
                                      cscd_contacts *out) {
    const uint32_t vertices = cscd_mesh_vertex_count(d->recording->mesh);
    const size_t given = d->options->answers.limits.memory,
                 most = given > 0 ? given : cscd_max_memory_default();
    cscd_status status = cscd_detector_set_longest_list(d->detector, most / CONTACT_SIZE + 1);
    if (status != CSCD_OK) return status;
    status = cscd_detector_step(d->detector, CSCD_DOUBLES(x0, vertices), CSCD_DOUBLES(x1, vertices), out);
    cscd_detector_set_longest_list(d->detector, 0);
    return status;
}

/* Before the step, which may take long just there. */
static void look_for_half_turns(replay_detector *d, uint32_t k, const double *x0, const double *x1) {
    half_turn found;
    if (d->told_half_turn || d->options->quiet || !half_turn_find(d->recording->mesh, x0, x1, &found)) return;
    half_turn_tell(d->recording, &d->ignored->parts, k, &found);
    d->told_half_turn = true;
}

bool replay_detector_step(replay_detector *d, uint32_t k, const double *x0, const double *x1,
                          interval_step *out, io_error *error) {
    cscd_contacts contacts;
    look_for_half_turns(d, k, x0, x1);
    const cscd_status status = step_within_memory(d, x0, x1, &contacts);
    if (status == CSCD_LIST_TOO_LONG) {
        orientation_row_forget(&d->orientations);
        *out = (interval_step){.unlisted = contacts.count, .orientations = &d->orientations};
        return true;
    }
    if (status != CSCD_OK)
        return io_fail(error, "frame %d: %s", d->recording->frame_numbers[k],
                       cscd_context_detail(d->recording->context));
    for (uint32_t i = 0; i < cscd_mesh_component_count(d->recording->mesh); i++)
        d->guarantees[i] = cscd_detector_guarantee(d->detector, i);
    if (d->takes_orientations) orientation_row_take(&d->orientations, d->detector);
    *out = (interval_step){.contacts = contacts,
                           .counters = cscd_detector_counters(d->detector),
                           .timings = cscd_detector_timings(d->detector),
                           .guarantees = d->guarantees,
                           .orientations = &d->orientations};
    return true;
}

bool replay_detector_check(replay_detector *d, uint32_t frame, const double *positions, frame_check *out,
                           io_error *error) {
    *out = (frame_check){.checked = !d->options->no_check};
    if (!out->checked) return true;
    io_error reason;
    if (!answers_find(d->answers, d->detector, positions, &out->found, &reason))
        return io_fail(error, "frame %d: %s", d->recording->frame_numbers[frame], reason.text);
    out->ms = cscd_detector_timings(d->detector).check_ms;
    if (out->found.patches != NULL) out->turned = out->found.patches->turned;
    return true;
}
