/* Mesh files as animations: patterns, folders and lists, their order, and everything that is wrong with them.
 */
#include "tests/support/io/frame_fixture.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { VERTICES = 4 };

static temp_path write_frame(const char *name, uint32_t frame) {
    return frame_fixture_write_mesh(&frame_fixture_folder, name, VERTICES, frame);
}

/* The animation at path has the frames expected[0..count-1]. */
static void check_frames(const char *path, const uint32_t *expected, uint32_t count) {
    animation *opened = frame_fixture_open(path, VERTICES);
    assert_int_equal(animation_frame_count(opened), count);
    for (uint32_t frame = count; frame-- > 0;) frame_fixture_check(opened, VERTICES, frame, expected[frame]);
    animation_close(opened);
}

static void check_folder_fails(const char *part, const char *name, const char *other) {
    io_error error;
    frame_fixture_open_fails(frame_fixture_folder.path, VERTICES, &error);
    frame_fixture_check_error(&error, frame_fixture_folder.path, part, name, other, NULL);
}

static void check_pattern_fails(const char *pattern, const char *part, const char *other) {
    const temp_path path = temp_file_path(&frame_fixture_folder, pattern);
    io_error error;
    frame_fixture_open_fails(path.text, VERTICES, &error);
    frame_fixture_check_error(&error, frame_fixture_folder.path, part, other, NULL);
}

/* ---- patterns ---------------------------------------------------------------------------------------- */

TEST(pattern_takes_the_numbers_in_order) {
    write_frame("f_9.obj", 9);
    write_frame("f_11.obj", 11);
    write_frame("f_10.obj", 10);
    write_frame("f_8.obj", 8);
    write_frame("f_008.obj", 90);
    write_frame("f_x-1.obj", 91);
    write_frame("f_99999999999.obj", 92);
    write_frame("g_12.obj", 93);
    write_frame("f_12.ply", 94);
    write_frame("f_12_.obj", 95);
    static const uint32_t expected[] = {8, 9, 10, 11};
    check_frames(temp_file_path(&frame_fixture_folder, "f_%d.obj").text, expected, 4);
}

TEST(pattern_pads_with_zeros) {
    write_frame("f_098.ply", 98);
    write_frame("f_099.ply", 99);
    write_frame("f_100.ply", 100);
    write_frame("f_98.ply", 1);
    write_frame("f_0098.ply", 2);
    static const uint32_t expected[] = {98, 99, 100};
    check_frames(temp_file_path(&frame_fixture_folder, "f_%03d.ply").text, expected, 3);
}

TEST(pattern_outgrows_its_width) {
    write_frame("f9.off", 9);
    write_frame("f10.off", 10);
    static const uint32_t expected[] = {9, 10};
    check_frames(temp_file_path(&frame_fixture_folder, "f%01d.off").text, expected, 2);
}

TEST(pattern_has_digits_and_percent_signs_around) {
    write_frame("10%s2_3.obj", 2);
    write_frame("10%s10_3.obj", 10);
    write_frame("10%s9_3.obj", 9);
    write_frame("10%s8_3.obj", 8);
    static const uint32_t expected[] = {8, 9, 10};
    check_pattern_fails("10%%s%d_3.obj", "10%s3_3.obj: missing", "from 10%s2_3.obj to 10%s10_3.obj");
    assert_int_equal(unlink(temp_file_path(&frame_fixture_folder, "10%s2_3.obj").text), 0);
    check_frames(temp_file_path(&frame_fixture_folder, "10%%s%d_3.obj").text, expected, 3);
}

TEST(pattern_works_in_the_current_folder) {
    write_frame("f0.obj", 0);
    write_frame("f1.obj", 1);
    char before[4096];
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(frame_fixture_folder.path), 0);
    static const uint32_t expected[] = {0, 1};
    check_frames("f%d.obj", expected, 2);
    check_frames(".", expected, 2);
    assert_int_equal(chdir(before), 0);
}

TEST(an_existing_name_is_no_pattern) {
    write_frame("f_1.obj", 1);
    static const uint32_t expected[] = {7};
    check_frames(write_frame("f_%d.obj", 7).text, expected, 1);
}

TEST(pattern_with_a_gap_names_the_missing_file) {
    write_frame("f_0001.obj", 1);
    write_frame("f_0002.obj", 2);
    write_frame("f_0005.obj", 5);
    check_pattern_fails("f_%04d.obj", "/f_0003.obj: missing", "from f_0001.obj to f_0005.obj");
}

