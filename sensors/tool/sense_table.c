/* Sums over the intervals of `cscd sense`, and the table of them. */
#include "sensors/tool/sense.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define TIME_OF(member)  offsetof(cscd_sensor_timings, member)
#define COUNT_OF(member) offsetof(cscd_sensor_counters, member)

const sense_timing_row sense_timing_rows[] = {
    {"walk", TIME_OF(walk_ms)},       {"verdict", TIME_OF(verdict_ms)}, {"exact", TIME_OF(exact_ms)},
    {"renewal", TIME_OF(renewal_ms)}, {"total", TIME_OF(total_ms)},
};

const sense_counter_row sense_counter_rows[] = {
    {"rounds", "walk_rounds", COUNT_OF(rounds)},
    {"cycles", "cycles", COUNT_OF(cycles)},
    {"vertices", "walk_vertices", COUNT_OF(vertices)},
    {"particle_pairs", "particle_pairs", COUNT_OF(particle_pairs)},
    {"tests", "tests", COUNT_OF(tests)},
};

_Static_assert(sizeof sense_timing_rows / sizeof *sense_timing_rows == SENSE_TIMINGS,
               "a member of cscd_sensor_timings has no row");
_Static_assert(sizeof sense_counter_rows / sizeof *sense_counter_rows == SENSE_COUNTERS,
               "a member of cscd_sensor_counters has no row");

double sense_timing_ms(const cscd_sensor_timings *timings, const sense_timing_row *row) {
    double value;
    memcpy(&value, (const char *)timings + row->place, sizeof value);
    return value;
}

uint64_t sense_counter_value(const cscd_sensor_counters *counters, const sense_counter_row *row) {
    uint64_t value;
    memcpy(&value, (const char *)counters + row->place, sizeof value);
    return value;
}

static void add_step(sense_totals *t, const sense_interval *i) {
    for (int k = 0; k < SENSE_TIMINGS; k++) {
        const sense_timing_row *row = &sense_timing_rows[k];
        double sum = sense_timing_ms(&t->timings, row) + sense_timing_ms(&i->timings, row);
        memcpy((char *)&t->timings + row->place, &sum, sizeof sum);
    }
    for (int k = 0; k < SENSE_COUNTERS; k++) {
        const sense_counter_row *row = &sense_counter_rows[k];
        uint64_t sum = sense_counter_value(&t->counters, row) + sense_counter_value(&i->counters, row);
        memcpy((char *)&t->counters + row->place, &sum, sizeof sum);
    }
}

void sense_totals_add(sense_totals *t, const sense_interval *i) {
    t->intervals++;
    t->intervals_warned += i->warnings->count > 0;
    t->intervals_touching += i->pairs.touching > 0;
    t->renewals += i->renewed;
    t->warnings += i->warnings->count;
    t->confirmed += i->confirmed;
    t->warned_pairs += i->pairs.warned;
    t->confirmed_pairs += i->pairs.confirmed;
    t->touching_pairs += i->pairs.touching;
    t->found_pairs += i->pairs.found;
    t->confirmed_found_pairs += i->pairs.confirmed_found;
    add_step(t, i);
    t->trees_ms += i->trees_ms;
    t->sense_max_ms = fmax(t->sense_max_ms, i->timings.total_ms);
    t->trees_max_ms = fmax(t->trees_max_ms, i->trees_ms);
}

static double share_of(uint64_t part, uint64_t whole) {
    return whole > 0 ? (double)part / (double)whole : 1.0;
}

double sense_recall(const sense_totals *t) {
    return share_of(t->found_pairs, t->touching_pairs);
}

double sense_precision(const sense_totals *t) {
    return share_of(t->found_pairs, t->warned_pairs);
}

double sense_confirmed_recall(const sense_totals *t) {
    return share_of(t->confirmed_found_pairs, t->touching_pairs);
}

const char *sense_method_name(cscd_sensor_method method) {
    return method == CSCD_SENSORS_RANDOM ? "random" : "cells";
}

