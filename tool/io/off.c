/* OFF (Object File Format) in text, with normals, colours or texture coordinates ignored. */
#include "tool/io/format_reader.h"

#include "tool/io/file_reader.h"
#include "tool/io/mesh_builder.h"

#include <inttypes.h>
#include <string.h>

/* The properties of a vertex, as the keyword and the line of a dimension say them. */
typedef struct off_kind {
    bool homogeneous; /* 4: a last coordinate divides the others */
    bool dimensioned; /* n: the number of dimensions stands behind the keyword */
} off_kind;

typedef struct off_counts {
    int64_t vertices, faces;
} off_counts;

static bool starts_with(text_token token, size_t at, const char *word) {
    size_t length = strlen(word);
    return token.length >= at + length && memcmp(token.text + at, word, length) == 0;
}

/* Finds which of the letters in front of OFF stands here: texture coordinates, colour, normal, 4 or n; NULL:
 * none. */
static const char *prefix_at(text_token token, size_t at) {
    static const char *const prefixes[] = {"ST", "C", "N", "4", "n"};
    for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++)
        if (starts_with(token, at, prefixes[i])) return prefixes[i];
    return NULL;
}

/* [ST][C][N][4][n]OFF, in any order, with the first count behind it or, in some widely used files, glued to
 * it. Returns the keyword's length, 0 when it is none. */
static size_t keyword_length(text_token token, off_kind *kind) {
    off_kind found = {0};
    size_t at = 0;
    for (const char *prefix; (prefix = prefix_at(token, at)) != NULL; at += strlen(prefix)) {
        found.homogeneous = found.homogeneous || *prefix == '4';
        found.dimensioned = found.dimensioned || *prefix == 'n';
    }
    if (!starts_with(token, at, "OFF") && !text_equals(token, "off")) return 0;
    at += strlen("OFF");
    if (at < token.length && !(token.text[at] >= '0' && token.text[at] <= '9')) return 0;
    *kind = found;
    return at;
}

/* The first word of the file is one of the keywords. */
static bool recognise_off(const file_reader *reader) {
    file_reader probe = *reader;
    text_token token;
    off_kind kind;
    probe.comments = true;
    return text_seek_token(&probe) && text_next_token(&probe, &token) && keyword_length(token, &kind) > 0;
}

/* Only vertices in space can be read. */
static bool read_dimension(file_reader *reader) {
    int64_t dimension;
    text_seek_token(reader);
    if (!text_integer(reader, "the number of dimensions", &dimension)) return false;
    return dimension == 3 ||
           file_reader_fail_here(reader, "vertices of %" PRId64 " dimensions, expected 3", dimension);
}

static bool read_keyword(file_reader *reader, off_kind *kind) {
    text_token token;
    if (!text_seek_token(reader) || !text_next_token(reader, &token)) return true;
    reader->at -= token.length - keyword_length(token, kind);
    file_reader probe = *reader;
    if (text_next_token(&probe, &token) && text_equals(token, "BINARY")) {
        return file_reader_fail_here(reader, "found binary OFF, expected text");
    }
    return !kind->dimensioned || read_dimension(reader);
}

static bool check_count(file_reader *reader, const char *what, int64_t count) {
    if (count >= 0 && count <= MESH_COUNT_LIMIT) return true;
    return file_reader_fail_here(reader, "the number of %s is %" PRId64 ", expected 0 to %" PRId32, what,
                                 count, MESH_COUNT_LIMIT);
}

/* The number of edges is not needed, and may be missing. It may have a line of its own, which then has one
 * number, while a vertex has three. */
static bool skip_edge_count(file_reader *reader) {
    text_token token;
    int64_t edges;
    file_reader next = *reader;
    if (!text_next_token(&next, &token)) {
        if (!text_seek_token(&next) || !text_next_token(&next, &token)) return true;
        const bool alone = text_parse_integer(token, &edges) && !text_next_token(&next, &token);
        if (alone) *reader = next;
        return true;
    }
    *reader = next;
    return text_parse_integer(token, &edges) ||
           file_reader_fail_here(reader, "found '%s', expected the number of edges", text_show(token).text);
}

