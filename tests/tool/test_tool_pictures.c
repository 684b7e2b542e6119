/* Pictures and pages for people with files of many programs: which way is up, how near a zoom goes, what a page is called. */
#include "tests/support/test.h"
#include "tests/support/tool/run_tool.h"
#include "tests/support/tool/tool_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 8 };

static temp_folder folder;
static temp_path model, cache, png, page;

static int make_files(void **state) {
    (void)state;
    folder = temp_folder_make();
    recorded flight = recorded_tetrahedra(FRAMES);
    model = recorded_write_mesh(&folder, "flight.obj", &flight, 0);
    cache = recorded_write_cache(&folder, "flight.pc2", &flight);
    png = temp_file_path(&folder, "out.png");
    page = temp_file_path(&folder, "out.html");
    recorded_free(&flight);
    return 0;
}

static int remove_files(void **state) {
    (void)state;
    temp_folder_remove(&folder);
    return 0;
}

typedef struct drawn {
    char *bytes;
    size_t size;
} drawn;

/* The picture that render draws of a frame with up to three more arguments. */
static drawn draw_scene(const char *mesh, const char *frames, const char *first, const char *second,
                        const char *third) {
    drawn picture;
    EXPECT_TOOL(0, "render", mesh, frames, "--frame", "3", "-o", png.text, "--size", "160x120", first, second,
                third);
    picture.bytes = read_whole_file(png.text, &picture.size);
    return picture;
}

static bool same_picture(drawn a, drawn b) {
    bool same = a.size == b.size && memcmp(a.bytes, b.bytes, a.size) == 0;
    free(a.bytes);
    free(b.bytes);
    return same;
}

/* OBJ stands on y, as exporters write it; PLY on z. */
static void the_format_says_what_is_up(void **state) {
    (void)state;
    recorded flight = recorded_tetrahedra(FRAMES);
    temp_path ply = recorded_write_mesh(&folder, "flight.ply", &flight, 0);
    recorded_free(&flight);
    assert_true(same_picture(draw_scene(model.text, cache.text, NULL, NULL, NULL),
                             draw_scene(model.text, cache.text, "--up", "y", NULL)));
    assert_false(same_picture(draw_scene(model.text, cache.text, NULL, NULL, NULL),
                              draw_scene(model.text, cache.text, "--up", "z", NULL)));
    assert_true(same_picture(draw_scene(ply.text, cache.text, NULL, NULL, NULL),
                             draw_scene(ply.text, cache.text, "--up", "z", NULL)));
    const struct {
        const char *mesh, *option, *value, *expected;
    } cases[] = {{model.text, NULL, NULL, "\"up\":\"y\""},
                 {model.text, "--up", "z", "\"up\":\"z\""},
                 {ply.text, NULL, NULL, "\"up\":\"z\""},
                 {ply.text, "--up", "y", "\"up\":\"y\""}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        EXPECT_TOOL(0, "replay", cases[i].mesh, cache.text, "--quiet", "--report", page.text, cases[i].option,
                    cases[i].value);
        char *text = read_whole_file(page.text, NULL);
        assert_non_null(strstr(text, cases[i].expected));
        free(text);
    }
}

/* A zoom to one contact shows what is around it, and the same wherever the body stands. */
static void a_zoom_does_not_depend_on_the_origin(void **state) {
    (void)state;
    recorded flight = recorded_tetrahedra(FRAMES);
    for (size_t i = 0; i < (size_t)FRAMES * flight.vertex_count * 3; i++) flight.frames[i] += 1024.0;
    temp_path far_model = recorded_write_mesh(&folder, "far.obj", &flight, 0);
    temp_path far_cache = recorded_write_cache(&folder, "far.pc2", &flight);
    recorded_free(&flight);
    drawn near = draw_scene(model.text, cache.text, "--colour=contacts", "--zoom", NULL);
    drawn far = draw_scene(far_model.text, far_cache.text, "--colour=contacts", "--zoom", NULL);
    drawn whole = draw_scene(model.text, cache.text, "--colour=contacts", NULL, NULL);
    drawn copy = {malloc(near.size), near.size};
    memcpy(copy.bytes, near.bytes, near.size);
    assert_false(same_picture(copy, whole));
    assert_true(same_picture(near, far));
}

/* A twentieth of the body on each side of the contact is in view: a flake there is seen, and one far away is not. */
static void a_zoom_shows_a_tenth_of_the_body(void **state) {
    (void)state;
    static const struct {
        const char *text;
        bool seen;
    } cases[] = {{"v 0.2 1 1.15\nv 0.2 1.05 1.2\nv 0.2 0.95 1.2\nf 1 2 3\n", true},
                 {"v 0.2 5 1.15\nv 0.2 5.05 1.2\nv 0.2 4.95 1.2\nf 1 2 3\n", false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        temp_path flake = temp_file_write(&folder, "flake.obj", cases[i].text, strlen(cases[i].text));
        drawn alone = draw_scene(model.text, cache.text, "--colour=contacts", "--zoom", NULL);
        EXPECT_TOOL(0, "render", model.text, cache.text, "--frame", "3", "-o", png.text, "--size", "160x120",
                    "--colour=contacts", "--zoom", "--scenery", flake.text);
        drawn with = {.bytes = NULL};
        with.bytes = read_whole_file(png.text, &with.size);
        assert_int_equal(same_picture(alone, with), !cases[i].seen);
    }
}

/* render leaves out what replay leaves out. */
static void pictures_leave_out_what_the_rules_say(void **state) {
    (void)state;
    assert_false(same_picture(
        draw_scene(model.text, cache.text, "--colour=contacts", NULL, NULL),
        draw_scene(model.text, cache.text, "--colour=contacts", "--ignore-parts=component 1", NULL)));
    EXPECT_ERROR(1, TEXTS("no part", "component 0"), "render", model.text, cache.text, "-o", png.text,
                 "--only", "Shirt");
}

static void pages_have_a_title_and_seconds(void **state) {
    (void)state;
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--quiet", "--report", page.text);
    char *text = read_whole_file(page.text, NULL);
    assert_non_null(strstr(text, "\"title\":\"flight.obj\""));
    assert_non_null(strstr(text, "\"fps\":null"));
    free(text);
    EXPECT_TOOL(0, "replay", model.text, cache.text, "--quiet", "--report", page.text, "--title", "Shot <12>",
                "--fps", "25");
    text = read_whole_file(page.text, NULL);
    assert_non_null(strstr(text, "\"title\":\"Shot \\u003c12>\""));
    assert_non_null(strstr(text, "\"fps\":25"));
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_format_says_what_is_up),
        cmocka_unit_test(a_zoom_does_not_depend_on_the_origin),
        cmocka_unit_test(a_zoom_shows_a_tenth_of_the_body),
        cmocka_unit_test(pictures_leave_out_what_the_rules_say),
        cmocka_unit_test(pages_have_a_title_and_seconds),
    };
    return cmocka_run_group_tests(tests, make_files, remove_files);
}
