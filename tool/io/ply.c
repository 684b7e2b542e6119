/* PLY files: the header, the rows of its elements, text and binary of either byte order, and the mesh in
 * them. */
#include "tool/io/ply.h"

#include "tool/io/format_reader.h"
#include "tool/io/mesh_builder.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* ---- the header ---------------------------------------------------------------------------------------- */

typedef struct header_parser {
    file_reader *reader;
    ply_header *header;
    bool has_format;
} header_parser;

static size_t ply_type_size(ply_type type) {
    static const size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[type];
}

static bool ply_type_is_integer(ply_type type) {
    return type < PLY_FLOAT32;
}

static bool fail_expected(header_parser *parser, text_token token, const char *expected) {
    if (token.length == 0)
        return file_reader_fail_here(parser->reader, "the line ends, expected %s", expected);
    return file_reader_fail_here(parser->reader, "found '%s', expected %s", text_show(token).text, expected);
}

static ply_element *last_element(const ply_header *header) {
    return (ply_element *)header->elements.data + header->elements.count - 1;
}

static bool out_of_memory(header_parser *parser) {
    return file_reader_fail_here(parser->reader, "out of memory");
}

static bool read_format(header_parser *parser) {
    static const char *const encodings[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    text_token token;
    if (parser->has_format)
        return file_reader_fail_here(parser->reader, "a second format line, expected one");
    text_next_token(parser->reader, &token);
    int encoding = 0;
    while (encoding < 3 && !text_equals(token, encodings[encoding])) encoding++;
    if (encoding == 3)
        return fail_expected(parser, token, "ascii, binary_little_endian or binary_big_endian");
    parser->header->encoding = (ply_encoding)encoding;
    parser->has_format = true;
    text_next_token(parser->reader, &token);
    return text_equals(token, "1.0") || fail_expected(parser, token, "version 1.0");
}

static bool read_element(header_parser *parser) {
    ply_header *header = parser->header;
    ply_element element = {.first_property = header->properties.count};
    if (!text_next_token(parser->reader, &element.name))
        return fail_expected(parser, element.name, "an element name");
    if (!text_integer(parser->reader, "the number of elements", &element.count)) return false;
    if (text_equals(element.name, "vertex")) element.kind = PLY_VERTEX;
    if (text_equals(element.name, "face")) element.kind = PLY_FACE;
    int64_t limit = element.kind == PLY_OTHER ? INT64_MAX : MESH_COUNT_LIMIT;
    if (element.count < 0 || element.count > limit) {
        return file_reader_fail_here(parser->reader, "%" PRId64 " elements '%s', expected 0 to %" PRId64,
                                     element.count, text_show(element.name).text, limit);
    }
    for (size_t i = 0; i < header->elements.count && element.kind != PLY_OTHER; i++) {
        if (((ply_element *)header->elements.data)[i].kind == element.kind) {
            return file_reader_fail_here(parser->reader, "a second element '%s', expected one",
                                         text_show(element.name).text);
        }
    }
    if (element.kind == PLY_VERTEX) header->vertex_count = element.count;
    ply_element *added = growable_push(&header->elements);
    if (added == NULL) return out_of_memory(parser);
    *added = element;
    return true;
}

static bool parse_type(text_token token, ply_type *type) {
    static const char *const names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                           {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                           {"float", "float32"}, {"double", "float64"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (text_equals(token, names[i][0]) || text_equals(token, names[i][1])) {
            *type = (ply_type)i;
            return true;
        }
    }
    return false;
}

static ply_role role_of(ply_kind kind, text_token name) {
    static const char *const coordinates[] = {"x", "y", "z"};
    for (int i = 0; i < 3 && kind == PLY_VERTEX; i++) {
        if (text_equals(name, coordinates[i])) return (ply_role)(PLY_X + i);
    }
    if (kind == PLY_FACE && (text_equals(name, "vertex_indices") || text_equals(name, "vertex_index"))) {
        return PLY_CORNERS;
    }
    return PLY_IGNORED;
}

static bool names_part(const ply_element *element, const ply_property *property) {
    return element->kind == PLY_FACE && !property->is_list && ply_type_is_integer(property->type) &&
           (text_equals(property->name, "part") || text_equals(property->name, "label"));
}

static bool names_stiffness(const ply_element *element, const ply_property *property) {
    return element->kind == PLY_FACE && !property->is_list && text_equals(property->name, "stiffness");
}

static bool has_role(const ply_header *header, const ply_element *element, ply_role role) {
    const ply_property *properties = header->properties.data;
    for (size_t i = 0; i < element->property_count; i++) {
        if (properties[element->first_property + i].role == role) return true;
    }
    return false;
}

/* Reads "type name" or "list length_type type name". */
static bool read_property_words(header_parser *parser, ply_property *property) {
    static const char type_names[] =
        "a type: char, uchar, short, ushort, int, uint, float, double or a list of one";
    text_token token;
    text_next_token(parser->reader, &token);
    property->is_list = text_equals(token, "list");
    if (property->is_list) {
        text_next_token(parser->reader, &token);
        if (!parse_type(token, &property->length_type) || !ply_type_is_integer(property->length_type)) {
            return fail_expected(parser, token, "an integer type for the length of the list");
        }
        text_next_token(parser->reader, &token);
    }
    if (!parse_type(token, &property->type)) return fail_expected(parser, token, type_names);
    return text_next_token(parser->reader, &property->name) ||
           fail_expected(parser, property->name, "a property name");
}

static bool read_property(header_parser *parser) {
    ply_header *header = parser->header;
    ply_property property = {0};
    if (header->elements.count == 0)
        return file_reader_fail_here(parser->reader, "a property before any element");
    if (!read_property_words(parser, &property)) return false;
    ply_element *element = last_element(header);
    property.role = role_of(element->kind, property.name);
    if (names_part(element, &property) && !has_role(header, element, PLY_PART)) {
        property.role = PLY_PART;
    } else if (names_stiffness(element, &property) && !has_role(header, element, PLY_STIFFNESS)) {
        property.role = PLY_STIFFNESS;
    } else if (property.role != PLY_IGNORED) {
        if (property.is_list != (property.role == PLY_CORNERS)) {
            return file_reader_fail_here(
                parser->reader, "property '%s' is %s, expected %s", text_show(property.name).text,
                property.is_list ? "a list" : "no list", property.is_list ? "one number" : "a list");
        }
        if (has_role(header, element, property.role)) {
            return file_reader_fail_here(parser->reader, "a second property '%s', expected one",
                                         text_show(property.name).text);
        }
    }
    ply_property *added = growable_push(&header->properties);
    if (added == NULL) return out_of_memory(parser);
    *added = property;
    element->property_count++;
    return true;
}

static bool check_complete(header_parser *parser) {
    static const char *const names[] = {"x", "y", "z", "vertex_indices"};
    const ply_header *header = parser->header;
    bool has_vertex = false, has_face = false;
    if (!parser->has_format)
        return file_reader_fail_here(parser->reader, "the header ends, expected a format line");
    for (size_t i = 0; i < header->elements.count; i++) {
        const ply_element *element = (const ply_element *)header->elements.data + i;
        if (element->kind == PLY_OTHER) continue;
        bool is_vertex = element->kind == PLY_VERTEX;
        has_vertex = has_vertex || is_vertex;
        has_face = has_face || !is_vertex;
        for (int role = is_vertex ? PLY_X : PLY_CORNERS; role <= (is_vertex ? PLY_Z : PLY_CORNERS); role++) {
            if (has_role(header, element, (ply_role)role)) continue;
            return file_reader_fail_here(parser->reader, "element '%s' lacks the property '%s'",
                                         text_show(element->name).text, names[role]);
        }
    }
    if (has_vertex && has_face) return true;
    return file_reader_fail_here(parser->reader, "the header ends, expected an element '%s'",
                                 has_vertex ? "face" : "vertex");
}

/* One line of the header but its last. */
static bool read_line(header_parser *parser, text_token keyword) {
    bool done;
    if (text_equals(keyword, "comment") || text_equals(keyword, "obj_info")) return true;
    if (text_equals(keyword, "format")) {
        done = read_format(parser);
    } else if (text_equals(keyword, "element")) {
        done = read_element(parser);
    } else if (text_equals(keyword, "property")) {
        done = read_property(parser);
    } else {
        return fail_expected(parser, keyword, "format, comment, obj_info, element, property or end_header");
    }
    return done && text_expect_line_end(parser->reader);
}

static bool read_lines(header_parser *parser) {
    file_reader *reader = parser->reader;
    text_token keyword;
    while (text_seek_token(reader)) {
        text_next_token(reader, &keyword);
        if (text_equals(keyword, "end_header")) return text_expect_line_end(reader) && check_complete(parser);
        if (!read_line(parser, keyword)) return false;
        text_skip_line(reader);
    }
    return file_reader_fail_here(reader, "file ends inside the header, expected end_header");
}

/* Reads up to the first byte of the data. The header must have one element vertex with x, y, z and one
 * element face with vertex_indices or vertex_index. On false the reader's error is set. Free it in either
 * case. */
static bool ply_header_read(file_reader *reader, ply_header *header) {
    *header = (ply_header){
        .elements = growable_of(sizeof(ply_element)),
        .properties = growable_of(sizeof(ply_property)),
    };
    header_parser parser = {.reader = reader, .header = header};
    text_token magic;
    text_next_token(reader, &magic);
    if (!text_equals(magic, "ply")) return fail_expected(&parser, magic, "ply");
    if (!text_expect_line_end(reader)) return false;
    bool lone_return = reader->bytes[reader->at] == '\r' && reader->bytes[reader->at + 1] != '\n';
    text_skip_line(reader);
    if (!read_lines(&parser)) return false;
    /* The first byte of binary data may look like the second of a line end. */
    if (lone_return && reader->bytes[reader->at] == '\r') {
        reader->at++;
        reader->line++;
    } else {
        text_skip_line(reader);
    }
    return true;
}

static void ply_header_free(ply_header *header) {
    growable_free(&header->elements);
    growable_free(&header->properties);
}

/* ---- the rows ------------------------------------------------------------------------------------------ */

static bool fail_end(ply_data *data) {
    data->reader->mark = data->reader->size;
    return file_reader_fail_here(data->reader, "file ends inside %s %" PRId64 " of %" PRId64,
                                 text_show(data->element->name).text, data->row + 1, data->element->count);
}

static bool fail_missing(ply_data *data, const ply_property *property) {
    if (data->reader->at == data->reader->size) return fail_end(data);
    return file_reader_fail_here(
        data->reader, "the line ends inside %s %" PRId64 " of %" PRId64 ", expected its property '%s'",
        text_show(data->element->name).text, data->row + 1, data->element->count,
        text_show(property->name).text);
}

static bool read_text_scalar(ply_data *data, const ply_property *property, ply_type type, double *value) {
    text_token token;
    int64_t integer;
    if (!text_next_token(data->reader, &token)) return fail_missing(data, property);
    if (!ply_type_is_integer(type)) {
        if (text_parse_number(token, value)) return true;
    } else if (text_parse_integer(token, &integer)) {
        *value = (double)integer;
        return true;
    }
    const bool whole = ply_type_is_integer(type);
    return file_reader_fail_here(data->reader, "found '%s', expected %s for property '%s'%s",
                                 text_show(token).text, whole ? "an integer" : "a number",
                                 text_show(property->name).text, whole ? "" : text_number_advice(token));
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
static double decode_value(uint64_t bits, ply_type type) {
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

static bool read_binary_scalar(ply_data *data, ply_type type, double *value) {
    file_reader *reader = data->reader;
    size_t size = ply_type_size(type);
    if (reader->size - reader->at < size) return fail_end(data);
    *value = decode_value(
        load_bits(reader->bytes + reader->at, size, data->header.encoding == PLY_BIG_ENDIAN), type);
    reader->mark = reader->at;
    reader->at += size;
    return true;
}

static bool read_scalar(ply_data *data, const ply_property *property, ply_type type, double *value) {
    if (data->header.encoding == PLY_ASCII) return read_text_scalar(data, property, type, value);
    return read_binary_scalar(data, type, value);
}

bool ply_data_number(ply_data *data, const ply_property *property, double *value) {
    return read_scalar(data, property, property->type, value);
}

bool ply_data_length(ply_data *data, const ply_property *property, int64_t *length) {
    double value;
    if (!read_scalar(data, property, property->length_type, &value)) return false;
    if (value < 0) {
        return file_reader_fail_here(data->reader, "the list '%s' has %.0f entries, expected 0 or more",
                                     text_show(property->name).text, value);
    }
    *length = (int64_t)value; /* below 10^18, also in text */
    return true;
}

/* Skips values that are not needed, without checking them. */
static bool skip_values(ply_data *data, const ply_property *property, int64_t count) {
    file_reader *reader = data->reader;
    if (data->header.encoding == PLY_ASCII) {
        text_token token;
        for (int64_t i = 0; i < count; i++) {
            if (!text_next_token(reader, &token)) return fail_missing(data, property);
        }
        return true;
    }
    size_t size = ply_type_size(property->type);
    if ((uint64_t)count > (reader->size - reader->at) / size) return fail_end(data);
    reader->at += (size_t)count * size;
    return true;
}

bool ply_data_skip(ply_data *data, const ply_property *property) {
    int64_t length = 1;
    if (property->is_list && !ply_data_length(data, property, &length)) return false;
    return skip_values(data, property, length);
}

/* Reads one vertex, face or other element; in text it is one line. */
static bool read_row(ply_data *data, const ply_visitor *visitor) {
    bool is_text = data->header.encoding == PLY_ASCII;
    size_t start = data->reader->at;
    if (is_text && !text_seek_token(data->reader)) return fail_end(data);
    const ply_property *property =
        (const ply_property *)data->header.properties.data + data->element->first_property;
    for (size_t i = 0; i < data->element->property_count; i++) {
        if (!visitor->visit(visitor->user, property + i)) return false;
    }
    if (is_text && !text_expect_line_end(data->reader)) return false;
    data->reader->mark = start;
    if (!visitor->end_row(visitor->user)) return false;
    if (is_text) text_skip_line(data->reader);
    return true;
}

/* More than the header promises means that the header is wrong, and the mesh is not what its author meant. */
static bool expect_file_end(ply_data *data) {
    file_reader *reader = data->reader;
    text_token token;
    if (data->header.encoding == PLY_ASCII) {
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

bool ply_data_open(ply_data *data, file_reader *reader) {
    *data = (ply_data){.reader = reader};
    bool opened = ply_header_read(reader, &data->header);
    reader->binary = opened && data->header.encoding != PLY_ASCII;
    return opened;
}

void ply_data_close(ply_data *data) {
    ply_header_free(&data->header);
}

bool ply_data_read(ply_data *data, const ply_visitor *visitor) {
    const ply_element *elements = data->header.elements.data;
    for (size_t i = 0; i < data->header.elements.count; i++) {
        data->element = elements + i;
        /* An element without properties takes no room, whatever its count. */
        if (data->element->property_count == 0) continue;
        for (data->row = 0; data->row < data->element->count; data->row++) {
            if (!read_row(data, visitor)) return false;
        }
    }
    return expect_file_end(data);
}

/* ---- the mesh ------------------------------------------------------------------------------------------ */

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

/* A number of a text is at the reader's mark, too. */
static bool read_coordinate(ply_parser *ply, const ply_property *property) {
    file_reader *reader = ply->data.reader;
    const ply_encoding encoding = ply->data.header.encoding;
    if (!ply_data_number(&ply->data, property, &ply->position[property->role])) return false;
    coordinate_place *place = &reader->coordinates[property->role];
    *place = (coordinate_place){COORDINATE_TEXT, reader->mark, reader->at - reader->mark};
    if (encoding == PLY_LITTLE_ENDIAN) place->form = COORDINATE_LITTLE;
    if (encoding == PLY_BIG_ENDIAN) place->form = COORDINATE_BIG;
    if (ply_type_is_integer(property->type)) place->form = COORDINATE_NOWHERE;
    return true;
}

static bool visit_property(void *user, const ply_property *property) {
    ply_parser *ply = user;
    switch (property->role) {
    case PLY_X:
    case PLY_Y:
    case PLY_Z:
        return read_coordinate(ply, property);
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

/* Parts are called by their number. A face is begun before its label is known if the label stands behind its
 * corners. */
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
