/* Animations as their readers are called: frames in any order and beyond the end, files that shrink, and counts that no tool gives. */
#include "tests/support/io/recordings.h"
#include "tests/support/test.h"

#include <unistd.h>

enum { VERTICES = 5, FRAMES = 4 };

static frame_fixture_bytes cache_bytes(bool mdd) {
    return mdd ? frame_fixture_mdd(VERTICES, FRAMES) : frame_fixture_pc2(VERTICES, FRAMES);
}

static temp_path write_cache(bool mdd, const frame_fixture_bytes *bytes) {
    return frame_fixture_write(&own_folder, mdd ? "cache.mdd" : "cache.pc2", bytes);
}

TEST(reads_in_any_order) {
    static const uint32_t order[] = {3, 0, 2, 2, 1, 3, 0};
    for (int mdd = 0; mdd < 2; mdd++) {
        const frame_fixture_bytes bytes = cache_bytes(mdd);
        animation *opened = frame_fixture_open(write_cache(mdd, &bytes).text, VERTICES);
        for (size_t i = 0; i < sizeof order / sizeof *order; i++)
            frame_fixture_check(opened, VERTICES, order[i], order[i]);
        animation_close(opened);
    }
}

TEST(refuses_a_frame_past_the_end) {
    const frame_fixture_bytes bytes = cache_bytes(false);
    const temp_path path = write_cache(false, &bytes);
    animation *opened = frame_fixture_open(path.text, VERTICES);
    io_error error;
    frame_fixture_read_fails(opened, VERTICES, FRAMES, &error);
    frame_fixture_check_error(&error, path.text, "no frame 4", "from 0 to 3", NULL);
    frame_fixture_read_fails(opened, VERTICES, UINT32_MAX, &error);
    frame_fixture_check(opened, VERTICES, FRAMES - 1, FRAMES - 1);
    animation_close(opened);
}

TEST(refuses_counts_that_overflow) {
    for (int mdd = 0; mdd < 2; mdd++) {
        frame_fixture_bytes bytes = cache_bytes(mdd);
        frame_fixture_put_int(&bytes, mdd ? 4 : 16, INT32_MAX, mdd);
        frame_fixture_put_int(&bytes, mdd ? 0 : 28, INT32_MAX, mdd);
        const temp_path path = write_cache(mdd, &bytes);
        io_error error;
        frame_fixture_open_fails(path.text, INT32_MAX, &error);
        frame_fixture_check_error(&error, path.text, "more than a file can hold", NULL);
    }
}

TEST(notices_that_the_file_shrinks) {
    for (int mdd = 0; mdd < 2; mdd++) {
        const frame_fixture_bytes bytes = cache_bytes(mdd);
        const temp_path path = write_cache(mdd, &bytes);
        animation *opened = frame_fixture_open(path.text, VERTICES);
        assert_int_equal(truncate(path.text, (off_t)bytes.size - 1), 0);
        io_error error;
        frame_fixture_read_fails(opened, VERTICES, FRAMES - 1, &error);
        frame_fixture_check_error(&error, path.text, "frame 3", "shrank", mdd ? "byte 263" : "byte 271",
                                  mdd ? "264 bytes in all" : "272 bytes in all", NULL);
        frame_fixture_check(opened, VERTICES, 2, 2);
        animation_close(opened);
    }
}

TEST(refuses_what_is_no_animation) {
    io_error error;
    animation *opened = NULL;
    assert_false(animation_open(NULL, 0, VERTICES, NULL, &opened, &error));
    frame_fixture_check_error(&error, "no animation given", "f_%04d.obj", NULL);
    const frame_fixture_bytes bytes = cache_bytes(false);
    const temp_path path = write_cache(false, &bytes);
    frame_fixture_open_fails(path.text, 0, &error);
    frame_fixture_check_error(&error, path.text, "the model has no vertices", NULL);
    animation_close(NULL);
}

AROUND_EACH(own_folder_make, own_folder_remove)
