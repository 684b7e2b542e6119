/* PLY (Stanford polygon format) as a mesh. */
#include "tool/io/format_reader.h"

#include "tool/io/mesh_builder.h"
#include "tool/io/ply_data.h"

#include <inttypes.h>
#include <stdio.h>

typedef struct ply_parser {
    ply_data data;
    mesh_builder builder;
    double position[3]; /* of the current vertex */
    double label;       /* of the current face */
    bool labelled;      /* the face has one */
    bool has_parts;     /* the last face with a label had part_label */
    double part_label;
    double stiffness; /* of the current face */
    bool is_stiff;    /* the face has one */
} ply_parser;

/* The first line of the file is "ply". */
static bool recognise_ply(const file_reader *reader) {
    file_reader probe = *reader;
    text_token token;
    return text_next_token(&probe, &token) && text_equals(token, "ply");
}

static bool read_corner(ply_parser *ply, const ply_property *property) {
    double value;
    if (!ply_data_number(&ply->data, property, &value)) return false;
    if (!(value >= 0 && value < (double)ply->data.header.vertex_count)) {
        return file_reader_fail_here(
            ply->data.reader, "face index %.9g is out of range, the file has %" PRId64 " vertices, from 0",
            value, ply->data.header.vertex_count);
    }
    uint32_t vertex = (uint32_t)value;
    if ((double)vertex != value) {
        return file_reader_fail_here(ply->data.reader, "face index %.9g, expected an integer", value);
    }
    return mesh_builder_add_corner(&ply->builder, vertex);
}

static bool read_corners(ply_parser *ply, const ply_property *property) {
    int64_t length = 0;
    if (!ply_data_length(&ply->data, property, &length)) return false;
    if (!mesh_builder_begin_face(&ply->builder)) return false;
    for (int64_t i = 0; i < length; i++) {
        if (!read_corner(ply, property)) return false;
    }
    return mesh_builder_end_face(&ply->builder);
}

static bool visit_property(void *user, const ply_property *property) {
    ply_parser *ply = user;
    switch (property->role) {
    case PLY_X:
    case PLY_Y:
    case PLY_Z:
        return ply_data_number(&ply->data, property, &ply->position[property->role]);
    case PLY_CORNERS:
        return read_corners(ply, property);
    case PLY_PART:
        ply->labelled = true;
        return ply_data_number(&ply->data, property, &ply->label);
    case PLY_STIFFNESS:
        ply->is_stiff = true;
        return ply_data_number(&ply->data, property, &ply->stiffness);
    case PLY_IGNORED:
        break;
    }
    return ply_data_skip(&ply->data, property);
}

/* Parts are called by their number. A face is begun before its label is known if the label stands behind its corners. */
static bool set_part(ply_parser *ply) {
    char name[32];
    if (ply->has_parts && ply->label == ply->part_label) return true; /* as the face before it */
    const int length = snprintf(name, sizeof name, "%.0f", ply->label);
    ply->has_parts = true;
    ply->part_label = ply->label;
    return mesh_builder_set_face_part(&ply->builder, name, (size_t)length);
}

static bool end_row(void *user) {
    ply_parser *ply = user;
    if (ply->data.element->kind == PLY_VERTEX) return mesh_builder_add_vertex(&ply->builder, ply->position);
    if (ply->data.element->kind != PLY_FACE) return true;
    if (ply->is_stiff && !mesh_builder_add_face_stiffness(&ply->builder, ply->stiffness)) return false;
    return !ply->labelled || set_part(ply);
}

static bool read_ply(file_reader *reader, mesh_file *out) {
    ply_parser ply = {.builder = mesh_builder_of(reader, 0)};
    const ply_visitor visitor = {visit_property, end_row, &ply};
    bool done = ply_data_open(&ply.data, reader) && ply_data_read(&ply.data, &visitor) &&
                mesh_builder_finish(&ply.builder, out);
    mesh_builder_free(&ply.builder);
    ply_data_close(&ply.data);
    return done;
}

const format_reader ply_reader = {MESH_FORMAT_PLY, .by_ending = true, .recognise = recognise_ply,
                                  .read = read_ply};
