/* `cscd render`: single pictures, strips of frames, and scenery beside them. */
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

enum { FRAMES = 8, WIDTH = 160, HEIGHT = 120, LABEL_WIDTH = 60, LABEL_HEIGHT = 30 };

static temp_folder folder;
static temp_path model, cache, ground, ball, png;

/* A level square much larger than the body, seen from above and from below. */
static const char ground_text[] = "v -900 -900 -1\nv 900 -900 -1\nv 900 900 -1\nv -900 900 -1\nf 1 2 3 4\n";

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded flight = recorded_tetrahedra(FRAMES), cube = recorded_cube(false);
    model = recorded_write_mesh(&folder, "flight.obj", &flight, 0);
    cache = recorded_write_cache(&folder, "flight.pc2", &flight);
    ground = temp_file_write(&folder, "ground.obj", ground_text, sizeof ground_text - 1);
    ball = recorded_write_mesh(&folder, "ball.obj", &cube, 0);
    png = temp_file_path(&folder, "picture.png");
    recorded_free(&flight);
    recorded_free(&cube);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

/* Returns the picture as RGB; the caller frees it. */
static unsigned char *read_png(uint32_t width, uint32_t height) {
    static const unsigned char signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    size_t size;
    char *bytes = read_whole_file(png.text, &size);
    assert_true(size > 8);
    assert_memory_equal(bytes, signature, sizeof signature);
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_memory(&image, bytes, size));
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    image.format = PNG_FORMAT_RGB;
    unsigned char *pixels = malloc(PNG_IMAGE_SIZE(image));
    assert_non_null(pixels);
    assert_true(png_image_finish_read(&image, NULL, pixels, 0, NULL));
    free(bytes);
    return pixels;
}

/* Counts the pixels of exactly this colour. */
static size_t count_pixels(const unsigned char *pixels, size_t count, int r, int g, int b) {
    size_t found = 0;
    for (size_t i = 0; i < count; i++)
        found += pixels[i * 3] == r && pixels[i * 3 + 1] == g && pixels[i * 3 + 2] == b;
    return found;
}

static void render_draws_a_frame(void **state) {
    (void)state;
    EXPECT_TOOL(0, "render", model.text, cache.text, "--frame", "4", "-o", png.text, "--size", "320x240");
    unsigned char *first = read_png(320, 240);
    EXPECT_TOOL(0, "render", model.text, cache.text, "--frame", "0", "-o", png.text, "--size", "320x240");
    unsigned char *second = read_png(320, 240);
    assert_memory_not_equal(first, second, 320 * 240 * 3);
    EXPECT_TOOL(0, "render", model.text, "-o", png.text, "--wire", "--up", "y", "--view", "30,20");
    free(read_png(1280, 960));
    free(first);
    free(second);
}

static void render_marks_contacts(void **state) {
    (void)state;
    EXPECT_TOOL(0, "render", model.text, cache.text, "--frame", "3", "--colour", "contacts", "-o", png.text);
    unsigned char *with = read_png(1280, 960);
    EXPECT_TOOL(0, "render", model.text, cache.text, "--frame", "3", "--colour", "plain", "-o", png.text);
    unsigned char *without = read_png(1280, 960);
    assert_true(count_pixels(with, 1280 * 960, 0, 90, 181) > 20); /* dots and legend */
    assert_int_equal(count_pixels(without, 1280 * 960, 0, 90, 181), 0);
    EXPECT_TOOL(0, "render", model.text, cache.text, "--frame", "3", "--color", "contacts", "--zoom", "-o",
                png.text);
    free(read_png(1280, 960));
    free(with);
    free(without);
}

