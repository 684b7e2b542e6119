/* Frames that are said to be read soon: the system fetches their files from the disk meanwhile. */
#include "tests/support/io/frame_fixture.h"
#include "tests/support/page_cache.h"
#include "tests/support/test.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { VERTICES = 4, FRAME_BYTES = 1 << 20 };

static void wait_for(long milliseconds) {
    const struct timespec time = {.tv_nsec = milliseconds * 1000 * 1000};
    nanosleep(&time, NULL);
}

/* A frame with empty lines behind it, so that it has many pages. */
static temp_path write_large(const char *name, uint32_t frame) {
    const temp_path path = frame_fixture_write_mesh(&frame_fixture_folder, name, VERTICES, frame);
    static char lines[FRAME_BYTES];
    memset(lines, '\n', sizeof lines);
    FILE *file = fopen(path.text, "ab");
    assert_non_null(file);
    const size_t left = FRAME_BYTES - (size_t)ftell(file);
    assert_int_equal(fwrite(lines, 1, left, file), left);
    assert_int_equal(fclose(file), 0);
    return path;
}

TEST(an_expected_frame_comes_from_its_disk) {
    write_large("f_0.obj", 0);
    const temp_path expected = write_large("f_1.obj", 1), other = write_large("f_2.obj", 2);
    animation *opened = frame_fixture_open(frame_fixture_folder.path, VERTICES);
    const bool dropped = page_cache_drop(expected.text) && page_cache_drop(other.text);
    animation_expect(opened, 1);
    if (dropped) page_cache_expect(expected.text);
    if (dropped) assert_int_equal(page_cache_count(other.text), 0);
    frame_fixture_check(opened, VERTICES, 1, 1);
    animation_close(opened);
    if (!dropped) skip();
}

TEST(an_expected_frame_need_not_be_there) {
    const temp_path path = write_large("f_0.obj", 0);
    animation *opened = frame_fixture_open(frame_fixture_folder.path, VERTICES);
    assert_int_equal(unlink(path.text), 0);
    animation_expect(opened, 0);
    write_large("f_0.obj", 0);
    frame_fixture_check(opened, VERTICES, 0, 0);
    animation_close(opened);
}

static void *write_pipe(void *path) {
    const int file = open(path, O_WRONLY); /* waits for its reader */
    const bool written = file >= 0 && write(file, "v 0 0 0\n", 8) == 8;
    close(file);
    return written ? path : NULL;
}

/* The writer of a pipe waits for its reader, and one that only looks would leave it alone. */
TEST(a_pipe_is_left_alone) {
    temp_path path = frame_fixture_write_mesh(&frame_fixture_folder, "f_0.obj", VERTICES, 0);
    animation *opened = frame_fixture_open(frame_fixture_folder.path, VERTICES);
    char text[9] = "";
    pthread_t writer;
    void *written;
    assert_int_equal(unlink(path.text), 0);
    assert_int_equal(mkfifo(path.text, 0600), 0);
    assert_int_equal(pthread_create(&writer, NULL, write_pipe, path.text), 0);
    wait_for(100); /* so that it waits */
    signal(SIGPIPE, SIG_IGN);
    animation_expect(opened, 0);
    wait_for(100); /* so that it writes, if it takes this for its reader */
    const int file = open(path.text, O_RDONLY | O_NONBLOCK);
    for (int tries = 0; read(file, text, 8) <= 0 && tries < 1000; tries++) wait_for(10);
    assert_int_equal(pthread_join(writer, &written), 0);
    close(file);
    assert_string_equal(text, "v 0 0 0\n");
    assert_ptr_equal(written, path.text);
    animation_close(opened);
}

AROUND_EACH(frame_fixture_make_folder, frame_fixture_remove_folder)
