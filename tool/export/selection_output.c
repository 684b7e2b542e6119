/* Lists of what to select in a modelling program: vertices and polygons of triangles that cross, part by
 * part. */
#include "tool/export/export_values.h"

#include <stdlib.h>

/* The reasons for which a triangle is listed: crossing another one, or meeting one otherwise. */
enum { LISTED_CROSSING = 1, LISTED_TOUCHING = 2 };

static void free_arrays(selection_output *s) {
    free(s->now);
    free(s->ever);
    free(s->listed);
    free(s->numbers);
    *s = (selection_output){0};
}

static uint32_t object_of(const selection_output *s, uint32_t triangle) {
    return recording_object_of_triangle(s->recording, triangle);
}

/* The polygon of a triangle, or a corner, as the model file numbers them. The corners are the file's own,
 * also where vertices are welded. */
static uint32_t file_number(const selection_output *s, uint32_t triangle, int corner) {
    const mesh_file *file = &s->recording->objects[object_of(s, triangle)].file;
    const uint32_t own = recording_file_triangle(s->recording, triangle);
    return corner < 0 ? mesh_file_polygon(file, own) : file->triangles[3 * (size_t)own + (size_t)corner];
}

/* ---- what the numbers refer to ------------------------------------------------------------------------- */

static void write_objects(selection_output *s) {
    json_break_line(&s->out);
    json_begin_array(&s->out, "objects");
    for (uint32_t i = 0; i < s->recording->object_count; i++) {
        const recorded_object *object = &s->recording->objects[i];
        json_break_line(&s->out);
        json_begin_object(&s->out, NULL);
        json_string(&s->out, "name", object->source.name);
        json_string(&s->out, "model", object->source.model_path);
        json_integer(&s->out, "vertices", object->file.vertex_count);
        json_integer(&s->out, "polygons", object->file.polygon_count);
        json_end_object(&s->out);
    }
    json_end_array(&s->out);
}

/* The range of the numbers of some triangles. */
typedef struct number_range {
    uint32_t first, last;
} number_range;

static void widen_range(number_range *range, uint32_t number) {
    if (number < range->first) range->first = number;
    if (number > range->last) range->last = number;
}

static void write_part(selection_output *s, uint32_t object, uint32_t part, number_range vertices,
                       number_range polygons) {
    json_break_line(&s->out);
    json_begin_object(&s->out, NULL);
    json_string(&s->out, "name", s->parts->names[part]);
    json_string(&s->out, "object", s->recording->objects[object].source.name);
    json_integer(&s->out, "first_vertex", vertices.first);
    json_integer(&s->out, "last_vertex", vertices.last);
    json_integer(&s->out, "first_polygon", polygons.first);
    json_integer(&s->out, "last_polygon", polygons.last);
    json_end_object(&s->out);
}

/* The parts of one object, with the ranges of their numbers: one object of a scene is mostly one range of its
 * file. */
static void write_object_parts(selection_output *s, uint32_t index, number_range (*ranges)[2]) {
    const recorded_object *object = &s->recording->objects[index];
    for (uint32_t i = 0; i < s->parts->count; i++)
        for (int k = 0; k < 2; k++) ranges[i][k] = (number_range){UINT32_MAX, 0};
    for (uint32_t t = object->first_triangle; t < object->first_triangle + object->triangle_count; t++) {
        const uint32_t part = s->parts->labels[t];
        if (part == NO_PART) continue;
        for (int k = 0; k < 3; k++) widen_range(&ranges[part][0], file_number(s, t, k));
        widen_range(&ranges[part][1], file_number(s, t, -1));
    }
    for (uint32_t i = 0; i < s->parts->count; i++)
        if (ranges[i][0].first != UINT32_MAX) write_part(s, index, i, ranges[i][0], ranges[i][1]);
}

static bool write_beginning(selection_output *s) {
    number_range(*ranges)[2] = malloc(((size_t)s->parts->count + 1) * sizeof *ranges);
    if (ranges == NULL) return false;
    json_begin_object(&s->out, NULL);
    json_integer(&s->out, "version", 1);
    write_objects(s);
    json_break_line(&s->out);
    json_begin_array(&s->out, "parts");
    for (uint32_t i = 0; i < s->recording->object_count; i++) write_object_parts(s, i, ranges);
    json_end_array(&s->out);
    json_break_line(&s->out);
    json_begin_array(&s->out, "frames");
    free(ranges);
    return true;
}

bool selection_output_open(const char *path, recording *r, const part_names *parts, selection_output *out,
                           io_error *error) {
    const size_t count = (size_t)cscd_mesh_triangle_count(r->mesh) + 1;
    selection_output s = {.path = path, .recording = r, .parts = parts};
    s.now = calloc(count, sizeof *s.now);
    s.ever = calloc(count, sizeof *s.ever);
    s.listed = malloc(count * sizeof *s.listed);
    s.numbers = malloc(3 * count * sizeof *s.numbers);
    bool opened = (s.now != NULL && s.ever != NULL && s.listed != NULL && s.numbers != NULL) ||
                  io_fail(error, "out of memory for the lists of --select");
    if (opened && !output_file_open(path, &s.file)) opened = io_fail_write(error, path);
    s.out.file = s.file.file;
    if (opened && !write_beginning(&s)) {
        opened = io_fail(error, "out of memory for the lists of --select");
        output_file_close(&s.file, OUTPUT_ABANDONED);
    }
    if (!opened) {
        free_arrays(&s);
        return false;
    }
    *out = s;
    return true;
}

