/* The parts of `cscd sense`: its options, its picture, and its results for each interval and in all, as a table and as files. */
#pragma once

#include "cscd/sensors.h"
#include "tool/common/frame_range.h"
#include "tool/common/options.h"
#include "tool/common/plans.h"
#include "tool/common/recording.h"
#include "tool/io/io.h"
#include "tool/io/json.h"
#include "tool/io/output_file.h"
#include "tool/picture/picture.h"

#include <stdio.h>

/* ---- options ------------------------------------------------------------------------------------------- */

typedef struct sense_options {
    recording_options source;
    frame_range frames;
    cscd_sensor_options sensors;
    const char *plan_path; /* NULL: as for replay */
    bool no_plan;
    bool compare, quiet;
    const char *json_path, *csv_path, *picture_path; /* NULL: not given */
    frame_number frame;                              /* of the picture; not given: the last */
    picture_options picture;
    up_axis up;
    int argument_count; /* the command line, for the provenance */
    char **arguments;
} sense_options;

extern const option_table sense_table;

/* False: *code is the exit code to end with (0 after --help). */
bool sense_options_parse(int argument_count, char **arguments, sense_options *out, int *code);

/* ---- a picture of cells, particles and the vertices that these have visited ---------------------------- */

/* The places where the particles have been so far. */
typedef struct sense_paths {
    uint32_t particle_count;
    uint32_t *places; /* the vertex of each particle after the last interval */
    growable steps;   /* of uint32_t[2]: from a vertex to a vertex */
} sense_paths;

sense_paths sense_paths_none(void);
void sense_paths_free(sense_paths *paths);

/* Adds the steps of an interval. False when out of memory. */
bool sense_paths_follow(sense_paths *paths, const cscd_sensors *sensors);

/* Call it when particles get new numbers; the paths so far stay. */
void sense_paths_break(sense_paths *paths);

typedef struct sense_view {
    const recording *recording;
    const cscd_sensors *sensors;
    const sense_paths *paths;
    const double *positions; /* of the frame */
    int32_t frame;
    const cscd_warnings *warnings; /* of the interval that ends there; NULL: there is none */
} sense_view;

bool sense_picture_draw(const sense_view *view, const sense_options *options, io_error *error);

/* ---- results ------------------------------------------------------------------------------------------- */

/* Numbers of object pairs: with warnings, with confirmed warnings, in contact by the detector, and in
 * common. */
typedef struct pair_counts {
    uint32_t warned, confirmed, touching, found, confirmed_found;
} pair_counts;

typedef struct sense_interval {
    int32_t frame;
    const cscd_warnings *warnings;
    uint32_t confirmed; /* warnings whose exact check has found a contact */
    uint32_t renewed;   /* parts that got new cells after it */
    pair_counts pairs;
    cscd_sensor_timings timings;
    cscd_sensor_counters counters;
    double trees_ms; /* of the detector; 0 without --compare */
} sense_interval;

/* The stages and counters of a step of the sensors, a row each, as the files name them. */
typedef struct sense_timing_row {
    const char *name;
    size_t place; /* of the double in cscd_sensor_timings */
} sense_timing_row;

typedef struct sense_counter_row {
    const char *name, *sum_name; /* in an interval, and of the sum over all intervals */
    size_t place;                /* of the uint64_t in cscd_sensor_counters */
} sense_counter_row;

/* All members of the structs; the total is the last of the timings. */
enum {
    SENSE_TIMINGS = offsetof(cscd_sensor_timings, reserved) / sizeof(double),
    SENSE_COUNTERS = offsetof(cscd_sensor_counters, reserved) / sizeof(uint64_t)
};
extern const sense_timing_row sense_timing_rows[];   /* SENSE_TIMINGS of them */
extern const sense_counter_row sense_counter_rows[]; /* SENSE_COUNTERS of them */

double sense_timing_ms(const cscd_sensor_timings *timings, const sense_timing_row *row);
uint64_t sense_counter_value(const cscd_sensor_counters *counters, const sense_counter_row *row);

typedef struct sense_totals {
    uint32_t intervals, intervals_warned, intervals_touching, renewals;
    uint64_t warnings, confirmed;
    uint64_t warned_pairs, confirmed_pairs, touching_pairs, found_pairs, confirmed_found_pairs;
    cscd_sensor_counters counters; /* sums */
    cscd_sensor_timings timings;   /* sums */
    double sense_max_ms, trees_ms, trees_max_ms;
} sense_totals;

void sense_totals_add(sense_totals *t, const sense_interval *interval);

/* The share of the pairs in contact that were found, and the share of the warned pairs that are in
 * contact; 1 if there is no such pair. */
double sense_recall(const sense_totals *t);
double sense_precision(const sense_totals *t);
/* The share of the pairs in contact that have a confirmed warning. */
double sense_confirmed_recall(const sense_totals *t);

void sense_print_head(bool compare);
void sense_print_row(const sense_interval *interval, bool compare);

/* The objects of a run, for the table and the files. */
typedef struct sense_subject {
    const sense_options *options;
    const recording *recording;
    const plan_choice *plan;
    const cscd_sensors *sensors;
} sense_subject;

/* In a scene of one object its components are the objects that are watched. */
uint32_t sense_object_count(const cscd_mesh *mesh);

void sense_print_totals(const sense_subject *subject, const sense_totals *t);

/* The warnings as CSV and the intervals as JSON; either may be absent. */
typedef struct sense_files {
    output_file csv, json; /* their files are NULL when not wanted */
    json out;
} sense_files;

bool sense_files_open(const sense_options *options, sense_files *out, io_error *error);
bool sense_files_add(sense_files *files, const sense_subject *subject, const sense_interval *interval,
                     io_error *error);
/* stopped_by: why not every interval is there; NULL when all are. */
bool sense_files_close(sense_files *files, const sense_subject *subject, const sense_totals *t,
                       const char *stopped_by, io_error *error);

const char *sense_method_name(cscd_sensor_method method);
const char *sense_renewal_name(cscd_renewal renewal);
