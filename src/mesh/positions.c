/* Checks the coordinates of positions, and packs positions of other layouts. */
#include "src/mesh/positions.h"

#include "src/core/check.h"
#include "src/mesh/mesh.h"

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
    return CSCD_OK;
}

/* ---- other layouts ----------------------------------------------------------------------------------- */

static double load_scalar(const char *at, cscd_scalar scalar) {
    if (scalar == CSCD_SCALAR_FLOAT) {
        float value;
        memcpy(&value, at, sizeof value);
        return (double)value;
    }
    double value;
    memcpy(&value, at, sizeof value);
    return value;
}

static void pack_view(const cscd_view *view, uint32_t vertex_count, double *out) {
    size_t size = view->scalar == CSCD_SCALAR_FLOAT ? sizeof(float) : sizeof(double);
    size_t step = view->coordinate_stride != 0 ? view->coordinate_stride : size;
    size_t stride = view->stride != 0 ? view->stride : 3 * size;
    const char *at = view->data;
    for (uint32_t v = 0; v < vertex_count; v++, at += stride) {
        for (size_t k = 0; k < 3; k++) *out++ = load_scalar(at + k * step, view->scalar);
    }
}

cscd_status cscd_mesh_pack(const cscd_mesh *mesh, const cscd_view *views, double *positions) {
    if (mesh == NULL) return CSCD_INVALID_ARGUMENT;
    if (views == NULL || positions == NULL)
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT,
                            "cscd_mesh_pack: views or positions is NULL");
    for (uint32_t i = 0; i < mesh->object_count; i++) {
        if (views[i].data == NULL)
            return context_fail(mesh->context, CSCD_INVALID_ARGUMENT,
                                "cscd_mesh_pack: views[%u].data is NULL", i);
        if ((unsigned)views[i].scalar > CSCD_SCALAR_FLOAT)
            return context_fail(
                mesh->context, CSCD_INVALID_ARGUMENT,
                "cscd_mesh_pack: views[%u].scalar is %d, expected CSCD_SCALAR_DOUBLE or _FLOAT", i,
                (int)views[i].scalar);
    }
    for (uint32_t i = 0; i < mesh->object_count; i++)
        pack_view(&views[i], mesh->objects[i].vertex_count,
                  positions + (size_t)mesh->objects[i].first_vertex * 3);
    return CSCD_OK;
}
