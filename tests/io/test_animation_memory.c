/* The memory of animations: every allocation fails once, and the peak does not grow with the number of
 * frames. */
#include "tests/support/files.h"
#include "tests/support/io/recordings.h"
#include "tests/support/test.h"
#include "tool/io/io.h"
#include "tool/io/point_cache.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    VERTICES = 4,
    FRAMES = 70, /* more names than the list first has room for */
    FIRST = 10   /* what the first file's number is: a frame without its own would be called 0 */
};

static int remove_folder(void **state) {
    io_allocations_left = -1;
    return own_folder_remove(state);
}

static void write_frames(void) {
    char name[32];
    for (uint32_t frame = 0; frame < FRAMES; frame++) {
        snprintf(name, sizeof name, "f%u.obj", FIRST + frame);
        frame_fixture_write_mesh(&own_folder, name, VERTICES, frame);
    }
}

/* Opens with the first, second, ... allocation failing until none is left to fail. */
static void fail_every_allocation(const char *const *paths, size_t path_count, int32_t first, long least) {
    animation *opened = NULL;
    long successes = 0;
    for (;; successes++) {
        io_error error = {""};
        io_allocations_left = successes;
        io_allocation_failed = false;
        const bool done = animation_open(paths, path_count, VERTICES, NULL, &opened, &error);
        io_allocations_left = -1;
        assert_int_equal(done, !io_allocation_failed);
        if (done) break;
        assert_null(opened);
        frame_fixture_check_error(&error, own_folder.path, "out of memory", NULL);
    }
    assert_true(successes >= least);
    assert_int_equal(animation_frame_number(opened, 0), first);
    frame_fixture_check(opened, VERTICES, animation_frame_count(opened) - 1,
                        animation_frame_count(opened) - 1);
    animation_close(opened);
}

TEST(point_cache_survives_failed_allocations) {
    const frame_fixture_bytes bytes = frame_fixture_pc2(VERTICES, 3);
    const temp_path path = frame_fixture_write(&own_folder, "cache.pc2", &bytes);
    const char *const paths[] = {path.text};
    fail_every_allocation(paths, 1, 0, 2);
}

TEST(sequences_survive_failed_allocations) {
    write_frames();
    const temp_path pattern = temp_file_path(&own_folder, "f%d.obj"),
                    first = temp_file_path(&own_folder, "f10.obj");
    const temp_path second = temp_file_path(&own_folder, "f11.obj");
    const char *const pattern_paths[] = {pattern.text}, *const folder_paths[] = {own_folder.path};
    const char *const list_paths[] = {first.text, second.text};
    fail_every_allocation(pattern_paths, 1, FIRST, FRAMES + 4);
    fail_every_allocation(folder_paths, 1, FIRST, FRAMES + 4);
    fail_every_allocation(list_paths, 2, FIRST, 2 + 4);
}

TEST(reading_survives_failed_allocations) {
    const temp_path path = frame_fixture_write_mesh(&own_folder, "f0.obj", VERTICES, 0);
    animation *opened = frame_fixture_open(path.text, VERTICES);
    double positions[VERTICES * 3];
    io_error error;
    long successes = 0;
    for (;; successes++) {
        io_allocations_left = successes;
        io_allocation_failed = false;
        const bool done = animation_read(opened, 0, positions, &error);
        io_allocations_left = -1;
        if (done && !io_allocation_failed) break;
        if (!done) frame_fixture_check_error(&error, path.text, NULL); /* arrays need not become shorter */
    }
    assert_true(successes > 0);
    frame_fixture_check(opened, VERTICES, 0, 0);
    animation_close(opened);
}

TEST(writer_survives_a_failed_allocation) {
    const temp_path path = temp_file_path(&own_folder, "cache.pc2");
    point_cache_writer *writer = NULL;
    io_error error;
    io_allocations_left = 0;
    assert_false(point_cache_writer_open(path.text, VERTICES, 1, &writer, &error));
    io_allocations_left = -1;
    assert_null(writer);
    frame_fixture_check_error(&error, path.text, "out of memory", NULL);
    assert_int_not_equal(access(path.text, F_OK), 0);
}

/* ---- the peak ---------------------------------------------------------------------------------------- */

enum { LARGE = 2000 };
static double large_frame[LARGE * 3];

static temp_path write_large(const char *name, uint32_t frame_count) {
    const temp_path path = temp_file_path(&own_folder, name);
    point_cache_writer *writer;
    io_error error;
    assert_true(point_cache_writer_open(path.text, LARGE, frame_count, &writer, &error));
    for (uint32_t frame = 0; frame < frame_count; frame++)
        assert_true(point_cache_writer_write(writer, large_frame, &error));
    assert_true(point_cache_writer_close(writer, &error));
    return path;
}

/* The peak resident size of a process that reads all frames. */
static long peak_of_reading(const char *path, uint32_t frame_count) {
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        animation *opened;
        bool done = animation_open(&path, 1, LARGE, NULL, &opened, NULL) &&
                    animation_frame_count(opened) == frame_count;
        for (uint32_t frame = 0; done && frame < frame_count; frame++)
            done = animation_read(opened, frame, large_frame, NULL);
        _exit(done ? 0 : 1);
    }
    int status;
    struct rusage usage;
    assert_int_equal(wait4(child, &status, 0, &usage), child);
    assert_int_equal(status, 0);
    return usage.ru_maxrss;
}

/* The 540 frames more are 12,960 KiB; the system itself counts resident pages in batches. */
TEST(peak_does_not_grow_with_the_frames) {
    static const char *const names[][2] = {{"short.pc2", "long.pc2"}, {"short.mdd", "long.mdd"}};
    for (size_t i = 0; i < 2; i++) {
        const temp_path few = write_large(names[i][0], 60), many = write_large(names[i][1], 600);
        const long few_peak = peak_of_reading(few.text, 60), many_peak = peak_of_reading(many.text, 600);
        if (many_peak - few_peak > 512)
            fail_msg("600 frames take %ld KiB, 60 take %ld KiB", many_peak, few_peak);
    }
}

AROUND_EACH(own_folder_make, remove_folder)
