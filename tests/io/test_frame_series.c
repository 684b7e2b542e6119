/* What frames are called, in which order listed files come, which one is missing, and when the model is a frame. */
#include "tests/support/io/frame_fixture.h"
#include "tests/support/test.h"

#include <stdint.h>
#include <string.h>
#include <unistd.h>

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

TEST(lists_are_taken_in_the_order_of_their_numbers) {
    const listed_files files = {{"f_1.obj", "f_10.obj", "f_11.obj", "f_2.obj"}, {1, 10, 11, 2}};
    io_error error;
    animation *opened = open_listed(&files, -1, true, &error);
    check_opened(opened, (const uint32_t[]){1, 2, 10, 11}, (const int32_t[]){1, 2, 10, 11}, 4);
    assert_non_null(strstr(animation_note(opened), "in the order of their numbers"));
    animation_close(opened);
}

TEST(sorted_lists_need_no_note) {
    const listed_files files = {{"f_09.obj", "f_10.obj", "f_11.obj"}, {9, 10, 11}};
    io_error error;
    animation *opened = open_listed(&files, -1, false, &error);
    check_opened(opened, (const uint32_t[]){9, 10, 11}, (const int32_t[]){9, 10, 11}, 3);
    assert_null(animation_note(opened));
    animation_close(opened);
}

TEST(names_that_differ_in_two_numbers_stay_as_given) {
    const listed_files files = {{"s2_f1.obj", "s1_f2.obj", "s1_f1.obj"}, {21, 12, 11}};
    io_error error;
    animation *opened = open_listed(&files, -1, false, &error);
    check_opened(opened, (const uint32_t[]){21, 12, 11}, (const int32_t[]){0, 1, 2}, 3);
    assert_non_null(strstr(animation_note(opened), "in the order given"));
    animation_close(opened);
}

TEST(regular_steps_are_no_gaps) {
    const listed_files files = {{"f1003.obj", "f1001.obj", "f1005.obj"}, {3, 1, 5}};
    io_error error;
    animation *opened = open_listed(&files, -1, false, &error);
    check_opened(opened, (const uint32_t[]){1, 3, 5}, (const int32_t[]){1001, 1003, 1005}, 3);
    animation_close(opened);
}

