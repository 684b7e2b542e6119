/* Point caches as animations: PC2 and MDD, every header error, every truncation, every flipped bit. */
#include "src/io/point_cache_write.h"
#include "tests/support/io/frame_fixture.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { VERTICES = 5, FRAMES = 4 };

static frame_fixture_bytes cache_bytes(bool mdd) {
    return mdd ? frame_fixture_mdd(VERTICES, FRAMES) : frame_fixture_pc2(VERTICES, FRAMES);
}

static temp_path write_cache(bool mdd, const frame_fixture_bytes *bytes) {
    return frame_fixture_write(&frame_fixture_folder, mdd ? "cache.mdd" : "cache.pc2", bytes);
}

/* Writes the bytes as a cache that must not open. */
static void cache_fails(bool mdd, const frame_fixture_bytes *bytes, io_error *error) {
    const temp_path path = write_cache(mdd, bytes);
    frame_fixture_open_fails(path.text, VERTICES, error);
    frame_fixture_check_error(error, path.text, NULL);
}

static void check_all_frames(const char *path) {
    animation *opened = frame_fixture_open(path, VERTICES);
    assert_int_equal(animation_frame_count(opened), FRAMES);
    for (uint32_t frame = 0; frame < FRAMES; frame++) frame_fixture_check(opened, VERTICES, frame, frame);
    animation_close(opened);
}

TEST(reads_both_formats) {
    for (int mdd = 0; mdd < 2; mdd++) {
        const frame_fixture_bytes bytes = cache_bytes(mdd);
        check_all_frames(write_cache(mdd, &bytes).text);
    }
}

/* 1.5, -2 and 2^-149, every byte written out by hand. */
TEST(decodes_bytes_exactly) {
    static const unsigned char pc2[] = {'P', 'O', 'I', 'N', 'T', 'C', 'A', 'C', 'H', 'E', '2', 0,
                                        1,   0,   0,   0,   1,   0,   0,   0,   0,   0,   0,   0,
                                        0,   0,   0,   0,   1,   0,   0,   0, /* header */
                                        0,   0,   192, 63,  0,   0,   0,   192, 1,   0,   0,   0};
    static const unsigned char mdd[] = {0,  0,   0, 1, 0,   0, 0, 1, 0, 0, 0, 0, /* header, time */
                                        63, 192, 0, 0, 192, 0, 0, 0, 0, 0, 0, 1};
    const temp_path paths[] = {temp_file_write(&frame_fixture_folder, "hand.pc2", pc2, sizeof pc2),
                               temp_file_write(&frame_fixture_folder, "hand.mdd", mdd, sizeof mdd)};
    for (size_t i = 0; i < 2; i++) {
        animation *opened = frame_fixture_open(paths[i].text, 1);
        double position[3];
        io_error error;
        assert_true(animation_read(opened, 0, position, &error));
        assert_true(position[0] == 1.5 && position[1] == -2.0 && position[2] == 0x1p-149);
        animation_close(opened);
    }
}

