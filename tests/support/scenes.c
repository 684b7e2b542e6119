/* Random intervals of deforming meshes, by family. */
#include "tests/support/scenes.h"

#include "tests/support/random_stream.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static const double origin[3] = {0, 0, 0};

const char *scene_family_name(scene_family family) {
    static const char *const names[SCENE_FAMILY_COUNT] = {
        "noisy sphere", "bent capsule", "squashed torus", "folded sheet", "two spheres", "nested spheres",
        "linked tori",  "spike",        "bow-tie",        "soup",         "grid",        "far away"};
    return names[family];
}

/* Maps a rest position to the position at one end of the interval; a: the family's random numbers. */
typedef void deformation(const double rest[3], const double *a, double out[3]);

static void deform_scene(scene *s, deformation *d, const double *start, const double *end) {
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        double rest[3];
        memcpy(rest, s->x0 + (size_t)v * 3, sizeof rest);
        d(rest, start, s->x0 + (size_t)v * 3);
        d(rest, end, s->x1 + (size_t)v * 3);
    }
}

static void jitter_vertices(scene *s, double size, random_stream *random) {
    for (uint32_t i = 0; i < s->vertex_count * 3; i++) {
        double offset = size * stream_between(random, -1.0, 1.0);
        s->x0[i] += offset;
        s->x1[i] += offset + 0.3 * size * stream_between(random, -1.0, 1.0);
    }
}

static void fill_parameters(double *a, int count, random_stream *random, double low, double high) {
    for (int i = 0; i < count; i++) a[i] = stream_between(random, low, high);
}

static void wave_radius(const double rest[3], const double *a, double out[3]) {
    double r = 1.0;
    for (int i = 0; i < 3; i++) r += a[i] * sin(3.0 * rest[i] + a[3 + i] * 4.0) + a[6] * sin(7.0 * rest[i]);
    for (int k = 0; k < 3; k++) out[k] = r * rest[k];
}

static void make_noisy_sphere(scene *s, random_stream *random) {
    double start[7], end[7], strength = stream_between(random, 0.0, 0.9);
    scene_add_sphere(s, origin, 1.0, 7, 11);
    fill_parameters(start, 7, random, -strength, strength);
    for (int i = 0; i < 7; i++) end[i] = start[i] + 0.5 * strength * stream_between(random, -1.0, 1.0);
    deform_scene(s, wave_radius, start, end);
}

/* Bends the z axis to a circle of total angle a[0], then moves by a[1..3]. */
static void bend_tube(const double rest[3], const double *a, double out[3]) {
    double length = 6.0, curvature = a[0] / length, angle = rest[2] * curvature;
    if (fabs(curvature) < 1e-6) curvature = 1e-6;
    double reach = 1.0 / curvature - rest[0];
    out[0] = 1.0 / curvature - reach * cos(angle) + a[1];
    out[1] = rest[1] + 0.004 * rest[2] * fabs(a[0]) + a[2];
    out[2] = reach * sin(angle) + a[3];
}

static void make_bent_capsule(scene *s, random_stream *random) {
    double start[4] = {stream_between(random, 5.2, 6.2), 0, 0, 0}, end[4] = {0};
    end[0] = start[0] + stream_between(random, -0.4, 0.6);
    scene_add_capsule(s, 6.0, 0.35, 18, 8);
    deform_scene(s, bend_tube, start, end);
}

static void make_far_away(scene *s, random_stream *random) {
    double start[4] = {stream_between(random, 5.0, 6.2)}, end[4];
    fill_parameters(start + 1, 3, random, -1e4, 1e4);
    end[0] = start[0] + stream_between(random, -0.3, 0.5);
    for (int k = 1; k < 4; k++) end[k] = start[k] + stream_between(random, -3.0, 3.0);
    scene_add_capsule(s, 6.0, 0.35, 14, 7);
    deform_scene(s, bend_tube, start, end);
}

