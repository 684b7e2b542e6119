/* Animations of glTF files: which frames there are, and where vertices are in them, with numbers by hand. */
#include "src/io/animation.h"
#include "tests/support/io/gltf_animations.h"
#include "tests/support/temp_file.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- a triangle that one channel moves --------------------------------------------------------------- */

enum { VERTICES = 3 };

/* A file in a folder, and its frames. */
typedef struct open_file {
    temp_folder folder;
    temp_path path;
    animation *frames;
} open_file;

static open_file open_bytes(file_bytes file, double fps, const char *name) {
    open_file opened = {.folder = temp_folder_make()};
    opened.path = temp_file_write(&opened.folder, file.name, file.bytes, file.size);
    const char *path = opened.path.text;
    const animation_options options = {.fps = fps, .animation_name = name};
    io_error error;
    if (!animation_open(&path, 1, VERTICES, &options, &opened.frames, &error)) fail_msg("%s", error.text);
    return opened;
}

static void close_file(open_file *opened) {
    animation_close(opened->frames);
    temp_folder_remove(&opened->folder);
}

static void check_near(const open_file *opened, uint32_t frame, const double *expected, double tolerance) {
    double positions[3 * VERTICES];
    io_error error;
    if (!animation_read(opened->frames, frame, positions, &error)) fail_msg("%s", error.text);
    for (int i = 0; i < 3 * VERTICES; i++)
        if (!(fabs(positions[i] - expected[i]) <= tolerance))
            fail_msg("frame %u, number %d: %.17g, expected %.17g", frame, i, positions[i], expected[i]);
}

static void check_frame(const open_file *opened, uint32_t frame, const double *expected) {
    check_near(opened, frame, expected, 2e-15);
}

static open_file open_channel(gltf_channel_keys keys, double fps) {
    gltf_fixture fixture;
    return open_bytes(gltf_animations_channel(&fixture, keys), fps, NULL);
}

/* The triangle moved by x. */
static void check_moved(const open_file *opened, uint32_t frame, double x, double y, double z) {
    double expected[9];
    for (int i = 0; i < 9; i++)
        expected[i] = gltf_animations_triangle[i] + (i % 3 == 0 ? x : i % 3 == 1 ? y : z);
    check_frame(opened, frame, expected);
}

TEST(moves_along_lines) {
    static const double times[] = {0, 1, 3}, values[] = {0, 0, 0, 2, 4, 6, 2, 0, 6};
    open_file opened =
        open_channel((gltf_channel_keys){"translation", "LINEAR", "VEC3", 3, 9, times, values}, 4);
    assert_int_equal(animation_frame_count(opened.frames), 13);
    for (uint32_t i = 0; i <= 4; i++) check_moved(&opened, i, 0.5 * i, i, 1.5 * i);
    for (uint32_t i = 4; i <= 12; i++) check_moved(&opened, i, 2, 4 - 0.5 * (i - 4), 6);
    close_file(&opened);
}

/* Half of a tangent is the slope there: by the polynomials of the format, 0.25 + 1 - 0.75 at the middle. */
TEST(moves_along_splines) {
    static const double times[] = {1, 3};
    static const double values[] = {9, 9, 9, 0, 1, 5, 1, 0, 0, 3, 0, 0, 2, 1, 5, 9, 9, 9};
    open_file opened =
        open_channel((gltf_channel_keys){"translation", "CUBICSPLINE", "VEC3", 2, 18, times, values}, 2);
    assert_int_equal(animation_frame_count(opened.frames), 5);
    assert_int_equal(animation_frame_number(opened.frames, 0), 2);
    check_moved(&opened, 0, 0, 1, 5);
    /* s = 1/4: 0.84375 * 0 + 0.140625 * 2 * 1 + 0.15625 * 2 - 0.046875 * 2 * 3 */
    check_moved(&opened, 1, 0.3125, 1, 5);
    check_moved(&opened, 2, 0.5, 1, 5);
    /* s = 3/4: 0.046875 * 2 * 1 + 0.84375 * 2 - 0.140625 * 2 * 3 */
    check_moved(&opened, 3, 0.9375, 1, 5);
    check_moved(&opened, 4, 2, 1, 5);
    close_file(&opened);
}

