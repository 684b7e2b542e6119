/* The barrier of incremental potential contact, and its energy over all pairs of features nearer than its reach. */
#include "models/ipc/newton_system.h"

#include "models/common/vec3.h"
#include "models/shapes/body.h"

#include <math.h>
#include <stdlib.h>

/* ---- the barrier --------------------------------------------------------------------------------------- */

ipc_curve ipc_barrier(double distance, double reach) {
    if (distance >= reach) return (ipc_curve){0.0, 0.0, 0.0};
    if (distance <= 0.0) return (ipc_curve){INFINITY, -INFINITY, INFINITY};
    double beyond = distance - reach, logarithm = log(distance / reach), share = beyond / distance;
    return (ipc_curve){
        .value = -beyond * beyond * logarithm,
        .slope = -2.0 * beyond * logarithm - beyond * share,
        .curvature = -2.0 * logarithm - 4.0 * share + share * share,
    };
}

ipc_curve ipc_mollifier(double crossing, double threshold) {
    if (crossing >= threshold) return (ipc_curve){1.0, 0.0, 0.0};
    double share = crossing / threshold;
    return (ipc_curve){share * (2.0 - share), 2.0 * (1.0 - share) / threshold,
                       -2.0 / (threshold * threshold)};
}

/* ---- the energy of contacts ---------------------------------------------------------------------------- */

/* Multiplies the energy by the mollifier and adds the mollifier's part of the gradient. crossing is |a x
 * b|^2, whose derivative by a is 2 b x (a x b), and by b 2 (a x b) x a. */
static void fade_parallel(ipc_contact *c, double threshold, const double *positions) {
    const uint32_t *v = c->vertices;
    double a[3], b[3], across[3], by_a[3], by_b[3];
    vec3_subtract(positions + (size_t)v[1] * 3, positions + (size_t)v[0] * 3, a);
    vec3_subtract(positions + (size_t)v[3] * 3, positions + (size_t)v[2] * 3, b);
    vec3_cross(a, b, across);
    ipc_curve fade = ipc_mollifier(vec3_dot(across, across), threshold);
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 3; k++) c->gradient[i][k] *= fade.value;
    }
    vec3_cross(b, across, by_a);
    vec3_cross(across, a, by_b);
    double factor = 2.0 * fade.slope * c->energy;
    vec3_add_scaled(c->gradient[0], -factor, by_a);
    vec3_add_scaled(c->gradient[1], factor, by_a);
    vec3_add_scaled(c->gradient[2], -factor, by_b);
    vec3_add_scaled(c->gradient[3], factor, by_b);
    c->energy *= fade.value;
    c->curvature *= fade.value;
}

static ipc_contact make_contact(const double *positions, const cscd_proximity *item,
                                const ipc_barrier_options *options) {
    const ipc_curve barrier = ipc_barrier(item->distance, options->reach);
    double stiffness = options->stiffness * item->count;
    ipc_contact c = {.energy = stiffness * barrier.value, .curvature = stiffness * barrier.curvature};
    for (int k = 0; k < 3; k++) c.normal[k] = item->normal[k];
    for (int i = 0; i < 4; i++) {
        c.vertices[i] = item->vertices[i];
        c.weights[i] = item->weights[i];
        vec3_add_scaled(c.gradient[i], stiffness * barrier.slope * c.weights[i], c.normal);
    }
    if (item->threshold > 0.0) fade_parallel(&c, item->threshold, positions);
    return c;
}

static void reserve_items(ipc_contacts *contacts, size_t count) {
    if (count <= contacts->capacity) return;
    free(contacts->items);
    contacts->capacity = count + count / 2;
    contacts->items = body_allocate(contacts->capacity, sizeof *contacts->items);
}

void ipc_contacts_find(ipc_contacts *contacts, const double *positions, const cscd_proximities *near,
                       const ipc_barrier_options *options) {
    reserve_items(contacts, near->count);
    contacts->count = near->count;
    contacts->energy = 0.0;
    contacts->least_distance = INFINITY;
    for (size_t i = 0; i < near->count; i++) {
        contacts->items[i] = make_contact(positions, &near->items[i], options);
        contacts->energy += contacts->items[i].energy;
        contacts->least_distance = fmin(contacts->least_distance, near->items[i].distance);
    }
}

void ipc_contacts_free(ipc_contacts *contacts) {
    free(contacts->items);
    *contacts = (ipc_contacts){0};
}

void ipc_contacts_add_gradient(const ipc_contacts *contacts, double *gradient) {
    for (size_t i = 0; i < contacts->count; i++) {
        const ipc_contact *c = &contacts->items[i];
        for (int k = 0; k < 4; k++)
            vec3_add_scaled(gradient + (size_t)c->vertices[k] * 3, 1.0, c->gradient[k]);
    }
}

void ipc_contacts_add_product(const ipc_contacts *contacts, const double *x, double *out) {
    for (size_t i = 0; i < contacts->count; i++) {
        const ipc_contact *c = &contacts->items[i];
        double approach = 0.0;
        for (int k = 0; k < 4; k++)
            approach += c->weights[k] * vec3_dot(c->normal, x + (size_t)c->vertices[k] * 3);
        for (int k = 0; k < 4; k++)
            vec3_add_scaled(out + (size_t)c->vertices[k] * 3, c->curvature * approach * c->weights[k],
                            c->normal);
    }
}
