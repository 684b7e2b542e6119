/* PLY (Stanford polygon format): text and binary, either byte order. */
#include "src/io/ply.h"

#include "src/io/mesh_builder.h"
#include "src/io/ply_header.h"
#include "src/io/text.h"

#include <inttypes.h>
#include <string.h>

typedef struct ply_parser {
    file_reader *reader;
    ply_header header;
    mesh_builder builder;
    const ply_element *element; /* in hand */
    int64_t row;                /* of the element */
    double position[3];         /* of the vertex in hand */
} ply_parser;

bool ply_recognise(const file_reader *reader) {
    file_reader probe = *reader;
    text_token token;
    return text_next_token(&probe, &token) && text_equals(token, "ply");
}

static bool fail_end(ply_parser *ply) {
    ply->reader->mark = ply->reader->size;
    return file_reader_fail_here(ply->reader, "file ends inside %s %" PRId64 " of %" PRId64,
                                 text_show(ply->element->name).text, ply->row + 1, ply->element->count);
}

static bool fail_missing(ply_parser *ply, const ply_property *property) {
    if (ply->reader->at == ply->reader->size) return fail_end(ply);
    return file_reader_fail_here(
        ply->reader, "the line ends inside %s %" PRId64 " of %" PRId64 ", expected its property '%s'",
        text_show(ply->element->name).text, ply->row + 1, ply->element->count,
        text_show(property->name).text);
}

static bool read_text_scalar(ply_parser *ply, const ply_property *property, ply_type type, double *value) {
    text_token token;
    int64_t integer;
    if (!text_next_token(ply->reader, &token)) return fail_missing(ply, property);
    if (!ply_type_is_integer(type)) {
        if (text_parse_number(token, value)) return true;
    } else if (text_parse_integer(token, &integer)) {
        *value = (double)integer;
        return true;
    }
    return file_reader_fail_here(ply->reader, "found '%s', expected %s for property '%s'",
                                 text_show(token).text, ply_type_is_integer(type) ? "an integer" : "a number",
                                 text_show(property->name).text);
}

static uint64_t load_bits(const char *bytes, size_t size, bool big_endian) {
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++) {
        unsigned char byte = (unsigned char)bytes[big_endian ? i : size - 1 - i];
        bits = bits << 8 | byte;
    }
    return bits;
}

/* All types fit a double exactly. */
static double decode(uint64_t bits, ply_type type) {
    uint32_t half = (uint32_t)bits;
    float single_value;
    double double_value;
    switch (type) {
    case PLY_INT8:
        return (int8_t)bits;
    case PLY_INT16:
        return (int16_t)bits;
    case PLY_INT32:
        return (int32_t)bits;
    case PLY_FLOAT32:
        memcpy(&single_value, &half, sizeof single_value);
        return (double)single_value;
    case PLY_FLOAT64:
        memcpy(&double_value, &bits, sizeof double_value);
        return double_value;
    case PLY_UINT8:
    case PLY_UINT16:
    case PLY_UINT32:
        break;
    }
    return half;
}

static bool read_binary_scalar(ply_parser *ply, ply_type type, double *value) {
    file_reader *reader = ply->reader;
    size_t size = ply_type_size(type);
    if (reader->size - reader->at < size) return fail_end(ply);
    *value =
        decode(load_bits(reader->bytes + reader->at, size, ply->header.encoding == PLY_BIG_ENDIAN), type);
    reader->mark = reader->at;
    reader->at += size;
    return true;
}

static bool read_scalar(ply_parser *ply, const ply_property *property, ply_type type, double *value) {
    if (ply->header.encoding == PLY_ASCII) return read_text_scalar(ply, property, type, value);
    return read_binary_scalar(ply, type, value);
}

static bool read_list_length(ply_parser *ply, const ply_property *property, int64_t *length) {
    double value;
    if (!read_scalar(ply, property, property->length_type, &value)) return false;
    if (value < 0) {
        return file_reader_fail_here(ply->reader, "the list '%s' has %.0f entries, expected 0 or more",
                                     text_show(property->name).text, value);
    }
    *length = (int64_t)value; /* below 10^18, also in text */
    return true;
}