static void check_turned(const open_file *opened, uint32_t frame, double angle, double tolerance) {
    const double expected[] = {0, 0, 0, cos(angle), sin(angle), 0, -sin(angle), cos(angle), 0};
    check_near(opened, frame, expected, tolerance);
}

/* From rest to a quaternion around z of either sign, at constant speed and the shorter way: to 90 degrees, to 90 by
 * the opposite quaternion, to 240, which is -120, to a small angle, and to none. */
TEST(turns_the_shorter_way) {
    static const double times[] = {0, 1};
    static const double ends[][2] = {{1, 1}, {-1, -1}, {1.75, -1}, {1e-6, 1}, {0, -1}}; /* z and w */
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        const double length = sqrt(ends[i][0] * ends[i][0] + ends[i][1] * ends[i][1]);
        const double values[] = {
            0, 0, 0, 1, 0, 0, (float)(ends[i][0] / length), (float)(ends[i][1] / length)};
        const double angle = 2 * atan(values[6] / values[7]); /* -180 to 180 degrees */
        open_file opened =
            open_channel((gltf_channel_keys){"rotation", "LINEAR", "VEC4", 2, 8, times, values}, 6);
        assert_int_equal(animation_frame_count(opened.frames), 7);
        for (uint32_t frame = 0; frame <= 6; frame++) check_turned(&opened, frame, angle * frame / 6, 1e-7);
        close_file(&opened);
    }
}

TEST(changes_weights) {
    static const double times[] = {0, 2}, values[] = {0, 1, 1, -1};
    open_file opened =
        open_channel((gltf_channel_keys){"weights", "LINEAR", "SCALAR", 2, 4, times, values}, 2);
    for (uint32_t i = 0; i <= 4; i++) {
        const double expected[] = {0, 0, 0, 1, 0.25 * i, 0, 0, 1, 1 - 0.5 * i};
        check_frame(&opened, i, expected);
    }
    close_file(&opened);
    /* In, value and out of two weights each. The middle: 0.5 * p0 + 0.125 * 2 * out + 0.5 * p1 - 0.125 * 2 * in. */
    static const double spline[] = {8, 8, 0, 1, 2, 4, 6, -2, 1, -1, 8, 8};
    opened = open_channel((gltf_channel_keys){"weights", "CUBICSPLINE", "SCALAR", 2, 12, times, spline}, 1);
    static const double middle[] = {0, 0, 0, 1, 0.5 * 0 + 0.5 + 0.5 - 1.5, 0, 0, 1, 0.5 + 1 - 0.5 + 0.5};
    check_frame(&opened, 1, middle);
    close_file(&opened);
}

/* Keys are rounded to floats, some of them past the frame that they belong to. */
TEST(steps_at_the_frame_of_the_key) {
    static const double values[] = {0, 0, 0, 7, 0, 0};
    uint32_t late = 0;
    for (uint32_t n = 1; n < 300; n += 3) {
        const double times[] = {0, n / 24.0};
        late += (double)(float)times[1] > times[1];
        open_file opened =
            open_channel((gltf_channel_keys){"translation", "STEP", "VEC3", 2, 6, times, values}, 0);
        assert_int_equal(animation_frame_count(opened.frames),
                         n + 1); /* 24 frames a second when none are given */
        check_moved(&opened, n - 1, 0, 0, 0);
        check_moved(&opened, n, 7, 0, 0);
        close_file(&opened);
    }
    assert_true(late > 20);
}

