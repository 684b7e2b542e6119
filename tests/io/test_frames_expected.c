/* Frames that are said to be read soon: the system fetches their files from the disk meanwhile. */
#include "tests/support/io/recordings.h"
#include "tests/support/test.h"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { VERTICES = 4, FRAME_BYTES = 1 << 20 };

/* ---- which files the system has in memory -------------------------------------------------------------- */

static size_t file_size(const char *path) {
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return (size_t)status.st_size;
}

/* How many pages the file has. */
static size_t page_cache_pages(const char *path) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    return (file_size(path) + page - 1) / page;
}

/* How many of these pages are in memory. */
static size_t page_cache_count(const char *path) {
    const size_t pages = page_cache_pages(path), size = file_size(path);
    size_t count = 0;
    unsigned char *in_memory = calloc(pages, 1);
    const int file = open(path, O_RDONLY);
    assert_non_null(in_memory);
    assert_true(file >= 0);
    void *bytes = mmap(NULL, size, PROT_READ, MAP_SHARED, file, 0);
    assert_ptr_not_equal(bytes, MAP_FAILED);
    assert_int_equal(mincore(bytes, size, in_memory), 0);
    for (size_t i = 0; i < pages; i++) count += in_memory[i] & 1;
    munmap(bytes, size);
    close(file);
    free(in_memory);
    return count;
}

/* Takes the file out of memory. False where this cannot be: its file system has no disk, or somebody else uses it. */
static bool page_cache_drop(const char *path) {
    const int file = open(path, O_RDONLY);
    assert_true(file >= 0);
    assert_int_equal(fsync(file), 0);
    assert_int_equal(posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED), 0);
    close(file);
    return page_cache_count(path) == 0;
}

/* Waits until the whole file is in memory; the test fails if that takes longer than ten seconds. */
static void page_cache_expect(const char *path) {
    const struct timespec rest = {.tv_nsec = 10 * 1000 * 1000};
    for (int i = 0; i < 1000 && page_cache_count(path) < page_cache_pages(path); i++) nanosleep(&rest, NULL);
    if (page_cache_count(path) < page_cache_pages(path))
        fail_msg("%s: %zu of %zu pages are in memory", path, page_cache_count(path), page_cache_pages(path));
}

/* ---- frames -------------------------------------------------------------------------------------------- */

static void wait_for(long milliseconds) {
    const struct timespec time = {.tv_nsec = milliseconds * 1000 * 1000};
    nanosleep(&time, NULL);
}

/* A frame with empty lines behind it, so that it has many pages. */
static temp_path write_large(const char *name, uint32_t frame) {
    const temp_path path = frame_fixture_write_mesh(&own_folder, name, VERTICES, frame);
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
    animation *opened = frame_fixture_open(own_folder.path, VERTICES);
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
    animation *opened = frame_fixture_open(own_folder.path, VERTICES);
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
    temp_path path = frame_fixture_write_mesh(&own_folder, "f_0.obj", VERTICES, 0);
    animation *opened = frame_fixture_open(own_folder.path, VERTICES);
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

AROUND_EACH(own_folder_make, own_folder_remove)
