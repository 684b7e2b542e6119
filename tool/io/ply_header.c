/* The header of a PLY file: its encoding, elements and properties. */
#include "tool/io/ply_header.h"

#include "tool/io/mesh_builder.h"

#include <inttypes.h>

typedef struct header_parser {
    file_reader *reader;
    ply_header *header;
    bool has_format;
} header_parser;

size_t ply_type_size(ply_type type) {
    static const size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[type];
}

bool ply_type_is_integer(ply_type type) {
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

bool ply_header_read(file_reader *reader, ply_header *header) {
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

void ply_header_free(ply_header *header) {
    growable_free(&header->elements);
    growable_free(&header->properties);
}