static void squash_axes(const double rest[3], const double *a, double out[3]) {
    out[0] = rest[0] * (1.0 + 0.3 * a[1] * rest[1]);
    out[1] = rest[1] * a[0];
    out[2] = rest[2] * (1.0 + a[2] * rest[0]);
}

static void make_squashed_torus(scene *s, random_stream *random) {
    double start[3] = {stream_between(random, 0.2, 0.7)}, end[3];
    fill_parameters(start + 1, 2, random, -0.5, 0.5);
    end[0] = start[0] + stream_between(random, -0.5, 0.2);
    for (int k = 1; k < 3; k++) end[k] = start[k] + stream_between(random, -0.3, 0.3);
    scene_add_torus(s, origin, 1.0, 0.35, 16, 7, false);
    deform_scene(s, squash_axes, start, end);
}

/* Rolls the x axis to a spiral whose radius grows by a[1] per turn. */
static void roll_sheet(const double rest[3], const double *a, double out[3]) {
    double angle = rest[0] * a[0], radius = 1.0 / a[0] + a[1] * angle;
    out[0] = radius * sin(angle);
    out[1] = rest[1];
    out[2] = 1.0 / a[0] - radius * cos(angle) + a[2] * sin(2.0 * rest[1]);
}

static void make_folded_sheet(scene *s, random_stream *random) {
    double start[3] = {stream_between(random, 0.8, 2.2), stream_between(random, -0.01, 0.08), 0.0}, end[3];
    end[0] = start[0] + stream_between(random, -0.2, 0.4);
    end[1] = start[1] + stream_between(random, -0.08, 0.03);
    end[2] = stream_between(random, -0.1, 0.1);
    scene_add_sheet(s, 6.0, 1.5, 24, 5);
    deform_scene(s, roll_sheet, start, end);
}

/* Moves the second half of the vertices by a and scales it by 1 + a[3]. */
static void move_second(scene *s, uint32_t first, const double start[4], const double end[4]) {
    for (uint32_t v = first; v < s->vertex_count; v++) {
        for (uint32_t k = 0; k < 3; k++) {
            double rest = s->x0[v * 3 + k];
            s->x0[v * 3 + k] = rest * (1.0 + start[3]) + start[k];
            s->x1[v * 3 + k] = rest * (1.0 + end[3]) + end[k];
        }
    }
}

static void make_two_spheres(scene *s, random_stream *random) {
    double start[4], end[4];
    fill_parameters(start, 3, random, -2.0, 2.0);
    fill_parameters(end, 3, random, -2.0, 2.0);
    start[3] = end[3] = 0.0;
    scene_add_sphere(s, origin, 0.9, 5, 8);
    uint32_t first = s->vertex_count;
    scene_add_sphere(s, origin, 0.7, 5, 7);
    move_second(s, first, start, end);
}

static void make_nested_spheres(scene *s, random_stream *random) {
    double start[4], end[4];
    fill_parameters(start, 3, random, -0.2, 0.2);
    fill_parameters(end, 3, random, -0.3, 0.3);
    start[3] = stream_between(random, -0.2, 0.3);
    end[3] = start[3] + stream_between(random, -0.3, 0.9);
    scene_add_sphere(s, origin, 1.0, 6, 9);
    uint32_t first = s->vertex_count;
    scene_add_sphere(s, origin, 0.5, 5, 8);
    move_second(s, first, start, end);
}

static void make_linked_tori(scene *s, random_stream *random) {
    double start[4] = {1.0}, end[4] = {1.0};
    fill_parameters(start + 1, 2, random, -0.1, 0.1);
    fill_parameters(end + 1, 2, random, -0.4, 0.4);
    end[0] = start[0] + stream_between(random, -0.3, 1.0);
    start[3] = end[3] = 0.0;
    scene_add_torus(s, origin, 1.0, 0.2, 14, 6, false);
    uint32_t first = s->vertex_count;
    scene_add_torus(s, origin, 1.0, 0.2, 13, 6, true);
    move_second(s, first, start, end);
}

