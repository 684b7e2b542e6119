/* A temporary folder for a test, files of given bytes in it, and random damage to bytes. */
#pragma once

#include "tests/support/random.h"

#include <stdbool.h>
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

/* ---- one folder for a program -------------------------------------------------------------------------- */

extern temp_folder own_folder;

/* For cmocka_run_group_tests. */
int own_folder_make(void **state);
int own_folder_remove(void **state);

/* ---- damage -------------------------------------------------------------------------------------------- */

/* How many bytes one fault may add. */
enum { DAMAGE_GROWTH_MAX = 64 };

/* Does one more fault to bytes, which have room for DAMAGE_GROWTH_MAX more, and returns their new size, never 0: a bit flipped, another
 * byte, a byte doubled or dropped, the end cut off, a piece copied over another, or a number that becomes an extreme one. size is not
 * 0. */
size_t damage_bytes(random_stream *random, unsigned char *bytes, size_t size);

/* ---- allocations that fail ----------------------------------------------------------------------------- */

/* Allocations of the readers and writers fail when a test wants it. The linker puts those of io_allocations.c in place of their
 * io_realloc (--wrap). */
extern long io_allocations_left;  /* so many succeed before one fails; negative: none fails */
extern bool io_allocation_failed; /* one did, since a test has cleared it */

/* for (long place = 0; io_allocations_go_on(place); place++): the first allocation fails in the first round, the second one in the
 * second, and so on, until a round had none to fail. */
bool io_allocations_go_on(long place);
