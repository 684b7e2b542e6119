/* The point cache writer: the exact bytes, and no file left behind by a failure. */
#include "tests/support/files.h"
#include "tests/support/io/recordings.h"
#include "tests/support/test.h"
#include "tool/io/point_cache.h"

#include <float.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

enum { VERTICES = 5, FRAMES = 4 };

static double positions[VERTICES * 3];

static int make_folder(void **state) {
    own_folder_make(state);
    memset(positions, 0, sizeof positions);
    return 0;
}

static point_cache_writer *open_writer(const char *path, uint32_t vertex_count, uint32_t frame_count) {
    point_cache_writer *writer = NULL;
    io_error error;
    if (!point_cache_writer_open(path, vertex_count, frame_count, &writer, &error))
        fail_msg("%s", error.text);
    return writer;
}

static void write_fixture(const char *path) {
    point_cache_writer *writer = open_writer(path, VERTICES, FRAMES);
    io_error error;
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        for (uint32_t i = 0; i < VERTICES * 3; i++) positions[i] = frame_fixture_value(frame, i / 3, i % 3);
        assert_true(point_cache_writer_write(writer, positions, &error));
    }
    assert_true(point_cache_writer_close(writer, &error));
}

static frame_fixture_bytes read_bytes(const char *path) {
    frame_fixture_bytes bytes;
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    bytes.size = fread(bytes.data, 1, sizeof bytes.data, file);
    fclose(file);
    return bytes;
}

static void check_gone(const char *path) {
    assert_int_not_equal(access(path, F_OK), 0);
}

TEST(writes_what_the_format_says) {
    frame_fixture_bytes expected[] = {frame_fixture_pc2(VERTICES, FRAMES),
                                      frame_fixture_mdd(VERTICES, FRAMES)};
    frame_fixture_put_float(&expected[0], 20, 0.0F, false);
    frame_fixture_put_float(&expected[0], 24, 1.0F, false);
    static const char *const names[] = {"cache.pc2", "cache.MDD"};
    for (size_t i = 0; i < 2; i++) {
        const temp_path path = temp_file_path(&own_folder, names[i]);
        write_fixture(path.text);
        const frame_fixture_bytes written = read_bytes(path.text);
        assert_int_equal(written.size, expected[i].size);
        assert_memory_equal(written.data, expected[i].data, written.size);
    }
}

TEST(replaces_an_existing_file) {
    static const char old[1000] = "old";
    const temp_path path = temp_file_write(&own_folder, "cache.pc2", old, sizeof old);
    write_fixture(path.text);
    assert_int_equal(read_bytes(path.text).size, 32 + FRAMES * VERTICES * 12);
}

TEST(rounds_to_float) {
    const temp_path path = temp_file_path(&own_folder, "cache.mdd");
    point_cache_writer *writer = open_writer(path.text, 1, 1);
    const double written[] = {0.1, -(double)FLT_MAX, 1e-300};
    io_error error;
    assert_true(point_cache_writer_write(writer, written, &error));
    assert_true(point_cache_writer_close(writer, &error));
    animation *opened = frame_fixture_open(path.text, 1);
    double read[3];
    assert_true(animation_read(opened, 0, read, &error));
    assert_true(read[0] == (double)0.1F && read[1] == -(double)FLT_MAX && read[2] == 0);
    animation_close(opened);
}

TEST(refuses_what_float_cannot_hold) {
    static const double values[] = {NAN, INFINITY, -1e39};
    const temp_path path = temp_file_path(&own_folder, "cache.pc2");
    for (size_t i = 0; i < 3; i++) {
        point_cache_writer *writer = open_writer(path.text, VERTICES, FRAMES);
        io_error error;
        positions[7] = 0;
        assert_true(point_cache_writer_write(writer, positions, &error));
        positions[7] = values[i];
        assert_false(point_cache_writer_write(writer, positions, &error));
        frame_fixture_check_error(&error, path.text, "frame 1, vertex 2, y", "fits in float32", NULL);
        check_gone(path.text);
        io_error again;
        assert_false(point_cache_writer_write(writer, positions, &again));
        frame_fixture_check_error(&again, path.text, "an earlier write failed", NULL);
        const io_error before = error;
        assert_false(point_cache_writer_close(writer, &error));
        assert_string_equal(error.text, before.text);
    }
}

