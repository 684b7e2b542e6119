/* OFF (Object File Format) in text, with normals, colours or texture coordinates ignored. */
#include "src/io/off.h"

#include "src/io/mesh_builder.h"
#include "src/io/text.h"

#include <inttypes.h>
#include <string.h>

typedef struct off_counts {
    int64_t vertices, faces;
} off_counts;

static bool starts_with(text_token token, size_t at, const char *word) {
    size_t length = strlen(word);
    return token.length >= at + length && memcmp(token.text + at, word, length) == 0;
}

/* [ST][C][N][4][n]OFF, with the first count behind it or, in some widely used files, glued to it. Returns the
 * keyword's length, 0 when it is none; dimension_flag is the 4 or n that changes what a vertex is, else 0. */
static size_t keyword_length(text_token token, char *dimension_flag) {
    static const char *const prefixes[] = {"ST", "C", "N", "4", "n"};
    size_t at = 0;
    *dimension_flag = '\0';
    for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++) {
        if (!starts_with(token, at, prefixes[i])) continue;
        at += strlen(prefixes[i]);
        if (i >= 3) *dimension_flag = *prefixes[i];
    }
    if (!starts_with(token, at, "OFF")) return 0;
    at += strlen("OFF");
    bool ends = at == token.length || (token.text[at] >= '0' && token.text[at] <= '9');
    return ends ? at : 0;
}

bool off_recognise(const file_reader *reader) {
    file_reader probe = *reader;
    text_token token;
    char dimension_flag;
    probe.comments = true;
    return text_seek_token(&probe) && text_next_token(&probe, &token) &&
           keyword_length(token, &dimension_flag) > 0;
}

/* Every OFF keyword leaves x y z the first three numbers of a vertex's line, except those refused here. */
static bool read_keyword(file_reader *reader) {
    text_token token;
    char dimension_flag;
    if (!text_seek_token(reader) || !text_next_token(reader, &token)) return true;
    size_t length = keyword_length(token, &dimension_flag);
    reader->at -= token.length - length;
    if (dimension_flag != '\0' && length > 0) {
        return file_reader_fail_here(
            reader, "found '%s', expected vertices of three dimensions: OFF, COFF, NOFF or STOFF",
            text_show(token).text);
    }
    file_reader probe = *reader;
    if (text_next_token(&probe, &token) && text_equals(token, "BINARY")) {
        return file_reader_fail_here(reader, "found binary OFF, expected text");
    }
    return true;
}

static bool check_count(file_reader *reader, const char *what, int64_t count) {
    if (count >= 0 && count <= MESH_COUNT_LIMIT) return true;
    return file_reader_fail_here(reader, "the number of %s is %" PRId64 ", expected 0 to %" PRId32, what,
                                 count, MESH_COUNT_LIMIT);
}

/* Reads the counts of vertices and faces and, if it is given, that of edges, which is not needed. */
static bool read_counts(file_reader *reader, off_counts *counts) {
    text_seek_token(reader);
    if (!text_integer(reader, "the number of vertices", &counts->vertices) ||
        !check_count(reader, "vertices", counts->vertices) ||
        !text_integer(reader, "the number of faces", &counts->faces) ||
        !check_count(reader, "faces", counts->faces)) {
        return false;
    }
    text_token token;
    int64_t edges;
    if (text_next_token(reader, &token) && !text_parse_integer(token, &edges)) {
        return file_reader_fail_here(reader, "found '%s', expected the number of edges",
                                     text_show(token).text);
    }
    if (!text_expect_line_end(reader)) return false;
    text_skip_line(reader);
    return true;
}

static bool seek_row(file_reader *reader, const char *what, int64_t row, int64_t count) {
    return text_seek_token(reader) ||
           file_reader_fail_here(reader, "file ends before %s %" PRId64 " of %" PRId64, what, row + 1, count);
}

static bool read_vertices(file_reader *reader, int64_t count, mesh_builder *builder) {
    static const char *const names[3] = {"coordinate x of a vertex", "coordinate y of a vertex",
                                         "coordinate z of a vertex"};
    for (int64_t row = 0; row < count; row++) {
        double position[3];
        if (!seek_row(reader, "vertex", row, count)) return false;
        for (int axis = 0; axis < 3; axis++) {
            if (!text_number(reader, names[axis], &position[axis])) return false;
        }
        if (!mesh_builder_add_vertex(builder, position)) return false;
        text_skip_line(reader);
    }
    return true;
}

static bool read_face(file_reader *reader, int64_t vertex_count, mesh_builder *builder) {
    int64_t corner_count, index;
    if (!text_integer(reader, "the number of corners of a face", &corner_count)) return false;
    if (corner_count < 0) {
        return file_reader_fail_here(reader, "a face of %" PRId64 " corners, expected 3 or more",
                                     corner_count);
    }
    mesh_builder_begin_face(builder);
    for (int64_t corner = 0; corner < corner_count; corner++) {
        if (!text_integer(reader, "a vertex index of the face", &index)) return false;
        if (index < 0 || index >= vertex_count) {
            return file_reader_fail_here(
                reader, "face index %" PRId64 " is out of range, the file has %" PRId64 " vertices, from 0",
                index, vertex_count);
        }
        if (!mesh_builder_add_corner(builder, (uint32_t)index)) return false;
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

bool off_read(file_reader *reader, mesh_file *out) {
    reader->comments = true;
    mesh_builder builder = mesh_builder_of(reader, 0);
    off_counts counts = {0};
    bool done = read_keyword(reader) && read_counts(reader, &counts) &&
                read_vertices(reader, counts.vertices, &builder) && read_faces(reader, &counts, &builder) &&
                expect_file_end(reader) && mesh_builder_finish(&builder, out);
    mesh_builder_free(&builder);
    return done;
}
