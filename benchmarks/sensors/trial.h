/* One recording under particle sensors of some rules, and what the detector finds in it; and steps of sensors by
 * size and by number of objects. */
#pragma once

#include "benchmarks/lib/scene_files.h"
#include "sensors/tool/object_pairs.h"
#include "tool/io/io.h"

/* Sorts the values. */
double sensor_median(double *values, uint32_t count);

/* Pairs of objects in contact, interval by interval. */
typedef struct sensor_truth {
    object_pairs *touching;
    uint32_t interval_count;
    double trees_ms; /* median */
} sensor_truth;

bool sensor_truth_find(const recording_data *r, sensor_truth *out, io_error *error);
void sensor_truth_free(sensor_truth *truth);

typedef struct sensor_rules {
    const char *name;
    bool plan; /* parts are the regions of a plan by charge, else components */
    enum { RULE_DEFAULT, RULE_VECTOR, RULE_SCALAR, RULE_STRONGEST } rule; /* as in particles.h */
    double mu_edges; /* mu in mean edges of the first frame; 0: the default */
    uint32_t cells;  /* of each part; 0: the default */
    /* R_eff in mu, and in largest diameters of a cell of the first frame; both 0: the default */
    double reach_mu, reach_cells;
    bool random, as_cells;
    uint32_t particles, seed; /* RANDOM; as_cells: as many as there are cells */
} sensor_rules;

/* Pairs and particles of all intervals together; rounds and shares of moments with a cycle per moment; ms:
 * the median of a step. Several trials are summed up. */
typedef struct sensor_trial {
    double particles, touching, warned, found, confirmed, rounds, cycles, ms, trees_ms;
    double vertices, pairs; /* walked on, and within R_eff, in all intervals */
} sensor_trial;

bool sensor_trial_run(const recording_data *r, const sensor_truth *truth, const sensor_rules *rules,
                      sensor_trial *out, io_error *error);
void sensor_trial_add(sensor_trial *sum, const sensor_trial *one);

/* ---- cost of steps ------------------------------------------------------------------------------------- */

/* Prints two tables on the standard output. */
bool sensor_cost_print(io_error *error);