TEST(missing_members_are_named) {
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

TEST(a_missing_member_in_steps_says_the_step) {
    const listed_files files = {{"f1.obj", "f3.obj", "f7.obj"}, {0}};
    io_error error;
    assert_null(open_listed(&files, -1, false, &error));
    frame_fixture_check_error(&error, "f5.obj: missing", "in steps of 2", NULL);
}

TEST(folders_and_patterns_have_gaps_and_numbers_too) {
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

/* ---- negative numbers -------------------------------------------------------------------------------- */

/* A sign stands behind a dot, an underscore or another '-'; elsewhere a '-' only separates. */
TEST(signs_count) {
    static const struct {
        listed_files files;
        int32_t numbers[4];
    } cases[] = {
        {{{"f.-0002.obj", "f.-0001.obj", "f.0000.obj", "f.0001.obj"}, {1, 2, 3, 4}}, {-2, -1, 0, 1}},
        {{{"g_-2.ply", "g_-1.ply", "g_0.ply", "g_1.ply"}, {1, 2, 3, 4}}, {-2, -1, 0, 1}},
        {{{"walk--020.obj", "walk--010.obj", "walk-000.obj", "walk-010.obj"}, {1, 2, 3, 4}},
         {-20, -10, 0, 10}},
        {{{"-4.obj", "-3.obj", "-2.obj", "-1.obj"}, {1, 2, 3, 4}}, {-4, -3, -2, -1}},
        {{{"run-1.obj", "run-2.obj", "run-3.obj", "run-4.obj"}, {1, 2, 3, 4}}, {1, 2, 3, 4}},
        {{{"2024-06-1.obj", "2024-06-2.obj", "2024-06-3.obj", "2024-06-4.obj"}, {1, 2, 3, 4}}, {1, 2, 3, 4}},
    };
    static const uint32_t in_order[] = {1, 2, 3, 4};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        listed_files turned = {{NULL}, {0}};
        for (int k = 0; k < 4; k++) {
            turned.names[k] = cases[i].files.names[(k + 2) % 4];
            turned.frames[k] = cases[i].files.frames[(k + 2) % 4];
        }
        for (int model = -1; model < 4; model++) {
            io_error error;
            animation *opened = open_listed(&turned, model, false, &error);
            check_opened(opened, in_order, cases[i].numbers, 4);
            animation_close(opened);
        }
    }
}

TEST(folders_and_patterns_have_negative_numbers) {
    static const char *const names[][4] = {{"f.-0002.obj", "f.-0001.obj", "f.0000.obj", "f.0001.obj"},
                                           {"f.-002.obj", "f.-001.obj", "f.0000.obj", "f.0001.obj"}};
    static const uint32_t in_order[] = {1, 2, 3, 4};
    for (size_t i = 0; i < 2; i++) {
        temp_path paths[4];
        for (uint32_t k = 0; k < 4; k++) paths[k] = write_frame(names[i][k], k + 1);
        const temp_path pattern = temp_file_path(&frame_fixture_folder, "f.%04d.obj");
        const char *const sources[] = {pattern.text, frame_fixture_folder.path};
        for (size_t k = 0; k < 2; k++) {
            animation *opened = frame_fixture_open(sources[k], VERTICES);
            check_opened(opened, in_order, (const int32_t[]){-2, -1, 0, 1}, 4);
            animation_close(opened);
        }
        for (uint32_t k = 0; k < 4; k++) assert_int_equal(unlink(paths[k].text), 0);
    }
    /* A pattern knows where its number is, whatever stands before the sign. */
    write_frame("h-10.obj", 1);
    write_frame("h-5.obj", 2);
    write_frame("h0.obj", 3);
    const temp_path pattern = temp_file_path(&frame_fixture_folder, "h%d.obj");
    animation *opened = frame_fixture_open(pattern.text, VERTICES);
    check_opened(opened, in_order, (const int32_t[]){-10, -5, 0}, 3);
    animation_close(opened);
}

TEST(missing_negative_numbers_are_named) {
    io_error error;
    const listed_files files = {{"f.-0003.obj", "f.-0001.obj", "f.0000.obj"}, {0}};
    assert_null(open_listed(&files, -1, false, &error));
    frame_fixture_check_error(&error, "f.-0002.obj: missing", NULL);
    const temp_path wide = temp_file_path(&frame_fixture_folder, "f.%04d.obj");
    frame_fixture_open_fails(wide.text, VERTICES, &error);
    frame_fixture_check_error(&error, "f.-0002.obj: missing", NULL);
    write_frame("p-03.obj", 1);
    write_frame("p-01.obj", 1);
    write_frame("p000.obj", 1);
    const temp_path pattern = temp_file_path(&frame_fixture_folder, "p%03d.obj");
    frame_fixture_open_fails(pattern.text, VERTICES, &error);
    frame_fixture_check_error(&error, "p-02.obj: missing", NULL);
    write_frame("p-001.obj", 1);
    write_frame("p-02.obj", 1);
    frame_fixture_open_fails(pattern.text, VERTICES, &error);
    frame_fixture_check_error(&error, "both p-001.obj and p-01.obj are frame -1", NULL);
}

/* ---- subframes --------------------------------------------------------------------------------------- */

TEST(subframes_are_taken_by_their_times) {
    static const listed_files cases[] = {
        {{"f.0001.00.obj", "f.0001.50.obj", "f.0002.00.obj", "f.0002.50.obj"}, {1, 2, 3, 4}},
        {{"g_8.250.obj", "g_8.500.obj", "g_9.000.obj", "g_10.000.obj"}, {1, 2, 3, 4}},
        {{"h.-0001.5.obj", "h.-0001.0.obj", "h.-0000.5.obj", "h.0000.0.obj"}, {1, 2, 3, 4}},
    };
    static const uint32_t in_order[] = {1, 2, 3, 4};
    static const int32_t numbers[] = {0, 1, 2, 3};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        listed_files turned = {{NULL}, {0}};
        for (int k = 0; k < 4; k++) {
            turned.names[k] = cases[i].names[(3 * k + 1) % 4];
            turned.frames[k] = cases[i].frames[(3 * k + 1) % 4];
        }
        for (int model = -1; model < 4; model++) {
            io_error error;
            animation *opened = open_listed(&turned, model, true, &error);
            check_opened(opened, in_order, numbers, 4);
            assert_non_null(strstr(animation_note(opened), "these have fractions"));
            animation_close(opened);
        }
    }
}

