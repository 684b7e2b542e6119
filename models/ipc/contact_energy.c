/* The energy of the barrier over all pairs of features nearer than its reach, as a list of terms. */
#include "models/ipc/contact_energy.h"
#include "models/common/vec3.h"
#include "models/ipc/barrier.h"
#include "models/shapes/body.h"

#include <stdlib.h>

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
