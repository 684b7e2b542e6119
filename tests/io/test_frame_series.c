/* What frames are called, in which order listed files come, which one is missing, and when the model is a frame. */
#include "tests/support/io/frame_fixture.h"
#include "tests/support/test.h"

#include <stdint.h>
#include <string.h>

enum { VERTICES = 4, LISTED_MAX = 8 };

static temp_path write_frame(const char *name, uint32_t frame) {
    return frame_fixture_write_mesh(&frame_fixture_folder, name, VERTICES, frame);
}

/* Names of files, each written with the contents of a frame: the same number. */
typedef struct listed_files {
    const char *names[LISTED_MAX];
    uint32_t frames[LISTED_MAX];
} listed_files;

/* Writes the files and opens their list. model: which of them is the model and not listed; -1: none. NULL, with a
 * reason, when they are refused. */
static animation *open_listed(const listed_files *files, int model, bool allow_gaps, io_error *error) {
    static temp_path paths[LISTED_MAX];
    const char *texts[LISTED_MAX];
    size_t count = 0;
    animation_options options = {.allow_gaps = allow_gaps};
    for (int i = 0; i < LISTED_MAX && files->names[i] != NULL; i++) {
        paths[i] = write_frame(files->names[i], files->frames[i]);
        if (i == model)
            options.model_path = paths[i].text;
        else
            texts[count++] = paths[i].text;
    }
    animation *opened = NULL;
    error->text[0] = '\0';
    return animation_open(texts, count, VERTICES, &options, &opened, error) ? opened : NULL;
}

/* The frames hold what was written as `expected`, and are called `numbers`. */
static void check_opened(animation *opened, const uint32_t *expected, const int32_t *numbers,
                         uint32_t count) {
    assert_non_null(opened);
    assert_int_equal(animation_frame_count(opened), count);
    for (uint32_t i = 0; i < count; i++) {
        frame_fixture_check(opened, VERTICES, i, expected[i]);
        assert_int_equal(animation_frame_number(opened, i), numbers[i]);
    }
}

static void lists_are_taken_in_the_order_of_their_numbers(void **state) {
    (void)state;
    const listed_files files = {{"f_1.obj", "f_10.obj", "f_11.obj", "f_2.obj"}, {1, 10, 11, 2}};
    io_error error;
    animation *opened = open_listed(&files, -1, true, &error);
    check_opened(opened, (const uint32_t[]){1, 2, 10, 11}, (const int32_t[]){1, 2, 10, 11}, 4);
    assert_non_null(strstr(animation_note(opened), "in the order of their numbers"));
    animation_close(opened);
}

static void sorted_lists_need_no_note(void **state) {
    (void)state;
    const listed_files files = {{"f_09.obj", "f_10.obj", "f_11.obj"}, {9, 10, 11}};
    io_error error;
    animation *opened = open_listed(&files, -1, false, &error);
    check_opened(opened, (const uint32_t[]){9, 10, 11}, (const int32_t[]){9, 10, 11}, 3);
    assert_null(animation_note(opened));
    animation_close(opened);
}

static void names_that_differ_in_two_numbers_stay_as_given(void **state) {
    (void)state;
    const listed_files files = {{"s2_f1.obj", "s1_f2.obj", "s1_f1.obj"}, {21, 12, 11}};
    io_error error;
    animation *opened = open_listed(&files, -1, false, &error);
    check_opened(opened, (const uint32_t[]){21, 12, 11}, (const int32_t[]){0, 1, 2}, 3);
    assert_non_null(strstr(animation_note(opened), "in the order given"));
    animation_close(opened);
}

static void regular_steps_are_no_gaps(void **state) {
    (void)state;
    const listed_files files = {{"f1003.obj", "f1001.obj", "f1005.obj"}, {3, 1, 5}};
    io_error error;
    animation *opened = open_listed(&files, -1, false, &error);
    check_opened(opened, (const uint32_t[]){1, 3, 5}, (const int32_t[]){1001, 1003, 1005}, 3);
    animation_close(opened);
}

