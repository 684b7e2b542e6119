/* A solution for charges in a process of its own, so that its peak of memory is known and memory that others left does not matter. */
#pragma once

#include "cscd/cscd.h"
#include "models/shapes/body.h"
#include "tool/io/io.h"

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