static void render_draws_a_plan(void **state) {
    (void)state;
    static const uint8_t first_region[3] = {86, 180, 233}, second_region[3] = {230, 159, 0};
    temp_path plan = temp_file_path(&folder, "two.ply");
    const size_t count = 320 * 240;
    EXPECT_TOOL(0, "render", model.text, "--colour", "region", "-o", png.text, "--size", "320x240");
    unsigned char *region = read_png(320, 240);
    EXPECT_TOOL(0, "render", model.text, "--colour", "charge", "-o", png.text, "--size", "320x240");
    unsigned char *charge = read_png(320, 240);
    assert_true(count_pixels(region, count, first_region[0], first_region[1], first_region[2]) > 5);
    assert_true(count_pixels(region, count, second_region[0], second_region[1], second_region[2]) > 5);
    assert_true(count_pixels(charge, count, 68, 1, 84) > 5 && count_pixels(charge, count, 253, 231, 37) > 5);
    EXPECT_TOOL(0, "preprocess", model.text, "--method", "single", "-o", plan.text, "--quiet");
    EXPECT_TOOL(0, "render", model.text, "--colour", "region", "--plan", plan.text, "-o", png.text, "--size",
                "320x240");
    unsigned char *single = read_png(320, 240);
    assert_memory_not_equal(single, region, count * 3); /* the caption names another method */
    EXPECT_TOOL(0, "render", model.text, cache.text, "--frame", "5", "--colour", "region", "-o", png.text);
    EXPECT_ERROR(1, TEXTS("two.ply", "of method single, expected charge"), "render", model.text, "--colour",
                 "charge", "--plan", plan.text, "-o", png.text);
    free(region);
    free(charge);
    free(single);
}

static void render_refuses_frames_that_are_not_there(void **state) {
    (void)state;
    EXPECT_ERROR(1, TEXTS("--frame 8", "frames 0 to 7"), "render", model.text, cache.text, "-o", png.text,
                 "--frame", "8");
    EXPECT_ERROR(1, TEXTS("--frame 7", "next"), "render", model.text, cache.text, "-o", png.text, "--frame",
                 "7", "--colour", "contacts");
    EXPECT_TOOL(0, "render", model.text, cache.text, "-o", png.text, "--frame", "7");
}

/* Returns one tile of a strip as RGB; the caller frees it. */
static unsigned char *tile_of(const unsigned char *sheet, uint32_t columns, uint32_t index) {
    unsigned char *tile = malloc((size_t)WIDTH * HEIGHT * 3);
    assert_non_null(tile);
    for (uint32_t row = 0; row < HEIGHT; row++) {
        size_t line = (size_t)(index / columns * HEIGHT + row) * columns * WIDTH + index % columns * WIDTH;
        memcpy(tile + (size_t)row * WIDTH * 3, sheet + line * 3, (size_t)WIDTH * 3);
    }
    return tile;
}

/* Counts of different pixels in the label's corner and elsewhere, without the lines at the left and at the
 * top. */
typedef struct difference {
    size_t label, elsewhere;
} difference;

static difference compare_pictures(const unsigned char *a, const unsigned char *b) {
    difference found = {0, 0};
    for (uint32_t row = 1; row < HEIGHT; row++)
        for (uint32_t column = 1; column < WIDTH; column++) {
            size_t at = ((size_t)row * WIDTH + column) * 3;
            bool differs = memcmp(a + at, b + at, 3) != 0;
            *(row < LABEL_HEIGHT && column < LABEL_WIDTH ? &found.label : &found.elsewhere) += differs;
        }
    return found;
}

static difference compare_tiles(const unsigned char *sheet, uint32_t columns, uint32_t one, uint32_t other) {
    unsigned char *a = tile_of(sheet, columns, one), *b = tile_of(sheet, columns, other);
    difference found = compare_pictures(a, b);
    free(a);
    free(b);
    return found;
}

static size_t coloured_pixels(const unsigned char *pixels, size_t count) {
    return count - count_pixels(pixels, count, 255, 255, 255);
}

#define RENDER_TILES(...) EXPECT_TOOL(0, "render", "-o", png.text, "--size", "160x120", __VA_ARGS__)