static void missing_members_are_named(void **state) {
    (void)state;
    static const struct {
        listed_files files;
        const char *missing;
    } cases[] = {
        {{{"a1.obj", "a2.obj", "a4.obj"}, {0}}, "a3.obj: missing, expected all frames from"},
        {{{"b0008.obj", "b0009.obj", "b0011.obj"}, {0}}, "b0010.obj: missing"},
        {{{"c1.obj", "c3.obj", "c7.obj", "c9.obj"}, {0}}, "c5.obj: missing"},
        {{{"d98.obj", "d99.obj", "d101.obj"}, {0}}, "d100.obj: missing"},
        {{{"e07_v2.obj", "e08_v2.obj", "e10_v2.obj"}, {0}}, "e09_v2.obj: missing"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        io_error error;
        assert_null(open_listed(&cases[i].files, -1, false, &error));
        frame_fixture_check_error(&error, cases[i].missing, "--allow-gaps", NULL);
        animation *opened = open_listed(&cases[i].files, -1, true, &error);
        assert_non_null(opened);
        animation_close(opened);
    }
}

static void a_missing_member_in_steps_says_the_step(void **state) {
    (void)state;
    const listed_files files = {{"f1.obj", "f3.obj", "f7.obj"}, {0}};
    io_error error;
    assert_null(open_listed(&files, -1, false, &error));
    frame_fixture_check_error(&error, "f5.obj: missing", "in steps of 2", NULL);
}

static void folders_and_patterns_have_gaps_and_numbers_too(void **state) {
    (void)state;
    write_frame("g_0101.obj", 1);
    write_frame("g_0103.obj", 3);
    write_frame("g_0104.obj", 4);
    const temp_path pattern = temp_file_path(&frame_fixture_folder, "g_%04d.obj");
    const char *const sources[] = {pattern.text, frame_fixture_folder.path};
    for (size_t i = 0; i < 2; i++) {
        io_error error;
        frame_fixture_open_fails(sources[i], VERTICES, &error);
        frame_fixture_check_error(&error, frame_fixture_folder.path, "/g_0102.obj: missing", NULL);
        const animation_options options = {.allow_gaps = true};
        animation *opened = NULL;
        assert_true(animation_open(&sources[i], 1, VERTICES, &options, &opened, &error));
        check_opened(opened, (const uint32_t[]){1, 3, 4}, (const int32_t[]){101, 103, 104}, 3);
        animation_close(opened);
    }
}

/* ---- the model --------------------------------------------------------------------------------------- */

static void a_model_of_the_series_is_a_frame(void **state) {
    (void)state;
    const listed_files files = {{"f_1.obj", "f_10.obj", "f_2.obj"}, {1, 10, 2}};
    io_error error;
    for (int model = 0; model < 3; model++) {
        animation *opened = open_listed(&files, model, true, &error);
        check_opened(opened, (const uint32_t[]){1, 2, 10}, (const int32_t[]){1, 2, 10}, 3);
        animation_close(opened);
    }
}

static void a_model_that_is_listed_too_is_a_frame_once(void **state) {
    (void)state;
    const temp_path first = write_frame("f_1.obj", 1), second = write_frame("f_2.obj", 2);
    const char *const paths[] = {second.text, first.text};
    const animation_options options = {.model_path = first.text};
    animation *opened = NULL;
    io_error error;
    assert_true(animation_open(paths, 2, VERTICES, &options, &opened, &error));
    check_opened(opened, (const uint32_t[]){1, 2}, (const int32_t[]){1, 2}, 2);
    animation_close(opened);
}

static void other_models_are_no_frames(void **state) {
    (void)state;
    static const char *const models[] = {"rest.obj", "f_1.off", "f_1_v2.obj", "g_1.obj"};
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        const listed_files files = {{models[i], "f_2.obj", "f_3.obj"}, {7, 2, 3}};
        io_error error;
        animation *opened = open_listed(&files, 0, false, &error);
        check_opened(opened, (const uint32_t[]){2, 3}, (const int32_t[]){2, 3}, 2);
        animation_close(opened);
    }
}

/* ---- point caches ------------------------------------------------------------------------------------ */

static void check_pc2_numbers(float start, float rate, const int32_t numbers[3]) {
    frame_fixture_bytes bytes = frame_fixture_pc2(VERTICES, 3);
    frame_fixture_put_float(&bytes, 20, start, false);
    frame_fixture_put_float(&bytes, 24, rate, false);
    animation *opened =
        frame_fixture_open(frame_fixture_write(&frame_fixture_folder, "cache.pc2", &bytes).text, VERTICES);
    check_opened(opened, (const uint32_t[]){0, 1, 2}, numbers, 3);
    animation_close(opened);
}

static void pc2_headers_say_what_frames_are_called(void **state) {
    (void)state;
    check_pc2_numbers(1001.0f, 1.0f, (const int32_t[]){1001, 1002, 1003});
    check_pc2_numbers(-5.0f, 2.0f, (const int32_t[]){-5, -3, -1});
    check_pc2_numbers(1.0f, 0.5f, (const int32_t[]){0, 1, 2});
    check_pc2_numbers(0.25f, 1.0f, (const int32_t[]){0, 1, 2});
    check_pc2_numbers(3.0f, 0.0f, (const int32_t[]){0, 1, 2});
    check_pc2_numbers(-3e9f, 1.0f, (const int32_t[]){0, 1, 2});
    check_pc2_numbers(0.0f, 2e9f, (const int32_t[]){0, 1, 2});
    check_pc2_numbers(0.0f / 0.0f, 1.0f, (const int32_t[]){0, 1, 2});
}

int main(void) {
    const struct CMUnitTest tests[] = {
#define TEST(name)                                                                                           \
    cmocka_unit_test_setup_teardown(name, frame_fixture_make_folder, frame_fixture_remove_folder)
        TEST(lists_are_taken_in_the_order_of_their_numbers),
        TEST(sorted_lists_need_no_note),
        TEST(names_that_differ_in_two_numbers_stay_as_given),
        TEST(regular_steps_are_no_gaps),
        TEST(missing_members_are_named),
        TEST(a_missing_member_in_steps_says_the_step),
        TEST(folders_and_patterns_have_gaps_and_numbers_too),
        TEST(a_model_of_the_series_is_a_frame),
        TEST(a_model_that_is_listed_too_is_a_frame_once),
        TEST(other_models_are_no_frames),
        TEST(pc2_headers_say_what_frames_are_called),
    };
    return cmocka_run_group_tests_name("frame_series", tests, NULL, NULL);
}
