/* A temporary folder for a test, and files of given bytes in it. */
#pragma once

#include <stddef.h>

typedef struct temp_folder {
    char path[256];
} temp_folder;

typedef struct temp_path {
    char text[512];
} temp_path;

/* All functions end the program when the file system refuses, since no test can continue then. */

/* Makes a new, empty folder. */
temp_folder temp_folder_make(void);

/* Removes the folder and the files in it. */
void temp_folder_remove(const temp_folder *folder);

/* Returns the path of the file `name` in the folder, without creating it. */
temp_path temp_file_path(const temp_folder *folder, const char *name);

/* Writes the bytes to the file `name` in the folder and returns its path. */
temp_path temp_file_write(const temp_folder *folder, const char *name, const void *bytes, size_t size);

/* Reads a whole file as a string, which the caller frees. size may be NULL. */
char *temp_file_read(const char *path, size_t *size);
