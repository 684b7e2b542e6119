/* Generates the demo: a slender capsule that bends until its two ends run into each other.
 *
 * The capsule has radius 1 and length L = 18. Its surface in parameters (s, psi), s along the centre line
 * from -9 to 9: sections are circles of radius rho(s) = 1, over the caps (|s| > 8) sqrt(1 - (|s| - 8)^2).
 * Bent by the total angle theta, with curvature k = theta / L, the section at s lies in the half-plane at
 * angle k s around the centre of a circular arc:
 *
 *     x(s, psi) = (sin(k s) / k, -(1 - cos(k s)) / k, -lift(s)) + rho(s) cos(psi) n - rho(s) sin(psi) z
 *     n = (-sin(k s), -cos(k s), 0),  lift(s) = rise * theta / (2 pi) * clamp(s, -8, 8) / 16
 *
 * in frame f of 0..59 with theta = theta_end sin(pi/2 f/59). The rise keeps the poles from meeting exactly.
 *
 * First contact: a cap point at distance d from its section's centre lags delta(d) = 1 - sqrt(1 - d^2) of arc
 * behind its pole. The section centres of the two caps are a = rise * theta / (2 pi) apart, so the ends first
 * share a point half way between the centres, at d = a / 2, as soon as theta - 2 k delta(a / 2) = 2 pi.
 * Nothing else touches: the inside of the bend keeps the radius L / theta - 1 > 1.6. The mesh is inscribed,
 * which delays its contact by less than 0.2 frames. */
#include "tool/io/mesh_file.h"
#include "tool/io/point_cache.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Ring i of a cap has 5 i vertices; ring 0 is the pole. */
enum {
    frame_count = 60,
    cap_rings = 6,
    around = 5 * cap_rings,
    rows = 80,
    ring_count = 2 * cap_rings + rows + 1,
    vertex_count = 2 + 5 * cap_rings * (cap_rings - 1) + around * (rows + 1),
    triangle_count = 2 * vertex_count - 4
};

static const double pi = 3.14159265358979323846;
static const double length = 18.0, straight = 16.0, rise = 0.3;
static const double theta_end = 1.035 * 2.0 * 3.14159265358979323846;

typedef struct capsule {
    double s[vertex_count], psi[vertex_count]; /* in each ring psi grows from index to index */
    uint32_t first[ring_count + 1];            /* ring i has the vertices first[i] to first[i + 1] - 1 */
    uint32_t triangles[3 * triangle_count];
} capsule;

/* Noise in -1..1, the same in every run. */
static double noise_at(uint32_t index) {
    uint32_t h = index * 2654435769u + 0x9e3779b9u;
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return (double)(h ^ h >> 16) / 2147483647.5 - 1.0;
}

/* Rings are slightly uneven along s and around, and each is turned against the one before by an odd part of
 * its step: no two features of the mesh are exactly parallel, also where the ends touch. */
static void place_rings(capsule *model) {
    uint32_t vertex = 0;
    for (uint32_t ring = 0; ring < ring_count; ring++) {
        uint32_t from_end = ring < ring_count - 1 - ring ? ring : ring_count - 1 - ring;
        uint32_t count = from_end == 0 ? 1 : from_end < cap_rings ? 5 * from_end : around;
        double s = straight * ((ring - (double)cap_rings + 0.07 * noise_at(ring)) / rows - 0.5);
        if (from_end < cap_rings) {
            double uneven = from_end == 0 ? 0.0 : 0.05 * noise_at(ring);
            double polar = 0.5 * pi * (from_end + uneven) / cap_rings;
            s = (ring == from_end ? -1.0 : 1.0) * (0.5 * straight + cos(polar));
        }
        model->first[ring] = vertex;
        for (uint32_t i = 0; i < count; i++, vertex++) {
            double turned = fmod(0.5 * from_end + 0.037 * ring, 1.0);
            model->s[vertex] = s;
            model->psi[vertex] = 2.0 * pi * (i + turned + 0.06 * noise_at(vertex + 1000)) / count;
        }
    }
    model->first[ring_count] = vertex;
}

/* The angle of a ring's vertex `index`, which may run past the ring's end into the next turn. */
static double unrolled_angle(const capsule *model, uint32_t ring, uint32_t index) {
    uint32_t count = model->first[ring + 1] - model->first[ring];
    return model->psi[model->first[ring] + index % count] + 2.0 * pi * (index / count);
}

