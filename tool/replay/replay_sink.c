/* The outputs of a replay: the table of all, and those that only hand on what other rooms write. */
#include "tool/replay/replay_sink.h"

#include <stdlib.h>

/* ---- contacts ---------------------------------------------------------------------------------------------- */

typedef struct contact_output {
    const recording *recording;
    contact_file *file;
    const char *object_names[RECORDING_OBJECTS_MAX + 1];
} contact_output;

static bool open_contacts(replay *r, void **state, io_error *error) {
    const recording *of = &r->recording;
    if (r->options->contacts_path == NULL) return true;
    contact_output *out = calloc(1, sizeof *out);
    if (out == NULL) return io_fail(error, "out of memory");
    out->recording = of;
    contact_columns columns = {.bounded = r->options->min_separation > 0.0};
    for (uint32_t i = 0; i < of->object_count; i++) out->object_names[i] = of->objects[i].source.name;
    if (of->object_count > 1) columns.object_names = out->object_names;
    if (!contact_file_open(r->options->contacts_path, columns, &out->file, error)) {
        free(out);
        return false;
    }
    *state = out;
    return true;
}

static bool write_contacts(void *state, uint32_t k, const interval_step *step, io_error *error) {
    const contact_output *out = state;
    for (size_t i = 0; i < step->contacts.count; i++) {
        const contact_record record = recording_contact(out->recording, k, &step->contacts.items[i]);
        if (!contact_file_write(out->file, &record, error)) return false;
    }
    return contact_file_flush(out->file, error);
}

static bool close_contacts(void *state, bool whole, io_error *error) {
    (void)whole; /* a file of contacts holds whole lines at any time */
    contact_output *out = state;
    const bool written = contact_file_close(out->file, error);
    free(out);
    return written;
}

static const replay_sink contact_sink = {
    .open = open_contacts, .add_interval = write_contacts, .close = close_contacts};

/* ---- events and test cases ----------------------------------------------------------------------------------- */

typedef struct event_output {
    const replay *replay;
    answer_outputs files;
} event_output;

static bool open_events(replay *r, void **state, io_error *error) {
    event_output *out = calloc(1, sizeof *out);
    if (out == NULL) return io_fail(error, "out of memory");
    out->replay = r;
    if (!answer_outputs_open(&r->options->answers, &out->files, error)) {
        answer_outputs_close(&out->files, NULL, &r->rules, NULL, NULL);
        free(out);
        return false;
    }
    *state = out;
    return true;
}

static bool close_events(void *state, bool whole, io_error *error) {
    event_output *out = state;
    const replay *r = out->replay;
    const bool written = answer_outputs_close(&out->files, whole ? &r->answers : NULL, &r->rules,
                                              recording_options_path(&r->options->source), error);
    free(out);
    return written;
}

static const replay_sink event_sink = {.open = open_events, .close = close_events};

/* ---- files of other programs --------------------------------------------------------------------------------- */

typedef struct export_output {
    const replay *replay;
    exports exports;
} export_output;

static bool open_exports(replay *r, void **state, io_error *error) {
    if (!export_request_any(&r->options->exports)) return true;
    export_output *out = calloc(1, sizeof *out);
    if (out == NULL) return io_fail(error, "out of memory");
    out->replay = r;
    if (!exports_open(&r->options->exports, &r->recording, &r->ignored.parts, r->plan.plan, &out->exports,
                      error)) {
        free(out);
        return false;
    }
    *state = out;
    return true;
}

static bool export_contacts(void *state, uint32_t k, const interval_step *step, io_error *error) {
    export_output *out = state;
    (void)k, (void)error;
    exports_add_contacts(&out->exports, &step->contacts);
    return true;
}

static bool export_frame(void *state, uint32_t frame, const cscd_intersections *found, io_error *error) {
    export_output *out = state;
    return found == NULL || exports_add_frame(&out->exports, frame, out->replay->source.x0, found, error);
}

static bool close_exports(void *state, bool whole, io_error *error) {
    export_output *out = state;
    (void)whole; /* without a frame older files stay */
    const bool written = exports_close(&out->exports, error);
    free(out);
    return written;
}

static const replay_sink export_sink = {
    .open = open_exports, .add_interval = export_contacts, .add_frame = export_frame, .close = close_exports};

/* ---- all ------------------------------------------------------------------------------------------------------- */

/* Outputs are closed in this order, because the report contains the summary. They are opened from the last to
 * the first, so that a report whose scenery is missing leaves all files as they are. */
static const replay_sink *const sinks[REPLAY_SINKS] = {&contact_sink, &summary_sink, &event_sink,
                                                       &export_sink, &report_sink};

bool sinks_open(replay *r, io_error *error) {
    for (size_t i = REPLAY_SINKS; i-- > 0;)
        if (!sinks[i]->open(r, &r->sinks[i], error)) return false;
    r->sinks_are_open = true;
    return true;
}

bool sinks_add_interval(replay *r, uint32_t k, const interval_step *step, io_error *error) {
    for (size_t i = 0; i < REPLAY_SINKS; i++)
        if (r->sinks[i] != NULL && sinks[i]->add_interval != NULL &&
            !sinks[i]->add_interval(r->sinks[i], k, step, error))
            return false;
    return true;
}

bool sinks_add_frame(replay *r, uint32_t frame, const cscd_intersections *found, io_error *error) {
    for (size_t i = 0; i < REPLAY_SINKS; i++)
        if (r->sinks[i] != NULL && sinks[i]->add_frame != NULL &&
            !sinks[i]->add_frame(r->sinks[i], frame, found, error))
            return false;
    return true;
}

bool sinks_end_interval(replay *r, const interval_result *result, io_error *error) {
    for (size_t i = 0; i < REPLAY_SINKS; i++)
        if (r->sinks[i] != NULL && sinks[i]->end_interval != NULL &&
            !sinks[i]->end_interval(r->sinks[i], result, error))
            return false;
    return true;
}

bool sinks_close(replay *r, io_error *error) {
    bool written = true;
    for (size_t i = 0; i < REPLAY_SINKS; i++) {
        if (r->sinks[i] == NULL) continue;
        written = sinks[i]->close(r->sinks[i], r->sinks_are_open, written ? error : NULL) && written;
        r->sinks[i] = NULL;
    }
    return written;
}
