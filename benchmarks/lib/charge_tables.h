/* The tables of benchmarks/charge.c. Each prints its rows and, when out->file is not NULL, writes them as JSON. */
#pragma once

#include "benchmarks/lib/charge_trial.h"
#include "tool/io/json.h"

typedef struct charge_limits {
    uint32_t most, dense_most; /* triangles, and those that are solved by a dense matrix */
} charge_limits;

bool charge_print_errors(const charge_limits *limits, json *out, io_error *error);
bool charge_print_ranks(const charge_limits *limits, json *out, io_error *error);
bool charge_print_times(const charge_limits *limits, json *out, io_error *error);
bool charge_print_hard(const charge_limits *limits, json *out, io_error *error);

/* The first and the last members of a row in JSON. Without a file the first returns false, and there is no row to write. */
bool charge_row_begin(json *out, const char *table, const char *name, uint32_t triangles,
                      cscd_charge_solver solver);
void charge_row_end(json *out, const charge_trial *t);