TEST(folders_have_subframes_and_gaps) {
    write_frame("f.0001.00.obj", 1);
    write_frame("f.0001.50.obj", 2);
    const temp_path third = write_frame("f.0002.00.obj", 3);
    write_frame("f.0002.50.obj", 4);
    animation *opened = frame_fixture_open(frame_fixture_folder.path, VERTICES);
    check_opened(opened, (const uint32_t[]){1, 2, 3, 4}, (const int32_t[]){0, 1, 2, 3}, 4);
    assert_non_null(animation_note(opened));
    animation_close(opened);
    assert_int_equal(unlink(third.text), 0);
    io_error error;
    frame_fixture_open_fails(frame_fixture_folder.path, VERTICES, &error);
    frame_fixture_check_error(&error, "f.0001.50.obj: is not followed by the next frame but by f.0002.50.obj",
                              "--allow-gaps", NULL);
}

/* ---- the model --------------------------------------------------------------------------------------- */

/* Words are no series: what is named first is looked at first. */
/* 1.5 before 2.25: as numbers without their point, 15 and 225, they would lie in steps of 210. */
TEST(fractions_of_other_lengths_are_no_subframes) {
    write_frame("f_1.5.obj", 1);
    write_frame("f_2.25.obj", 2);
    io_error error;
    frame_fixture_open_fails(frame_fixture_folder.path, VERTICES, &error);
    frame_fixture_check_error(&error, "f_1.5.obj and f_2.25.obj", "differ in one number only", NULL);
}

TEST(a_model_among_words_is_the_first_frame) {
    static const listed_files cases[] = {
        {{"crouch.obj", "run.obj", "stand.obj", "walk.obj"}, {1, 2, 3, 4}},
        {{"s2_f1.obj", "s1_f2.obj", "s1_f1.obj", "x.obj"}, {1, 2, 3, 4}},
        {{"a.obj", "b.obj"}, {1, 2}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        io_error error;
        animation *opened = open_listed(&cases[i], 0, false, &error);
        check_opened(opened, (const uint32_t[]){1, 2, 3, 4}, (const int32_t[]){0, 1, 2, 3}, i == 2 ? 2 : 4);
        assert_non_null(strstr(animation_note(opened), "in the order given, the model first"));
        animation_close(opened);
    }
}

TEST(a_model_of_the_series_is_a_frame) {
    const listed_files files = {{"f_1.obj", "f_10.obj", "f_2.obj"}, {1, 10, 2}};
    io_error error;
    for (int model = 0; model < 3; model++) {
        animation *opened = open_listed(&files, model, true, &error);
        check_opened(opened, (const uint32_t[]){1, 2, 10}, (const int32_t[]){1, 2, 10}, 3);
        animation_close(opened);
    }
}

TEST(a_model_that_is_listed_too_is_a_frame_once) {
    const temp_path first = write_frame("f_1.obj", 1), second = write_frame("f_2.obj", 2);
    const char *const paths[] = {second.text, first.text};
    const animation_options options = {.model_path = first.text};
    animation *opened = NULL;
    io_error error;
    assert_true(animation_open(paths, 2, VERTICES, &options, &opened, &error));
    check_opened(opened, (const uint32_t[]){1, 2}, (const int32_t[]){1, 2}, 2);
    animation_close(opened);
}

TEST(other_models_are_no_frames) {
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

TEST(pc2_headers_say_what_frames_are_called) {
    check_pc2_numbers(1001.0f, 1.0f, (const int32_t[]){1001, 1002, 1003});
    check_pc2_numbers(-5.0f, 2.0f, (const int32_t[]){-5, -3, -1});
    check_pc2_numbers(1.0f, 0.5f, (const int32_t[]){0, 1, 2});
    check_pc2_numbers(0.25f, 1.0f, (const int32_t[]){0, 1, 2});
    check_pc2_numbers(3.0f, 0.0f, (const int32_t[]){0, 1, 2});
    check_pc2_numbers(-3e9f, 1.0f, (const int32_t[]){0, 1, 2});
    check_pc2_numbers(0.0f, 2e9f, (const int32_t[]){0, 1, 2});
    check_pc2_numbers(0.0f / 0.0f, 1.0f, (const int32_t[]){0, 1, 2});
}

AROUND_EACH(frame_fixture_make_folder, frame_fixture_remove_folder)
