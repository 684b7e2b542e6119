/* Keeps a command from writing over what it reads. */
#pragma once

#include "tool/io/io_error.h"

#include <stdbool.h>
#include <stddef.h>

/* False, with the reason, when `path` is one of the files in others. Links are followed, and NULLs among
 * the others are skipped. path may be NULL. */
bool output_path_differs(const char *path, const char *const *others, size_t other_count, io_error *error);

/* The same, but false also when the path is named like a mesh or a point cache, because it may then be a
 * frame of a pattern or of a folder. */
bool output_path_is_safe(const char *path, const char *const *others, size_t other_count, io_error *error);

/* False, with the reason, when the path has the ending of another format than the one that is written, which
 * `ending` names (".png"). Endings that no program knows are fine. path may be NULL. */
bool output_path_fits(const char *path, const char *ending, io_error *error);

/* Can path be opened for writing? Its content stays as it is. A command asks this of all outputs before it
 * truncates any. path may be NULL. */
bool output_path_opens(const char *path, io_error *error);