const char *sense_renewal_name(cscd_renewal renewal) {
    static const char *const names[] = {"none", "area", "edge", "concave"};
    return names[renewal];
}

void sense_print_head(bool compare) {
    printf("%7s %9s %9s %7s %7s %9s %8s %8s %10s", "frame", "warnings", "confirmed", "renewed", "rounds",
           "vertices", "tests", "pairs", "sense ms");
    if (compare) printf(" %8s %6s %7s %6s %10s", "contact", "found", "missed", "false", "trees ms");
    putchar('\n');
}

void sense_print_row(const sense_interval *i, bool compare) {
    const pair_counts *p = &i->pairs;
    printf("%7d %9zu %9u %7u %7llu %9llu %8llu %8u %10.3f", i->frame, i->warnings->count, i->confirmed,
           i->renewed, (unsigned long long)i->counters.rounds, (unsigned long long)i->counters.vertices,
           (unsigned long long)i->counters.tests, p->warned, i->timings.total_ms);
    if (compare)
        printf(" %8u %6u %7u %6u %10.3f", p->touching, p->found, p->touching - p->found, p->warned - p->found,
               i->trees_ms);
    putchar('\n');
}

static void print_comparison(const sense_totals *t) {
    printf("pairs of objects in contact: %llu in %u intervals; found %llu, missed %llu, false %llu\n",
           (unsigned long long)t->touching_pairs, t->intervals_touching, (unsigned long long)t->found_pairs,
           (unsigned long long)(t->touching_pairs - t->found_pairs),
           (unsigned long long)(t->warned_pairs - t->found_pairs));
    printf("recall %.4f, precision %.4f; confirmed: recall %.4f\n", sense_recall(t), sense_precision(t),
           sense_confirmed_recall(t));
    printf("trees: %.3f ms mean, %.3f ms most; sensors take %.2f of that\n",
           t->intervals > 0 ? t->trees_ms / t->intervals : 0.0, t->trees_max_ms,
           t->trees_ms > 0.0 ? t->timings.total_ms / t->trees_ms : 0.0);
}

uint32_t sense_object_count(const cscd_mesh *mesh) {
    uint32_t count = cscd_mesh_object_count(mesh);
    return count == 1 ? cscd_mesh_component_count(mesh) : count;
}

void sense_print_totals(const sense_subject *subject, const sense_totals *t) {
    const cscd_mesh *mesh = subject->recording->mesh;
    double count = t->intervals > 0 ? t->intervals : 1.0;
    printf("\n%s: %u triangles, %u objects, %u parts, %u cells; method %s, %u particles\n",
           subject->options->source.model_path, cscd_mesh_triangle_count(mesh), sense_object_count(mesh),
           cscd_sensors_part_count(subject->sensors), cscd_sensors_cell_count(subject->sensors),
           sense_method_name(subject->options->sensors.method),
           cscd_sensors_particle_count(subject->sensors));
    plan_choice_print(subject->plan);
    printf("warnings: %llu in %u of %u intervals", (unsigned long long)t->warnings, t->intervals_warned,
           t->intervals);
    if (subject->options->sensors.exact)
        printf("; confirmed %llu; tests %llu", (unsigned long long)t->confirmed,
               (unsigned long long)t->counters.tests);
    printf("\nwalks: %llu rounds, %llu cycles, %llu vertices, %llu pairs within R_eff; cells renewed: %u\n",
           (unsigned long long)t->counters.rounds, (unsigned long long)t->counters.cycles,
           (unsigned long long)t->counters.vertices, (unsigned long long)t->counters.particle_pairs,
           t->renewals);
    printf("sensors: %.3f ms mean, %.3f ms most (", t->timings.total_ms / count, t->sense_max_ms);
    for (int k = 0; k < SENSE_TIMINGS - 1; k++)
        printf("%s%s %.3f", k > 0 ? ", " : "", sense_timing_rows[k].name,
               sense_timing_ms(&t->timings, &sense_timing_rows[k]) / count);
    printf(")\n");
    if (subject->options->compare) print_comparison(t);
}
