/* A whole file in memory, a position in it, and errors that name the place. */
#pragma once

#include "tool/io/io_error.h"
#include "tool/io/mesh_parts.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct file_reader {
    const char *path; /* the caller's, alive as long as the reader */
    io_error *error;
    char *bytes; /* `size` bytes, and a 0 behind the last */
    size_t size;
    size_t at;              /* the next byte to read */
    size_t line;            /* the line of `at`, from 1 */
    bool binary;            /* places are byte offsets, not lines */
    size_t mark;            /* in binary files: the first byte of the value last read */
    bool comments;          /* text: # starts a comment */
    bool continuations;     /* text: a backslash before a line's end is a blank */
    mesh_parts_by parts_by; /* of meshes: what their parts are */
} file_reader;

/* On false *reader owns nothing. */
bool file_reader_open(file_reader *reader, const char *path, io_error *error);
void file_reader_close(file_reader *reader);

/* Asks the system to begin to fetch the file from its disk, without waiting for it. Where that cannot be, nothing happens. */
void file_reader_expect(const char *path);

/* Write "path: message" to reader->error, or, with the place where the reader is, "path:LINE: message", as compilers do, or
 * "path: byte N: message". The message is always one line; the result is always false. */
bool file_reader_fail(file_reader *reader, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool file_reader_fail_here(file_reader *reader, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
