/* The parts of strips and scenery: sheets of tiles, cameras for many frames, shadows, squares, the second
 * mesh. */
#include "tests/support/test.h"
#include "tool/picture/picture.h"
#include "tool/picture/shade.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/support/random.h"

static picture_image filled_image(uint32_t width, uint32_t height, uint8_t value) {
    picture_image image;
    assert_true(picture_image_create(width, height, &image, NULL));
    memset(image.pixels, value, (size_t)width * height * 4);
    return image;
}

static const uint8_t *pixel_at(const picture_image *image, double x, double y) {
    assert_true(x >= 0 && y >= 0 && x < image->width && y < image->height);
    return image->pixels + 4 * ((size_t)y * image->width + (size_t)x);
}

TEST(sheet_places_tiles_row_by_row) {
    picture_sheet sheet;
    assert_true(picture_sheet_create(5, 3, 20, 10, &sheet, NULL));
    assert_true(sheet.image.width == 60 && sheet.image.height == 20);
    for (uint32_t i = 0; i < 5; i++) {
        picture_image tile = filled_image(20, 10, (uint8_t)(10 + i));
        tile.pixels[3] = 255;
        picture_sheet_place(&sheet, i, &tile);
        picture_image_free(&tile);
    }
    for (uint32_t i = 0; i < 5; i++)
        for (double corner = 1.0; corner < 20.0; corner += 18.0)
            assert_int_equal(pixel_at(&sheet.image, i % 3 * 20 + corner, i / 3 * 10 + 1)[0], 10 + i);
    assert_int_equal(pixel_at(&sheet.image, 50, 15)[0], 255); /* no tile */
    assert_int_equal(pixel_at(&sheet.image, 20, 5)[0], 150);  /* a line */
    assert_int_equal(pixel_at(&sheet.image, 5, 10)[0], 150);
    assert_int_equal(pixel_at(&sheet.image, 0, 5)[0], 10); /* no line at the rim */
    picture_image_free(&sheet.image);
}

TEST(sheets_too_large_are_refused) {
    picture_sheet sheet;
    io_error error;
    assert_false(picture_sheet_create(3, 3, 8000, 10, &sheet, &error));
    assert_non_null(strstr(error.text, "24000 x 10"));
    assert_false(picture_sheet_create(UINT32_MAX, 1, 16384, 16384, &sheet, &error));
    assert_false(picture_sheet_create(UINT32_MAX, UINT32_MAX, 16384, 16384, &sheet, &error));
    assert_false(picture_sheet_create(0, 3, 10, 10, &sheet, &error));
    assert_false(picture_sheet_create(3, 0, 10, 10, &sheet, NULL));
}

enum { POINTS = 400 };

static void random_points(random_stream *random, double spread, double points[3 * POINTS]) {
    double middle[3];
    for (int k = 0; k < 3; k++) middle[k] = spread * stream_between(random, -1.0, 1.0);
    for (int i = 0; i < 3 * POINTS; i++) points[i] = middle[i % 3] + stream_between(random, -1.0, 1.0);
}

/* The camera is chosen from five points of each frame, and still shows all frames. */
TEST(outermost_points_frame_a_motion) {
    enum { frames = 7 };
    static double points[frames][3 * POINTS], outermost[frames][PICTURE_OUTERMOST][3];
    random_stream random = stream_start(7);
    for (int view = 0; view < 40; view++) {
        double azimuth = stream_between(&random, -180.0, 180.0),
               elevation = stream_between(&random, -80.0, 80.0);
        bool y_up = view % 2 != 0;
        uint32_t width = 100 + 50 * (uint32_t)(view % 7), height = 240;
        for (int f = 0; f < frames; f++) {
            random_points(&random, 5.0, points[f]);
            picture_camera_outermost(points[f], POINTS, azimuth, elevation, y_up, width, height,
                                     outermost[f]);
        }
        picture_camera all, few;
        picture_camera_frame(points[0], (size_t)frames * POINTS, azimuth, elevation, y_up, width, height,
                             &all);
        picture_camera_frame(outermost[0][0], (size_t)frames * PICTURE_OUTERMOST, azimuth, elevation, y_up,
                             width, height, &few);
        for (int k = 0; k < 3; k++) assert_true(all.eye[k] == few.eye[k]);
        assert_true(all.near_depth == few.near_depth && all.focal == few.focal);
    }
}

