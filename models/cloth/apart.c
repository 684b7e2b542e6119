/* Contact and friction: turns the pairs of cscd_detector_find_near into constraints on positions. */
#include "models/cloth/cloth.h"
#include "models/common/vec3.h"
#include "models/shapes/body.h"

#include <stdlib.h>
#include <string.h>

void apart_free(apart *a) {
    free(a->pairs);
    *a = (apart){0};
}

static bool is_inside(double parameter) {
    return parameter > 0.0 && parameter < 1.0;
}

static bool is_with_obstacle(const cscd_mesh *mesh, const cscd_stencil *s) {
    return cscd_mesh_object(mesh, cscd_mesh_vertex_object(mesh, s->vertices[0])).obstacle ||
           cscd_mesh_object(mesh, cscd_mesh_vertex_object(mesh, s->vertices[3])).obstacle;
}

/* Sorts pairs with obstacles to the end: obstacles do not give way, so they are solved last. */
void apart_take(apart *a, const cscd_mesh *mesh, const cscd_proximities *near) {
    a->count = 0;
    if (near->count > a->capacity) {
        free(a->pairs);
        a->capacity = near->count + near->count / 2;
        a->pairs = body_allocate(a->capacity, sizeof *a->pairs);
    }
    for (int last = 0; last < 2; last++) {
        for (size_t i = 0; i < near->count; i++) {
            const cscd_proximity *p = &near->items[i];
            if (p->kind == CSCD_CONTACT_EE && !(is_inside(p->weights[1]) && is_inside(-p->weights[3])))
                continue;
            apart_pair pair = {.healing = a->healing[last]};
            memcpy(pair.stencil.vertices, p->vertices, sizeof p->vertices);
            memcpy(pair.stencil.weights, p->weights, sizeof p->weights);
            if (is_with_obstacle(mesh, &pair.stencil) != (last == 1)) continue;
            for (int k = 0; k < 3; k++) pair.normal[k] = p->normal[k];
            a->pairs[a->count++] = pair;
        }
    }
}

void apart_sum(const cscd_stencil *s, const double *positions, double sum[3]) {
    sum[0] = sum[1] = sum[2] = 0.0;
    for (int i = 0; i < 4; i++) vec3_add_scaled(sum, s->weights[i], positions + (size_t)s->vertices[i] * 3);
}

void apart_push(const cscd_stencil *s, const double *inverse_masses, const double change[3],
                double *positions) {
    double squares = 0.0;
    for (int i = 0; i < 4; i++) squares += inverse_masses[s->vertices[i]] * s->weights[i] * s->weights[i];
    if (squares == 0.0) return;
    for (int i = 0; i < 4; i++)
        vec3_add_scaled(positions + (size_t)s->vertices[i] * 3,
                        inverse_masses[s->vertices[i]] * s->weights[i] / squares, change);
}

static void solve_pair(const apart *a, const apart_pair *pair, const double *inverse_masses, double *previous,
                       double *positions) {
    double between[3], slid[3], change[3] = {0.0, 0.0, 0.0};
    apart_sum(&pair->stencil, positions, between);
    double depth = a->thickness - vec3_dot(between, pair->normal);
    if (depth <= 0.0) return;
    apart_sum(&pair->stencil, previous, slid);
    for (int k = 0; k < 3; k++) slid[k] = between[k] - slid[k];
    double approach = -vec3_dot(slid, pair->normal), stopped = fmin(depth, fmax(approach, 0.0));
    vec3_add_scaled(slid, approach, pair->normal);
    double sliding = vec3_norm(slid);
    vec3_add_scaled(change, stopped, pair->normal);
    if (sliding > 0.0) vec3_add_scaled(change, -fmin(a->friction * stopped, sliding) / sliding, slid);
    apart_push(&pair->stencil, inverse_masses, change, positions);
    double healed = pair->healing * (depth - stopped);
    for (int k = 0; k < 3; k++) change[k] = healed * pair->normal[k];
    apart_push(&pair->stencil, inverse_masses, change, positions);
    apart_push(&pair->stencil, inverse_masses, change, previous);
}

void apart_solve(const apart *a, const double *inverse_masses, double *previous, double *positions) {
    for (size_t i = 0; i < a->count; i++) solve_pair(a, &a->pairs[i], inverse_masses, previous, positions);
}
