/* STL (stereolithography), binary and as text: triangles that each bring their own three vertices. */
#include "tool/io/format_reader.h"

#include "tool/io/file_reader.h"
#include "tool/io/mesh_builder.h"

#include <inttypes.h>
#include <string.h>
#include <strings.h>

/* A binary file: a header of any content, the number of triangles, and for each a normal, three vertices (12
 * floats) and two bytes of attributes, all little endian. */
enum { HEADER_SIZE = 80, COUNT_SIZE = 4, NORMAL_SIZE = 12, ATTRIBUTE_SIZE = 2, TRIANGLE_SIZE = 50 };

static uint32_t load_word(const char *bytes) {
    const unsigned char *b = (const unsigned char *)bytes;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static bool has_binary_start(const file_reader *reader) {
    return reader->size >= HEADER_SIZE + COUNT_SIZE;
}

static uint64_t binary_size(const file_reader *reader) {
    return HEADER_SIZE + COUNT_SIZE + (uint64_t)TRIANGLE_SIZE * load_word(reader->bytes + HEADER_SIZE);
}

/* Keywords may be in upper or lower case. */
static bool is_keyword(text_token token, const char *word) {
    return token.length == strlen(word) && strncasecmp(token.text, word, token.length) == 0;
}

/* The size decides: the header of a binary file may begin with "solid" as a text does. Files that are not as
 * long as they say are binary if they hold a zero, or do not begin as a text. */
static bool is_binary(const file_reader *reader) {
    file_reader probe = *reader;
    text_token token;
    if (has_binary_start(reader) && binary_size(reader) == reader->size) return true;
    if (!text_seek_token(&probe) || !text_next_token(&probe, &token)) return false;
    const size_t start = HEADER_SIZE + COUNT_SIZE < reader->size ? HEADER_SIZE + COUNT_SIZE : reader->size;
    return memchr(reader->bytes, 0, start) != NULL ||
           (has_binary_start(reader) && !is_keyword(token, "solid") && !is_keyword(token, "facet"));
}

/* The size is that of a binary file, or the text begins with "solid" and goes on with a facet. */
static bool recognise_stl(const file_reader *reader) {
    file_reader probe = *reader;
    text_token token;
    if (has_binary_start(reader) && reader->size > HEADER_SIZE + COUNT_SIZE &&
        binary_size(reader) == reader->size)
        return true;
    if (!text_seek_token(&probe) || !text_next_token(&probe, &token) || !is_keyword(token, "solid"))
        return false;
    text_skip_line(&probe);
    return text_seek_token(&probe) && text_next_token(&probe, &token) && is_keyword(token, "facet");
}

/* ---- binary ------------------------------------------------------------------------------------------ */

/* Notes where three numbers stand. */
static bool note_normal(file_reader *reader, const coordinate_place places[3]) {
    if (reader->normal_places == NULL) return true;
    void *normal = growable_push(reader->normal_places);
    if (normal == NULL) return file_reader_fail_here(reader, "out of memory for normals");
    memcpy(normal, places, 3 * sizeof *places);
    return true;
}

static bool pass_binary_normal(file_reader *reader) {
    coordinate_place places[3];
    for (size_t axis = 0; axis < 3; axis++)
        places[axis] =
            (coordinate_place){COORDINATE_LITTLE, reader->at + axis * sizeof(float), sizeof(float)};
    reader->at += NORMAL_SIZE;
    return note_normal(reader, places);
}

static bool read_binary_triangle(file_reader *reader, mesh_builder *builder) {
    if (!pass_binary_normal(reader)) return false;
    if (!mesh_builder_begin_face(builder)) return false;
    for (int corner = 0; corner < 3; corner++) {
        double position[3];
        const uint32_t vertex = (uint32_t)builder->positions.count;
        reader->mark = reader->at;
        for (int axis = 0; axis < 3; axis++) {
            const uint32_t bits = load_word(reader->bytes + reader->at);
            float value;
            memcpy(&value, &bits, sizeof value);
            position[axis] = (double)value;
            reader->coordinates[axis] = (coordinate_place){COORDINATE_LITTLE, reader->at, sizeof value};
            reader->at += sizeof value;
        }
        if (!mesh_builder_add_vertex(builder, position) || !mesh_builder_add_corner(builder, vertex))
            return false;
    }
    reader->at += ATTRIBUTE_SIZE; /* a colour in some programs */
    return mesh_builder_end_face(builder);
}

/* More than the header promises means that the header is wrong, and the mesh is not what its author meant. */
static bool expect_binary_end(file_reader *reader) {
    for (size_t i = reader->at; i < reader->size; i++) {
        const char c = reader->bytes[i];
        if (c == '\0' || c == ' ' || c == '\n' || c == '\r') continue; /* padding */
        reader->mark = reader->at;
        return file_reader_fail_here(reader,
                                     "%zu bytes follow the last triangle, expected the end of the file",
                                     reader->size - reader->at);
    }
    return true;
}

static bool read_binary(file_reader *reader, mesh_builder *builder) {
    reader->binary = true;
    if (!has_binary_start(reader)) {
        reader->mark = reader->size;
        return file_reader_fail_here(reader,
                                     "file ends in the header, expected %d bytes of a binary STL file",
                                     HEADER_SIZE + COUNT_SIZE);
    }
    const uint32_t count = load_word(reader->bytes + HEADER_SIZE);
    reader->at = HEADER_SIZE + COUNT_SIZE;
    for (uint32_t i = 0; i < count; i++) {
        if (reader->size - reader->at < TRIANGLE_SIZE) {
            reader->mark = reader->size;
            return file_reader_fail_here(reader, "file ends inside triangle %" PRIu32 " of %" PRIu32, i + 1,
                                         count);
        }
        if (!read_binary_triangle(reader, builder)) return false;
    }
    return expect_binary_end(reader);
}

/* ---- text -------------------------------------------------------------------------------------------- */

/* Takes the next word of the file, which may be several lines on. At the end it is empty. */
static text_token take_word(file_reader *reader) {
    text_token token = {reader->bytes + reader->size, 0};
    if (text_seek_token(reader)) text_next_token(reader, &token);
    return token;
}

static bool fail_word(file_reader *reader, text_token token, const char *expected) {
    if (token.length == 0) return file_reader_fail_here(reader, "the file ends, expected %s", expected);
    return file_reader_fail_here(reader, "found '%s', expected %s", text_show(token).text, expected);
}

static bool expect_word(file_reader *reader, const char *word) {
    const text_token token = take_word(reader);
    return is_keyword(token, word) || fail_word(reader, token, word);
}

static bool read_text_vertex(file_reader *reader, mesh_builder *builder) {
    static const char *const names[3] = {"coordinate x of the vertex", "coordinate y of the vertex",
                                         "coordinate z of the vertex"};
    double position[3];
    const uint32_t vertex = (uint32_t)builder->positions.count;
    for (int axis = 0; axis < 3; axis++) {
        text_seek_token(reader);
        if (!text_coordinate(reader, axis, names[axis], &position[axis])) return false;
    }
    return mesh_builder_add_vertex(builder, position) && mesh_builder_add_corner(builder, vertex);
}

/* The normal is skipped: it follows from the vertices, and is often wrong or missing. */
static bool skip_normal(file_reader *reader) {
    text_token token = take_word(reader);
    coordinate_place places[3];
    const bool has_normal = is_keyword(token, "normal");
    for (int axis = 0; axis < 3 && has_normal; axis++) {
        token = take_word(reader);
        places[axis] = (coordinate_place){COORDINATE_TEXT, reader->mark, token.length};
    }
    if (has_normal) token = take_word(reader);
    if (!is_keyword(token, "outer")) return fail_word(reader, token, "outer loop");
    return !has_normal || note_normal(reader, places);
}

/* Reads a facet behind its first word. */
static bool read_text_facet(file_reader *reader, mesh_builder *builder) {
    if (!mesh_builder_begin_face(builder)) return false;
    if (!skip_normal(reader) || !expect_word(reader, "loop")) return false;
    text_token token;
    for (token = take_word(reader); is_keyword(token, "vertex"); token = take_word(reader))
        if (!read_text_vertex(reader, builder)) return false;
    if (!is_keyword(token, "endloop")) return fail_word(reader, token, "vertex or endloop");
    return mesh_builder_end_face(builder) && expect_word(reader, "endfacet");
}

/* Reads a solid behind its name. */
static bool read_text_solid(file_reader *reader, mesh_builder *builder) {
    text_token token;
    for (token = take_word(reader); is_keyword(token, "facet"); token = take_word(reader))
        if (!read_text_facet(reader, builder)) return false;
    if (!is_keyword(token, "endsolid")) return fail_word(reader, token, "facet or endsolid");
    text_skip_line(reader); /* the name again */
    return true;
}

/* A name is the rest of the line, without the blanks around it. */
static bool read_solid_name(file_reader *reader, mesh_builder *builder) {
    text_token word, name = {"", 0};
    while (text_next_token(reader, &word)) {
        if (name.length == 0) name = word;
        name.length = (size_t)(word.text + word.length - name.text);
    }
    text_skip_line(reader);
    return mesh_builder_set_part(builder, name.text, name.length);
}

/* Several solids are parts. One alone is none: exporters write their own name there. */
static bool read_text(file_reader *reader, mesh_builder *builder) {
    text_token token = take_word(reader);
    uint32_t solid_count = 0;
    do {
        if (!is_keyword(token, "solid")) return fail_word(reader, token, "solid");
        if (!read_solid_name(reader, builder) || !read_text_solid(reader, builder)) return false;
        token = take_word(reader);
        solid_count++;
    } while (token.length > 0);
    if (solid_count == 1) mesh_parts_free(&builder->parts);
    return true;
}

static bool read_stl(file_reader *reader, mesh_file *out) {
    mesh_builder builder = mesh_builder_of(reader, 0);
    const bool done = (is_binary(reader) ? read_binary(reader, &builder) : read_text(reader, &builder)) &&
                      mesh_builder_finish(&builder, out);
    mesh_builder_free(&builder);
    return done;
}

const format_reader stl_reader = {MESH_FORMAT_STL, .by_ending = true, .recognise = recognise_stl,
                                  .read = read_stl};