TEST(refuses_a_wrong_number_of_frames) {
    const temp_path path = temp_file_path(&own_folder, "cache.pc2");
    io_error error;
    point_cache_writer *writer = open_writer(path.text, VERTICES, 2);
    assert_true(point_cache_writer_write(writer, positions, &error));
    assert_false(point_cache_writer_close(writer, &error));
    frame_fixture_check_error(&error, path.text, "only 1 frames were written, expected 2", NULL);
    check_gone(path.text);

    writer = open_writer(path.text, VERTICES, 1);
    assert_true(point_cache_writer_write(writer, positions, &error));
    assert_false(point_cache_writer_write(writer, positions, &error));
    frame_fixture_check_error(&error, path.text, "one frame more than the 1", NULL);
    assert_false(point_cache_writer_close(writer, NULL));
    check_gone(path.text);
    assert_true(point_cache_writer_close(NULL, &error));
    writer = open_writer(path.text, VERTICES, 1);
    assert_true(point_cache_writer_write(writer, positions, &error));
    point_cache_writer_abandon(writer);
    point_cache_writer_abandon(NULL);
    check_gone(path.text);
}

static void check_open_fails(const char *path, uint32_t vertex_count, uint32_t frame_count,
                             const char *part) {
    point_cache_writer *writer = NULL;
    io_error error;
    assert_false(point_cache_writer_open(path, vertex_count, frame_count, &writer, &error));
    assert_null(writer);
    frame_fixture_check_error(&error, path, part, NULL);
}

TEST(refuses_bad_arguments) {
    const temp_path path = temp_file_path(&own_folder, "cache.pc2");
    check_open_fails(path.text, 0, 1, "1 frames of 0 vertices");
    check_open_fails(path.text, 1, 0, "0 frames of 1 vertices");
    check_open_fails(path.text, (uint32_t)INT32_MAX + 1, 1, "expected 1 to 2147483647");
    check_open_fails(path.text, 1, UINT32_MAX, "expected 1 to 2147483647");
    check_gone(path.text);
    check_open_fails(temp_file_path(&own_folder, "none/cache.pc2").text, 1, 1, "cannot create: No such file");
    const temp_path other = temp_file_write(&own_folder, "cache.obj", "mine", 4);
    check_open_fails(other.text, 1, 1, "unknown extension, expected .pc2 or .mdd");
    assert_int_equal(read_bytes(other.text).size, 4);
}

/* A limit on file sizes stands for a full disk. It is reached within a frame, or only when the last bytes are
 * flushed. */
TEST(removes_the_file_when_the_disk_is_full) {
    static double large[4000 * 3];
    struct rlimit before;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    const struct rlimit limited = {.rlim_cur = 20000, .rlim_max = before.rlim_max};
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limited), 0);
    static const struct {
        const char *name;
        uint32_t vertex_count;
    } cases[] = {{"cache.pc2", 4000}, {"cache.mdd", 4000}, {"flush.pc2", 1700}};
    bool failed[3], gone[3];
    io_error errors[3];
    for (size_t i = 0; i < 3; i++) {
        const temp_path path = temp_file_path(&own_folder, cases[i].name);
        point_cache_writer *writer = open_writer(path.text, cases[i].vertex_count, 1);
        const bool written = point_cache_writer_write(writer, large, &errors[i]);
        failed[i] = !point_cache_writer_close(writer, written ? &errors[i] : NULL);
        gone[i] = access(path.text, F_OK) != 0;
    }
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    signal(SIGXFSZ, handler);
    for (size_t i = 0; i < 3; i++) {
        assert_true(failed[i]);
        assert_true(gone[i]);
        frame_fixture_check_error(&errors[i], cases[i].name, "cannot write", "File too large", NULL);
    }
}

/* Until the last frame is there, and for good when there is an error. */
TEST(leaves_the_older_file_until_it_is_whole) {
    const temp_path path = temp_file_write(&own_folder, "cache.pc2", "older", 5);
    io_error error;
    point_cache_writer *writer = open_writer(path.text, VERTICES, 2);
    assert_true(point_cache_writer_write(writer, positions, &error));
    assert_int_equal(read_bytes(path.text).size, 5);
    assert_false(point_cache_writer_close(writer, &error));
    assert_int_equal(read_bytes(path.text).size, 5);
    writer = open_writer(path.text, VERTICES, 1);
    assert_true(point_cache_writer_write(writer, positions, &error));
    assert_int_equal(read_bytes(path.text).size, 5);
    assert_true(point_cache_writer_close(writer, &error));
    assert_int_equal(read_bytes(path.text).size, 32 + VERTICES * 12);
}

