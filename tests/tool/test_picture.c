/* The renderer: known pixels, hidden surfaces, markers, and PNG files that read back or leave nothing. */
#include "tests/support/test.h"
#include "tool/picture/picture.h"

#include <math.h>
#include <png.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "tests/support/files.h"

/* A triangle seen from azimuth 0 and elevation 0: x points to the right, z up, y away from the eye. */
static const double facing_positions[] = {-1, 0, -1, 1, 0, -1, 0, 0, 1};
static const uint32_t facing_triangle[] = {0, 1, 2};
static const uint8_t red[] = {220, 40, 30}, green[] = {30, 180, 60}, blue[] = {40, 60, 220};

static picture_scene scene_of(uint32_t vertex_count, const double *positions, uint32_t triangle_count,
                              const uint32_t *triangles) {
    return (picture_scene){.vertex_count = vertex_count,
                           .triangle_count = triangle_count,
                           .positions = positions,
                           .triangles = triangles};
}

static picture_scene facing_scene(void) {
    picture_scene scene = scene_of(3, facing_positions, 1, facing_triangle);
    scene.triangle_colours = red;
    return scene;
}

static picture_options front_view(picture_shading shading) {
    picture_options options = picture_options_defaults();
    options.width = 160, options.height = 120;
    options.azimuth = options.elevation = 0.0;
    options.shading = shading;
    return options;
}

static picture_image render_scene(const picture_scene *scene, const picture_options *options) {
    picture_image image;
    io_error error = {""};
    if (!picture_render_image(scene, options, &image, &error)) fail_msg("%s", error.text);
    return image;
}

static const uint8_t *pixel_at(const picture_image *image, double x, double y) {
    assert_true(x >= 0 && y >= 0 && x < image->width && y < image->height);
    return image->pixels + 4 * ((size_t)y * image->width + (size_t)x);
}

static const uint8_t *middle_pixel(const picture_image *image) {
    return pixel_at(image, image->width / 2, image->height / 2);
}

static void project_point(const picture_scene *scene, const picture_options *options, const double point[3],
                          double pixel[2]) {
    picture_camera camera;
    double at[3];
    picture_scene_camera(scene, options, &camera);
    picture_camera_project(&camera, point, at);
    assert_true(at[2] > camera.near_depth);
    pixel[0] = at[0] / at[2];
    pixel[1] = at[1] / at[2];
}

TEST(triangle_covers_the_middle_with_its_colour) {
    picture_scene scene = facing_scene();
    picture_options options = front_view(PICTURE_UNLIT);
    picture_image image = render_scene(&scene, &options);
    const uint8_t white[] = {255, 255, 255, 255};
    assert_memory_equal(middle_pixel(&image), ((const uint8_t[]){220, 40, 30, 255}), 4);
    assert_memory_equal(pixel_at(&image, 0, 0), white, 4);
    picture_image_free(&image);
    options.shading = PICTURE_SMOOTH;
    options.transparent = true;
    image = render_scene(&scene, &options);
    assert_true(middle_pixel(&image)[0] > 2 * middle_pixel(&image)[1]);
    assert_true(middle_pixel(&image)[3] == 255 && pixel_at(&image, 0, 0)[3] == 0);
    picture_image_free(&image);
}

TEST(camera_keeps_everything_within_the_margin) {
    static const double positions[] = {-3, 2, 5, 7, -1, 0, 0, 11, -2, 4, 4, 4};
    picture_scene scene = {.vertex_count = 4, .positions = positions};
    picture_options options = front_view(PICTURE_SMOOTH);
    for (int view = 0; view < 48; view++) {
        options.azimuth = 30.0 * view;
        options.elevation = -80.0 + 40.0 * (view % 5);
        options.y_up = view % 2 != 0;
        double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {0.0, 0.0};
        for (int i = 0; i < 8; i++) {
            double pixel[2];
            project_point(&scene, &options, positions + 3 * (i / 2), pixel);
            low[i % 2] = fmin(low[i % 2], pixel[i % 2]);
            high[i % 2] = fmax(high[i % 2], pixel[i % 2]);
        }
        const double least = 7.2 - 0.01, most = 7.2 + 0.01; /* 6 % of the height, except for rounding */
        assert_true(low[0] > least && low[1] > least && high[0] < 160 - least && high[1] < 120 - least);
        /* The body fits tightly in one direction. */
        assert_true(low[0] < most || low[1] < most);
    }
}

