/* What intersects in each frame of a replay, and the events, for its report. */
#include "src/tool/replay/replay_answers.h"

static bool api_failed(const replay_answers *a, io_error *error) {
    return io_fail(error, "%s", cscd_context_detail(a->recording->context));
}

bool replay_answers_open(recording *r, const part_names *parts, replay_answers *out, io_error *error) {
    *out = (replay_answers){.recording = r, .parts = parts};
    cscd_event_options options = cscd_event_defaults();
    options.part_count = parts->count;
    options.labels = parts->labels;
    return cscd_event_tracker_create(r->context, r->mesh, &options, &out->tracker) == CSCD_OK ||
           api_failed(out, error);
}

void replay_answers_close(replay_answers *a) {
    cscd_event_tracker_destroy(a->tracker);
    *a = (replay_answers){0};
}

bool replay_answers_add_contacts(replay_answers *a, const cscd_contacts *contacts, io_error *error) {
    return a->tracker == NULL ||
           cscd_event_tracker_add_contacts(a->tracker, contacts->items, contacts->count) == CSCD_OK ||
           api_failed(a, error);
}

bool replay_answers_add_frame(replay_answers *a, report *page, cscd_detector *detector, uint32_t frame,
                              const double *positions, io_error *error) {
    if (a->tracker == NULL) return true;
    cscd_intersection_options options = cscd_intersection_defaults();
    options.curves = options.patches = options.depths = true;
    cscd_intersection_pairs found;
    const cscd_view *view = CSCD_DOUBLES(positions, cscd_mesh_vertex_count(a->recording->mesh));
    if (cscd_detector_find_intersections(detector, view, &options, &found) != CSCD_OK)
        return api_failed(a, error);
    return report_add_answers(page, frame, &found, error) &&
           (cscd_event_tracker_add_frame(a->tracker, frame, &found) == CSCD_OK || api_failed(a, error));
}

static const char *name_part(void *user, uint32_t part, char buffer[REPORT_PART_NAME_SIZE]) {
    const replay_answers *a = user;
    (void)buffer;
    return part_names_at(a->parts, part);
}

bool replay_answers_finish(replay_answers *a, report *page, io_error *error) {
    if (a->tracker == NULL) return true;
    cscd_events events;
    if (cscd_event_tracker_finish(a->tracker, &events) != CSCD_OK) return api_failed(a, error);
    return report_set_events(page, events.items, events.count, name_part, a, error);
}