TEST(recognises_pc2_by_its_content) {
    const frame_fixture_bytes pc2 = cache_bytes(false), mdd = cache_bytes(true);
    check_all_frames(frame_fixture_write(&frame_fixture_folder, "without_extension", &pc2).text);
    check_all_frames(frame_fixture_write(&frame_fixture_folder, "misnamed.mdd", &pc2).text);
    check_all_frames(frame_fixture_write(&frame_fixture_folder, "misnamed.obj", &pc2).text);
    check_all_frames(frame_fixture_write(&frame_fixture_folder, "percent_%d.MDD", &mdd).text);
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

TEST(refuses_wrong_magic_and_version) {
    io_error error;
    frame_fixture_bytes bytes = cache_bytes(false);
    bytes.data[10] = '\n';
    cache_fails(false, &bytes, &error);
    frame_fixture_check_error(&error, "not a PC2 file: starts with \"POINTCACHE\\x0a\\x00\"",
                              "expected \"POINTCACHE2", NULL);
    bytes = cache_bytes(true);
    cache_fails(false, &bytes, &error);
    frame_fixture_check_error(&error, "not a PC2 file", NULL);
    bytes = cache_bytes(false);
    frame_fixture_put_int(&bytes, 12, 2, false);
    cache_fails(false, &bytes, &error);
    frame_fixture_check_error(&error, "PC2 version 2 at byte 12, expected 1", NULL);
}

/* All of a header in the order of the other format. */
TEST(tells_the_other_byte_order) {
    io_error error;
    frame_fixture_bytes bytes = cache_bytes(false);
    frame_fixture_put_int(&bytes, 12, 1, true);
    frame_fixture_put_int(&bytes, 16, VERTICES, true);
    cache_fails(false, &bytes, &error);
    frame_fixture_check_error(&error, "its numbers are big-endian, and those of a PC2 file are little-endian",
                              NULL);
    bytes = cache_bytes(true);
    frame_fixture_put_int(&bytes, 0, FRAMES, false);
    frame_fixture_put_int(&bytes, 4, VERTICES, false);
    cache_fails(true, &bytes, &error);
    frame_fixture_check_error(&error,
                              "its numbers are little-endian, and those of an MDD file are big-endian", NULL);
}

TEST(refuses_wrong_counts) {
    static const int32_t points[] = {VERTICES - 1, VERTICES + 1, 0, -1, INT32_MIN, INT32_MAX};
    static const int32_t frames[] = {0, -1, INT32_MIN};
    char text[64];
    io_error error;
    for (int mdd = 0; mdd < 2; mdd++) {
        for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
            frame_fixture_bytes bytes = cache_bytes(mdd);
            frame_fixture_put_int(&bytes, mdd ? 4 : 16, points[i], mdd);
            cache_fails(mdd, &bytes, &error);
            snprintf(text, sizeof text, "holds %d points, the model has 5 vertices", points[i]);
            frame_fixture_check_error(&error, text, "it was exported from another mesh", NULL);
        }
        for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
            frame_fixture_bytes bytes = cache_bytes(mdd);
            frame_fixture_put_int(&bytes, mdd ? 0 : 28, frames[i], mdd);
            cache_fails(mdd, &bytes, &error);
            snprintf(text, sizeof text, "holds %d frames, expected at least 1", frames[i]);
            frame_fixture_check_error(&error, text, NULL);
        }
    }
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

TEST(refuses_every_truncation) {
    for (int mdd = 0; mdd < 2; mdd++) {
        frame_fixture_bytes bytes = cache_bytes(mdd);
        for (size_t size = bytes.size; size-- > 0;) {
            bytes.size = size;
            io_error error;
            cache_fails(mdd, &bytes, &error);
            frame_fixture_check_error(&error, "too short", NULL);
        }
    }
}

TEST(says_how_far_the_size_is_off) {
    io_error error;
    frame_fixture_bytes bytes = cache_bytes(false);
    bytes.size = 32 + 2 * 60 + 7;
    cache_fails(false, &bytes, &error);
    frame_fixture_check_error(&error, "too short: 159 bytes, expected 272 for 4 frames of 60 bytes",
                              "room for 2 whole frames", NULL);
    bytes.size = 272 + 60;
    cache_fails(false, &bytes, &error);
    frame_fixture_check_error(&error, "too long: 332 bytes, expected 272", "room for 5 whole frames", NULL);
    bytes = cache_bytes(true);
    bytes.size++;
    cache_fails(true, &bytes, &error);
    frame_fixture_check_error(&error, "too long: 265 bytes, expected 264", "room for 4 whole frames", NULL);
    bytes.size = 20;
    cache_fails(true, &bytes, &error);
    frame_fixture_check_error(&error, "too short: 20 bytes", "room for 0 whole frames", NULL);
}

/* A flipped bit in the times changes nothing; any other one is refused. */
TEST(survives_flipped_header_bits) {
    for (int mdd = 0; mdd < 2; mdd++) {
        const size_t header_size = mdd ? 8 + 4 * FRAMES : 32, times_start = mdd ? 8 : 20;
        const size_t times_end = mdd ? header_size : 28;
        for (size_t bit = 0; bit < header_size * 8; bit++) {
            frame_fixture_bytes bytes = cache_bytes(mdd);
            bytes.data[bit / 8] ^= (unsigned char)(1U << bit % 8);
            io_error error;
            if (bit / 8 >= times_start && bit / 8 < times_end)
                check_all_frames(write_cache(mdd, &bytes).text);
            else
                cache_fails(mdd, &bytes, &error);
        }
    }
}

