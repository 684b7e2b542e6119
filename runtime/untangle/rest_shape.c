/* The rest shape: near what intersects, edges are drawn to the lengths that they have there, turned as the surface is now (Sorkine and
 * Alexa, As-Rigid-As-Possible Surface Modeling, Symposium on Geometry Processing 2007, equations 3 and 8). */
#include "runtime/untangle/untangle.h"

#include "src/core/vec3.h"

#include <math.h>
#include <string.h>

/* ---- rotations ------------------------------------------------------------------------------------------- */

/* Turns the columns of a rotation by a vector: its direction is the axis, its length the angle. */
static void turn_columns(double columns[3][3], const double by[3]) {
    const double angle = sqrt(vec3_dot(by, by));
    const double s = angle > 0.0 ? sin(angle) / angle : 1.0;
    const double c = angle > 0.0 ? (1.0 - cos(angle)) / (angle * angle) : 0.5;
    for (int k = 0; k < 3; k++) {
        double across[3], twice[3];
        vec3_cross(by, columns[k], across);
        vec3_cross(by, across, twice);
        for (int i = 0; i < 3; i++) columns[k][i] += s * across[i] + c * twice[i];
    }
}

enum { TURNS = 30 };

/* The rotation that is nearest to a matrix, given by its columns (Müller, Bender, Chentanez and Macklin, A Robust Method to Extract the
 * Rotational Part of Deformations, Motion in Games 2016). It has no reflection in any case. */
static void find_rotation(const double matrix[3][3], double columns[3][3]) {
    static const double still = 1e-9;
    for (int i = 0; i < TURNS; i++) {
        double by[3] = {0.0, 0.0, 0.0}, along = 0.0, across[3];
        for (int k = 0; k < 3; k++) {
            vec3_cross(columns[k], matrix[k], across);
            vec3_add_scaled(by, 1.0, across, by);
            along += vec3_dot(columns[k], matrix[k]);
        }
        if (along == 0.0) return;
        for (int k = 0; k < 3; k++) by[k] /= fabs(along);
        turn_columns(columns, by);
        if (vec3_dot(by, by) < still * still) return;
    }
}

/* Writes three directions: of an edge, of the normal of a triangle beside it, and across both. False: it has no area. */
static bool find_frame(const double *a, const double *b, const double *c, double frame[3][3]) {
    double other[3];
    vec3_subtract(b, a, frame[0]);
    vec3_subtract(c, a, other);
    vec3_cross(frame[0], other, frame[1]);
    vec3_cross(frame[1], frame[0], frame[2]);
    for (int k = 0; k < 3; k++) {
        const double length = sqrt(vec3_dot(frame[k], frame[k]));
        if (!(length > 0.0)) return false;
        for (int i = 0; i < 3; i++) frame[k][i] /= length;
    }
    return true;
}

/* How the first triangle of a vertex has turned; not at all, if it has no area. From there the nearest rotation is found, even after
 * half a turn. */
static void first_rotation(const untangle_work *w, const double *rest, uint32_t v, double columns[3][3]) {
    const uint32_t *corners = w->mesh->triangles[w->mesh->vertex_stars[w->mesh->vertex_star_offsets[v]]];
    const size_t a = 3 * (size_t)corners[0], b = 3 * (size_t)corners[1], c = 3 * (size_t)corners[2];
    double from[3][3], to[3][3];
    const bool has_area = find_frame(rest + a, rest + b, rest + c, from) &&
                          find_frame(w->input + a, w->input + b, w->input + c, to);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) {
            columns[k][i] = k == i;
            if (has_area)
                columns[k][i] = to[0][i] * from[0][k] + to[1][i] * from[1][k] + to[2][i] * from[2][k];
        }
    }
}

/* How the edges of a vertex have turned from the rest shape to the input. */
static void rotation_at(const untangle_work *w, const double *rest, uint32_t v, double columns[3][3]) {
    const vertex_graph *g = &w->graph;
    double matrix[3][3] = {{0.0}}, from[3], to[3];
    first_rotation(w, rest, v, columns);
    for (size_t n = g->begins[v]; n < g->begins[v + 1]; n++) {
        const size_t other = 3 * (size_t)g->neighbours[n];
        vec3_subtract(rest + other, rest + 3 * (size_t)v, from);
        vec3_subtract(w->input + other, w->input + 3 * (size_t)v, to);
        for (int k = 0; k < 3; k++) vec3_add_scaled(matrix[k], g->couplings[n] * from[k], to, matrix[k]);
    }
    find_rotation(matrix, columns);
}

