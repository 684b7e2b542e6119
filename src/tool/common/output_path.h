/* Keeps a command from writing over what it reads. */
#pragma once

#include "src/io/io_error.h"

#include <stdbool.h>
#include <stddef.h>

/* False, with the reason, when `path` is one of the files in others (links followed; NULLs among them are
 * skipped). path NULL is fine. */
bool output_path_differs(const char *path, const char *const *others, size_t other_count, io_error *error);

/* The same, and false too when it is named like a mesh or a point cache: it may then be a frame of a pattern
 * or a folder. */
bool output_path_is_safe(const char *path, const char *const *others, size_t other_count, io_error *error);

/* Can path be opened for writing? What it holds stays as it is. Asked of all outputs before any is truncated.
 * NULL is fine. */
bool output_path_opens(const char *path, io_error *error);
