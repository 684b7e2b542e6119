/* Measurements of a recording: its softness, its speed, and its contacts with itself. */
#include "models/common/motion.h"
#include "models/common/vec3.h"
#include "models/shapes/body.h"

#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 2000 };

static const double soft_residual = 0.03;

/* Finds the largest eigenvalue of a symmetric matrix by power iteration. The matrix is shifted so that
 * this eigenvalue is also the largest by magnitude. */
static double largest_eigenvalue(double m[4][4]) {
    double vector[4] = {1.0, 0.3, 0.2, 0.1}, shift = 0.0, value = 0.0;
    for (int i = 0; i < 16; i++) shift += m[i / 4][i % 4] * m[i / 4][i % 4];
    shift = sqrt(shift);
    for (int round = 0; shift > 0.0 && round < ROUNDS; round++) {
        double next[4], length = 0.0;
        for (int i = 0; i < 4; i++) {
            next[i] = shift * vector[i];
            for (int j = 0; j < 4; j++) next[i] += m[i][j] * vector[j];
            length += next[i] * next[i];
        }
        length = sqrt(length);
        for (int i = 0; i < 4; i++) vector[i] = next[i] / length;
        value = length - shift;
    }
    return value;
}

static void find_centroid(const double *points, uint32_t count, double out[3]) {
    out[0] = out[1] = out[2] = 0.0;
    for (uint32_t i = 0; i < count; i++) vec3_add_scaled(out, 1.0 / count, points + i * 3);
}

double rigid_residual(const double *from, const double *to, uint32_t point_count) {
    double from_centre[3], to_centre[3], s[3][3] = {{0.0}}, squares = 0.0;
    find_centroid(from, point_count, from_centre);
    find_centroid(to, point_count, to_centre);
    for (uint32_t i = 0; i < point_count; i++) {
        double a[3], b[3];
        vec3_subtract(from + i * 3, from_centre, a);
        vec3_subtract(to + i * 3, to_centre, b);
        squares += vec3_dot(a, a) + vec3_dot(b, b);
        for (int k = 0; k < 3; k++) vec3_add_scaled(s[k], a[k], b);
    }
    double n[4][4] = {
        {s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
        {s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
        {s[2][0] - s[0][2], s[0][1] + s[1][0], s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
        {s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], s[2][2] - s[0][0] - s[1][1]},
    };
    return sqrt(fmax(squares - 2.0 * largest_eigenvalue(n), 0.0) / point_count);
}

cscd_status recording_motion_begin(const cscd_mesh *mesh, const double *first, recording_motion *out) {
    recording_motion m = {.mesh = mesh};
    uint32_t vertex_count = cscd_mesh_vertex_count(mesh), edge_count = cscd_mesh_edge_count(mesh);
    size_t bytes = (size_t)vertex_count * 3 * sizeof *first;
    double low[3], high[3];
    cscd_status status = cscd_detector_create(cscd_mesh_context(mesh), mesh, NULL, NULL, &m.detector);
    if (status != CSCD_OK) return status;
    m.first = memcpy(body_allocate(bytes, 1), first, bytes);
    m.last = body_allocate(bytes, 1);
    for (uint32_t k = 0; k < 3; k++) low[k] = high[k] = first[k];
    for (uint32_t i = 0; i < vertex_count * 3; i++) {
        low[i % 3] = fmin(low[i % 3], first[i]);
        high[i % 3] = fmax(high[i % 3], first[i]);
    }
    vec3_subtract(high, low, high);
    m.diagonal = vec3_norm(high);
    for (uint32_t e = 0; e < edge_count; e++) {
        uint32_t v[2];
        double along[3];
        cscd_mesh_edge(mesh, e, v);
        vec3_subtract(first + (size_t)v[1] * 3, first + (size_t)v[0] * 3, along);
        m.edge_length += vec3_norm(along) / edge_count;
    }
    status = recording_motion_add(&m, first);
    if (status == CSCD_OK)
        *out = m;
    else
        recording_motion_free(&m);
    return status;
}

static cscd_status add_contacts(recording_motion *m, const double *frame) {
    cscd_contacts contacts = {.count = 0};
    cscd_intersections intersections;
    if (m->frame_count > 0) {
        cscd_status status =
            cscd_detector_step(m->detector, CSCD_DOUBLES(m->last, cscd_mesh_vertex_count(m->mesh)),
                               CSCD_DOUBLES(frame, cscd_mesh_vertex_count(m->mesh)), &contacts);
        if (status != CSCD_OK) return status;
        m->contact_intervals += contacts.count > 0;
    }
    cscd_status status = cscd_detector_check(
        m->detector, CSCD_DOUBLES(frame, cscd_mesh_vertex_count(m->mesh)), &intersections);
    if (status == CSCD_OK) m->intersecting_frames += intersections.count > 0;
    return status;
}

cscd_status recording_motion_add(recording_motion *m, const double *frame) {
    uint32_t vertex_count = cscd_mesh_vertex_count(m->mesh);
    cscd_status status = add_contacts(m, frame);
    if (status != CSCD_OK) return status;
    double residual = rigid_residual(m->first, frame, vertex_count) / m->diagonal;
    m->soft_frames += residual > soft_residual;
    m->largest_residual = fmax(m->largest_residual, residual);
    for (uint32_t v = 0; m->frame_count > 0 && v < vertex_count; v++) {
        double moved[3];
        vec3_subtract(frame + (size_t)v * 3, m->last + (size_t)v * 3, moved);
        m->largest_motion = fmax(m->largest_motion, vec3_norm(moved) / m->edge_length);
    }
    memcpy(m->last, frame, (size_t)vertex_count * 3 * sizeof *frame);
    m->frame_count++;
    return CSCD_OK;
}

void recording_motion_free(recording_motion *m) {
    cscd_detector_destroy(m->detector);
    free(m->first);
    free(m->last);
    *m = (recording_motion){0};
}