static void strip_is_a_grid_of_tiles(void **state) {
    (void)state;
    RENDER_TILES(model.text, cache.text, "--frames", "0:6:2", "--columns", "3");
    unsigned char *sheet = read_png(3 * WIDTH, 2 * HEIGHT);
    for (uint32_t i = 0; i < 4; i++) {
        unsigned char *tile = tile_of(sheet, 3, i);
        assert_true(coloured_pixels(tile, (size_t)WIDTH * HEIGHT) > 500);
        free(tile);
        for (uint32_t j = 0; j < i; j++) {
            difference found = compare_tiles(sheet, 3, i, j);
            assert_true(found.label > 10 && found.elsewhere > 50);
        }
    }
    unsigned char *empty = tile_of(sheet, 3, 5);
    assert_int_equal(coloured_pixels(empty, (size_t)WIDTH * HEIGHT), WIDTH + HEIGHT - 1); /* only the lines */
    free(empty);
    free(sheet);
    RENDER_TILES(model.text, cache.text, "--frames", "3:");
    free(read_png(3 * WIDTH, 2 * HEIGHT));
    RENDER_TILES(model.text, cache.text, "--frames", "2:3", "--columns", "9");
    free(read_png(2 * WIDTH, HEIGHT));
    EXPECT_TOOL(0, "render", model.text, "--frames", "0", "-o", png.text);
    free(read_png(400, 300));
}

/* The tetrahedron flies along a line, so all frames need the same camera as the first and the last
 * position, and the tiles are the same, bit for bit. The camera for the fourth frame alone is nearer. */
static void camera_holds_the_whole_motion(void **state) {
    (void)state;
    RENDER_TILES(model.text, cache.text, "--frames", "0:", "--columns", "4");
    unsigned char *all = read_png(4 * WIDTH, 2 * HEIGHT);
    RENDER_TILES(model.text, cache.text, "--frames", "0::7", "--columns", "2");
    unsigned char *ends = read_png(2 * WIDTH, HEIGHT);
    RENDER_TILES(model.text, cache.text, "--frames", "4");
    unsigned char *alone = read_png(WIDTH, HEIGHT);
    unsigned char *first = tile_of(all, 4, 0), *last = tile_of(all, 4, 7), *fourth = tile_of(all, 4, 4);
    unsigned char *first_end = tile_of(ends, 2, 0), *last_end = tile_of(ends, 2, 1);
    difference same = compare_pictures(first, first_end), other = compare_pictures(fourth, alone);
    assert_true(same.label == 0 && same.elsewhere == 0);
    same = compare_pictures(last, last_end);
    assert_true(same.label == 0 && same.elsewhere == 0);
    assert_true(other.elsewhere > 500);
    free(all);
    free(ends);
    free(alone);
    free(first);
    free(last);
    free(fourth);
    free(first_end);
    free(last_end);
}

/* A torus that flies without turning looks the same in all tiles that follow it, except for the label's
 * number. */
static void following_camera_keeps_the_body_in_the_middle(void **state) {
    (void)state;
    recorded torus = recorded_torus(12, 8);
    const size_t count = (size_t)torus.vertex_count * 3;
    torus.frame_count = 4;
    double *frames = malloc(count * 4 * sizeof *frames);
    assert_non_null(frames);
    for (size_t i = 0; i < count * 4; i++)
        frames[i] = torus.frames[i % count] + (double)(i / count) * (i % 3 == 2 ? -8.0 : 2.0);
    free(torus.frames);
    torus.frames = frames;
    temp_path body = recorded_write_mesh(&folder, "torus.obj", &torus, 0),
              flight = recorded_write_cache(&folder, "torus.pc2", &torus);
    recorded_free(&torus);
    RENDER_TILES(body.text, flight.text, "--frames", ":3");
    unsigned char *still = read_png(2 * WIDTH, 2 * HEIGHT);
    RENDER_TILES(body.text, flight.text, "--frames", ":3", "--follow");
    unsigned char *followed = read_png(2 * WIDTH, 2 * HEIGHT);
    for (uint32_t i = 1; i < 4; i++) {
        assert_true(compare_tiles(still, 2, 0, i).elsewhere > 200);
        difference found = compare_tiles(followed, 2, 0, i);
        assert_true(found.label > 10 && found.elsewhere < 10);
    }
    assert_true(coloured_pixels(followed, (size_t)WIDTH * HEIGHT * 4) >
                coloured_pixels(still, (size_t)WIDTH * HEIGHT * 4));
    free(still);
    free(followed);
    RENDER_TILES(body.text, flight.text, "--frames", ":3", "--follow", "--scenery", ground.text);
    followed = read_png(2 * WIDTH, 2 * HEIGHT);
    assert_true(compare_tiles(followed, 2, 0, 3).elsewhere > 200); /* the ground comes nearer */
    free(followed);
}

