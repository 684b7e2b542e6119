/* The table and the JSON of benchmarks/methods. */
#pragma once

#include "benchmarks/lib/contest.h"
#include "src/io/json.h"

enum { RESULTS_MAX = 32 };

/* Of one recording; methods none and iccd first. */
typedef struct report {
    const truth *truth;
    result results[RESULTS_MAX];
    uint32_t count, regions;
} report;

void report_print(const report *r);

/* One object per method over all intervals: means per interval, but losses per run. */
void report_write(const report *r, json *out, uint32_t thread_count);