/* Fills the band between ring and ring + 1 with triangles, always stepping on to the vertex that comes next
 * around. psi grows counter-clockwise seen from larger s, so these are counter-clockwise from outside. */
static uint32_t *join_rings(const capsule *model, uint32_t ring, uint32_t *out) {
    uint32_t lower = model->first[ring], upper = model->first[ring + 1];
    uint32_t lower_count = upper - lower, upper_count = model->first[ring + 2] - upper;
    uint32_t lower_steps = lower_count > 1 ? lower_count : 0, upper_steps = upper_count > 1 ? upper_count : 0;
    for (uint32_t i = 0, j = 0; i < lower_steps || j < upper_steps;) {
        bool step_lower = j == upper_steps || (i < lower_steps && unrolled_angle(model, ring, i + 1) <
                                                                      unrolled_angle(model, ring + 1, j + 1));
        *out++ = lower + i % lower_count;
        *out++ = step_lower ? lower + (i + 1) % lower_count : upper + (j + 1) % upper_count;
        *out++ = upper + j % upper_count;
        i += step_lower;
        j += !step_lower;
    }
    return out;
}

static double bend_angle(double frame) {
    return theta_end * sin(0.5 * pi * frame / (frame_count - 1));
}

/* Through memory: gcc 12 may drop the rounding of neighbouring stores when it vectorises them. */
static double rounded_to_float(double x) {
    volatile float rounded = (float)x;
    return rounded;
}

/* Positions are rounded to float here, so that the mesh file equals frame 0 exactly. */
static void place_vertices(const capsule *model, double theta, double *positions) {
    double k = theta / length;
    for (uint32_t vertex = 0; vertex < vertex_count; vertex++) {
        double s = model->s[vertex], psi = model->psi[vertex];
        double along = fmin(fmax(s, -0.5 * straight), 0.5 * straight), cap = s - along;
        double rho = sqrt(fmax(1.0 - cap * cap, 0.0));
        double inward = rho * cos(psi), upward = rho * sin(psi);
        double *p = positions + 3 * (size_t)vertex;
        p[0] = rounded_to_float((k > 0.0 ? sin(k * s) / k : s) - inward * sin(k * s));
        p[1] = rounded_to_float((k > 0.0 ? (cos(k * s) - 1.0) / k : 0.0) - inward * cos(k * s));
        p[2] = rounded_to_float(0.0 - rise * theta / (2.0 * pi) * along / straight - upward);
    }
}

/* The frame, with a fraction, at which theta - 2 k delta(a / 2) = 2 pi, as derived above. */
static double contact_frame(void) {
    double before = 0.0, after = frame_count - 1;
    for (int i = 0; i < 60; i++) {
        double frame = 0.5 * (before + after), theta = bend_angle(frame);
        double d = 0.5 * rise * theta / (2.0 * pi), delta = 1.0 - sqrt(1.0 - d * d);
        bool apart = theta - 2.0 * theta / length * delta < 2.0 * pi;
        if (apart)
            before = frame;
        else
            after = frame;
    }
    return after;
}

static bool write_frames(const char *path, const capsule *model, double *positions, io_error *error) {
    point_cache_writer *writer;
    if (!point_cache_writer_open(path, vertex_count, frame_count, &writer, error)) return false;
    for (int frame = 0; frame < frame_count; frame++) {
        place_vertices(model, bend_angle(frame), positions);
        if (!point_cache_writer_write(writer, positions, error)) break;
    }
    return point_cache_writer_close(writer, error);
}

int main(int argument_count, char **arguments) {
    static capsule model;
    static double positions[3 * vertex_count];
    io_error error;
    if (argument_count != 3) {
        fprintf(stderr, "usage: capsule_bend OUT.obj OUT.pc2\n");
        return 2;
    }
    place_rings(&model);
    uint32_t *end = model.triangles;
    for (uint32_t ring = 0; ring + 1 < ring_count; ring++) end = join_rings(&model, ring, end);
    place_vertices(&model, 0.0, positions);
    const mesh_file mesh = mesh_file_of(vertex_count, triangle_count, positions, model.triangles);
    if (!mesh_file_write_obj(arguments[1], &mesh, &error) ||
        !write_frames(arguments[2], &model, positions, &error)) {
        fprintf(stderr, "capsule_bend: %s\n", error.text);
        return 1;
    }
    double contact = contact_frame();
    printf("%d vertices, %d triangles, %d frames; the ends touch at frame %.2f\n", vertex_count,
           triangle_count, frame_count, contact);
    printf("first contact expected in interval %d\n", (int)contact);
    return 0;
}