TEST(axes_point_where_the_header_says) {
    picture_scene scene = facing_scene();
    picture_options options = front_view(PICTURE_SMOOTH);
    double origin[2], x[2], up[2];
    for (int y_up = 0; y_up < 2; y_up++) {
        options.y_up = y_up != 0;
        project_point(&scene, &options, (const double[]){0, 0, 0}, origin);
        project_point(&scene, &options, (const double[]){0.1, 0, 0}, x);
        project_point(&scene, &options, (const double[]){0, y_up ? 0.1 : 0, y_up ? 0 : 0.1}, up);
        assert_true(x[0] > origin[0] + 1 && up[1] < origin[1] - 1);
    }
}

TEST(nearer_hides_farther_in_either_order) {
    static const double positions[] = {-1, 0.5,  -1, 1, 0.5,  -1, 0, 0.5,  1,
                                       -1, -0.5, -1, 1, -0.5, -1, 0, -0.5, 1};
    static const uint32_t orders[2][6] = {{0, 1, 2, 3, 4, 5}, {3, 4, 5, 0, 1, 2}};
    picture_options options = front_view(PICTURE_UNLIT);
    for (int order = 0; order < 2; order++) {
        uint8_t colours[6];
        memcpy(colours + 3 * order, red, 3);
        memcpy(colours + 3 - 3 * order, green, 3);
        picture_scene scene = scene_of(6, positions, 2, orders[order]);
        scene.triangle_colours = colours;
        picture_image image = render_scene(&scene, &options);
        assert_memory_equal(middle_pixel(&image), green, 3);
        picture_image_free(&image);
    }
}

TEST(back_faces_are_tinted) {
    picture_scene scene = facing_scene();
    picture_options options = front_view(PICTURE_SMOOTH);
    scene.triangle_colours = blue;
    picture_image front = render_scene(&scene, &options);
    options.azimuth = 180.0;
    picture_image back = render_scene(&scene, &options);
    assert_true(middle_pixel(&front)[2] > middle_pixel(&front)[0]);
    assert_true(middle_pixel(&back)[0] > middle_pixel(&back)[2]);
    picture_image_free(&front);
    picture_image_free(&back);
}

/* A square of slivers that fan out from a point on its lower side: no sample may fall between two triangles.
 */
TEST(neighbours_leave_no_gap) {
    enum { slivers = 300 };
    static double positions[3 * (slivers + 2)];
    static uint32_t triangles[3 * slivers];
    positions[0] = 0.13, positions[2] = -1.0;
    for (uint32_t i = 0; i <= slivers; i++) {
        positions[3 * i + 3] = 1.0 - 2.0 * i / slivers;
        positions[3 * i + 4] = 0.3 * (i % 7);
        positions[3 * i + 5] = 1.0;
        if (i == slivers) break;
        triangles[3 * i + 1] = i + 1;
        triangles[3 * i + 2] = i + 2;
    }
    picture_scene scene = scene_of(slivers + 2, positions, slivers, triangles);
    picture_options options = front_view(PICTURE_UNLIT);
    picture_image image = render_scene(&scene, &options);
    for (double x = 0.35; x < 0.65; x += 0.004)
        for (double y = 0.26; y < 0.4; y += 0.005)
            assert_memory_equal(pixel_at(&image, x * 160, y * 120), pixel_at(&image, 80, 30), 4);
    assert_memory_not_equal(pixel_at(&image, 80, 30), pixel_at(&image, 0, 0), 4);
    picture_image_free(&image);
}

/* The middle column of samples lies exactly on the edge that the two triangles share. */
TEST(shared_edge_is_drawn) {
    static const double positions[] = {0, 0, -1, 0, 0, 1, -1, 0, 0, 1, 0, 0};
    static const uint32_t triangles[] = {0, 1, 2, 1, 0, 3};
    picture_scene scene = scene_of(4, positions, 2, triangles);
    picture_options options = front_view(PICTURE_UNLIT);
    options.width = 161, options.samples = 1;
    picture_image image = render_scene(&scene, &options);
    for (double y = 20; y < 100; y++)
        assert_memory_equal(pixel_at(&image, 80, y), pixel_at(&image, 82, 60), 4);
    assert_memory_not_equal(pixel_at(&image, 82, 60), pixel_at(&image, 0, 0), 4);
    picture_image_free(&image);
}

