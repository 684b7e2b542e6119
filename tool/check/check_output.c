/* The pairs of triangles that `cscd check` finds, as JSON and as CSV, frame by frame. */
#include "tool/check/check_run.h"

#include "tool/io/record.h"

/* A pair as its columns have it; triangles and faces are those of the model files. */
typedef struct pair_row {
    int32_t frame;
    const char *kind, *parts[2], *objects[2];
    uint32_t a, b, face_a, face_b;
} pair_row;

#define FIELD_OF(member) offsetof(pair_row, member)

/* The columns of a pair. In JSON a frame has an array for each of them. */
static const record_field pair_fields[] = {
    {"frame", NULL, RECORD_SIGNED, FIELD_OF(frame)},
    {"kind", NULL, RECORD_WORD, FIELD_OF(kind)},
    {"a", NULL, RECORD_INDEX, FIELD_OF(a)},
    {"b", NULL, RECORD_INDEX, FIELD_OF(b)},
    {"face_a", NULL, RECORD_INDEX, FIELD_OF(face_a)},
    {"face_b", NULL, RECORD_INDEX, FIELD_OF(face_b)},
    {"part_a,part_b", NULL, RECORD_NAMES, FIELD_OF(parts)},
    {"object_a,object_b", NULL, RECORD_NAMES, FIELD_OF(objects)},
};

enum { PAIR_FIELDS = sizeof pair_fields / sizeof *pair_fields };

static bool write_failed(const char *path, io_error *error) {
    return io_fail_write(error, path);
}

bool check_output_open(const char *json_path, const char *csv_path, check_output *out, io_error *error) {
    *out = (check_output){.json_path = json_path, .csv_path = csv_path};
    if (json_path != NULL && !output_file_open(json_path, &out->json_file))
        return write_failed(json_path, error);
    if (csv_path != NULL && !output_file_open(csv_path, &out->csv_file)) return write_failed(csv_path, error);
    out->out.file = out->json_file.file;
    if (out->out.file != NULL) {
        json_begin_object(&out->out, NULL);
        json_begin_array(&out->out, "frames");
    }
    if (csv_path != NULL) record_write_header(out->csv_file.file, pair_fields, PAIR_FIELDS);
    return true;
}

/* ---- a frame -------------------------------------------------------------------------------------------- */

typedef uint32_t number_of_triangle(const recording *r, uint32_t triangle);

/* Pairs of numbers, of all pairs of triangles but duplicates. */
static void write_numbers(json *out, const char *member, const recording *r, const cscd_intersections *found,
                          number_of_triangle *number) {
    json_begin_array(out, member);
    for (size_t i = 0; i < found->count; i++) {
        if (found->items[i].kind == CSCD_INTERSECTION_DUPLICATE) continue;
        json_begin_array(out, NULL);
        json_integer(out, NULL, number(r, found->items[i].a));
        json_integer(out, NULL, number(r, found->items[i].b));
        json_end_array(out);
    }
    json_end_array(out);
}

static void write_kinds(json *out, const cscd_intersections *found) {
    json_begin_array(out, "kinds");
    for (size_t i = 0; i < found->count; i++)
        if (found->items[i].kind != CSCD_INTERSECTION_DUPLICATE)
            json_string(out, NULL, cscd_intersection_kind_name(found->items[i].kind));
    json_end_array(out);
}

static const char *object_name(const recording *r, uint32_t triangle) {
    return r->objects[recording_object_of_triangle(r, triangle)].source.name;
}

static void write_objects(json *out, const recording *r, const cscd_intersections *found) {
    json_begin_array(out, "objects");
    for (size_t i = 0; i < found->count; i++) {
        if (found->items[i].kind == CSCD_INTERSECTION_DUPLICATE) continue;
        json_begin_array(out, NULL);
        json_string(out, NULL, object_name(r, found->items[i].a));
        json_string(out, NULL, object_name(r, found->items[i].b));
        json_end_array(out);
    }
    json_end_array(out);
}