/* Interval 3 has a vertex-face contact; the last frame begins no interval, so it has none. */
static void strip_shows_contacts_where_they_begin(void **state) {
    (void)state;
    RENDER_TILES(model.text, cache.text, "--frames", "0:7", "--columns", "8", "--colour", "contacts");
    unsigned char *sheet = read_png(8 * WIDTH, HEIGHT);
    RENDER_TILES(model.text, cache.text, "--frames", "0:7", "--columns", "8");
    unsigned char *plain = read_png(8 * WIDTH, HEIGHT);
    for (uint32_t i = 0; i < 8; i++) {
        unsigned char *tile = tile_of(sheet, 8, i), *without = tile_of(plain, 8, i);
        bool touches = i == 3 || i == 5;
        size_t dots = count_pixels(tile, (size_t)WIDTH * HEIGHT, 0, 90, 181);
        assert_true(touches ? dots > 10 : memcmp(tile, without, (size_t)WIDTH * HEIGHT * 3) == 0);
        free(tile);
        free(without);
    }
    free(sheet);
    free(plain);
}

static void strip_shows_a_plan(void **state) {
    (void)state;
    static const char *const colours[] = {"plain", "charge", "region"};
    unsigned char *sheets[3];
    for (int i = 0; i < 3; i++) {
        RENDER_TILES(model.text, cache.text, "--frames", "0:3", "--colour", colours[i]);
        sheets[i] = read_png(2 * WIDTH, 2 * HEIGHT);
    }
    for (uint32_t i = 0; i < 4; i++)
        for (int k = 1; k < 3; k++) {
            unsigned char *plain = tile_of(sheets[0], 2, i), *painted = tile_of(sheets[k], 2, i);
            difference found = compare_pictures(plain, painted);
            assert_true(found.elsewhere > 300);
            free(plain);
            free(painted);
        }
    for (int i = 0; i < 3; i++) free(sheets[i]);
}

/* The ground fills the background and leaves the body where it was, except for its smoothed rim. */
static void scenery_leaves_the_framing_alone(void **state) {
    (void)state;
    const size_t count = (size_t)WIDTH * HEIGHT;
    RENDER_TILES(model.text, cache.text, "--frame", "2");
    unsigned char *alone = read_png(WIDTH, HEIGHT);
    RENDER_TILES(model.text, cache.text, "--frame", "2", "--scenery", ground.text);
    unsigned char *with = read_png(WIDTH, HEIGHT);
    size_t body = 0, kept = 0;
    for (size_t i = 0; i < count; i++) {
        bool drawn = alone[i * 3] != 255;
        body += drawn;
        kept += drawn && memcmp(alone + i * 3, with + i * 3, 3) == 0;
    }
    assert_true(body > 1500 && kept > body * 3 / 4);
    assert_true(coloured_pixels(with, count) > count - 2000); /* all but the label */
    free(alone);
    free(with);
}

static void scenery_moves_with_its_frames(void **state) {
    (void)state;
    recorded cube = recorded_cube(false);
    temp_path three = recorded_write_cache(&folder, "cube.mdd", &cube);
    recorded cycle = cube;
    cycle.frame_count = 1;
    temp_path one = recorded_write_cache(&folder, "cube_1.pc2", &cycle);
    temp_path eight = recorded_write_cycle(&folder, "cube_8.pc2", &cube, FRAMES);
    recorded_free(&cube);
    RENDER_TILES(model.text, cache.text, "--frames", "0:1", "--scenery", ball.text);
    unsigned char *still = read_png(2 * WIDTH, HEIGHT);
    RENDER_TILES(model.text, cache.text, "--frames", "0:1", "--scenery", ball.text, "--scenery-frames",
                 one.text);
    unsigned char *single = read_png(2 * WIDTH, HEIGHT);
    RENDER_TILES(model.text, cache.text, "--frames", "0:1", "--scenery", ball.text, "--scenery-frames",
                 eight.text);
    unsigned char *moving = read_png(2 * WIDTH, HEIGHT);
    assert_memory_equal(still, single, (size_t)2 * WIDTH * HEIGHT * 3);
    unsigned char *before = tile_of(still, 2, 0), *after = tile_of(moving, 2, 0);
    assert_memory_equal(before, after, (size_t)WIDTH * HEIGHT * 3);
    free(before);
    free(after);
    assert_memory_not_equal(still, moving, (size_t)2 * WIDTH * HEIGHT * 3);
    free(still);
    free(single);
    free(moving);
    EXPECT_ERROR(1, TEXTS("cube.mdd: 3 frames", "one or the recording's 8"), "render", model.text, cache.text,
                 "-o", png.text, "--scenery", ball.text, "--scenery-frames", three.text);
    EXPECT_ERROR(1, TEXTS("--scenery-frames", "flight.pc2", "points"), "render", model.text, cache.text, "-o",
                 png.text, "--scenery", ball.text, "--scenery-frames", cache.text);
}

