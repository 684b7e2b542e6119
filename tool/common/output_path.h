/* Keeps a command from writing over what it reads. */
#pragma once

#include "tool/common/option_table.h"

/* Readers of paths (const char *), by which the functions below know what a row of a table of options is: a file or folder that the
 * command reads, or one that it looks after by itself; a file that it writes, with an ending of those that the row's value has; the
 * beginning of the names of several files that it writes. */
bool read_input_path(const char *text, void *place);
bool read_output_path(const char *text, void *place);
bool read_output_stem(const char *text, void *place);

bool option_is_output(const option_row *row);

/* Outputs are not inputs, and not each other, are not named like meshes, and have the ending of their format. False, with the reason and
 * the option. */
bool output_paths_are_safe(const option_table *table, const void *options, const given_options *given,
                           io_error *error);

/* Can all files of a command be opened for writing? See output_path_opens. */
bool output_paths_open(const option_table *table, const void *options, io_error *error);

/* Collects the paths of all outputs, NULLs among them, in the order of the table. Returns the number. */
size_t output_paths_of(const option_table *table, const void *options, const char *paths[OPTION_ROWS_MAX]);

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