static void make_spike(scene *s, random_stream *random) {
    scene_add_sphere(s, origin, 1.0, 6, 10);
    uint32_t v = 1 + stream_below(random, s->vertex_count - 2);
    double far = stream_between(random, -1.5, 1.2);
    for (uint32_t k = 0; k < 3; k++) s->x1[v * 3 + k] = far * s->x0[v * 3 + k];
}

/* Tilts the vertices above z = 0 by a[0] and those below by a[1] about the y axis. */
static void tilt_halves(const double rest[3], const double *a, double out[3]) {
    double angle = rest[2] > 0 ? a[0] : a[1];
    out[0] = rest[0] * cos(angle) + rest[2] * sin(angle);
    out[1] = rest[1];
    out[2] = rest[2] * cos(angle) - rest[0] * sin(angle);
}

static void make_bow_tie(scene *s, random_stream *random) {
    double start[2] = {stream_between(random, 0.0, 1.1), 0.0}, end[2];
    end[0] = start[0] + stream_between(random, -0.3, 0.6);
    end[1] = stream_between(random, -0.3, 0.0);
    scene_add_sphere(s, (double[3]){0, 0, 1.0}, 1.0, 5, 8);
    uint32_t first = s->vertex_count, first_triangle = s->triangle_count;
    scene_add_sphere(s, (double[3]){0, 0, -1.0}, 1.0, 5, 8);
    /* The top pole of the second sphere becomes the bottom pole of the first. */
    for (uint32_t i = first_triangle * 3; i < s->triangle_count * 3; i++) {
        if (s->triangles[i] == s->vertex_count - 1) s->triangles[i] = 0;
    }
    s->vertex_count--;
    (void)first;
    deform_scene(s, tilt_halves, start, end);
}

static void make_triangles(scene *s, random_stream *random, uint32_t vertex_count, uint32_t triangle_count) {
    s->vertex_count = vertex_count;
    while (s->triangle_count < triangle_count) {
        uint32_t t[3];
        for (int i = 0; i < 3; i++) t[i] = stream_below(random, vertex_count);
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        memcpy(s->triangles + (size_t)s->triangle_count++ * 3, t, sizeof t);
    }
}

static void make_soup(scene *s, random_stream *random) {
    const uint32_t triangle_count = 1 + stream_below(random, 2 + stream_below(random, 60));
    make_triangles(s, random, 12 + stream_below(random, 60), triangle_count);
    double spread = stream_between(random, 2.0, 60.0);
    double centres[SCENE_VERTICES_MAX];
    fill_parameters(centres, (int)s->vertex_count, random, -spread, spread);
    for (uint32_t i = 0; i < s->vertex_count * 3; i++) {
        s->x0[i] = centres[i / 3] + stream_between(random, -1.0, 1.0);
        s->x1[i] = s->x0[i] + stream_between(random, -0.5, 0.5);
    }
}

static void make_grid(scene *s, random_stream *random) {
    const uint32_t triangle_count = 2 + stream_below(random, 8);
    make_triangles(s, random, 6 + stream_below(random, 10), triangle_count);
    uint32_t extent = 3 + stream_below(random, 12);
    for (uint32_t i = 0; i < s->vertex_count * 3; i++) {
        s->x0[i] = stream_below(random, extent);
        s->x1[i] = stream_below(random, 3) == 0 ? stream_below(random, extent) : s->x0[i];
    }
}

void scene_make(scene_family family, uint64_t seed, scene *out) {
    static void (*const makers[SCENE_FAMILY_COUNT])(scene *, random_stream *) = {
        make_noisy_sphere, make_bent_capsule,   make_squashed_torus, make_folded_sheet,
        make_two_spheres,  make_nested_spheres, make_linked_tori,    make_spike,
        make_bow_tie,      make_soup,           make_grid,           make_far_away};
    random_stream random = stream_start(seed * SCENE_FAMILY_COUNT + (uint64_t)family);
    scene_clear(out);
    makers[family](out, &random);
    if (family != SCENE_GRID && family != SCENE_SOUP) jitter_vertices(out, 0.004, &random);
}
