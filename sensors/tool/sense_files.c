/* The warnings of `cscd sense` as CSV, and its intervals as JSON. */
#include "sensors/tool/sense.h"
#include "tool/common/options.h"
#include "tool/common/provenance.h"
#include "tool/io/record.h"

#include <math.h>

/* A warning as its columns have it. Without the exact check contact and toi are unknown. */
typedef struct warning_row {
    int32_t frame;
    cscd_warning warning;
    uint32_t vertex_a, vertex_b; /* of the model files */
    uint32_t contact;            /* 0 or 1 */
    double toi;
} warning_row;

#define FIELD_OF(member) offsetof(warning_row, member)

/* The columns of a warning, which JSON does not have. */
static const record_field warning_fields[] = {
    {"frame", NULL, RECORD_SIGNED, FIELD_OF(frame)},
    {"part_a", NULL, RECORD_INDEX, FIELD_OF(warning.part_a)},
    {"part_b", NULL, RECORD_INDEX, FIELD_OF(warning.part_b)},
    {"object_a", NULL, RECORD_INDEX, FIELD_OF(warning.object_a)},
    {"object_b", NULL, RECORD_INDEX, FIELD_OF(warning.object_b)},
    {"vertex_a", NULL, RECORD_INDEX, FIELD_OF(vertex_a)},
    {"vertex_b", NULL, RECORD_INDEX, FIELD_OF(vertex_b)},
    {"distance", NULL, RECORD_NUMBER, FIELD_OF(warning.distance)},
    {"time", NULL, RECORD_NUMBER, FIELD_OF(warning.time)},
    {"contact", NULL, RECORD_INDEX, FIELD_OF(contact)},
    {"toi", NULL, RECORD_NUMBER, FIELD_OF(toi)},
};

enum { WARNING_FIELDS = sizeof warning_fields / sizeof *warning_fields };

static bool open_one(const char *path, output_file *out, io_error *error) {
    return path == NULL || output_file_open(path, out) || io_fail_write(error, path);
}

bool sense_files_open(const sense_options *o, sense_files *out, io_error *error) {
    if (!open_one(o->csv_path, &out->csv, error) || !open_one(o->json_path, &out->json, error)) return false;
    out->out.file = out->json.file;
    if (out->csv.file != NULL) record_write_header(out->csv.file, warning_fields, WARNING_FIELDS);
    if (out->out.file == NULL) return true;
    json_begin_object(&out->out, NULL);
    json_begin_array(&out->out, "intervals");
    return true;
}

static void write_warnings(FILE *csv, const sense_subject *subject, const sense_interval *interval) {
    const bool exact = subject->options->sensors.exact;
    for (size_t i = 0; i < interval->warnings->count; i++) {
        const cscd_warning *w = &interval->warnings->items[i];
        const warning_row row = {.frame = interval->frame,
                                 .warning = *w,
                                 .vertex_a = recording_file_vertex(subject->recording, w->vertex_a),
                                 .vertex_b = recording_file_vertex(subject->recording, w->vertex_b),
                                 .contact = exact ? w->contact : UINT32_MAX,
                                 .toi = exact && w->contact ? w->toi : (double)NAN};
        record_write_row(csv, warning_fields, WARNING_FIELDS, &row);
    }
}

static void write_pairs(json *out, const pair_counts *p, bool compare) {
    json_begin_object(out, "object_pairs");
    json_integer(out, "warned", p->warned);
    json_integer(out, "confirmed", p->confirmed);
    if (compare) {
        json_integer(out, "touching", p->touching);
        json_integer(out, "found", p->found);
        json_integer(out, "missed", p->touching - p->found);
        json_integer(out, "false", p->warned - p->found);
    }
    json_end_object(out);
}

static void write_interval(json *out, const sense_options *o, const sense_interval *interval) {
    json_break_line(out);
    json_begin_object(out, NULL);
    json_signed(out, "frame", interval->frame);
    json_integer(out, "warnings", interval->warnings->count);
    json_integer(out, "confirmed", interval->confirmed);
    json_integer(out, "renewed", interval->renewed);
    write_pairs(out, &interval->pairs, o->compare);
    for (int i = 0; i < SENSE_COUNTERS; i++)
        json_integer(out, sense_counter_rows[i].name,
                     sense_counter_value(&interval->counters, &sense_counter_rows[i]));
    json_begin_object(out, "ms");
    for (int i = 0; i < SENSE_TIMINGS; i++)
        json_number(out, sense_timing_rows[i].name,
                    sense_timing_ms(&interval->timings, &sense_timing_rows[i]));
    if (o->compare) json_number(out, "trees", interval->trees_ms);
    json_end_object(out);
    json_end_object(out);
}