TEST(bad_patterns_are_refused) {
    static const char *const patterns[] = {
        "f_%s.obj",    "f_%n.obj",   "f_%5d.obj", "f_%0d.obj", "f_%00d.obj",
        "f_%033d.obj", "f_%-3d.obj", "f_%ld.obj", "f_%.obj",   "f_%",
        "f_%0",        "f_%04",      "f_%*d.obj", "f_% d.obj", "f_%018446744073709551617d.obj"};
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++)
        check_pattern_fails(patterns[i], "bad pattern: another conversion", "expected one %d or %0Nd");
    check_pattern_fails("f_%d_%04d.obj", "bad pattern: a second number", "");
    check_pattern_fails("f_%%d.obj", "bad pattern: no number", "");
    check_pattern_fails("%d/f.obj", "bad pattern: a number in the folder", "");
    check_pattern_fails("f_%d.txt", "unknown extension", ".obj, .ply, .off");
    check_pattern_fails("f_%d", "unknown extension", "");
    check_pattern_fails("f_%d.obj", "no file matches", "");
    check_pattern_fails("none/f_%d.obj", "cannot open the folder", "No such file");
}

/* ---- folders ----------------------------------------------------------------------------------------- */

TEST(folder_is_in_natural_order) {
    write_frame("f2.obj", 2);
    write_frame("f10.obj", 10);
    write_frame("f1.obj", 1);
    write_frame("f0100.obj", 100);
    write_frame("f99999999999999999999999.obj", 3);
    static const uint32_t expected[] = {1, 2, 10, 100, 3};
    check_frames(frame_fixture_folder.path, expected, 5);
}

TEST(folder_ignores_other_files) {
    write_frame("take2_f2_v3.OFF", 2);
    write_frame("take2_f10_v3.OFF", 10);
    write_frame("._take2_f11_v3.OFF", 11);
    temp_file_write(&frame_fixture_folder, "readme.txt", "x", 1);
    temp_file_write(&frame_fixture_folder, "f1.mtl", "x", 1);
    temp_file_write(&frame_fixture_folder, "take2_f2_v3.plan.ply", "x", 1);
    temp_file_write(&frame_fixture_folder, "obj", "x", 1);
    assert_int_equal(mkdir(temp_file_path(&frame_fixture_folder, "take2_f12_v3.OFF").text, 0700), 0);
    static const uint32_t expected[] = {2, 10};
    check_frames(frame_fixture_folder.path, expected, 2);
    char slashed[300];
    snprintf(slashed, sizeof slashed, "%s/", frame_fixture_folder.path);
    check_frames(slashed, expected, 2);
}

TEST(folder_with_one_file_is_one_frame) {
    write_frame("pose.ply", 6);
    static const uint32_t expected[] = {6};
    check_frames(frame_fixture_folder.path, expected, 1);
}

TEST(folder_without_frames_is_refused) {
    check_folder_fails("no frames in this folder", ".obj, .ply, .off", "");
    temp_file_write(&frame_fixture_folder, "readme.txt", "x", 1);
    check_folder_fails("no frames in this folder", "", "");
}

