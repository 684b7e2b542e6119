/* The JSON summary of a replay, written interval by interval. */
#include "tool/answers/answers.h"
#include "tool/common/provenance.h"
#include "tool/io/output_file.h"
#include "tool/replay/replay_sink.h"

#include <stdlib.h>
#include <string.h>

typedef struct summary_writer {
    replay *replay;
    output_file file; /* its file is NULL when nothing is written */
    char *path;
    FILE *memory; /* everything is written here first: text, size bytes of it */
    char *text;
    size_t size;
    bool keeps_text;  /* all of it, for summary_close */
    bool times;       /* are written */
    size_t forwarded; /* bytes of it that the file has */
    const cscd_mesh *mesh;
    json out;
} summary_writer;

static bool write_failed(const summary_writer *w, io_error *error) {
    return io_fail_write(error, w->path);
}

static void free_summary(summary_writer *w) {
    if (w->memory != NULL) fclose(w->memory);
    free(w->text);
    free(w->path);
    free(w);
}

static bool open_file(summary_writer *w, const char *path, io_error *error) {
    w->path = strdup(path);
    return (w->path != NULL && output_file_open(path, &w->file)) || io_fail_write(error, path);
}

static bool open_summary(replay *r, void **state, io_error *error) {
    const replay_options *o = r->options;
    summary_writer *w = calloc(1, sizeof *w);
    if (w != NULL) w->memory = open_memstream(&w->text, &w->size);
    if (w == NULL || w->memory == NULL) {
        free(w);
        return io_fail(error, "out of memory");
    }
    if (o->json_path != NULL && !open_file(w, o->json_path, error)) {
        free_summary(w);
        return false;
    }
    w->replay = r;
    w->mesh = r->recording.mesh;
    w->keeps_text = o->report.path != NULL;
    w->times = !o->reproducible;
    w->out.file = w->memory;
    json_begin_object(&w->out, NULL);
    json_begin_array(&w->out, "intervals");
    *state = w;
    return true;
}

/* Hands the new part of the text to the file. A stream in memory fails only when memory runs out. */
static bool forward_text(summary_writer *w, io_error *error) {
    if (fflush(w->memory) != 0 || ferror(w->memory)) return io_fail(error, "out of memory for the summary");
    size_t begin = w->keeps_text ? w->forwarded : 0, count = w->size - begin;
    w->forwarded = w->size;
    FILE *file = w->file.file;
    bool written =
        file == NULL || (fwrite(w->text + begin, 1, count, file) == count && output_file_flush(&w->file));
    if (!w->keeps_text) rewind(w->memory);
    return written || write_failed(w, error);
}

/* Components with the same guarantee. */
typedef struct guarantee_group {
    cscd_guarantee guarantee; /* of its first component */
    uint32_t count;
} guarantee_group;

/* More than there are reasons, complete and not. */
enum { GROUPS_MAX = 64 };

static bool same_guarantee(cscd_guarantee a, cscd_guarantee b) {
    return a.complete == b.complete && a.reason == b.reason;
}

/* In the order of their first components. */
static int group_guarantees(const cscd_guarantee *guarantees, uint32_t count,
                            guarantee_group groups[GROUPS_MAX]) {
    int group_count = 0, g = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (g == group_count ||
            !same_guarantee(groups[g].guarantee, guarantees[i])) /* else as the one before */
            for (g = 0; g < group_count && !same_guarantee(groups[g].guarantee, guarantees[i]);) g++;
        if (g == group_count) groups[group_count++] = (guarantee_group){.guarantee = guarantees[i]};
        groups[g].count++;
    }
    return group_count;
}

static void write_members(json *out, const cscd_guarantee *guarantees, uint32_t count,
                          cscd_guarantee shared) {
    json_begin_array(out, "components");
    for (uint32_t i = 0; i < count; i++)
        if (same_guarantee(guarantees[i], shared)) json_integer(out, NULL, i);
    json_end_array(out);
}

/* By exception, because a mesh may have very many components: the largest group comes first and names
 * none. */
static void write_guarantees(summary_writer *w, const cscd_guarantee *guarantees) {
    guarantee_group groups[GROUPS_MAX];
    const uint32_t count = guarantees != NULL ? cscd_mesh_component_count(w->mesh) : 0;
    const int group_count = group_guarantees(guarantees, count, groups);
    int largest = 0;
    for (int g = 1; g < group_count; g++)
        if (groups[g].count > groups[largest].count) largest = g;
    json_begin_array(&w->out, "guarantee");
    for (int k = 0; k < group_count; k++) {
        const int g = k == 0 ? largest : k <= largest ? k - 1 : k;
        const cscd_guarantee shared = groups[g].guarantee;
        json_begin_object(&w->out, NULL);
        json_string(&w->out, "mode",
                    cscd_name(CSCD_MODES, shared.complete ? CSCD_MODE_ALL : CSCD_MODE_EARLIEST));
        json_string(&w->out, "reason", cscd_reason_text(shared.reason));
        json_integer(&w->out, "count", groups[g].count);
        if (k > 0) write_members(&w->out, guarantees, count, shared);
        json_end_object(&w->out);
    }
    json_end_array(&w->out);
}