TEST(refuses_values_that_are_not_finite) {
    static const float values[] = {NAN, INFINITY, -INFINITY};
    for (int mdd = 0; mdd < 2; mdd++) {
        for (size_t i = 0; i < 3; i++) {
            frame_fixture_bytes bytes = cache_bytes(mdd);
            const size_t offset = (mdd ? 8 + 4 * FRAMES : 32) + 2 * 60 + 3 * 12 + 4;
            frame_fixture_put_float(&bytes, offset, values[i], mdd);
            const temp_path path = write_cache(mdd, &bytes);
            animation *opened = frame_fixture_open(path.text, VERTICES);
            char place[64];
            snprintf(place, sizeof place, "sample 2, vertex 3, y at byte %zu is ", offset);
            io_error error;
            frame_fixture_read_fails(opened, VERTICES, 2, &error);
            frame_fixture_check_error(&error, path.text, place, i == 0 ? "nan" : "inf", "finite", NULL);
            frame_fixture_check(opened, VERTICES, 3, 3);
            animation_close(opened);
        }
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

/* More vertices than are read at a time, the last of them not finite in the last frame. */
TEST(reads_frames_of_many_vertices) {
    enum { MANY = 9001, LAST_VALUE = 32 + 2 * MANY * 12 - 4 };
    const temp_path path = temp_file_path(&frame_fixture_folder, "many.pc2");
    double *positions = malloc((size_t)MANY * 3 * sizeof *positions);
    assert_non_null(positions);
    point_cache_writer *writer;
    io_error error;
    assert_true(point_cache_writer_open(path.text, MANY, 2, &writer, &error));
    for (uint32_t frame = 0; frame < 2; frame++) {
        for (uint32_t i = 0; i < MANY * 3; i++) positions[i] = frame_fixture_value(frame, i / 3, i % 3);
        assert_true(point_cache_writer_write(writer, positions, &error));
    }
    assert_true(point_cache_writer_close(writer, &error));
    free(positions);

    animation *opened = frame_fixture_open(path.text, MANY);
    frame_fixture_check(opened, MANY, 1, 1);
    frame_fixture_check(opened, MANY, 0, 0);
    FILE *file = fopen(path.text, "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, LAST_VALUE, SEEK_SET), 0);
    assert_int_equal(fwrite("\xff\xff\xff\xff", 4, 1, file), 1);
    assert_int_equal(fclose(file), 0);
    frame_fixture_read_fails(opened, MANY, 1, &error);
    frame_fixture_check_error(&error, "sample 1, vertex 9000, z at byte 216052", NULL);
    animation_close(opened);
}

TEST(refuses_what_is_no_animation) {
    io_error error;
    animation *opened = NULL;
    assert_false(animation_open(NULL, 0, VERTICES, NULL, &opened, &error));
    frame_fixture_check_error(&error, "no animation given", "f_%04d.obj", NULL);

    const temp_path missing = temp_file_path(&frame_fixture_folder, "missing.pc2");
    frame_fixture_open_fails(missing.text, VERTICES, &error);
    frame_fixture_check_error(&error, missing.text, "cannot open: No such file", NULL);

    const temp_path text = temp_file_write(&frame_fixture_folder, "notes.txt", "v 0 0 0", 7);
    frame_fixture_open_fails(text.text, VERTICES, &error);
    frame_fixture_check_error(&error, text.text, "unknown extension", ".pc2", ".mdd", ".obj", NULL);

    const temp_path pipe_path = temp_file_path(&frame_fixture_folder, "pipe.pc2");
    assert_int_equal(mkfifo(pipe_path.text, 0600), 0);
    frame_fixture_open_fails(pipe_path.text, VERTICES, &error);
    frame_fixture_check_error(&error, pipe_path.text, "not a regular file", NULL);

    const frame_fixture_bytes bytes = cache_bytes(false);
    const temp_path path = write_cache(false, &bytes);
    frame_fixture_open_fails(path.text, 0, &error);
    frame_fixture_check_error(&error, path.text, "the model has no vertices", NULL);
    animation_close(NULL);
}

AROUND_EACH(frame_fixture_make_folder, frame_fixture_remove_folder)