/* A device (here behind a link that has the extension) must not be removed. */
TEST(leaves_devices_alone) {
    const temp_path path = temp_file_path(&own_folder, "device.pc2");
    assert_int_equal(symlink("/dev/null", path.text), 0);
    point_cache_writer *writer = open_writer(path.text, VERTICES, 1);
    assert_false(point_cache_writer_close(writer, NULL));
    struct stat status;
    assert_int_equal(lstat(path.text, &status), 0);
}

/* A frame of which every coordinate says which it is. */
static void write_numbered(point_cache_writer *writer, uint32_t frame, double value) {
    io_error error;
    for (uint32_t i = 0; i < VERTICES * 3; i++) positions[i] = value;
    assert_true(point_cache_writer_seek(writer, frame, &error));
    assert_true(point_cache_writer_write(writer, positions, &error));
}

/* The values of the frames of a file, and what they are called. */
static void check_frames(const char *path, uint32_t count, const double *values, int32_t first,
                         int32_t step) {
    animation *opened = frame_fixture_open(path, VERTICES);
    assert_int_equal(animation_frame_count(opened), count);
    for (uint32_t i = 0; i < count; i++) {
        io_error error;
        assert_true(animation_read(opened, i, positions, &error));
        assert_int_equal(animation_frame_number(opened, i), first + (int32_t)i * step);
        for (uint32_t k = 0; k < VERTICES * 3; k++) assert_true(positions[k] == values[i]);
    }
    animation_close(opened);
}

TEST(writes_frames_in_any_order) {
    static const double expected[FRAMES] = {10, 21, 12, 13};
    static const char *const names[] = {"cache.pc2", "cache.mdd"};
    for (size_t i = 0; i < 2; i++) {
        const temp_path path = temp_file_path(&own_folder, names[i]);
        point_cache_writer *writer = open_writer(path.text, VERTICES, FRAMES);
        io_error error;
        assert_true(point_cache_writer_number(writer, 60, 2, &error));
        write_numbered(writer, 2, 12);
        write_numbered(writer, 3, 13);
        write_numbered(writer, 1, 11);
        write_numbered(writer, 0, 10);
        write_numbered(writer, 1, 21); /* once more */
        assert_true(point_cache_writer_keep(writer, 0, FRAMES, &error));
        assert_true(point_cache_writer_close(writer, &error));
        check_frames(path.text, FRAMES, expected, i == 0 ? 60 : 0, i == 0 ? 2 : 1);
    }
}

TEST(keeps_a_part_of_the_frames) {
    static const double expected[2] = {11, 12};
    static const char *const names[] = {"cache.pc2", "cache.mdd"};
    for (size_t i = 0; i < 2; i++) {
        const temp_path path = temp_file_path(&own_folder, names[i]);
        point_cache_writer *writer = open_writer(path.text, VERTICES, FRAMES);
        io_error error;
        assert_true(point_cache_writer_number(writer, -3, 1, &error));
        write_numbered(writer, 2, 12);
        write_numbered(writer, 1, 11);
        assert_true(point_cache_writer_keep(writer, 1, 2, &error));
        assert_true(point_cache_writer_close(writer, &error));
        check_frames(path.text, 2, expected, i == 0 ? -2 : 0, 1);
    }
}

/* What a float does not hold is not said. */
TEST(leaves_out_numbers_that_a_header_cannot_hold) {
    static const double expected[1] = {1};
    const temp_path path = temp_file_path(&own_folder, "cache.pc2");
    point_cache_writer *writer = open_writer(path.text, VERTICES, 1);
    io_error error;
    assert_true(point_cache_writer_number(writer, (1 << 24) + 1, 1, &error));
    write_numbered(writer, 0, 1);
    assert_true(point_cache_writer_close(writer, &error));
    check_frames(path.text, 1, expected, 0, 1);
}

/* A device has no places. */
TEST(fails_where_frames_cannot_be_put_in_order) {
    const temp_path path = temp_file_path(&own_folder, "full.pc2");
    assert_int_equal(symlink("/dev/full", path.text), 0);
    point_cache_writer *writer = open_writer(path.text, VERTICES, FRAMES);
    io_error error = {""};
    for (uint32_t i = 0; i < VERTICES * 3; i++) positions[i] = 0;
    assert_true(point_cache_writer_write(writer, positions, &error));
    assert_false(point_cache_writer_keep(writer, 0, 1, &error));
    assert_non_null(strstr(error.text, "full.pc2: cannot"));
    assert_false(point_cache_writer_close(writer, &error));
}

AROUND_EACH(make_folder, own_folder_remove)