TEST(folder_must_hold_one_series) {
    static const char *const names[][2] = {
        {"f1.obj", "g2.obj"},  {"f1.obj", "f2b.obj"}, {"f.obj", "f1.obj"}, {"f1_1.obj", "f2_2.obj"},
        {"f01.obj", "f1.obj"}, {"f1.obj", "f2.ply"},  {"f1.obj", "f2.OBJ"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const temp_path first = write_frame(names[i][0], 1);
        const temp_path second = temp_file_write(&frame_fixture_folder, names[i][1], "x", 1);
        check_folder_fails("holds both", names[i][0], names[i][1]);
        assert_int_equal(unlink(first.text), 0);
        assert_int_equal(unlink(second.text), 0);
    }
    write_frame("f1_1.obj", 1);
    write_frame("f1_2.obj", 2);
    write_frame("f2_1.obj", 3);
    check_folder_fails("differ in one number only", "f1_1.obj", "f2_1.obj");
}

TEST(folder_says_why_names_clash) {
    write_frame("f1.obj", 1);
    const temp_path same = write_frame("f01.obj", 1);
    check_folder_fails("the same frame", "f1.obj", "f01.obj");
    assert_int_equal(unlink(same.text), 0);
    write_frame("f2.ply", 1);
    check_folder_fails("one extension", "f1.obj", "f2.ply");
}

TEST(folder_knows_that_minus_zero_is_zero) {
    write_frame("f_-0.obj", 1);
    write_frame("f_0.obj", 1);
    check_folder_fails("the same frame", "f_-0.obj", "f_0.obj");
}

/* ---- lists ------------------------------------------------------------------------------------------- */

TEST(list_keeps_the_order_given) {
    const temp_path b = write_frame("b.obj", 1), a = write_frame("a.ply", 2), c = write_frame("%d.off", 3);
    const char *const paths[] = {b.text, a.text, c.text, b.text};
    animation *opened;
    io_error error;
    assert_true(animation_open(paths, 4, VERTICES, NULL, &opened, &error));
    assert_int_equal(animation_frame_count(opened), 4);
    static const uint32_t expected[] = {1, 2, 3, 1};
    for (uint32_t frame = 0; frame < 4; frame++)
        frame_fixture_check(opened, VERTICES, frame, expected[frame]);
    animation_close(opened);
}

static void check_list_fails(const char *second, const char *part) {
    const temp_path first = write_frame("first.obj", 1);
    const char *const paths[] = {first.text, second};
    animation *opened = NULL;
    io_error error;
    assert_false(animation_open(paths, 2, VERTICES, NULL, &opened, &error));
    assert_null(opened);
    frame_fixture_check_error(&error, second, part, NULL);
}

TEST(list_with_a_stranger_is_refused) {
    const frame_fixture_bytes pc2 = frame_fixture_pc2(VERTICES, 1);
    check_list_fails(frame_fixture_write(&frame_fixture_folder, "cache.pc2", &pc2).text,
                     "a point cache among several");
    check_list_fails(frame_fixture_write(&frame_fixture_folder, "hidden.obj", &pc2).text,
                     "a point cache among several");
    check_list_fails(frame_fixture_write(&frame_fixture_folder, "cache.mdd", &pc2).text,
                     "a point cache among several");
    check_list_fails(temp_file_path(&frame_fixture_folder, "missing.obj").text, "cannot open: No such file");
    check_list_fails(temp_file_path(&frame_fixture_folder, "f_%d.obj").text, "cannot open: No such file");
    check_list_fails(temp_file_write(&frame_fixture_folder, "a.txt", "x", 1).text, "unknown extension");
    check_list_fails(temp_file_write(&frame_fixture_folder, "a.abc", "x", 1).text,
                     "this is an Alembic archive");
    check_list_fails(frame_fixture_folder.path, "a folder must be the only path");
}

/* ---- frames ------------------------------------------------------------------------------------------ */

TEST(keeps_doubles) {
    static const char obj[] = "v 0.1 1e-300 -3.0000000000000004\nv 0 0 0\nv 1 0 0\nf 1 2 3\n";
    static const char ply[] =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
        "property double z\nelement face 1\nproperty list uchar int vertex_indices\n"
        "end_header\n0.1 1e-300 -3.0000000000000004\n0 0 0\n1 0 0\n3 0 1 2\n";
    const temp_path paths[] = {temp_file_write(&frame_fixture_folder, "a.obj", obj, strlen(obj)),
                               temp_file_write(&frame_fixture_folder, "a.ply", ply, strlen(ply))};
    for (size_t i = 0; i < 2; i++) {
        animation *opened = frame_fixture_open(paths[i].text, 3);
        double positions[9];
        io_error error;
        assert_true(animation_read(opened, 0, positions, &error));
        assert_true(positions[0] == 0.1 && positions[1] == 1e-300 && positions[2] == -3.0000000000000004);
        animation_close(opened);
    }
}

TEST(bad_frames_are_named) {
    write_frame("f0.obj", 0);
    const temp_path other = frame_fixture_write_mesh(&frame_fixture_folder, "f1.obj", VERTICES + 1, 1);
    const temp_path garbage = temp_file_write(&frame_fixture_folder, "f2.obj", "v 0 0\n", 6);
    const temp_path gone = write_frame("f3.obj", 3);
    write_frame("f4.obj", 4);
    animation *opened = frame_fixture_open(frame_fixture_folder.path, VERTICES);
    assert_int_equal(unlink(gone.text), 0);
    io_error error;
    frame_fixture_read_fails(opened, VERTICES, 1, &error);
    frame_fixture_check_error(&error, other.text, "holds 5 vertices, the model has 4 vertices",
                              "exported from another mesh", NULL);
    frame_fixture_read_fails(opened, VERTICES, 2, &error);
    frame_fixture_check_error(&error, garbage.text, ":1: ", NULL);
    frame_fixture_read_fails(opened, VERTICES, 3, &error);
    frame_fixture_check_error(&error, gone.text, "No such file", NULL);
    frame_fixture_read_fails(opened, VERTICES, 5, &error);
    frame_fixture_check_error(&error, frame_fixture_folder.path, "no frame 5", NULL);
    frame_fixture_check(opened, VERTICES, 4, 4);
    frame_fixture_check(opened, VERTICES, 0, 0);
    animation_close(opened);
}

TEST(values_that_are_not_finite_are_refused) {
    static const char *const values[] = {"nan", "inf", "-inf", "1e999"};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        char obj[128];
        const int size = snprintf(obj, sizeof obj, "v 0 0 0\nv 1 %s 0\nv 0 1 0\nf 1 2 3\n", values[i]);
        const temp_path path = temp_file_write(&frame_fixture_folder, "f7.obj", obj, (size_t)size);
        animation *opened = frame_fixture_open(path.text, 3);
        io_error error;
        frame_fixture_read_fails(opened, 3, 0, &error);
        frame_fixture_check_error(&error, path.text, ":2: ", NULL);
        animation_close(opened);
    }
}

AROUND_EACH(frame_fixture_make_folder, frame_fixture_remove_folder)
