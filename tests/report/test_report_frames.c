/* The frames of a report: decoded positions are near the given ones, and the stated error is the error
 * made. */
#include "src/io/growable.h"
#include "src/tool/report/frame_stream.h"
#include "tests/support/io_allocations.h"
#include "tests/support/random.h"
#include "tests/support/report/page_reader.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERTICES = 50, FRAMES = 24, VALUES = VERTICES * 3 };

/* A recording that a function computes. */
typedef struct frame_motion {
    const char *name;
    void (*place)(uint32_t frame, double *positions);
    uint32_t vertex_count, keys_max;
    double scale;
} frame_motion;

/* Computes a point of the body, which is the same in every frame. */
static void body_point(uint32_t vertex, double out[3]) {
    random_seed(vertex + 1);
    for (int k = 0; k < 3; k++) out[k] = random_unit();
}

/* Places the body: its coordinates times size, plus centre. */
static void place_body(double *positions, const double size[3], const double centre[3]) {
    for (uint32_t v = 0; v < VERTICES; v++) {
        double point[3];
        body_point(v, point);
        for (int k = 0; k < 3; k++) positions[v * 3 + (uint32_t)k] = centre[k] + size[k] * point[k];
    }
}

static void place_vertices(double *positions, double size, double x) {
    place_body(positions, (double[]){size, size, size}, (double[]){x, -x / 2.0, 0.0});
}

static void still_motion(uint32_t frame, double *positions) {
    (void)frame;
    place_vertices(positions, 1.0, 0.0);
}

static void wobbling_motion(uint32_t frame, double *positions) {
    place_body(positions, (double[]){1.0 + 0.1 * sin(frame), 1.0, 2.0}, (double[]){0.0, 0.01 * frame, 0.0});
}

static void flying_far(uint32_t frame, double *positions) {
    place_vertices(positions, 1.0, pow(10.0, frame % 12));
}

static void shrinking_motion(uint32_t frame, double *positions) {
    place_vertices(positions, pow(10.0, -1.0 * frame), 0.0);
}

static void exploding_motion(uint32_t frame, double *positions) {
    place_vertices(positions, pow(10.0, frame), 3.0);
}

/* The body grows so slowly at first that the first grid becomes very fine. */
static void swelling_motion(uint32_t frame, double *positions) {
    place_vertices(positions, pow(1.7, frame), 0.0);
}

static void from_a_point(uint32_t frame, double *positions) {
    place_vertices(positions, frame < 3 || frame == 10 ? 0.0 : 1.0, 5.0);
}

static void flat_motion(uint32_t frame, double *positions) {
    place_body(positions, (double[]){1.0, 0.0, 1e-9}, (double[]){frame, frame, 1e9});
}

static void one_vertex(uint32_t frame, double *positions) {
    for (int k = 0; k < 3; k++) positions[k] = frame * 1.1 + k;
}

static void huge_motion(uint32_t frame, double *positions) {
    place_vertices(positions, 0x1p299, frame * 0x1p298);
}

static void huge_with_zeros(uint32_t frame, double *positions) {
    place_vertices(positions, 0x1p298, 0.0);
    for (uint32_t v = 0; v < VERTICES; v += 2) memset(positions + v * 3, 0, sizeof(double[3]));
    positions[4] = frame * 0x1p-300;
}

static void tiny_motion(uint32_t frame, double *positions) {
    place_vertices(positions, 0x1p-250, frame * 0x1p-260);
}

static void coarse_doubles(uint32_t frame, double *positions) {
    place_vertices(positions, 4.0, 0x1p52 + frame);
    for (uint32_t i = 0; i < VALUES; i++) positions[i] = rint(positions[i]);
}

static void jumping_motion(uint32_t frame, double *positions) {
    place_vertices(positions, 1.0, frame % 2 == 0 ? 16000.0 : -16000.0);
}

/* The motion exceeds everything that a page can show; the stated error is still true. */
static void bursting_motion(uint32_t frame, double *positions) {
    place_vertices(positions, frame < 5 ? 1.0 : frame % 2 == 0 ? 1e80 : 1e-60, 0.0);
    if (frame == 20) place_vertices(positions, 0.0, 1e80);
}

static const frame_motion bursts = {"bursting", bursting_motion, VERTICES, FRAMES, 1.0};

static const frame_motion motions[] = {
    {"still", still_motion, VERTICES, 1, 1.0},
    {"wobbling", wobbling_motion, VERTICES, 1, 1.0},
    {"flying far", flying_far, VERTICES, FRAMES, 1.0},
    {"shrinking", shrinking_motion, VERTICES, FRAMES, 1.0},
    {"exploding", exploding_motion, VERTICES, 8, 1.0},
    {"swelling", swelling_motion, VERTICES, 2, 1.0},
    {"from a point", from_a_point, VERTICES, 6, 1.0},
    {"flat", flat_motion, VERTICES, 1, 1.0},
    {"one vertex", one_vertex, 1, FRAMES, 1.0},
    {"huge", huge_motion, VERTICES, 1, 0x1p-300},
    {"huge with zeros", huge_with_zeros, VERTICES, 1, 0x1p-298},
    {"tiny", tiny_motion, VERTICES, 1, 0x1p250},
    {"coarse doubles", coarse_doubles, VERTICES, 1, 1.0},
    {"jumping", jumping_motion, VERTICES, 2, 1.0},
};

