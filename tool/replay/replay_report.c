/* The report of a replay. An error in it ends the report and not the replay, and is printed at the end. */
#include "tool/common/provenance.h"
#include "tool/io/io.h"
#include "tool/picture/picture.h"
#include "tool/replay/replay_sink.h"
#include "tool/report/report.h"

#include <stdlib.h>
#include <string.h>

typedef struct replay_report {
    replay *replay;
    const report_request *request;
    report *report;          /* NULL: it has failed */
    picture_scenery scenery; /* zeroed: none */
    char generator[PROVENANCE_GENERATOR_SIZE];
    io_error failure; /* "" while all is well */
} replay_report;

/* The vertices as the contact list names them. */
static void file_vertices(void *user, const cscd_contact *contact, uint32_t vertices[4]) {
    contact_record record = recording_contact(user, 0, contact);
    bool vf = contact->kind == CSCD_CONTACT_VF;
    memcpy(vertices, record.a, (vf ? 1 : 2) * sizeof *vertices);
    memcpy(vertices + (vf ? 1 : 2), record.b, (vf ? 3 : 2) * sizeof *vertices);
}

static bool open_scenery(replay_report *r, io_error *error) {
    const report_request *request = r->request;
    return request->scenery_path == NULL ||
           picture_scenery_open(request->scenery_path, request->scenery_frames_path,
                                r->replay->recording.frame_count, &r->scenery, error);
}

static bool create_report(replay_report *r, io_error *error) {
    replay *of = r->replay;
    recording *source = &of->recording;
    const char *model_path = recording_options_path(&of->options->source);
    provenance_generator(r->generator);
    report_options options = {
        .kind = REPORT_REPLAY,
        .title = r->request->title != NULL ? r->request->title : path_file_name(model_path),
        .fps = recording_fps(source),
        .length_unit = of->unit.name,
        .generator = r->generator,
        .mesh = source->mesh,
        .plan = of->plan.plan,
        .frame_numbers = source->frame_numbers,
        .first = of->first,
        .last = of->last,
        .oriented = replay_detector_is_oriented(&of->source.detector),
        .up_axis = (int)up_axis_choose(r->request->up, model_path),
        .scenery = {r->scenery.mesh.vertex_count, r->scenery.mesh.triangle_count, r->scenery.mesh.triangles,
                    r->scenery.frame_count > 1},
        .file_vertices =
            source->edge_file_vertices != NULL || source->object_count > 1 ? file_vertices : NULL,
        .file_vertices_user = source};
    return report_create(&options, &r->report, error);
}

static void free_report(replay_report *r) {
    report_destroy(r->report);
    picture_scenery_close(&r->scenery);
    free(r);
}

static bool open_report(replay *of, void **state, io_error *error) {
    if (of->options->report.path == NULL) return true;
    replay_report *r = calloc(1, sizeof *r);
    if (r == NULL) return io_fail(error, "out of memory");
    r->replay = of;
    r->request = &of->options->report;
    if (!open_scenery(r, error) || !create_report(r, error)) {
        free_report(r);
        return false;
    }
    *state = r;
    return true;
}

/* A report that has failed is given up at once, to free its memory. */
static void keep_or_give_up(replay_report *r, bool added) {
    if (added) return;
    report_destroy(r->report);
    r->report = NULL;
}

static bool add_interval(void *state, uint32_t k, const interval_step *step, io_error *error) {
    replay_report *r = state;
    (void)k, (void)error;
    if (r->report != NULL)
        keep_or_give_up(r, report_add_interval(r->report, step->orientations, &step->contacts,
                                               r->replay->source.x1, &r->failure));
    return true;
}

static bool add_frame(void *state, uint32_t frame, const cscd_intersections *found, io_error *error) {
    replay_report *r = state;
    (void)error;
    const answers *a = &r->replay->answers;
    const bool checked = frame_answer_checked(answers_frames(a) + answers_frame_count(a) - 1);
    if (r->report != NULL && frame == r->replay->first)
        keep_or_give_up(r, report_begin(r->report, r->replay->source.x0, &r->failure));
    if (r->report != NULL && found != NULL && checked)
        keep_or_give_up(r, report_add_answers(r->report, frame, found, &r->failure));
    return true;
}

static bool add_scenery(replay_report *r, io_error *error) {
    if (r->request->scenery_path == NULL) return true;
    uint32_t count = r->scenery.frame_count > 1 ? report_frame_count(r->report) : 1;
    for (uint32_t i = 0; i < count; i++) {
        if (!picture_scenery_read(&r->scenery, report_frame(r->report, i), error) ||
            !report_add_scenery(r->report, r->scenery.file.positions, error))
            return false;
    }
    return true;
}

static const char *name_part(void *user, uint32_t part, char buffer[REPORT_PART_NAME_SIZE]) {
    (void)buffer;
    return part_names_at(user, part);
}

/* A page of frames that nobody has checked shows no events. */
static bool set_events(replay_report *r, io_error *error) {
    const answers *found = &r->replay->answers;
    return r->replay->options->no_check || report_set_events(r->report, found->events, found->event_count,
                                                             name_part, (void *)found->parts, error);
}

static bool write_report(replay_report *r, io_error *error) {
    const char *text = r->replay->summary_text;
    if (r->failure.text[0] != '\0') return io_fail(error, "no report was written: %s", r->failure.text);
    if (r->report == NULL) return true;
    if (text == NULL) return io_fail(error, "no report was written: out of memory for the summary");
    report_summary summary = {path_file_name(recording_options_path(&r->replay->options->source)), text};
    io_error reason;
    if (set_events(r, &reason) && add_scenery(r, &reason) &&
        report_write(r->report, r->request->path, &summary, 1, NULL, &reason))
        return true;
    return io_fail(error, "no report was written: %s", reason.text);
}

/* Without any interval there is no report. */
static bool close_report(void *state, bool whole, io_error *error) {
    replay_report *r = state;
    terminal_progress *progress = &r->replay->progress;
    bool written = true;
    if (whole && r->replay->totals.intervals > 0) {
        terminal_progress_begin(progress, r->replay->options->quiet);
        terminal_progress_say(progress, "writing the report");
        written = write_report(r, error);
        terminal_progress_end(progress);
    }
    free_report(r);
    return written;
}

const replay_sink report_sink = {
    .open = open_report, .add_interval = add_interval, .add_frame = add_frame, .close = close_report};
