/* The one clear line that a failing file operation leaves behind. */
#pragma once

#include <stdbool.h>

typedef struct io_error {
    char text[1024];
} io_error;

/* Formats "what is wrong, where (file, line or byte offset), what was expected"; always returns false,
 * so that a reader can end with `return io_fail(...)`. error may be NULL. */
bool io_fail(io_error *error, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Why something could not be written, in words and by errno, and what helps against it. */
const char *io_write_reason(void);
/* "PATH: cannot write: " and the reason; "-" is the standard output. */
bool io_fail_write(io_error *error, const char *path);
