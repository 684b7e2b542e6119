/* What is printed of the cases: a line each, a summary by class beside what is wanted, and the failures. */
#pragma once

#include "benchmarks/untangle/untangle_trial.h"
#include "tool/io/json.h"

typedef struct untangle_cases {
    untangle_case *items;
    uint32_t count, capacity;
} untangle_cases;

void untangle_cases_add(untangle_cases *l, const untangle_case *c);
void untangle_cases_free(untangle_cases *l);

/* Whether a case is one of the failures: not clean, or with a broken promise. */
bool untangle_case_failed(const untangle_case *c);

void print_case_heading(void);
void print_case(const untangle_case *c);
void print_summary(const untangle_cases *l);
void print_failures(const untangle_cases *l);

/* The rows of JSON: one of each case, and one of each line of the summary. */
void write_case(json *out, const untangle_case *c);
void write_summary(json *out, const untangle_cases *l);
