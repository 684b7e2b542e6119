/* Options, progress and JSON that the programs on deforming bodies have in common. */
#ifndef CSCD_BENCHMARK_OPTIONS_H
#define CSCD_BENCHMARK_OPTIONS_H

#include "cscd/cscd.h"
#include "models/shapes/catalogue.h"
#include "src/cli/progress.h"
#include "src/io/json.h"

enum { SIZES_MAX = 16, INTERVALS_MAX = 60 };

typedef struct bench_options {
    uint32_t sizes[SIZES_MAX], size_count; /* triangles */
    uint32_t interval_count;               /* 0: fewer with size */
    uint32_t thread_count;
    cscd_simd simd;
    body_kind kind;
    bool quick, shuffled;
    const char *data, *json_path;
} bench_options;

/* What all of them share; to be printed behind a program's own help. */
extern const char bench_options_help[];

/* False: what is wrong has been said on stderr. Starts from *o, so the caller sets its defaults there. */
bool bench_options_parse(const char *program, int count, char **arguments, bench_options *o);

/* The first `count` of sizes, where none are given. */
void bench_default_sizes(bench_options *o, const uint32_t *sizes, uint32_t count);

/* Measured intervals of a size. */
uint32_t bench_intervals(const bench_options *o, uint32_t triangle_count);

/* The rows as JSON, with where they come from; file is NULL, and nothing is written, without --json. */
typedef struct bench_json {
    json out;
    int argument_count;
    char **arguments;
    uint32_t thread_count;
} bench_json;

bool bench_json_open(const bench_options *o, int argument_count, char **arguments, bench_json *out,
                     io_error *error);
bool bench_json_close(bench_json *j, io_error *error);

/* False after saying it on stderr. */
bool bench_fail(const char *program, const io_error *error);

#endif