TEST(unproject_undoes_project) {
    static double points[3 * POINTS];
    random_stream random = stream_start(11);
    picture_camera camera;
    random_points(&random, 3.0, points);
    picture_camera_frame(points, POINTS, 30.0, 25.0, false, 320, 240, &camera);
    for (size_t i = 0; i < POINTS; i++) {
        double at[3], back[3];
        picture_camera_project(&camera, points + 3 * i, at);
        picture_camera_unproject(&camera, at[0] / at[2], at[1] / at[2], at[2], back);
        for (size_t k = 0; k < 3; k++) assert_true(fabs(back[k] - points[3 * i + k]) < 1e-12);
    }
}

/* Makes a box from (0, 0, 0) to (1, 1, 1), moved up. */
static void make_box(double lifted, bool y_up, double positions[24]) {
    for (int corner = 0; corner < 8; corner++) {
        double x = corner & 1, across = corner >> 1 & 1, height = (corner >> 2) + lifted;
        positions[3 * corner] = x;
        positions[3 * corner + 1] = y_up ? height : across;
        positions[3 * corner + 2] = y_up ? across : height;
    }
}

static const uint32_t box_triangles[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                           2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

static double shadow_of(const picture_shadow *shadow, bool y_up, double x, double across, double height) {
    return picture_shadow_at(shadow, (const double[3]){x, y_up ? height : across, y_up ? across : height});
}

TEST(shadow_lies_below_and_softens) {
    double positions[24];
    for (int y_up = 0; y_up < 2; y_up++) {
        picture_shadow shadow;
        make_box(0.0, y_up != 0, positions);
        assert_true(picture_shadow_create(positions, 8, box_triangles, 12, y_up != 0, &shadow, NULL));
        assert_true(shadow_of(&shadow, y_up, 0.5, 0.5, -0.001) > 0.9);
        assert_true(shadow_of(&shadow, y_up, 0.5, 0.5, 0.5) > 0.9); /* inside the shadow */
        assert_true(shadow_of(&shadow, y_up, 0.5, 0.5, 1.1) == 0.0);
        assert_true(shadow_of(&shadow, y_up, 1.5, 0.5, -0.001) == 0.0);
        assert_true(shadow_of(&shadow, y_up, 1e300, -1e300, -0.001) == 0.0);
        double near_rim = shadow_of(&shadow, y_up, 1.05, 0.5, -0.001);
        double far_rim = shadow_of(&shadow, y_up, 1.05, 0.5, -1.0);
        assert_true(near_rim == 0.0 && far_rim > 0.05 && far_rim < 0.4);
        double last = 1.0; /* the shadow fades without jumps */
        for (double x = 0.7; x < 1.3; x += 0.005) {
            double here = shadow_of(&shadow, y_up, x, 0.5, -0.6);
            assert_true(here < last + 0.03 && here > last - 0.3);
            last = here;
        }
        assert_true(shadow_of(&shadow, y_up, 0.5, 0.5, -3.0) < shadow_of(&shadow, y_up, 0.5, 0.5, -0.1));
        picture_shadow_free(&shadow);
    }
}

/* Beside its longest side a triangle leaves all light. */
TEST(a_triangle_has_the_shadow_of_a_triangle) {
    static const double positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (uint32_t turn = 0; turn < 3; turn++) {
        const uint32_t corners[] = {turn, (turn + 1) % 3, (turn + 2) % 3};
        picture_shadow shadow;
        assert_true(picture_shadow_create(positions, 3, corners, 1, false, &shadow, NULL));
        assert_true(shadow_of(&shadow, false, 0.25, 0.25, -0.002) > 0.9);
        assert_true(shadow_of(&shadow, false, 0.75, 0.75, -0.002) == 0.0);
        picture_shadow_free(&shadow);
    }
}

/* Scaling by a power of two, up to the limits of coordinates, changes nothing. */
TEST(shadows_have_no_unit) {
    const double scales[] = {1.0, 0x1p290, 0x1p-290};
    double positions[24], expected = 0.0;
    for (int i = 0; i < 3; i++) {
        picture_shadow shadow;
        make_box(0.0, false, positions);
        for (int k = 0; k < 24; k++) positions[k] *= scales[i];
        assert_true(picture_shadow_create(positions, 8, box_triangles, 12, false, &shadow, NULL));
        double here = shadow_of(&shadow, false, 1.05 * scales[i], 0.5 * scales[i], -scales[i]);
        if (i == 0) expected = here;
        assert_true(here > 0.05 && here == expected);
        picture_shadow_free(&shadow);
    }
}

TEST(bodies_without_extent_cast_no_shadow) {
    const uint32_t triangle[3] = {0, 1, 2};
    const double still[9] = {1, 2, 3, 1, 2, 3, 1, 2, 3}, line[9] = {0, 0, 0, 0, 0, 1, 0, 0, 2},
                 huge[9] = {-1.7e308, 0, 0, 1.7e308, 0, 0, 0, 1.7e308, 1.7e308};
    const double *const bodies[3] = {still, line, huge};
    for (int i = 0; i < 3; i++) {
        picture_shadow shadow;
        assert_true(picture_shadow_create(bodies[i], 3, triangle, 1, false, &shadow, NULL));
        assert_true(picture_shadow_at(&shadow, (const double[3]){1, 2, -3}) == 0.0);
        picture_shadow_free(&shadow);
    }
    picture_shadow nothing;
    assert_true(picture_shadow_create(NULL, 0, NULL, 0, false, &nothing, NULL));
    picture_shadow_free(&nothing);
}

static const double ground_positions[] = {-1000, -1000, 0, 1000, -1000, 0, 1000, 1000, 0, -1000, 1000, 0};
static const uint32_t ground_triangles[] = {0, 1, 2, 0, 2, 3}, turned_ground[] = {0, 2, 1, 0, 3, 2};

static picture_scene box_scene(const double positions[24], const picture_mesh *scenery) {
    return (picture_scene){.vertex_count = 8,
                           .triangle_count = 12,
                           .positions = positions,
                           .triangles = box_triangles,
                           .scenery = scenery};
}

static picture_options small_picture(void) {
    picture_options options = picture_options_defaults();
    options.width = 200, options.height = 150;
    options.focus = true;
    for (int k = 0; k < 3; k++) options.focus_min[k] = -1.0, options.focus_max[k] = 2.0;
    return options;
}

static picture_image render_scene(const picture_scene *scene, const picture_options *options) {
    picture_image image;
    io_error error = {""};
    if (!picture_render_image(scene, options, &image, &error)) fail_msg("%s", error.text);
    return image;
}

static const uint8_t *pixel_of(const picture_image *image, const picture_scene *scene,
                               const picture_options *options, double x, double y, double z) {
    picture_camera camera;
    double at[3];
    picture_scene_camera(scene, options, &camera);
    picture_camera_project(&camera, (const double[3]){x, y, z}, at);
    return pixel_at(image, at[0] / at[2], at[1] / at[2]);
}

/* The picture is the same to the last bit from the largest coordinates to the smallest, also with a
 * caption beside it. */
TEST(pictures_have_no_unit) {
    const double scales[] = {1.0, 0x1p-7, 0x1p280, 0x1p-290};
    picture_image images[4];
    for (int i = 0; i < 4; i++) {
        double positions[24], around[12];
        make_box(0.0, false, positions);
        for (int k = 0; k < 24; k++) positions[k] *= scales[i];
        for (int k = 0; k < 12; k++) around[k] = ground_positions[k] * scales[i];
        const picture_mesh ground = {4, 2, around, ground_triangles};
        picture_scene scene = box_scene(positions, &ground);
        picture_options options = small_picture();
        scene.caption = "so long that the box would lie below it";
        options.focus = false;
        options.square = 0.25 * scales[i];
        images[i] = render_scene(&scene, &options);
        assert_memory_equal(images[i].pixels, images[0].pixels, (size_t)4 * 200 * 150);
    }
    assert_false(images[0].pixels[4 * (75 * 200 + 100)] == 255); /* the picture is not empty */
    for (int i = 0; i < 4; i++) picture_image_free(&images[i]);
}

/* A ground that passes below and behind the camera fills the picture, whichever way its triangles turn,
 * and moves nothing. It is darker below the body. */
TEST(ground_is_drawn_around_the_body) {
    const picture_mesh ground = {4, 2, ground_positions, ground_triangles},
                       turned = {4, 2, ground_positions, turned_ground};
    double positions[24];
    make_box(0.3, false, positions);
    picture_scene scene = box_scene(positions, &ground), alone = box_scene(positions, NULL),
                  other = box_scene(positions, &turned);
    picture_options options = small_picture();
    picture_image image = render_scene(&scene, &options), without = render_scene(&alone, &options),
                  again = render_scene(&other, &options);
    assert_memory_equal(image.pixels, again.pixels, (size_t)4 * 200 * 150);
    for (double x = 0; x < 200; x += 199)
        for (double y = 0; y < 150; y += 149) {
            assert_true(pixel_at(&image, x, y)[0] < 250);
            assert_int_equal(pixel_at(&without, x, y)[0], 255);
        }
    assert_memory_equal(pixel_of(&image, &scene, &options, 0.5, 0.5, 1.3),
                        pixel_of(&without, &alone, &options, 0.5, 0.5, 1.3), 4);
    assert_true(pixel_of(&image, &scene, &options, 0.7, 0.2, 0)[0] + 40 <
                pixel_of(&image, &scene, &options, 1.4, -0.2, 0)[0]);
    picture_image_free(&image);
    picture_image_free(&without);
    picture_image_free(&again);
}

TEST(squares_alternate_on_level_ground) {
    const picture_mesh ground = {4, 2, ground_positions, ground_triangles};
    double positions[24];
    make_box(0.0, false, positions);
    picture_scene scene = box_scene(positions, &ground);
    picture_options options = small_picture();
    options.elevation = 60.0;
    options.square = 0.5;
    picture_image image = render_scene(&scene, &options);
    int one = pixel_of(&image, &scene, &options, 1.25, -0.25, 0)[0],
        next = pixel_of(&image, &scene, &options, 1.25, 0.25, 0)[0],
        diagonal = pixel_of(&image, &scene, &options, 1.75, 0.25, 0)[0];
    assert_true(abs(one - next) > 5 && abs(one - diagonal) < 4);
    picture_image_free(&image);
}

TEST(given_camera_is_used) {
    double positions[24], moved[24];
    make_box(0.0, false, positions);
    memcpy(moved, positions, sizeof moved);
    for (int i = 0; i < 24; i += 3) moved[i] += 0.75;
    picture_scene scene = box_scene(positions, NULL), other = box_scene(moved, NULL);
    picture_options options = small_picture(), fixed = options;
    options.focus = false;
    picture_camera camera;
    picture_scene_camera(&scene, &options, &camera);
    fixed.camera = &camera;
    picture_image own = render_scene(&other, &options), first = render_scene(&scene, &options),
                  second = render_scene(&other, &fixed);
    assert_memory_not_equal(own.pixels, second.pixels, (size_t)4 * 200 * 150);
    camera.eye[0] += 0.75;
    picture_image third = render_scene(&other, &fixed);
    assert_memory_equal(first.pixels, third.pixels, (size_t)4 * 200 * 150);
    picture_image_free(&own);
    picture_image_free(&first);
    picture_image_free(&second);
    picture_image_free(&third);
}

TEST(bad_scenery_is_refused) {
    static const uint32_t wild[] = {0, 1, 4};
    const picture_mesh scenery = {4, 1, ground_positions, wild};
    double positions[24];
    make_box(0.0, false, positions);
    picture_scene scene = box_scene(positions, &scenery);
    picture_options options = small_picture();
    picture_image image;
    io_error error;
    assert_false(picture_render_image(&scene, &options, &image, &error));
    assert_non_null(strstr(error.text, "scenery: triangle 0 names vertex 4"));
    const picture_mesh many = {4, UINT32_MAX, ground_positions, wild};
    scene.scenery = &many;
    assert_false(picture_render_image(&scene, &options, &image, &error));
}