static void write_times(json *out, const cscd_timings *t) {
    json_begin_object(out, "ms");
    for (int i = 0; i < TIMING_COUNT; i++)
        json_number(out, timing_rows[i].name, timing_ms(t, &timing_rows[i]));
    json_end_object(out);
}

static void write_counters(json *out, const cscd_counters *counters, bool of_contacts, bool known) {
    for (int i = 0; i < COUNTER_COUNT; i++) {
        const counter_row *row = &counter_rows[i];
        if ((row->kind == COUNTER_OF_CONTACTS) != of_contacts) continue;
        if (!known)
            json_null(out, row->name);
        else
            json_integer(out, row->name, counter_value(counters, row));
    }
}

static bool add_interval(void *state, const interval_result *result, io_error *error) {
    summary_writer *w = state;
    json *out = &w->out;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_signed(out, "frame", result->frame);
    const bool listed = result->guarantees != NULL;
    write_counters(out, &result->counters, true, listed);
    if (result->contact_count > 0 && listed)
        json_number(out, "earliest_toi", result->earliest_toi);
    else
        json_null(out, "earliest_toi");
    write_counters(out, &result->counters, false, listed);
    json_string(out, "state", interval_state_name(result->state));
    write_guarantees(w, result->guarantees);
    if (w->times) write_times(out, &result->timings);
    json_end_object(out);
    return forward_text(w, error);
}

static void write_frame(json *out, const answers *a, const frame_answer *frame) {
    json_begin_object(out, NULL);
    json_signed(out, "frame", answers_frame_number(a, frame->frame));
    if (frame->checked)
        answers_write_frame(a, frame, out);
    else {
        json_null(out, "crossing");
        json_null(out, "clean");
    }
    json_end_object(out);
}

static void write_frames(json *out, const answers *a) {
    json_begin_array(out, "frames");
    for (size_t i = 0; i < answers_frame_count(a); i++) write_frame(out, a, &answers_frames(a)[i]);
    json_end_array(out);
}

static void write_column(json *out, const char *key, double sum, double max, uint32_t count) {
    json_begin_object(out, key);
    json_number(out, "mean", count > 0 ? sum / count : 0.0);
    json_number(out, "max", max);
    json_end_object(out);
}

/* Mean and maximum per interval, of every stage and of the counters that have them. */
static void write_columns(json *out, const replay_totals *t, bool times) {
    for (int i = 0; i < TIMING_COUNT && times; i++) {
        const timing_row *row = &timing_rows[i];
        char key[32];
        snprintf(key, sizeof key, "%s_ms", row->name);
        write_column(out, key, timing_ms(&t->time_sum, row), timing_ms(&t->time_max, row), t->intervals);
    }
    for (int i = 0; i < COUNTER_COUNT; i++) {
        const counter_row *row = &counter_rows[i];
        if (row->kind != COUNTER_AVERAGED) continue;
        write_column(out, row->name, (double)counter_value(&t->counter_sum, row),
                     (double)counter_value(&t->counter_max, row), t->intervals);
    }
}

static void write_sums(json *out, const replay_totals *t) {
    for (int i = 0; i < COUNTER_COUNT; i++) {
        const counter_row *row = &counter_rows[i];
        if (row->kind == COUNTER_OF_CONTACTS || row->kind == COUNTER_SUMMED)
            json_integer(out, row->name, counter_value(&t->counter_sum, row));
    }
}

static void write_plan(json *out, const plan_choice *plan, bool times) {
    json_begin_object(out, "plan");
    json_string(out, "source", plan_source_name(plan->source));
    json_string(out, "method",
                cscd_method_name(plan->plan != NULL ? cscd_plan_method(plan->plan) : CSCD_METHOD_NONE));
    json_integer(out, "regions", plan->plan != NULL ? cscd_plan_region_count(plan->plan) : 0);
    if (plan->path != NULL)
        json_string(out, "path", plan->path);
    else
        json_null(out, "path");
    const char *origin = plan->plan != NULL ? cscd_plan_describe(plan->plan).origin : NULL;
    if (origin != NULL)
        json_string(out, "made", origin);
    else
        json_null(out, "made");
    if (times) json_number(out, "made_ms", plan->made_ms);
    json_end_object(out);
}