TEST(counts_frames_from_the_start_to_the_end) {
    static const double values[] = {0, 0, 0, 1, 0, 0};
    static const struct {
        double start, end, fps;
        uint32_t count;
        int32_t first;
    } cases[] = {
        {0, 0, 24, 1, 0},
        {0.5, 1.5, 24, 25, 12},
        {1 / 24., 47 / 24., 24, 47, 1},
        {0, 1.05, 10, 11, 0},
        {0, 1.0999, 10, 11, 0},
        {0, 1.1, 10, 12, 0},
        {1000 + 1 / 24., 1000 + 250 / 24., 24, 250, 24001},
        {1, 2, 29.97, 30, 30},
        {-1, 1, 5, 11, -5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double times[] = {cases[i].start, cases[i].end};
        open_file opened = open_channel(
            (gltf_channel_keys){"translation", "LINEAR", "VEC3", 2, 6, times, values}, cases[i].fps);
        assert_int_equal(animation_frame_count(opened.frames), cases[i].count);
        assert_int_equal(animation_frame_number(opened.frames, 0), cases[i].first);
        assert_int_equal(animation_frame_number(opened.frames, cases[i].count - 1),
                         cases[i].first + (int32_t)cases[i].count - 1);
        close_file(&opened);
    }
}

/* ---- several channels and animations ----------------------------------------------------------------- */

TEST(plays_channels_together) {
    gltf_fixture fixture;
    /* The third channel is of an extension, the fourth of no node. */
    open_file opened =
        open_bytes(gltf_animations_two(&fixture, GLTF_MOVE_NODE_1
                                       "," GLTF_SCALE_NODE_0
                                       ",{\"sampler\":9,\"target\":{\"path\":\"pointer\"}},{\"sampler\":0,"
                                       "\"target\":{\"path\":\"scale\"}}"),
                   4, NULL);
    assert_int_equal(animation_frame_count(opened.frames), 9);
    for (uint32_t i = 0; i < 9; i++) { /* backwards as well: frames do not depend on each other */
        const uint32_t frame = i % 2 == 0 ? i : 8 - i;
        const double scale = frame <= 2 ? 1 : frame >= 4 ? 3 : 2;
        const double x = frame;
        const double expected[] = {x, 0, 0, x + scale, 0, 0, x, scale, 0};
        check_frame(&opened, frame, expected);
    }
    close_file(&opened);
}

TEST(chooses_animations_by_name) {
    gltf_fixture fixture;
    open_file opened = open_bytes(gltf_animations_two(&fixture, GLTF_MOVE_NODE_1), 4, "B");
    assert_int_equal(animation_frame_count(opened.frames), 3);
    assert_int_equal(animation_frame_number(opened.frames, 0), 2);
    const double expected[] = {4, 5, 0, 5, 5, 0, 4, 6, 0};
    check_frame(&opened, 1, expected);
    assert_null(animation_note(opened.frames));
    close_file(&opened);
    opened = open_bytes(gltf_animations_two(&fixture, GLTF_MOVE_NODE_1), 4, NULL);
    assert_string_equal(animation_note(opened.frames), "the first of 2 animations is played: A, B");
    close_file(&opened);
}

/* Joint 1 stands on joint 0 and turns around z by 180 degrees in two seconds; the triangle's vertex 1 follows it. */
TEST(moves_skins) {
    static const double joints[12] = {[4] = 1}, weights[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
                        times[] = {0, 1, 2};
    static const double turns[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const double inverse_bind[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,    0, 0, 1,
                                          1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5, 0, 0, 1};
    gltf_fixture fixture = {0};
    gltf_fixture_array(&fixture, 5126, "VEC3", 9, gltf_animations_triangle);
    gltf_fixture_array(&fixture, 5121, "VEC4", 12, joints);
    gltf_fixture_array(&fixture, 5126, "VEC4", 12, weights);
    gltf_fixture_array(&fixture, 5126, "MAT4", 32, inverse_bind);
    gltf_fixture_array(&fixture, 5126, "SCALAR", 3, times);
    gltf_fixture_array(&fixture, 5126, "VEC4", 12, turns);
    open_file opened = open_bytes(
        gltf_fixture_glb(
            &fixture,
            "\"nodes\":[{\"mesh\":0,\"skin\":0},{\"children\":[2],\"translation\":[0,0,3]},{\"translation\":["
            "0.5,0,0]}],\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":3}],\"meshes\":[{\"primitives\":["
            "{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}}]}],\"animations\":[{\"samplers\":["
            "{\"input\":4,\"output\":5}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":2,\"path\":\"rotation\""
            "}}]}]"),
        1, NULL);
    static const double expected[][9] = {
        {0, 0, 3, 1, 0, 3, 0, 1, 3}, {0, 0, 3, 0.5, 0.5, 3, 0, 1, 3}, {0, 0, 3, 0, 0, 3, 0, 1, 3}};
    for (uint32_t i = 0; i < 3; i++) check_frame(&opened, i, expected[i]);
    close_file(&opened);
}