/* Returns the stream's bytes in the form in which a page has them. */
static page_bytes bytes_of(frame_stream *stream) {
    char *text = NULL;
    size_t size;
    FILE *memory = open_memstream(&text, &size);
    assert_true(packed_array_finish(stream->bytes) && packed_array_write(stream->bytes, memory));
    fclose(memory);
    page_bytes bytes = page_unpack(text, size);
    assert_int_equal(bytes.size, packed_array_size(stream->bytes));
    free(text);
    return bytes;
}

/* Computes the largest error of a coordinate, and the longest side. */
static void compare_positions(const double *shown, const double *given, const frame_motion *m, double *error,
                              double *side) {
    *error = *side = 0.0;
    for (uint32_t k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = k; i < m->vertex_count * 3; i += 3) {
            low = fmin(low, given[i]);
            high = fmax(high, given[i]);
            *error = fmax(*error, fabs(shown[i] / m->scale - given[i]));
        }
        *side = fmax(*side, high - low);
    }
}

/* Checks that the error stays below relative_max, a share of the longest side. */
static void check_motion(const frame_motion *m, double relative_max) {
    frame_stream stream;
    double given[VALUES], *shown;
    uint32_t keys;
    assert_true(frame_stream_create(m->vertex_count, m->scale, &stream));
    for (uint32_t f = 0; f < FRAMES; f++) {
        m->place(f, given);
        assert_true(frame_stream_add(&stream, given));
    }
    page_bytes bytes = bytes_of(&stream);
    shown = page_frames(bytes, m->vertex_count, FRAMES, &keys);
    double max_error = 0.0, relative_error = 0.0, error, side;
    for (uint32_t f = 0; f < FRAMES; f++) {
        m->place(f, given);
        compare_positions(shown + (size_t)f * m->vertex_count * 3, given, m, &error, &side);
        max_error = fmax(max_error, error);
        if (error > 0.0) relative_error = fmax(relative_error, side > 0.0 ? error / side : 1.0);
    }
    if (stream.max_error != max_error || stream.relative_error != relative_error)
        fail_msg("%s: the error is %g (%g), stated is %g (%g)", m->name, max_error, relative_error,
                 stream.max_error, stream.relative_error);
    if (!(relative_error < relative_max)) fail_msg("%s: a relative error of %g", m->name, relative_error);
    if (keys > m->keys_max) fail_msg("%s: %u grids, expected %u", m->name, keys, m->keys_max);
    free(shown);
    free(bytes.data);
    frame_stream_free(&stream);
}

TEST(motions_come_back) {
    for (size_t i = 0; i < sizeof motions / sizeof *motions; i++) check_motion(&motions[i], 2e-5);
}

TEST(what_cannot_be_shown_is_told) {
    check_motion(&bursts, 1.1);
}

/* A mesh that stands still costs next to nothing. */
TEST(still_frames_are_small) {
    frame_stream stream;
    double given[VALUES];
    char *text = NULL;
    size_t size;
    still_motion(0, given);
    assert_true(frame_stream_create(VERTICES, 1.0, &stream));
    for (int f = 0; f < 1000; f++) assert_true(frame_stream_add(&stream, given));
    FILE *memory = open_memstream(&text, &size);
    assert_true(packed_array_finish(stream.bytes) && packed_array_write(stream.bytes, memory));
    fclose(memory);
    assert_true(size < 3 * VALUES + 2000);
    free(text);
    frame_stream_free(&stream);
}

/* Tests arrays of every length modulo three that are longer than a buffer. */
TEST(bytes_come_back) {
    for (size_t size = 0; size < 20000; size = size * 3 / 2 + 1) {
        uint8_t *given = malloc(size + 1);
        random_seed(size);
        for (size_t i = 0; i < size; i++) given[i] = (uint8_t)random_bits();
        frame_stream holder = {.bytes = packed_array_create()};
        assert_true(packed_array_add_bytes(holder.bytes, given, size));
        page_bytes bytes = bytes_of(&holder);
        assert_int_equal(bytes.size, size);
        assert_memory_equal(bytes.data, given, size);
        free(bytes.data);
        free(given);
        frame_stream_free(&holder);
    }
}

TEST(memory_that_runs_out_is_told) {
    double given[VALUES];
    still_motion(0, given);
    int failures = 0;
    for (; io_allocations_go_on(failures); failures++) {
        frame_stream stream = {0};
        const bool done = frame_stream_create(VERTICES, 1.0, &stream) && frame_stream_add(&stream, given) &&
                          packed_array_finish(stream.bytes);
        io_allocations_left = -1;
        assert_int_equal(done, !io_allocation_failed);
        frame_stream_free(&stream);
    }
    assert_true(failures > 6);
}
