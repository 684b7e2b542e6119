/* A solution for charges in a process of its own, so that its peak of memory is known and memory that others left
 * does not matter; and the tables of benchmarks/charge.c, which are made of such trials. */
#pragma once

#include "cscd/cscd.h"
#include "models/shapes/catalogue.h"
#include "tool/io/io.h"
#include "tool/io/json.h"

typedef struct charge_request {
    cscd_charge_solver solver;
    uint32_t threads;
    bool regions; /* make a whole plan, not the charges alone */
} charge_request;

typedef struct charge_trial {
    cscd_status status;
    char detail[512];    /* the sentence of a failure */
    uint32_t iterations; /* of all components; 0: of the dense system, or unknown, with several threads */
    uint32_t components, regions;
    double capacitance; /* of all components */
    double assembly_ms, solve_ms, regions_ms, total_ms, peak_bytes;
} charge_trial;

/* Writes what came of it, and, if density is not NULL, that of each triangle. Returns false when there is no process, or it ended early. */
bool charge_trial_run(const body *b, const charge_request *request, charge_trial *out, double *density,
                      io_error *error);

/* "tree", "coarse", "dense", as the tool calls them. */
const char *charge_solver_name(cscd_charge_solver solver);

/* ---- tables -------------------------------------------------------------------------------------------- */

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

/* ---- bodies whose charge is known ---------------------------------------------------------------------- */

/* At potential 1 in Gaussian units; NAN: unknown. That of the cube is known to 14 digits. */
double exact_capacitance(body_kind kind);

bool has_exact_density(body_kind kind);

/* The charge per area at the place of the surface that is nearest to the point, or in the same direction. */
double exact_density(body_kind kind, const double point[3]);

/* ---- meshes that are hard to solve --------------------------------------------------------------------- */

enum { HARD_CONDUCTORS = 16 };

/* To be freed by body_free(&c->body). */
typedef struct hard_conductor {
    char name[48];
    body body;
    double capacitance; /* of all components together, about; NAN: not known */
} hard_conductor;

bool hard_conductor_make(uint32_t index, hard_conductor *out, io_error *error);
