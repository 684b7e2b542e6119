/* What reads files of strangers: each format with its reader, and what must hold whatever a file says. */
#pragma once

#include "tests/support/files.h"
#include "tool/io/mesh_file.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct reading {
    const char *format; /* as the folder of its files is called */
    const char *ending; /* of its files */
    bool (*read)(const char *path, const mesh_file *model, io_error *error);
    bool has_model;      /* its files belong to a mesh */
    size_t memory_share; /* it may take so many bytes for each of the file, beside a constant */
} reading;

/* NULL: there is no such format. */
const reading *reading_named(const char *format);

/* By the ending of the path; NULL: no reader takes such files. */
const reading *reading_of_file(const char *path);

/* The mesh of all files that have no mesh of their own: a tetrahedron. */
const mesh_file *reading_tetrahedron(void);

/* Reads the bytes from the file `name` in the folder, which is written anew. Returns whether they were accepted. Ends the program, with
 * the reason, if what was read is no mesh, if a refusal is not one line that names the file, or if it took more than READING_SECONDS of
 * processor time or more memory than the format allows. */
enum { READING_SECONDS = 5 };
bool reading_try(const reading *r, const temp_folder *folder, const char *name, const mesh_file *model,
                 const unsigned char *bytes, size_t size);

/* ---- memory -------------------------------------------------------------------------------------------- */

/* Begins to count, from 0. */
void reading_memory_begin(void);

/* The most that was allocated at once since then; 0 in a program without the sanitizer. */
size_t reading_memory_peak(void);
