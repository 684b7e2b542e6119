/* Recorded animations for tests: point caches built byte by byte, mesh files, and checks of what is read. */
#include "tests/support/io/frame_fixture.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void frame_fixture_put_int(frame_fixture_bytes *bytes, size_t offset, int32_t value, bool big_endian) {
    assert_true(offset <= bytes->size && offset + 4 <= sizeof bytes->data);
    const uint32_t bits = (uint32_t)value;
    unsigned char *at = bytes->data + offset;
    at[big_endian ? 0 : 3] = (unsigned char)(bits >> 24);
    at[big_endian ? 1 : 2] = (unsigned char)(bits >> 16 & 255);
    at[big_endian ? 2 : 1] = (unsigned char)(bits >> 8 & 255);
    at[big_endian ? 3 : 0] = (unsigned char)(bits & 255);
    if (bytes->size < offset + 4) bytes->size = offset + 4;
}

void frame_fixture_put_float(frame_fixture_bytes *bytes, size_t offset, float value, bool big_endian) {
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    frame_fixture_put_int(bytes, offset, bits, big_endian);
}

double frame_fixture_value(uint32_t frame, uint32_t vertex, uint32_t axis) {
    return (double)frame * 64 - (double)vertex * 0.75 + (double)axis * 0.0625 - 3.5;
}

static void append_frames(frame_fixture_bytes *bytes, uint32_t vertex_count, uint32_t frame_count,
                          bool big_endian) {
    for (uint32_t frame = 0; frame < frame_count; frame++)
        for (uint32_t i = 0; i < vertex_count * 3; i++)
            frame_fixture_put_float(bytes, bytes->size, (float)frame_fixture_value(frame, i / 3, i % 3),
                                    big_endian);
}

frame_fixture_bytes frame_fixture_pc2(uint32_t vertex_count, uint32_t frame_count) {
    frame_fixture_bytes bytes = {.data = "POINTCACHE2", .size = 12};
    frame_fixture_put_int(&bytes, 12, 1, false);
    frame_fixture_put_int(&bytes, 16, (int32_t)vertex_count, false);
    frame_fixture_put_float(&bytes, 20, 1.0F, false);
    frame_fixture_put_float(&bytes, 24, 0.5F, false);
    frame_fixture_put_int(&bytes, 28, (int32_t)frame_count, false);
    append_frames(&bytes, vertex_count, frame_count, false);
    return bytes;
}

frame_fixture_bytes frame_fixture_mdd(uint32_t vertex_count, uint32_t frame_count) {
    frame_fixture_bytes bytes = {.size = 0};
    frame_fixture_put_int(&bytes, 0, (int32_t)frame_count, true);
    frame_fixture_put_int(&bytes, 4, (int32_t)vertex_count, true);
    for (uint32_t frame = 0; frame < frame_count; frame++)
        frame_fixture_put_float(&bytes, bytes.size, (float)frame / 24.0F, true);
    append_frames(&bytes, vertex_count, frame_count, true);
    return bytes;
}

temp_path frame_fixture_write(const temp_folder *folder, const char *name, const frame_fixture_bytes *bytes) {
    return temp_file_write(folder, name, bytes->data, bytes->size);
}

temp_path frame_fixture_write_mesh(const temp_folder *folder, const char *name, uint32_t vertex_count,
                                   uint32_t frame) {
    frame_fixture_bytes bytes = {.size = 0};
    for (uint32_t vertex = 0; vertex <= vertex_count; vertex++) {
        char line[100] = "f 1 2 3\n";
        if (vertex < vertex_count)
            snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", frame_fixture_value(frame, vertex, 0),
                     frame_fixture_value(frame, vertex, 1), frame_fixture_value(frame, vertex, 2));
        assert_true(bytes.size + strlen(line) < sizeof bytes.data);
        memcpy(bytes.data + bytes.size, line, strlen(line));
        bytes.size += strlen(line);
    }
    return frame_fixture_write(folder, name, &bytes);
}

animation *frame_fixture_open(const char *path, uint32_t vertex_count) {
    animation *opened = NULL;
    io_error error = {""};
    if (!animation_open(&path, 1, vertex_count, NULL, &opened, &error)) fail_msg("%s", error.text);
    assert_non_null(opened);
    return opened;
}

void frame_fixture_check(animation *opened, uint32_t vertex_count, uint32_t frame, uint32_t expected) {
    double *positions = malloc((size_t)vertex_count * 3 * sizeof *positions);
    assert_non_null(positions);
    io_error error = {""};
    if (!animation_read(opened, frame, positions, &error)) fail_msg("%s", error.text);
    for (uint32_t i = 0; i < vertex_count * 3; i++)
        if (positions[i] != frame_fixture_value(expected, i / 3, i % 3))
            fail_msg("frame %u, value %u: %g, expected %g", frame, i, positions[i],
                     frame_fixture_value(expected, i / 3, i % 3));
    free(positions);
}

void frame_fixture_check_error(const io_error *error, ...) {
    assert_true(error->text[0] != '\0');
    assert_null(strchr(error->text, '\n'));
    va_list parts;
    va_start(parts, error);
    for (const char *part = va_arg(parts, const char *); part != NULL; part = va_arg(parts, const char *))
        if (strstr(error->text, part) == NULL) fail_msg("\"%s\" lacks \"%s\"", error->text, part);
    va_end(parts);
}

void frame_fixture_open_fails(const char *path, uint32_t vertex_count, io_error *error) {
    animation *untouched = (animation *)(void *)error, *opened = untouched;
    error->text[0] = '\0';
    assert_false(animation_open(&path, 1, vertex_count, NULL, &opened, error));
    assert_ptr_equal(opened, untouched);
    frame_fixture_check_error(error, NULL);
    assert_false(animation_open(&path, 1, vertex_count, NULL, &opened, NULL));
}

void frame_fixture_read_fails(animation *opened, uint32_t vertex_count, uint32_t frame, io_error *error) {
    double *positions = malloc((size_t)vertex_count * 3 * sizeof *positions);
    assert_non_null(positions);
    error->text[0] = '\0';
    assert_false(animation_read(opened, frame, positions, error));
    frame_fixture_check_error(error, NULL);
    free(positions);
}