TEST(cube_keeps_its_creases) {
    double positions[24];
    for (int i = 0; i < 24; i++) positions[i] = i / 3 >> i % 3 & 1;
    static const uint32_t triangles[] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                         2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    picture_scene scene = scene_of(8, positions, 12, triangles);
    picture_options options = front_view(PICTURE_SMOOTH);
    options.azimuth = options.elevation = 30.0;
    picture_image smooth = render_scene(&scene, &options);
    options.shading = PICTURE_FLAT;
    picture_image flat = render_scene(&scene, &options);
    for (size_t i = 0; i < (size_t)4 * 160 * 120; i++)
        assert_true(abs(smooth.pixels[i] - flat.pixels[i]) <= 1);
    picture_image_free(&smooth);
    picture_image_free(&flat);
}

TEST(wires_darken_the_edges) {
    picture_scene scene = facing_scene();
    picture_options options = front_view(PICTURE_SMOOTH);
    picture_image plain = render_scene(&scene, &options);
    options.wire = true;
    picture_image wired = render_scene(&scene, &options);
    double edge[2];
    project_point(&scene, &options, (const double[]){0, 0, -1}, edge);
    assert_true(pixel_at(&wired, edge[0], edge[1] - 0.5)[0] <
                pixel_at(&plain, edge[0], edge[1] - 0.5)[0] - 20);
    assert_memory_equal(middle_pixel(&wired), middle_pixel(&plain), 4);
    picture_image_free(&plain);
    picture_image_free(&wired);
}

TEST(marker_appears_where_it_projects) {
    picture_marker markers[] = {{{0.3, 0.0, -0.4}, 6.0f, {40, 60, 220, 255}},
                                {{-0.3, 2.0, -0.4}, 6.0f, {40, 60, 220, 255}}};
    picture_scene scene = facing_scene();
    picture_options options = front_view(PICTURE_UNLIT);
    scene.markers = markers, scene.marker_count = 2;
    picture_image image = render_scene(&scene, &options);
    double visible[2], hidden[2];
    project_point(&scene, &options, markers[0].position, visible);
    project_point(&scene, &options, markers[1].position, hidden);
    assert_memory_equal(pixel_at(&image, visible[0], visible[1]), blue, 3);
    assert_memory_equal(pixel_at(&image, visible[0], visible[1] - 12), red, 3);
    for (int i = 0; i < 3; i++)
        assert_true(abs(pixel_at(&image, hidden[0], hidden[1])[i] - (red[i] + blue[i]) / 2) <= 1);
    picture_image_free(&image);
}

TEST(ground_under_and_behind_the_camera_is_drawn) {
    static const double positions[] = {-1000, -1000, -1, 1000, -1000, -1, 1000, 1000, -1, -1000, 1000, -1};
    static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
    picture_marker behind = {{0, -500, 0}, 5.0f, {0, 0, 0, 255}};
    picture_scene scene = scene_of(4, positions, 2, triangles);
    scene.markers = &behind, scene.marker_count = 1;
    picture_options options = front_view(PICTURE_SMOOTH);
    options.wire = options.focus = true;
    memcpy(options.focus_min, (const double[]){-1, -1, -1}, sizeof options.focus_min);
    memcpy(options.focus_max, (const double[]){1, 1, 1}, sizeof options.focus_max);
    const uint8_t white[] = {255, 255, 255, 255};
    picture_image image = render_scene(&scene, &options);
    for (double x = 0; x < 160; x++) {
        assert_memory_equal(pixel_at(&image, x, 20), white, 4);
        assert_memory_not_equal(pixel_at(&image, x, 119), white, 4);
    }
    picture_image_free(&image);
}