static bool has_polygons(const recording *r) {
    for (uint32_t i = 0; i < r->object_count; i++)
        if (r->objects[i].file.polygons != NULL) return true;
    return false;
}

static void write_json(json *out, const answers *a, const frame_answer *frame,
                       const cscd_intersections *found) {
    const recording *r = a->recording;
    json_break_line(out);
    json_begin_object(out, NULL);
    json_signed(out, "frame", answers_frame_number(a, frame->frame));
    answers_write_frame(a, frame, out);
    json_integer(out, "zero_area_triangles", found->zero_area_triangles);
    write_numbers(out, "pairs", r, found, recording_file_triangle);
    write_kinds(out, found);
    if (has_polygons(r)) write_numbers(out, "faces", r, found, recording_file_face);
    if (r->object_count > 1) write_objects(out, r, found);
    json_end_object(out);
}

static void write_csv(FILE *file, const answers *a, const frame_answer *frame,
                      const cscd_intersections *found) {
    const recording *r = a->recording;
    for (size_t i = 0; i < found->count; i++) {
        const cscd_intersection *pair = &found->items[i];
        if (pair->kind == CSCD_INTERSECTION_DUPLICATE) continue;
        const pair_row row = {.frame = answers_frame_number(a, frame->frame),
                              .kind = cscd_intersection_kind_name(pair->kind),
                              .a = recording_file_triangle(r, pair->a),
                              .b = recording_file_triangle(r, pair->b),
                              .face_a = recording_file_face(r, pair->a),
                              .face_b = recording_file_face(r, pair->b),
                              .parts = {part_names_at(a->parts, a->parts->labels[pair->a]),
                                        part_names_at(a->parts, a->parts->labels[pair->b])},
                              .objects = {object_name(r, pair->a), object_name(r, pair->b)}};
        record_write_row(file, pair_fields, PAIR_FIELDS, &row);
    }
}

bool check_output_add(check_output *out, const answers *a, const cscd_intersections *found, io_error *error) {
    const frame_answer *frame = &answers_frames(a)[answers_frame_count(a) - 1];
    if (out->json_path != NULL) {
        write_json(&out->out, a, frame, found);
        if (!output_file_flush(&out->json_file)) return write_failed(out->json_path, error);
    }
    if (out->csv_path == NULL) return true;
    write_csv(out->csv_file.file, a, frame, found);
    return output_file_flush(&out->csv_file) || write_failed(out->csv_path, error);
}

/* ---- the end -------------------------------------------------------------------------------------------- */

static void write_ending(json *out, const answers *a, const length_unit *unit) {
    const char *unfinished = answers_unfinished(a);
    json_end_array(out);
    json_break_line(out);
    answers_write_json(a, unit, out);
    json_break_line(out);
    json_boolean(out, "complete", unfinished == NULL);
    if (unfinished != NULL) json_string(out, "stopped_by", unfinished);
    json_end_object(out);
    fputc('\n', out->file);
}

bool check_output_close(check_output *out, const answers *a, const length_unit *unit, io_error *error) {
    bool written = true;
    if (out->json_file.file != NULL) {
        write_ending(&out->out, a, unit);
        written = output_file_close(&out->json_file, OUTPUT_WHOLE) || write_failed(out->json_path, error);
    }
    if (out->csv_file.file != NULL)
        written = (output_file_close(&out->csv_file, OUTPUT_WHOLE_LINES) ||
                   write_failed(out->csv_path, written ? error : NULL)) &&
                  written;
    *out = (check_output){0};
    return written;
}

void check_output_abandon(check_output *out) {
    if (out->json_file.file != NULL) output_file_close(&out->json_file, OUTPUT_ABANDONED);
    if (out->csv_file.file != NULL) output_file_close(&out->csv_file, OUTPUT_ABANDONED);
    *out = (check_output){0};
}
