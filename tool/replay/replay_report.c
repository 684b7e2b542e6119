/* The report of a replay. */
#include "tool/replay/replay_report.h"

#include "tool/io/path_name.h"

#include <string.h>

/* The vertices as the contact list names them. */
static void file_vertices(void *user, const cscd_contact *contact, uint32_t vertices[4]) {
    contact_record record = recording_contact(user, 0, contact);
    bool vf = contact->kind == CSCD_CONTACT_VF;
    memcpy(vertices, record.a, (vf ? 1 : 2) * sizeof *vertices);
    memcpy(vertices + (vf ? 1 : 2), record.b, (vf ? 3 : 2) * sizeof *vertices);
}

static bool open_scenery(replay_report *r, io_error *error) {
    const report_request *request = r->request;
    return request->scenery_path == NULL || scenery_open(request->scenery_path, request->scenery_frames_path,
                                                         r->recording->frame_count, &r->scenery, error);
}

bool replay_report_open(replay_report *out, const report_request *request, const char *model_path,
                        recording *r, const cscd_plan *plan, bool oriented, uint32_t first, uint32_t last,
                        const length_unit *unit, io_error *error) {
    *out = (replay_report){.request = request, .model_path = model_path, .recording = r};
    if (request->path == NULL) return true;
    if (!open_scenery(out, error)) return false;
    provenance_generator(out->generator);
    report_options options = {.kind = REPORT_REPLAY,
                              .title = request->title != NULL ? request->title : path_file_name(model_path),
                              .fps = recording_fps(r),
                              .length_unit = unit->name,
                              .generator = out->generator,
                              .mesh = r->mesh,
                              .plan = plan,
                              .frame_numbers = r->frame_numbers,
                              .first = first,
                              .last = last,
                              .oriented = oriented,
                              .up_axis = (int)up_axis_choose(request->up, model_path),
                              .scenery = {out->scenery.mesh.vertex_count, out->scenery.mesh.triangle_count,
                                          out->scenery.mesh.triangles, out->scenery.frame_count > 1},
                              .file_vertices =
                                  r->edge_file_vertices != NULL || r->object_count > 1 ? file_vertices : NULL,
                              .file_vertices_user = r};
    return report_create(&options, &out->report, error);
}

/* A report that has failed is given up at once, to free its memory. */
static void keep_or_give_up(replay_report *r, bool added) {
    if (added) return;
    report_destroy(r->report);
    r->report = NULL;
}

void replay_report_begin(replay_report *r, const double *positions) {
    if (r->report != NULL) keep_or_give_up(r, report_begin(r->report, positions, &r->failure));
}

void replay_report_add(replay_report *r, const orientation_row *orientations, const cscd_contacts *contacts,
                       const double *end) {
    if (r->report != NULL)
        keep_or_give_up(r, report_add_interval(r->report, orientations, contacts, end, &r->failure));
}

void replay_report_add_found(replay_report *r, uint32_t frame, const cscd_intersection_pairs *found) {
    if (r->report != NULL) keep_or_give_up(r, report_add_answers(r->report, frame, found, &r->failure));
}

static bool add_scenery(replay_report *r, io_error *error) {
    if (r->request->scenery_path == NULL) return true;
    uint32_t count = r->scenery.frame_count > 1 ? report_frame_count(r->report) : 1;
    for (uint32_t i = 0; i < count; i++) {
        if (!scenery_read(&r->scenery, report_frame(r->report, i), error) ||
            !report_add_scenery(r->report, r->scenery.file.positions, error))
            return false;
    }
    return true;
}

static const char *name_part(void *user, uint32_t part, char buffer[REPORT_PART_NAME_SIZE]) {
    (void)buffer;
    return part_names_at(user, part);
}

static bool set_events(replay_report *r, const answers *found, io_error *error) {
    return found == NULL || report_set_events(r->report, found->events, found->event_count, name_part,
                                              (void *)found->parts, error);
}

bool replay_report_write(replay_report *r, const answers *found, const char *summary, io_error *error) {
    if (r->failure.text[0] != '\0') return io_fail(error, "no report was written: %s", r->failure.text);
    if (r->report == NULL) return true;
    if (summary == NULL) return io_fail(error, "no report was written: out of memory for the summary");
    report_summary text = {path_file_name(r->model_path), summary};
    io_error reason;
    if (set_events(r, found, &reason) && add_scenery(r, &reason) &&
        report_write(r->report, r->request->path, &text, 1, NULL, &reason))
        return true;
    return io_fail(error, "no report was written: %s", reason.text);
}

void replay_report_close(replay_report *r) {
    report_destroy(r->report);
    scenery_close(&r->scenery);
    r->report = NULL;
}