/* ---- pulls ----------------------------------------------------------------------------------------------- */

/* Writes how strongly vertices are drawn, by their distance from what intersects: 1 as far as a spread, and 0 from two on. */
static void find_shares(untangle_work *w, const cscd_intersections *found, double spread, double *shares) {
    vertex_region *r = &w->region;
    const uint32_t rings = elastic_rings(w, spread);
    vertex_region_clear(r);
    memset(shares, 0, (size_t)w->mesh->vertex_count * sizeof *shares);
    for (size_t i = 0; i < found->count; i++) {
        for (int k = 0; k < 3; k++) {
            vertex_region_add(r, &w->graph, w->mesh->triangles[found->items[i].a][k]);
            vertex_region_add(r, &w->graph, w->mesh->triangles[found->items[i].b][k]);
        }
    }
    vertex_region_grow(r, &w->graph, rings);
    for (uint32_t row = 0; row < r->count; row++) shares[r->vertices[row]] = 1.0;
    for (uint32_t ring = 1; ring <= rings; ring++) {
        const uint32_t first = r->count;
        vertex_region_grow(r, &w->graph, 1);
        for (uint32_t row = first; row < r->count; row++)
            shares[r->vertices[row]] = 1.0 - (double)ring / (rings + 1.0);
    }
}

/* How far an edge is from what the rest shape wants of it. */
static void find_excess(const untangle_work *w, const double *rest, const double (*rotations)[3][3],
                        uint32_t v, uint32_t other, double out[3]) {
    double edge[3], wanted[3] = {0.0, 0.0, 0.0};
    const bool alone = w->graph.fixed[other];
    vec3_subtract(rest + 3 * (size_t)v, rest + 3 * (size_t)other, edge);
    for (int k = 0; k < 3; k++) {
        vec3_add_scaled(wanted, alone ? edge[k] : 0.5 * edge[k], rotations[v][k], wanted);
        if (!alone) vec3_add_scaled(wanted, 0.5 * edge[k], rotations[other][k], wanted);
    }
    vec3_subtract(w->input + 3 * (size_t)v, w->input + 3 * (size_t)other, edge);
    vec3_subtract(edge, wanted, out);
}

static void find_pulls(untangle_work *w, const double *rest, const double *shares,
                       double (*rotations)[3][3]) {
    const vertex_graph *g = &w->graph;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        if (shares[v] > 0.0) rotation_at(w, rest, v, rotations[v]);
    }
    w->pull_energy = 0.0;
    for (uint32_t v = 0; v < w->mesh->vertex_count; v++) {
        double *pull = w->pulls + 3 * (size_t)v;
        for (size_t n = g->begins[v]; n < g->begins[v + 1] && shares[v] > 0.0; n++) {
            const uint32_t other = g->neighbours[n];
            const double share = g->fixed[other] ? shares[v] : min_of(shares[v], shares[other]);
            double excess[3];
            if (!(share > 0.0)) continue;
            find_excess(w, rest, (const double(*)[3][3])rotations, v, other, excess);
            vec3_add_scaled(pull, share * g->couplings[n], excess, pull);
            const double once = g->fixed[other] ? 0.5 : 0.25; /* edges between unknowns come twice */
            w->pull_energy += once * share * g->couplings[n] * vec3_dot(excess, excess);
        }
    }
}

cscd_status rest_shape_pull(untangle_work *w, const double *rest, const cscd_intersections *found,
                            double spread) {
    const size_t n = w->mesh->vertex_count;
    double *shares = NULL, (*rotations)[3][3] = NULL;
    array_list list = {{ARRAY(shares, n), ARRAY(rotations, n), ARRAY(w->pulls, 3 * n)}};
    if (!context_allocate_all(w->context, list)) return CSCD_OUT_OF_MEMORY;
    find_shares(w, found, spread, shares);
    find_pulls(w, rest, shares, rotations);
    context_free(w->context, shares);
    context_free(w->context, rotations);
    return CSCD_OK;
}
