/* The share of a step that no further thread takes over. */
#pragma once

#include "benchmarks/lib/stages.h"

/* Means per interval. */
typedef struct serial_share {
    double total_ms, loops_ms; /* loops: the time within parallel loops */
    double loops, tasks;       /* how many loops a step hands out, and their tasks */
    size_t held;               /* bytes of context, mesh and detector after the intervals */
} serial_share;

/* Steps through the intervals on one thread, cut up for `thread_count` threads: a host's loop runs the tasks one after the other and
 * takes the time. So other programs on the machine disturb both times alike. The step with the least total of `rounds` counts. */
bool serial_share_measure(const deforming_body *b, cscd_method method, uint32_t thread_count,
                          uint32_t intervals, uint32_t rounds, serial_share *out, io_error *error);

/* Returns the speedup by that many processors if loops divide evenly and cost nothing to start (Amdahl's law). */
double serial_share_speedup(const serial_share *s, double processors);
