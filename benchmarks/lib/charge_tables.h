/* The tables of benchmarks/charge.c. Each prints its rows and, when out->file is not NULL, writes them as JSON. */
#pragma once

#include "src/io/io_error.h"
#include "src/io/json.h"

typedef struct charge_limits {
    uint32_t most, dense_most; /* triangles, and those that are solved by a dense matrix */
} charge_limits;

bool charge_print_errors(const charge_limits *limits, json *out, io_error *error);
bool charge_print_ranks(const charge_limits *limits, json *out, io_error *error);
bool charge_print_times(const charge_limits *limits, json *out, io_error *error);
bool charge_print_hard(const charge_limits *limits, json *out, io_error *error);
