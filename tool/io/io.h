/* The ground of readers and writers of files: the line that a failure leaves behind, arrays that grow, the
 * names of paths, and pipes. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* ---- errors -------------------------------------------------------------------------------------------- */

typedef struct io_error {
    char text[1024];
} io_error;

/* Formats "what is wrong, where (file, line or byte offset), what was expected"; always returns false,
 * so that a reader can end with `return io_fail(...)`. error may be NULL. */
bool io_fail(io_error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The reason why something could not be written, in words and by errno, and what helps against it. */
const char *io_write_reason(void);
/* "PATH: cannot write: " and the reason; "-" is the standard output. */
bool io_fail_write(io_error *error, const char *path);

/* ---- arrays that grow ---------------------------------------------------------------------------------- */

typedef struct growable {
    void *data;
    size_t count, capacity; /* elements */
    size_t element_size;
} growable;

/* An empty array; it owns no memory yet. */
growable growable_of(size_t element_size);
void growable_free(growable *array);

/* Room for at least capacity elements. On false the array is as before. */
bool growable_reserve(growable *array, size_t capacity);

/* Adds one element, its bytes undefined, and returns it; NULL when memory ran out. The pointer holds until
 * the next push or reserve. */
void *growable_push(growable *array);

/* Hands the data over, trimmed to count, and leaves the array empty. */
void *growable_take(growable *array);

/* realloc: the one place where the mesh readers get memory. It has a file of its own, so that a test can put
 * a failing one in its place. */
void *io_realloc(void *memory, size_t size);

/* New memory from it, all bytes 0. */
void *io_zeroed(size_t size);

/* ---- paths --------------------------------------------------------------------------------------------- */

/* extension: with its dot; upper and lower case are the same. A name that consists of the extension alone
 * does not count. */
bool path_has_extension(const char *path, const char *extension);

/* The length of the ending if it is that of a mesh file, else 0. */
size_t path_mesh_ending(const char *path);

/* Advice about a path that is not there, as the end of a sentence: patterns that no shell has filled in, and
 * ways in which other programs write the number of a frame. "": nothing is to be seen in it. */
const char *path_missing_advice(const char *path);

/* The characters that separate the names of a path: on Windows either slash does, and drives have letters. */
#ifdef _WIN32
#define PATH_SEPARATORS "/\\"
#else
#define PATH_SEPARATORS "/"
#endif

static inline bool path_is_separator(char c) {
    return c == PATH_SEPARATORS[0] ||
           (sizeof PATH_SEPARATORS > 2 && c == PATH_SEPARATORS[sizeof PATH_SEPARATORS - 2]);
}

/* The last separator; NULL: there is none. */
const char *path_last_separator(const char *path);

/* The length of the drive at the beginning, "C:" on Windows, else 0. */
size_t path_drive_length(const char *path);

/* Returns the part after the last separator. */
const char *path_file_name(const char *path);

static inline bool path_is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* ---- files that may be named pipes --------------------------------------------------------------------- */

/* The other side of a pipe comes when it likes: a program that is told to stop does not wait for it. */

/* While a pipe has nobody on its other side, or nothing to read, any thread calls stopped again and again.
 * When it returns true, the opening or reading fails with EINTR. NULL, as at the start: pipes wait as the
 * system has it. */
void pipe_file_ask(bool (*stopped)(void));

/* As fopen with "rb", of any file. NULL: errno says why. A stream of a pipe may have no descriptor
 * (fileno). */
FILE *pipe_file_read(const char *path);

/* As fopen with "wb", of a pipe. */
FILE *pipe_file_write(const char *path);