/* Reads the counts of vertices, faces and edges. */
static bool read_counts(file_reader *reader, off_counts *counts) {
    text_seek_token(reader);
    if (!text_integer(reader, "the number of vertices", &counts->vertices) ||
        !check_count(reader, "vertices", counts->vertices)) {
        return false;
    }
    text_seek_token(reader);
    if (!text_integer(reader, "the number of faces", &counts->faces) ||
        !check_count(reader, "faces", counts->faces)) {
        return false;
    }
    if (!skip_edge_count(reader) || !text_expect_line_end(reader)) return false;
    text_skip_line(reader);
    return true;
}

static bool seek_row(file_reader *reader, const char *what, int64_t row, int64_t count) {
    return text_seek_token(reader) ||
           file_reader_fail_here(reader, "file ends before %s %" PRId64 " of %" PRId64, what, row + 1, count);
}

/* The rest of a line is a normal, a colour or texture coordinates. */
static bool read_vertex(file_reader *reader, off_kind kind, double position[3]) {
    static const char *const names[3] = {"coordinate x of a vertex", "coordinate y of a vertex",
                                         "coordinate z of a vertex"};
    double divisor;
    for (int axis = 0; axis < 3; axis++) {
        if (!text_coordinate(reader, axis, names[axis], &position[axis])) return false;
    }
    if (!kind.homogeneous) return true;
    if (!text_number(reader, "the fourth coordinate of a vertex", &divisor)) return false;
    for (int axis = 0; axis < 3 && divisor != 1; axis++) {
        position[axis] /= divisor;
        reader->coordinates[axis].form = COORDINATE_NOWHERE;
    }
    return true;
}

static bool read_vertices(file_reader *reader, off_kind kind, int64_t count, mesh_builder *builder) {
    for (int64_t row = 0; row < count; row++) {
        double position[3];
        if (!seek_row(reader, "vertex", row, count) || !read_vertex(reader, kind, position) ||
            !mesh_builder_add_vertex(builder, position)) {
            return false;
        }
        text_skip_line(reader);
    }
    return true;
}

/* A face's indices may go on in further lines. A line that is too short takes from the next one then, and the
 * file ends too early, so it is noticed all the same. */
static bool read_index(file_reader *reader, int64_t vertex_count, int64_t *index) {
    text_seek_token(reader);
    if (!text_integer(reader, "a vertex index of the face", index)) return false;
    return (*index >= 0 && *index < vertex_count) ||
           file_reader_fail_here(
               reader, "face index %" PRId64 " is out of range, the file has %" PRId64 " vertices, from 0",
               *index, vertex_count);
}

static bool read_face(file_reader *reader, int64_t vertex_count, mesh_builder *builder) {
    int64_t corner_count, index;
    if (!text_integer(reader, "the number of corners of a face", &corner_count)) return false;
    if (corner_count < 0) {
        return file_reader_fail_here(reader, "a face of %" PRId64 " corners, expected 3 or more",
                                     corner_count);
    }
    if (!mesh_builder_begin_face(builder)) return false;
    for (int64_t corner = 0; corner < corner_count; corner++) {
        if (!read_index(reader, vertex_count, &index) || !mesh_builder_add_corner(builder, (uint32_t)index))
            return false;
    }
    return mesh_builder_end_face(builder);
}

static bool read_faces(file_reader *reader, const off_counts *counts, mesh_builder *builder) {
    for (int64_t row = 0; row < counts->faces; row++) {
        if (!seek_row(reader, "face", row, counts->faces)) return false;
        if (!read_face(reader, counts->vertices, builder)) return false;
        text_skip_line(reader); /* a colour may follow */
    }
    return true;
}

/* More than the counts promise means that the counts are wrong, and the mesh is not what its author meant. */
static bool expect_file_end(file_reader *reader) {
    text_token token;
    if (!text_seek_token(reader)) return true;
    text_next_token(reader, &token);
    return file_reader_fail_here(reader, "found '%s' after the last face, expected the end of the file",
                                 text_show(token).text);
}

static bool read_off(file_reader *reader, mesh_file *out) {
    reader->comments = true;
    mesh_builder builder = mesh_builder_of(reader, 0);
    off_kind kind = {0};
    off_counts counts = {0};
    bool done = read_keyword(reader, &kind) && read_counts(reader, &counts) &&
                read_vertices(reader, kind, counts.vertices, &builder) &&
                read_faces(reader, &counts, &builder) && expect_file_end(reader) &&
                mesh_builder_finish(&builder, out);
    mesh_builder_free(&builder);
    return done;
}

const format_reader off_reader = {MESH_FORMAT_OFF, .by_ending = true, .recognise = recognise_off,
                                  .read = read_off};