static void render_refuses_what_does_not_go_together(void **state) {
    (void)state;
#define REFUSED(...) "render", model.text, cache.text, "-o", png.text, __VA_ARGS__
    EXPECT_ERROR(2, TEXTS("--frame and --frames", "one of them"), REFUSED("--frame", "1", "--frames", "0:3"));
    EXPECT_ERROR(2, TEXTS("--columns is for a strip", "--frames"), REFUSED("--columns", "3"));
    EXPECT_ERROR(2, TEXTS("--follow is for a strip", "--frames"), REFUSED("--follow", "--frame", "3"));
    EXPECT_ERROR(2, TEXTS("--zoom is for a single"), REFUSED("--zoom", "--frames", "0:3"));
    EXPECT_ERROR(2, TEXTS("--scenery-frames", "--scenery MODEL"), REFUSED("--scenery-frames", "a.pc2"));
    EXPECT_ERROR(2, TEXTS("--columns cannot be '0'"), REFUSED("--frames", "0:3", "--columns", "0"));
    EXPECT_ERROR(2, TEXTS("--frames cannot be '3:0'"), REFUSED("--frames", "3:0"));
    EXPECT_ERROR(1, TEXTS("no frame 9", "frames 0 to 7"), REFUSED("--frames", "0:9"));
    EXPECT_ERROR(1, TEXTS("24000 x 8000 pixels"),
                 REFUSED("--frames", "0:2", "--columns", "3", "--size", "8000x8000"));
    EXPECT_ERROR(2, TEXTS("would overwrite"), "render", model.text, cache.text, "-o", "ground.txt",
                 "--scenery", "ground.txt");
    EXPECT_ERROR(1, TEXTS("none.obj", "No such file"), REFUSED("--scenery", "none.obj"));
}

/* An older picture stays when a later frame cannot be read. */
static void failed_strip_keeps_the_picture_that_was_there(void **state) {
    (void)state;
    recorded flight = recorded_tetrahedra(FRAMES), other = recorded_cube(false);
    temp_path pattern = recorded_write_sequence(&folder, "g_%02d.ply", &flight);
    recorded_write_mesh(&folder, "g_05.ply", &other, 0);
    recorded_free(&flight);
    recorded_free(&other);
    temp_path kept = temp_file_write(&folder, "kept.png", "kept", 4);
    EXPECT_ERROR(1, TEXTS("g_05.ply"), "render", model.text, pattern.text, "-o", kept.text, "--frames",
                 "2:7");
    char *bytes = read_whole_file(kept.text, NULL);
    assert_string_equal(bytes, "kept");
    free(bytes);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(render_draws_a_frame),
        cmocka_unit_test(render_marks_contacts),
        cmocka_unit_test(render_draws_a_plan),
        cmocka_unit_test(render_refuses_frames_that_are_not_there),
        cmocka_unit_test(strip_is_a_grid_of_tiles),
        cmocka_unit_test(camera_holds_the_whole_motion),
        cmocka_unit_test(following_camera_keeps_the_body_in_the_middle),
        cmocka_unit_test(strip_shows_contacts_where_they_begin),
        cmocka_unit_test(strip_shows_a_plan),
        cmocka_unit_test(scenery_leaves_the_framing_alone),
        cmocka_unit_test(scenery_moves_with_its_frames),
        cmocka_unit_test(render_refuses_what_does_not_go_together),
        cmocka_unit_test(failed_strip_keeps_the_picture_that_was_there),
    };
    return cmocka_run_group_tests_name("tool_render", tests, make_files, remove_files);
}