static void write_summary(summary_writer *w, const replay *r) {
    const replay_totals *t = &r->totals;
    const replay_options *o = r->options;
    json *out = &w->out;
    json_break_line(out);
    json_begin_object(out, "summary");
    const char *unfinished = answers_unfinished(&r->answers);
    json_boolean(out, "complete", unfinished == NULL);
    if (unfinished != NULL) json_string(out, "stopped_by", unfinished);
    json_string(out, "method", cscd_method_name(r->plan.method));
    json_string(out, "mode", cscd_name(CSCD_MODES, o->mode));
    json_string(out, "volume", cscd_name(CSCD_VOLUMES, o->volume));
    if (!o->reproducible)
        json_string(out, "simd", cscd_name(CSCD_SIMDS, cscd_context_describe(r->recording.context).simd));
    json_number(out, "min_separation", o->min_separation);
    write_plan(out, &r->plan, w->times);
    json_integer(out, "vertices", cscd_mesh_vertex_count(w->mesh));
    json_integer(out, "triangles", cscd_mesh_triangle_count(w->mesh));
    json_integer(out, "components", cscd_mesh_component_count(w->mesh));
    json_integer(out, "intervals", t->intervals);
    json_integer(out, "intervals_complete", t->intervals_complete);
    json_integer(out, "intervals_with_contact", t->intervals_with_contact);
    for (int i = 0; i < INTERVAL_STATES; i++)
        json_integer(out, interval_state_name((interval_state)i), t->states[i]);
    json_integer(out, "frames_checked", t->frames_checked);
    json_integer(out, "frames_crossing", t->frames_crossing);
    json_integer(out, "frames_touching", t->frames_touching);
    if (t->intervals_with_contact > 0)
        json_signed(out, "first_contact_frame", t->first_contact_frame);
    else
        json_null(out, "first_contact_frame");
    json_integer(out, "contradictions", t->contradictions);
    write_sums(out, t);
    write_columns(out, t, w->times);
    json_end_object(out);
}

static void write_provenance(json *out, const replay_options *o, const recording *r) {
    json_break_line(out);
    json_begin_object(out, "provenance");
    if (o->reproducible)
        provenance_write_build(out);
    else
        provenance_write(out, o->argument_count, o->arguments,
                         cscd_context_describe(r->context).thread_count);
    json_begin_array(out, "inputs");
    for (uint32_t i = 0; i < r->object_count; i++) {
        const recorded_object *object = &r->objects[i];
        provenance_write_input(out, object->source.model_path, recorded_object_hash_model(object));
        if (object->frames != NULL)
            provenance_write_input(out, object->source.frame_paths[0], object->frames_hash);
    }
    json_end_array(out);
    json_begin_array(out, "frame_paths");
    for (uint32_t i = 0; i < r->object_count; i++)
        for (size_t k = 0; k < r->objects[i].source.frame_path_count; k++)
            json_string(out, NULL, r->objects[i].source.frame_paths[k]);
    json_end_array(out);
    json_end_object(out);
}

/* Writes the frames, the events, the summary and the provenance. */
static bool write_ending(summary_writer *w, io_error *error) {
    const replay *r = w->replay;
    json_end_array(&w->out);
    json_break_line(&w->out);
    write_frames(&w->out, &r->answers);
    json_break_line(&w->out);
    answers_write_json(&r->answers, &r->unit, &w->out);
    write_summary(w, r);
    write_provenance(&w->out, r->options, &r->recording);
    json_end_object(&w->out);
    fputc('\n', w->memory);
    return forward_text(w, error);
}

/* The report gets the whole text, also when the file could not be written; NULL if there was no memory for
 * it. */
static void hand_on_text(summary_writer *w) {
    bool whole = !ferror(w->memory);
    whole = fclose(w->memory) == 0 && whole;
    w->memory = NULL;
    if (!whole || !w->keeps_text) return;
    w->replay->summary_text = w->text;
    w->text = NULL;
}

static bool close_summary(void *state, bool whole, io_error *error) {
    summary_writer *w = state;
    bool written = !whole || write_ending(w, error);
    if (w->file.file != NULL && !output_file_close(&w->file, whole ? OUTPUT_WHOLE : OUTPUT_ABANDONED) &&
        whole)
        written = write_failed(w, written ? error : NULL);
    if (whole) hand_on_text(w);
    free_summary(w);
    return written;
}

const replay_sink summary_sink = {.open = open_summary, .end_interval = add_interval, .close = close_summary};
