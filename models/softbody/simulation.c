/* Extended position-based dynamics of a soft body between obstacles, in small steps. */
#include "models/softbody/simulation.h"
#include "models/common/vec3.h"

#include <string.h>

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
