/* Soft bodies, and their motion in small steps of extended position-based dynamics. */
#include "models/softbody/softbody.h"

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

/* Rodrigues' formula. */
void turn_matrix(const double axis[3], double degrees, double out[3][3]) {
    double unit[3] = {axis[0], axis[1], axis[2]}, angle = degrees * 3.14159265358979323846 / 180.0;
    if (!vec3_normalize(unit)) angle = 0.0;
    for (int i = 0; i < 3; i++) {
        double row[3] = {i == 0, i == 1, i == 2}, crossed[3];
        vec3_cross(row, unit, crossed);
        for (int j = 0; j < 3; j++)
            out[i][j] = (float)(cos(angle) * row[j] + sin(angle) * crossed[j] +
                                (1.0 - cos(angle)) * unit[i] * unit[j]);
    }
}

/* ---- small steps --------------------------------------------------------------------------------------- */

/* Pushes a vertex out of an obstacle, and back along it as far as friction holds. */
static void push_out(soft_body *b, uint32_t vertex, const double point[3], const obstacle_hit *hit,
                     double friction) {
    double before[3], slid[3], change[3] = {0.0, 0.0, 0.0}, own = 1.0;
    lattice_place_vertex(&b->frame, b->previous, vertex, before);
    vec3_subtract(point, before, slid);
    if (hit->pushed != NULL) {
        double inverse = 1.0 / hit->pushed->mass, moved[3];
        own = b->vertex_mobilities[vertex] / (b->vertex_mobilities[vertex] + inverse);
        vec3_subtract(hit->pushed->centre, hit->pushed->previous, moved);
        vec3_add_scaled(slid, -1.0, moved);
    }
    vec3_add_scaled(slid, -vec3_dot(slid, hit->normal), hit->normal);
    double length = vec3_norm(slid), held = fmin(friction * hit->depth, length);
    vec3_add_scaled(change, hit->depth, hit->normal);
    if (length > 0.0) vec3_add_scaled(change, -held / length, slid);
    if (hit->pushed != NULL) vec3_add_scaled(hit->pushed->centre, own - 1.0, change);
    for (int k = 0; k < 3; k++) change[k] *= own;
    soft_body_push(b, b->nodes, vertex, change);
}

static void push_out_of_obstacles(soft_body *b, obstacles *o) {
    for (uint32_t v = 0; v < b->frame.vertex_count; v++) {
        for (uint32_t which = 0; which <= o->ball_count; which++) {
            double point[3];
            obstacle_hit hit;
            lattice_place_vertex(&b->frame, b->nodes, v, point);
            if (which < o->ball_count ? obstacles_hit_ball(o, which, point, &hit)
                                      : obstacles_hit_terrain(o, point, &hit))
                push_out(b, v, point, &hit, o->friction);
        }
    }
}

/* Finds the rigid motion with the same momentum as the corners of a cell: velocity + spin x arm. */
static void rigid_motion(const soft_body *b, const uint32_t corners[8], double arms[8][3], double velocity[3],
                         double spin[3]) {
    double centre[3] = {0.0, 0.0, 0.0}, momentum[3] = {0.0, 0.0, 0.0}, inertia[3][3] = {{0.0}}, mass = 0.0;
    velocity[0] = velocity[1] = velocity[2] = 0.0;
    for (int i = 0; i < 8; i++) mass += b->masses[corners[i]];
    for (int i = 0; i < 8; i++) {
        double share = b->masses[corners[i]] / mass;
        vec3_add_scaled(centre, share, b->nodes + corners[i] * 3);
        vec3_add_scaled(velocity, share, b->velocities + corners[i] * 3);
    }
    for (int i = 0; i < 8; i++) {
        double turning[3], share = b->masses[corners[i]] / mass;
        vec3_subtract(b->nodes + corners[i] * 3, centre, arms[i]);
        vec3_cross(arms[i], b->velocities + corners[i] * 3, turning);
        vec3_add_scaled(momentum, share, turning);
        for (int j = 0; j < 3; j++) {
            inertia[j][j] += share * vec3_dot(arms[i], arms[i]);
            vec3_add_scaled(inertia[j], -share * arms[i][j], arms[i]);
        }
    }
    double minors[3][3];
    for (int j = 0; j < 3; j++) vec3_cross(inertia[(j + 1) % 3], inertia[(j + 2) % 3], minors[j]);
    double size = vec3_dot(inertia[0], minors[0]);
    for (int j = 0; j < 3; j++) spin[j] = size > 0.0 ? vec3_dot(minors[j], momentum) / size : 0.0;
}

/* Takes away a share of the part of each cell's motion that is not rigid. */
static void damp_cells(soft_body *b, double share) {
    for (uint32_t cell = 0; cell < b->frame.cell_count; cell++) {
        const uint32_t *corners = b->frame.cells[cell];
        double arms[8][3], velocity[3], spin[3];
        rigid_motion(b, corners, arms, velocity, spin);
        for (int i = 0; i < 8; i++) {
            double *v = b->velocities + corners[i] * 3, rigid[3];
            vec3_cross(spin, arms[i], rigid);
            for (int k = 0; k < 3; k++) v[k] += share * (velocity[k] + rigid[k] - v[k]);
        }
    }
}

static void take_small_step(soft_body *b, obstacles *o, self_contacts *contacts, double step) {
    uint32_t node_count = b->frame.node_count;
    memcpy(b->previous, b->nodes, node_count * 3 * sizeof *b->nodes);
    for (uint32_t n = 0; n < node_count; n++) {
        b->velocities[n * 3 + 2] -= o->gravity * step;
        vec3_add_scaled(b->nodes + n * 3, step, b->velocities + n * 3);
    }
    obstacles_begin(o, step);
    tetrahedra_solve(b->tetrahedra, b->frame.cell_count * 5, b->inverse_masses, step, b->nodes);
    if (contacts != NULL) self_contacts_solve(contacts, b);
    push_out_of_obstacles(b, o);
    obstacles_end(o, step);
    for (uint32_t i = 0; i < node_count * 3; i++) b->velocities[i] = (b->nodes[i] - b->previous[i]) / step;
    damp_cells(b, b->damping * step / (1.0 + b->damping * step));
}

void simulation_advance(soft_body *b, obstacles *o, self_contacts *contacts, double seconds,
                        uint32_t step_count) {
    for (uint32_t i = 0; i < step_count; i++) take_small_step(b, o, contacts, seconds / step_count);
    lattice_place_vertices(&b->frame, b->nodes, b->vertices);
}
