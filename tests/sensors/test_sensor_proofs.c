/* What every call promises (tests/support/proofs/proof.h), of particle sensors. */
#include "cscd/sensors.h"
#include "tests/support/proofs/openings.h"
#include "tests/support/test.h"

/* What the call at hand writes, in the words that a proof has for others than the library's usual answers. */
typedef union sensor_answer {
    cscd_sensors *sensors;
    cscd_warnings warnings;
} sensor_answer;

static sensor_answer *answer_of(proof *p) {
    _Static_assert(sizeof(sensor_answer) <= sizeof p->answer.words, "there are too few words");
    return (sensor_answer *)(void *)p->answer.words;
}

static void close_sensors(proof *p) {
    cscd_sensors_destroy(p->own);
}

static cscd_status create_sensors(proof *p) {
    cscd_sensor_options options = cscd_sensor_defaults();
    cscd_view x;
    options.method = p->row->seed == 0 ? CSCD_SENSORS_CELLS : CSCD_SENSORS_RANDOM;
    options.within = true;
    return cscd_sensors_create(p->context, p->mesh, p->plan, at_moment(p, 0, &x), &options,
                               &answer_of(p)->sensors);
}

static void read_cells(proof *p) {
    for (uint32_t v = 0; v < p->shape.vertex_count; v++) {
        const uint32_t cell = cscd_sensors_vertex_cell(p->own, v);
        proof_add(p, &cell, sizeof cell);
    }
}

static void keep_sensors(proof *p) {
    p->own = answer_of(p)->sensors;
    read_cells(p);
}

static cscd_status renew_part(proof *p) {
    cscd_view x;
    return cscd_sensors_renew(p->own, at_moment(p, 2, &x), 1);
}

static cscd_status sense_between(proof *p, int from, int to) {
    cscd_view x0, x1;
    return cscd_sensors_step(p->own, at_moment(p, from, &x0), at_moment(p, to, &x1), &answer_of(p)->warnings);
}

static cscd_status sense_first(proof *p) {
    return sense_between(p, 0, 1);
}

static cscd_status sense_second(proof *p) {
    return sense_between(p, 1, 2);
}

/* How far particles have walked is counted, so one that is not put back after a failure is seen. */
static void read_warnings(proof *p) {
    const cscd_warnings *warnings = &answer_of(p)->warnings;
    const cscd_sensor_counters counters = cscd_sensors_counters(p->own);
    proof_add(p, &counters, sizeof counters);
    for (size_t i = 0; i < warnings->count; i++) {
        const cscd_warning *w = &warnings->items[i];
        const uint32_t vertices[2] = {w->vertex_a, w->vertex_b};
        const double numbers[2] = {w->distance, w->toi};
        proof_add_items(p, vertices, 2, sizeof *vertices);
        proof_add_items(p, numbers, 2, sizeof *numbers);
    }
}

static const proof_call sensors_made = {"sensors_create", PROOF_CREATES, create_sensors, keep_sensors};
static const proof_call part_renewed = {"sensors_renew", PROOF_CHANGES, renew_part, read_cells};
static const proof_call first_sensed = {"sensors_step", PROOF_CHANGES, sense_first, read_warnings};
static const proof_call second_sensed = {"sensors_step", PROOF_CHANGES, sense_second, read_warnings};

static const char walking[] = "particles are few, and walk one after the other";

#define SENSORS                                                                                              \
    { &sensors_made, &first_sensed, &part_renewed, &second_sensed }

static const proof_row rows[] = {
    {"sensors", SENSORS, open_mesh, close_sensors, .family = SCENE_TWO_SPHERES, .no_report = walking,
     .one_thread = walking},
    {"sensors_random", SENSORS, open_mesh, close_sensors, .family = SCENE_TWO_SPHERES, .seed = 1,
     .no_report = walking, .one_thread = walking},
};

PROOFS(rows)