/* Writes an interval, which is handed to the system at once. */
bool sense_files_add(sense_files *f, const sense_subject *subject, const sense_interval *interval,
                     io_error *error) {
    const sense_options *o = subject->options;
    if (f->csv.file != NULL) write_warnings(f->csv.file, subject, interval);
    if (f->csv.file != NULL && !output_file_flush(&f->csv)) return io_fail_write(error, o->csv_path);
    if (f->out.file == NULL) return true;
    write_interval(&f->out, o, interval);
    return output_file_flush(&f->json) || io_fail_write(error, o->json_path);
}

static void write_recall(json *out, const sense_totals *t) {
    json_integer(out, "touching_pairs", t->touching_pairs);
    json_integer(out, "found_pairs", t->found_pairs);
    json_integer(out, "missed_pairs", t->touching_pairs - t->found_pairs);
    json_integer(out, "false_pairs", t->warned_pairs - t->found_pairs);
    json_number(out, "recall", sense_recall(t));
    json_number(out, "precision", sense_precision(t));
    json_number(out, "confirmed_recall", sense_confirmed_recall(t));
    json_number(out, "trees_mean_ms", t->intervals > 0 ? t->trees_ms / t->intervals : 0.0);
    json_number(out, "trees_max_ms", t->trees_max_ms);
}

static void write_subject(json *out, const sense_subject *s) {
    const sense_options *o = s->options;
    json_string(out, "method", sense_method_name(o->sensors.method));
    json_boolean(out, "within", o->sensors.within);
    json_boolean(out, "exact", o->sensors.exact);
    json_number(out, "mu", o->sensors.collision_distance);
    json_number(out, "reff", o->sensors.effective_radius);
    json_string(out, "plan", plan_source_name(s->plan->source));
    json_integer(out, "vertices", cscd_mesh_vertex_count(s->recording->mesh));
    json_integer(out, "triangles", cscd_mesh_triangle_count(s->recording->mesh));
    json_integer(out, "objects", sense_object_count(s->recording->mesh));
    json_integer(out, "parts", cscd_sensors_part_count(s->sensors));
    json_integer(out, "cells", cscd_sensors_cell_count(s->sensors));
    json_integer(out, "particles", cscd_sensors_particle_count(s->sensors));
}

static void write_summary(json *out, const sense_subject *s, const sense_totals *t, const char *stopped_by) {
    json_break_line(out);
    json_begin_object(out, "summary");
    json_boolean(out, "complete", stopped_by == NULL);
    if (stopped_by != NULL) json_string(out, "stopped_by", stopped_by);
    if (s->sensors != NULL) write_subject(out, s);
    json_integer(out, "intervals", t->intervals);
    json_integer(out, "intervals_warned", t->intervals_warned);
    json_integer(out, "warnings", t->warnings);
    json_integer(out, "confirmed", t->confirmed);
    json_integer(out, "renewals", t->renewals);
    json_integer(out, "warned_pairs", t->warned_pairs);
    json_integer(out, "confirmed_pairs", t->confirmed_pairs);
    for (int i = 0; i < SENSE_COUNTERS; i++)
        json_integer(out, sense_counter_rows[i].sum_name,
                     sense_counter_value(&t->counters, &sense_counter_rows[i]));
    json_number(out, "mean_ms", t->intervals > 0 ? t->timings.total_ms / t->intervals : 0.0);
    json_number(out, "max_ms", t->sense_max_ms);
    if (s->options->compare) write_recall(out, t);
    json_end_object(out);
}

static void write_provenance(json *out, const sense_subject *s) {
    const sense_options *o = s->options;
    json_break_line(out);
    json_begin_object(out, "provenance");
    provenance_write(out, o->argument_count, o->arguments,
                     cscd_context_describe(s->recording->context).thread_count);
    json_begin_array(out, "inputs");
    provenance_write_input(out, o->source.model_path, recorded_object_hash_model(&s->recording->objects[0]));
    provenance_write_input(out, o->source.frame_paths[0], s->recording->objects[0].frames_hash);
    json_end_array(out);
    json_end_object(out);
}

static bool close_one(output_file *file, output_ending ending, const char *path, io_error *error) {
    return file->file == NULL || output_file_close(file, ending) || io_fail_write(error, path);
}

bool sense_files_close(sense_files *f, const sense_subject *subject, const sense_totals *t,
                       const char *stopped_by, io_error *error) {
    if (f->out.file != NULL) {
        json_end_array(&f->out);
        write_summary(&f->out, subject, t, stopped_by);
        write_provenance(&f->out, subject);
        json_end_object(&f->out);
        fputc('\n', f->out.file);
    }
    bool written = close_one(&f->csv, OUTPUT_WHOLE_LINES, subject->options->csv_path, error);
    written =
        close_one(&f->json, OUTPUT_WHOLE, subject->options->json_path, written ? error : NULL) && written;
    *f = (sense_files){0};
    return written;
}
