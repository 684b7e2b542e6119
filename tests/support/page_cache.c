/* Which files the system has in memory. */
#include "tests/support/page_cache.h"

#include "tests/support/test.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static size_t file_size(const char *path) {
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return (size_t)status.st_size;
}

size_t page_cache_pages(const char *path) {
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    return (file_size(path) + page - 1) / page;
}

size_t page_cache_count(const char *path) {
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

bool page_cache_drop(const char *path) {
    const int file = open(path, O_RDONLY);
    assert_true(file >= 0);
    assert_int_equal(fsync(file), 0);
    assert_int_equal(posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED), 0);
    close(file);
    return page_cache_count(path) == 0;
}

void page_cache_expect(const char *path) {
    const struct timespec rest = {.tv_nsec = 10 * 1000 * 1000};
    for (int i = 0; i < 1000 && page_cache_count(path) < page_cache_pages(path); i++) nanosleep(&rest, NULL);
    if (page_cache_count(path) < page_cache_pages(path))
        fail_msg("%s: %zu of %zu pages are in memory", path, page_cache_count(path), page_cache_pages(path));
}