static bool read_corner(ply_parser *ply, const ply_property *property) {
    double value;
    if (!read_scalar(ply, property, property->type, &value)) return false;
    if (!(value >= 0 && value < (double)ply->header.vertex_count)) {
        return file_reader_fail_here(
            ply->reader, "face index %.9g is out of range, the file has %" PRId64 " vertices, from 0", value,
            ply->header.vertex_count);
    }
    uint32_t vertex = (uint32_t)value;
    if ((double)vertex != value) {
        return file_reader_fail_here(ply->reader, "face index %.9g, expected an integer", value);
    }
    return mesh_builder_add_corner(&ply->builder, vertex);
}

static bool read_corners(ply_parser *ply, const ply_property *property) {
    int64_t length = 0;
    if (!read_list_length(ply, property, &length)) return false;
    mesh_builder_begin_face(&ply->builder);
    for (int64_t i = 0; i < length; i++) {
        if (!read_corner(ply, property)) return false;
    }
    return mesh_builder_end_face(&ply->builder);
}

/* Values that a mesh does not need are not looked at. */
static bool skip_values(ply_parser *ply, const ply_property *property, int64_t count) {
    file_reader *reader = ply->reader;
    if (ply->header.encoding == PLY_ASCII) {
        text_token token;
        for (int64_t i = 0; i < count; i++) {
            if (!text_next_token(reader, &token)) return fail_missing(ply, property);
        }
        return true;
    }
    size_t size = ply_type_size(property->type);
    if ((uint64_t)count > (reader->size - reader->at) / size) return fail_end(ply);
    reader->at += (size_t)count * size;
    return true;
}

static bool read_property(ply_parser *ply, const ply_property *property) {
    int64_t length = 0;
    switch (property->role) {
    case PLY_X:
    case PLY_Y:
    case PLY_Z:
        return read_scalar(ply, property, property->type, &ply->position[property->role]);
    case PLY_CORNERS:
        return read_corners(ply, property);
    case PLY_IGNORED:
        break;
    }
    if (!property->is_list) return skip_values(ply, property, 1);
    return read_list_length(ply, property, &length) && skip_values(ply, property, length);
}

/* One vertex, face or other: in text, one line. */
static bool read_row(ply_parser *ply) {
    bool is_text = ply->header.encoding == PLY_ASCII;
    size_t start = ply->reader->at;
    if (is_text && !text_seek_token(ply->reader)) return fail_end(ply);
    const ply_property *property =
        (const ply_property *)ply->header.properties.data + ply->element->first_property;
    for (size_t i = 0; i < ply->element->property_count; i++) {
        if (!read_property(ply, property + i)) return false;
    }
    if (is_text && !text_expect_line_end(ply->reader)) return false;
    ply->reader->mark = start;
    if (ply->element->kind == PLY_VERTEX && !mesh_builder_add_vertex(&ply->builder, ply->position))
        return false;
    if (is_text) text_skip_line(ply->reader);
    return true;
}

static bool read_elements(ply_parser *ply) {
    const ply_element *elements = ply->header.elements.data;
    for (size_t i = 0; i < ply->header.elements.count; i++) {
        ply->element = elements + i;
        /* An element without properties takes no room, whatever its count. */
        if (ply->element->property_count == 0) continue;
        for (ply->row = 0; ply->row < ply->element->count; ply->row++) {
            if (!read_row(ply)) return false;
        }
    }
    return true;
}

/* More than the header promises means that the header is wrong, and the mesh is not what its author meant. */
static bool expect_file_end(ply_parser *ply) {
    file_reader *reader = ply->reader;
    text_token token;
    if (ply->header.encoding == PLY_ASCII) {
        if (!text_seek_token(reader)) return true;
        text_next_token(reader, &token);
        return file_reader_fail_here(
            reader, "found '%s' after the last element, expected the end of the file", text_show(token).text);
    }
    for (size_t i = reader->at; i < reader->size; i++) {
        char c = reader->bytes[i];
        if (c == '\0' || c == ' ' || c == '\n' || c == '\r') continue; /* padding */
        reader->mark = reader->at;
        return file_reader_fail_here(reader,
                                     "%zu bytes follow the last element, expected the end of the file",
                                     reader->size - reader->at);
    }
    return true;
}

bool ply_read(file_reader *reader, mesh_file *out) {
    ply_parser ply = {.reader = reader, .builder = mesh_builder_of(reader, 0)};
    bool done = ply_header_read(reader, &ply.header);
    reader->binary = done && ply.header.encoding != PLY_ASCII;
    done = done && read_elements(&ply) && expect_file_end(&ply) && mesh_builder_finish(&ply.builder, out);
    mesh_builder_free(&ply.builder);
    ply_header_free(&ply.header);
    return done;
}
