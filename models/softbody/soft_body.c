/* A soft body: a lattice of masses around a surface, which follows it. */
#include "models/softbody/soft_body.h"
#include "models/common/vec3.h"
#include "models/shapes/body.h"

#include <stdlib.h>
#include <string.h>

/* Shares the mass of each cell equally among its corners. */
static void share_masses(soft_body *b, double density) {
    const lattice *l = &b->frame;
    double share = density * l->spacing * l->spacing * l->spacing / 8.0;
    for (uint32_t i = 0; i < l->cell_count * 8; i++) b->masses[l->cells[i / 8][i % 8]] += share;
    for (uint32_t n = 0; n < l->node_count; n++) b->inverse_masses[n] = 1.0 / b->masses[n];
}

soft_body soft_body_make(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                         uint32_t triangle_count, double spacing, const material *m) {
    soft_body b = {.damping = m->damping,
                   .frame = lattice_make(positions, vertex_count, triangles, triangle_count, spacing)};
    const lattice *l = &b.frame;
    b.tetrahedra = tetrahedra_make(l, m);
    b.masses = body_allocate(l->node_count, sizeof *b.masses);
    b.inverse_masses = body_allocate(l->node_count, sizeof *b.inverse_masses);
    b.nodes = body_allocate(l->node_count, 3 * sizeof *b.nodes);
    b.previous = body_allocate(l->node_count, 3 * sizeof *b.previous);
    b.velocities = body_allocate(l->node_count, 3 * sizeof *b.velocities);
    b.vertices = body_allocate(vertex_count, 3 * sizeof *b.vertices);
    b.vertex_mobilities = body_allocate(vertex_count, sizeof *b.vertex_mobilities);
    memcpy(b.nodes, l->rest, l->node_count * 3 * sizeof *b.nodes);
    memcpy(b.vertices, positions, vertex_count * 3 * sizeof *b.vertices);
    share_masses(&b, m->density);
    for (uint32_t v = 0; v < vertex_count * 8; v++) {
        double share = l->vertex_shares[v / 8][v % 8];
        b.vertex_mobilities[v / 8] +=
            share * share * b.inverse_masses[l->cells[l->vertex_cells[v / 8]][v % 8]];
    }
    return b;
}

void soft_body_free(soft_body *b) {
    lattice_free(&b->frame);
    free(b->tetrahedra);
    free(b->masses);
    free(b->inverse_masses);
    free(b->nodes);
    free(b->previous);
    free(b->velocities);
    free(b->vertices);
    free(b->vertex_mobilities);
    *b = (soft_body){0};
}

void soft_body_place(soft_body *b, double turn[3][3], const double offset[3]) {
    for (uint32_t n = 0; n < b->frame.node_count; n++) {
        double *p = b->nodes + n * 3, turned[3];
        for (int k = 0; k < 3; k++) turned[k] = vec3_dot(turn[k], p) + offset[k];
        memcpy(p, turned, sizeof turned);
    }
    lattice_place_vertices(&b->frame, b->nodes, b->vertices);
}

static void centre_of_mass(const soft_body *b, double out[3]) {
    double mass = 0.0;
    out[0] = out[1] = out[2] = 0.0;
    for (uint32_t n = 0; n < b->frame.node_count; n++) {
        vec3_add_scaled(out, b->masses[n], b->nodes + n * 3);
        mass += b->masses[n];
    }
    for (int k = 0; k < 3; k++) out[k] /= mass;
}

void soft_body_throw(soft_body *b, const double velocity[3], const double spin[3]) {
    double centre[3];
    centre_of_mass(b, centre);
    for (uint32_t n = 0; n < b->frame.node_count; n++) {
        double arm[3], *v = b->velocities + n * 3;
        vec3_subtract(b->nodes + n * 3, centre, arm);
        vec3_cross(spin, arm, v);
        vec3_add_scaled(v, 1.0, velocity);
    }
}

void soft_body_push(const soft_body *b, double *nodes, uint32_t vertex, const double change[3]) {
    const uint32_t *corners = b->frame.cells[b->frame.vertex_cells[vertex]];
    for (int i = 0; i < 8; i++) {
        double share = b->frame.vertex_shares[vertex][i];
        vec3_add_scaled(nodes + corners[i] * 3,
                        share * b->inverse_masses[corners[i]] / b->vertex_mobilities[vertex], change);
    }
}

double soft_body_energy(const soft_body *b, double gravity) {
    double energy = tetrahedra_energy(b->tetrahedra, b->frame.cell_count * 5, b->nodes);
    for (uint32_t n = 0; n < b->frame.node_count; n++) {
        const double *v = b->velocities + n * 3;
        energy += b->masses[n] * (0.5 * vec3_dot(v, v) + gravity * b->nodes[n * 3 + 2]);
    }
    return energy;
}
