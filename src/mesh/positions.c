/* Checks the coordinates of positions. */
#include "src/mesh/positions.h"

#include "src/core/floating.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

enum { COORDINATES_PER_TASK = 6144 };

/* The bits of doubles, without the sign, are ordered as their magnitudes. */
static uint64_t magnitude_bits(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits << 1;
}

/* Has no branch per coordinate. */
static bool all_acceptable(const double *x, size_t count) {
    uint64_t low = magnitude_bits(LENGTH_MIN), range = magnitude_bits(LENGTH_MAX) - low;
    unsigned refused = 0;
    for (size_t i = 0; i < count; i++) {
        uint64_t bits = magnitude_bits(x[i]);
        refused |= (unsigned)(bits - low > range) & (unsigned)(bits != 0);
    }
    return refused == 0;
}

typedef struct check {
    const double *x;
    size_t count;
    atomic_bool refused;
} check;

static void check_task(void *data, uint32_t index) {
    check *c = data;
    size_t begin = (size_t)index * COORDINATES_PER_TASK, rest = c->count - begin;
    if (!all_acceptable(c->x + begin, rest < COORDINATES_PER_TASK ? rest : COORDINATES_PER_TASK))
        atomic_store(&c->refused, true);
}

cscd_status positions_check(cscd_context *context, const double *positions, uint32_t vertex_count,
                            const char *name) {
    if (positions == NULL) return context_fail(context, CSCD_INVALID_ARGUMENT, "%s is NULL", name);
    check c = {.x = positions, .count = (size_t)vertex_count * 3};
    size_t tasks = (c.count + COORDINATES_PER_TASK - 1) / COORDINATES_PER_TASK;
    parallel_run(context->threads, (uint32_t)tasks, check_task, &c);
    for (size_t i = 0; atomic_load(&c.refused) && i < c.count; i++) {
        if (is_length(fabs(positions[i]))) continue;
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "%s: vertex %zu has %c = %g, expected 0 or a magnitude from 2^-300 to 2^300",
                            name, i / 3, "xyz"[i % 3], positions[i]);
    }
    return context_loop_status(context);
}