TEST(caption_and_legend_are_written) {
    const picture_legend legend = {{220, 40, 30}, "VF"};
    picture_scene scene = {.caption = "frame 44", .legend = &legend, .legend_count = 1};
    picture_options options = front_view(PICTURE_SMOOTH);
    picture_image image = render_scene(&scene, &options);
    int dark = 0, reddish = 0;
    for (size_t i = 0; i < (size_t)160 * 120; i++) {
        dark += image.pixels[4 * i] < 64;
        reddish += image.pixels[4 * i] > 200 && image.pixels[4 * i + 1] < 64;
    }
    assert_true(dark > 60 && dark < 400 && reddish > 5);
    picture_image_free(&image);
}

TEST(same_scene_same_pixels) {
    picture_scene scene = facing_scene();
    picture_options options = picture_options_defaults();
    picture_image first = render_scene(&scene, &options), second = render_scene(&scene, &options);
    assert_memory_equal(first.pixels, second.pixels, (size_t)4 * 1280 * 960);
    picture_image_free(&first);
    picture_image_free(&second);
}

TEST(bad_requests_are_refused) {
    static const uint32_t wild[] = {0, 1, 3};
    picture_image image;
    io_error error;
    picture_scene scene = facing_scene();
    picture_options options = front_view(PICTURE_SMOOTH);
    scene.triangles = wild;
    assert_false(picture_render_image(&scene, &options, &image, &error));
    assert_non_null(strstr(error.text, "vertex 3"));
    scene.triangles = facing_triangle;
    options.width = 0;
    assert_false(picture_render_image(&scene, &options, &image, &error));
    options.width = PICTURE_SIDE_MAX + 1;
    assert_false(picture_render_image(&scene, &options, &image, &error));
    options.width = 10, options.samples = PICTURE_SAMPLES_MAX + 1;
    assert_false(picture_render_image(&scene, &options, &image, NULL));
}

TEST(colour_map_ends_and_clamps) {
    uint8_t low[3], high[3], outside[3];
    picture_colour_map(0.0, low);
    picture_colour_map(1.0, high);
    assert_true(low[2] > low[1] && high[0] > 240 && high[1] > 220);
    picture_colour_map(-7.0, outside);
    assert_memory_equal(outside, low, 3);
    picture_colour_map(7.0, outside);
    assert_memory_equal(outside, high, 3);
}

TEST(png_reads_back_the_same) {
    temp_folder folder = temp_folder_make();
    temp_path path = temp_file_path(&folder, "a.png");
    picture_scene scene = facing_scene();
    picture_options options = front_view(PICTURE_SMOOTH);
    options.transparent = true;
    picture_image image = render_scene(&scene, &options);
    assert_true(picture_render(&scene, &options, path.text, NULL));
    png_image file = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_file(&file, path.text));
    file.format = PNG_FORMAT_RGBA;
    uint8_t *pixels = malloc(PNG_IMAGE_SIZE(file));
    assert_non_null(pixels);
    assert_true(png_image_finish_read(&file, NULL, pixels, 0, NULL));
    assert_true(file.width == 160 && file.height == 120);
    assert_memory_equal(pixels, image.pixels, (size_t)4 * 160 * 120);
    free(pixels);
    picture_image_free(&image);
    temp_folder_remove(&folder);
}

TEST(failed_writes_leave_no_file) {
    temp_folder folder = temp_folder_make();
    temp_path missing = temp_file_path(&folder, "missing/a.png"), path = temp_file_path(&folder, "a.png");
    io_error error = {""};
    picture_scene scene = facing_scene();
    picture_options options = front_view(PICTURE_SMOOTH);
    assert_false(picture_render(&scene, &options, missing.text, &error));
    assert_non_null(strstr(error.text, missing.text));
    assert_non_null(strstr(error.text, "No such file"));

    /* The file system takes the first bytes and then no more. */
    struct rlimit before, tight;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    tight = before;
    tight.rlim_cur = 100;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &tight), 0);
    bool written = picture_render(&scene, &options, path.text, &error);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    signal(SIGXFSZ, SIG_DFL);
    assert_false(written);
    assert_non_null(strstr(error.text, path.text));
    assert_non_null(strstr(error.text, "File too large"));
    assert_int_equal(access(path.text, F_OK), -1);
    temp_folder_remove(&folder);
}
