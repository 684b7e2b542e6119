/* Reads the folder and the ending of a path. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

/* extension: with its dot; upper and lower case are the same. A name that consists of the extension alone does not
 * count. */
bool path_has_extension(const char *path, const char *extension);

/* The length of the ending if it is that of a mesh file, else 0. */
size_t path_mesh_ending(const char *path);

/* What to do about a path that is not there, as the end of a sentence: patterns that no shell has filled in, and ways in which other
 * programs write the number of a frame. "": nothing is to be seen in it. */
const char *path_missing_advice(const char *path);

/* What separates the names of a path: on Windows either slash does, and drives have letters. */
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
