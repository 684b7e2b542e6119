/* What programs of benchmarks have in common: a JSON file of rows and where they come from, options, and progress. */
#pragma once

#include "cscd/cscd.h"
#include "models/shapes/catalogue.h"
#include "tool/common/terminal.h"
#include "tool/io/io.h"
#include "tool/io/json.h"

/* Begins the object. Without a path there is no file: out->file is NULL then, and nothing may be written. */
bool row_file_open(const char *path, json *out, io_error *error);

/* Begins and ends the list of rows. The second also writes the provenance, ends the object and closes the file, if there is one. */
void row_file_begin(json *out);
bool row_file_close(const char *path, int argument_count, char **arguments, uint32_t thread_count, json *out,
                    io_error *error);

/* ---- options ------------------------------------------------------------------------------------------- */

enum { SIZES_MAX = 16, INTERVALS_MAX = 60 };

typedef struct bench_options {
    uint32_t sizes[SIZES_MAX], size_count; /* triangles */
    uint32_t interval_count;               /* 0: fewer for larger meshes */
    uint32_t thread_count;
    cscd_simd simd;
    cscd_volume volume;
    body_kind kind;
    bool quick, shuffled;
    const char *data; /* NULL: none is given */
    const char *json_path;
} bench_options;

/* Returns a folder of the data to compare with, below the one that the environment variable CSCD_DATA
 * names, or NULL when that is not set; to be freed. */
char *bench_data_folder(const char *name);

/* Whether a folder with data is given; when it is not, says that `what` is left out. */
bool bench_has_data(const bench_options *o, const char *what);

/* Returns the number of measured intervals for a size. */
uint32_t bench_intervals(const bench_options *o, uint32_t triangle_count);

typedef struct bench_program {
    const char *name, *help;               /* the list of options is printed after the help */
    const uint32_t *sizes;                 /* the default sizes; */
    uint32_t size_count, quick_size_count; /* with --quick, the first ones */
    /* Prints the tables and, when out->file is not NULL, writes a row of JSON for each row of them. */
    bool (*run)(const bench_options *o, json *out, io_error *error);
} bench_program;

/* Runs a whole program and returns its exit status: parses, runs, explains errors, and adds the origin to
 * the rows of --json. */
int bench_main(const bench_program *program, int argument_count, char **arguments);