/* ---- the lists ----------------------------------------------------------------------------------------- */

static int compare_numbers(const void *a, const void *b) {
    const uint32_t first = *(const uint32_t *)a, second = *(const uint32_t *)b;
    return (first > second) - (first < second);
}

/* By object, by part, and then in order. */
static int compare_triangles(const void *a, const void *b, void *user) {
    const selection_output *s = user;
    const uint32_t first = *(const uint32_t *)a, second = *(const uint32_t *)b;
    const uint32_t objects[2] = {object_of(s, first), object_of(s, second)};
    const uint32_t labels[2] = {s->parts->labels[first], s->parts->labels[second]};
    if (objects[0] != objects[1]) return objects[0] < objects[1] ? -1 : 1;
    if (labels[0] != labels[1]) return labels[0] < labels[1] ? -1 : 1;
    return (first > second) - (first < second);
}

/* The vertices, or the polygons, of those of some triangles that are listed for something, ascending and each
 * once. */
static void write_list(selection_output *s, const char *key, const uint32_t *triangles, size_t count,
                       const uint8_t *marks, uint8_t mark, bool vertices) {
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        if ((marks[triangles[i]] & mark) == 0) continue;
        for (int k = 0; k < (vertices ? 3 : 1); k++)
            s->numbers[used++] = file_number(s, triangles[i], vertices ? k : -1);
    }
    qsort(s->numbers, used, sizeof *s->numbers, compare_numbers);
    json_begin_array(&s->out, key);
    for (size_t i = 0; i < used; i++)
        if (i == 0 || s->numbers[i] != s->numbers[i - 1]) json_integer(&s->out, NULL, s->numbers[i]);
    json_end_array(&s->out);
}

/* One part of one object. */
static void write_group(selection_output *s, const uint32_t *triangles, size_t count, const uint8_t *marks) {
    const uint32_t part = s->parts->labels[triangles[0]];
    json_break_line(&s->out);
    json_begin_object(&s->out, NULL);
    if (part == NO_PART)
        json_null(&s->out, "name");
    else
        json_string(&s->out, "name", s->parts->names[part]);
    json_string(&s->out, "object", s->recording->objects[object_of(s, triangles[0])].source.name);
    write_list(s, "vertices", triangles, count, marks, LISTED_CROSSING, true);
    write_list(s, "polygons", triangles, count, marks, LISTED_CROSSING, false);
    write_list(s, "touching_vertices", triangles, count, marks, LISTED_TOUCHING, true);
    write_list(s, "touching_polygons", triangles, count, marks, LISTED_TOUCHING, false);
    json_end_object(&s->out);
}

static void write_groups(selection_output *s, const char *key, size_t count, const uint8_t *marks) {
    qsort_r(s->listed, count, sizeof *s->listed, compare_triangles, s);
    json_begin_array(&s->out, key);
    for (size_t i = 0, end; i < count; i = end) {
        const uint32_t first = s->listed[i];
        for (end = i + 1; end < count; end++) {
            const uint32_t other = s->listed[end];
            if (object_of(s, other) != object_of(s, first) ||
                s->parts->labels[other] != s->parts->labels[first])
                break;
        }
        write_group(s, s->listed + i, end - i, marks);
    }
    json_end_array(&s->out);
}

/* Marks the triangles of the pairs; each is listed once. */
static size_t mark_pairs(selection_output *s, const cscd_intersections *found) {
    size_t count = 0;
    for (size_t i = 0; i < found->count; i++) {
        const cscd_intersection *pair = &found->items[i];
        const uint32_t sides[2] = {pair->a, pair->b};
        const uint8_t mark = pair->kind == CSCD_INTERSECTION_CROSSING ? LISTED_CROSSING : LISTED_TOUCHING;
        for (int k = 0; k < 2; k++) {
            if (s->now[sides[k]] == 0) s->listed[count++] = sides[k];
            s->now[sides[k]] |= mark;
            s->ever[sides[k]] |= mark;
        }
    }
    return count;
}

bool selection_output_add_frame(selection_output *s, int32_t number, const cscd_intersections *found,
                                io_error *error) {
    const size_t count = mark_pairs(s, found);
    if (count == 0) return true;
    json_break_line(&s->out);
    json_begin_object(&s->out, NULL);
    json_signed(&s->out, "frame", number);
    write_groups(s, "parts", count, s->now);
    json_end_object(&s->out);
    for (size_t i = 0; i < count; i++) s->now[s->listed[i]] = 0;
    return output_file_flush(&s->file) || io_fail_write(error, s->path);
}

bool selection_output_close(selection_output *s, bool kept, io_error *error) {
    const uint32_t triangles = cscd_mesh_triangle_count(s->recording->mesh);
    size_t count = 0;
    for (uint32_t t = 0; t < triangles; t++)
        if (s->ever[t] != 0) s->listed[count++] = t;
    json_end_array(&s->out);
    json_break_line(&s->out);
    write_groups(s, "union", count, s->ever);
    json_end_object(&s->out);
    fputc('\n', s->out.file);
    const bool written = output_file_close(&s->file, kept ? OUTPUT_WHOLE : OUTPUT_ABANDONED) || !kept ||
                         io_fail_write(error, s->path);
    free_arrays(s);
    return written;
}
