/* Wavefront OBJ: vertices, polygons, and the names of objects, groups and materials; all other records are
 * skipped. */
#include "tool/io/format_reader.h"

#include "tool/io/file_reader.h"
#include "tool/io/mesh_builder.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

typedef struct obj_parser {
    file_reader *reader;
    mesh_builder builder;
    /* A face may name vertices that come later: the largest index so far, and its line, are checked at the
     * end. */
    int64_t largest_index;
    size_t largest_line;
    text_token object, group, material; /* those of the faces to come; of length 0: none */
    bool renamed;                       /* since the last face: a name without faces is no part */
} obj_parser;

static bool read_vertex(obj_parser *obj) {
    static const char *const names[3] = {"coordinate x of the vertex", "coordinate y of the vertex",
                                         "coordinate z of the vertex"};
    double position[3];
    for (int axis = 0; axis < 3; axis++) {
        if (!text_coordinate(obj->reader, axis, names[axis], &position[axis])) return false;
    }
    /* The rest of the line is a weight or a colour. */
    return mesh_builder_add_vertex(&obj->builder, position);
}

/* Reads a, a/b, a//c or a/b/c; index becomes a. */
static bool parse_corner(text_token token, int64_t *index) {
    size_t at = text_parse_integer_prefix(token, index);
    if (at == 0) return false;
    for (int field = 0; field < 2 && at < token.length && token.text[at] == '/'; field++) {
        int64_t ignored;
        at++;
        at += text_parse_integer_prefix((text_token){token.text + at, token.length - at}, &ignored);
    }
    return at == token.length;
}

/* Indices count from 1, negative ones backwards from the last vertex so far. */
static bool resolve_index(obj_parser *obj, int64_t index, uint32_t *vertex) {
    int64_t vertex_count = (int64_t)obj->builder.positions.count;
    if (index == 0) {
        return file_reader_fail_here(obj->reader, "face index 0 is out of range, the first vertex is 1");
    }
    if (index < -vertex_count) {
        return file_reader_fail_here(obj->reader,
                                     "face index %" PRId64 " is out of range, the file has %" PRId64
                                     " vertices before it",
                                     index, vertex_count);
    }
    if (index > MESH_COUNT_LIMIT) {
        return file_reader_fail_here(
            obj->reader, "face index %" PRId64 " is out of range, a mesh has at most %" PRId32 " vertices",
            index, MESH_COUNT_LIMIT);
    }
    if (index > obj->largest_index) {
        obj->largest_index = index;
        obj->largest_line = obj->reader->line;
    }
    *vertex = (uint32_t)(index > 0 ? index - 1 : vertex_count + index);
    return true;
}

/* Names that exporters write for an object or a group without one. */
static bool is_no_name(text_token name) {
    return text_equals(name, "default") || text_equals(name, "off") || text_equals(name, "(null)");
}

/* Reads the name of an object or group: all of the line, for names have blanks and # in them. */
static void read_name(obj_parser *obj, text_token *name) {
    text_rest_of_line(obj->reader, name);
    if (is_no_name(*name)) name->length = 0;
    obj->renamed = true;
}

/* A material is called as its file calls it, be it default; programs write (null) where there is none. */
static void read_material(obj_parser *obj) {
    text_rest_of_line(obj->reader, &obj->material);
    if (text_equals(obj->material, "(null)")) obj->material.length = 0;
    obj->renamed = true;
}

typedef bool part_setter(mesh_builder *, const char *name, size_t length);

/* The faces to come are in the part OBJECT/GROUP, or in one of them alone. */
static bool name_joined(obj_parser *obj, part_setter *set_part) {
    char joined[512];
    const text_token object = obj->object, group = obj->group;
    if (object.length == 0 || group.length == 0) {
        const text_token only = object.length > 0 ? object : group;
        return set_part(&obj->builder, only.text, only.length);
    }
    int length = snprintf(joined, sizeof joined, "%.*s/%.*s", (int)object.length, object.text,
                          (int)group.length, group.text);
    if ((size_t)length >= sizeof joined) length = sizeof joined - 1;
    return set_part(&obj->builder, joined, (size_t)length);
}

/* By objects, groups or materials alone the faces to come are in a part of that name, and besides in one of
 * their own. */
static bool name_part(obj_parser *obj) {
    const mesh_parts_by by = obj->reader->parts_by;
    obj->renamed = false;
    if (by == MESH_PARTS_BY_FILE) return name_joined(obj, mesh_builder_set_part);
    const text_token name = by == MESH_PARTS_BY_OBJECT  ? obj->object
                            : by == MESH_PARTS_BY_GROUP ? obj->group
                                                        : obj->material;
    return mesh_builder_set_part(&obj->builder, name.text, name.length) &&
           name_joined(obj, mesh_builder_set_own_part);
}

static bool read_face(obj_parser *obj) {
    text_token token;
    if (obj->renamed && !name_part(obj)) return false;
    if (!mesh_builder_begin_face(&obj->builder)) return false;
    while (text_next_token(obj->reader, &token)) {
        int64_t index;
        uint32_t vertex = 0;
        if (!parse_corner(token, &index)) {
            return file_reader_fail_here(obj->reader,
                                         "found '%s', expected a face corner: v, v/vt, v//vn or v/vt/vn",
                                         text_show(token).text);
        }
        if (!resolve_index(obj, index, &vertex) || !mesh_builder_add_corner(&obj->builder, vertex))
            return false;
    }
    return mesh_builder_end_face(&obj->builder);
}

static bool read_records(obj_parser *obj) {
    const bool by_material = obj->reader->parts_by == MESH_PARTS_BY_MATERIAL;
    for (; text_seek_token(obj->reader); text_skip_line(obj->reader)) {
        text_token keyword;
        text_next_token(obj->reader, &keyword);
        if (text_equals(keyword, "v")) {
            if (!read_vertex(obj)) return false;
        } else if (text_equals(keyword, "f")) {
            if (!read_face(obj)) return false;
        } else if (text_equals(keyword, "o")) {
            obj->group = (text_token){"", 0}; /* an object's faces begin in no group */
            read_name(obj, &obj->object);
        } else if (text_equals(keyword, "g")) {
            read_name(obj, &obj->group);
        } else if (by_material && text_equals(keyword, "usemtl")) {
            read_material(obj);
        }
    }
    return true;
}

static bool check_largest_index(obj_parser *obj) {
    size_t vertex_count = obj->builder.positions.count;
    if (vertex_count == 0 || obj->largest_index <= (int64_t)vertex_count) return true;
    obj->reader->line = obj->largest_line;
    return file_reader_fail_here(obj->reader,
                                 "face index %" PRId64 " is out of range, the file has %zu vertices",
                                 obj->largest_index, vertex_count);
}

static bool read_obj(file_reader *reader, mesh_file *out) {
    reader->comments = true;
    reader->continuations = true;
    obj_parser obj = {.reader = reader, .builder = mesh_builder_of(reader, 1)};
    bool done = read_records(&obj) && check_largest_index(&obj) && mesh_builder_finish(&obj.builder, out);
    mesh_builder_free(&obj.builder);
    return done;
}

const format_reader obj_reader = {MESH_FORMAT_OBJ, .by_ending = true, .names_parts = true, .read = read_obj};
