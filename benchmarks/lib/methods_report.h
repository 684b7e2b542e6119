/* The table and the JSON of benchmarks/methods. */
#pragma once

#include "benchmarks/lib/contest.h"
#include "tool/io/json.h"

enum { RESULTS_MAX = 32 };

/* The results on one recording; methods none and iccd come first. */
typedef struct methods_report {
    const truth *truth;
    contest_result results[RESULTS_MAX];
    uint32_t count, regions;
} methods_report;

void methods_report_print(const methods_report *r);

/* Writes one object per method over all intervals: means per interval, but losses per run. */
void methods_report_write(const methods_report *r, json *out, uint32_t thread_count);
