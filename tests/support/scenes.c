/* Meshes and random intervals that all tests share, sequences of frames, and small meshes without positions. */
#include "tests/support/scenes.h"

#include "tests/support/random.h"
#include "tests/support/test.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

void scene_clear(scene *s) {
    s->vertex_count = s->triangle_count = 0;
}

static uint32_t add_vertex(scene *s, double x, double y, double z) {
    assert(s->vertex_count < SCENE_VERTICES_MAX);
    double p[3] = {x, y, z};
    memcpy(s->x0 + (size_t)s->vertex_count * 3, p, sizeof p);
    memcpy(s->x1 + (size_t)s->vertex_count * 3, p, sizeof p);
    return s->vertex_count++;
}

static void add_triangle(scene *s, uint32_t a, uint32_t b, uint32_t c) {
    assert(s->triangle_count < SCENE_TRIANGLES_MAX);
    uint32_t t[3] = {a, b, c};
    memcpy(s->triangles + (size_t)s->triangle_count++ * 3, t, sizeof t);
}

static void add_quad(scene *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    add_triangle(s, a, b, c);
    add_triangle(s, a, c, d);
}

/* Adds a surface of revolution about the z axis between two poles; z and radius of each ring are given. */
static void add_revolved(scene *s, const double centre[3], double low_pole, double high_pole, int rings,
                         int segments, const double (*profile)[2]) {
    uint32_t low = add_vertex(s, centre[0], centre[1], centre[2] + low_pole), first = s->vertex_count;
    for (int i = 0; i < rings; i++) {
        for (int j = 0; j < segments; j++) {
            double angle = 2.0 * PI * (j + 0.5 * (i % 2)) / segments;
            add_vertex(s, centre[0] + profile[i][1] * cos(angle), centre[1] + profile[i][1] * sin(angle),
                       centre[2] + profile[i][0]);
        }
    }
    uint32_t high = add_vertex(s, centre[0], centre[1], centre[2] + high_pole), n = (uint32_t)segments;
    for (uint32_t j = 0; j < n; j++) {
        uint32_t k = (j + 1) % n, last = first + (uint32_t)(rings - 1) * n;
        add_triangle(s, low, first + k, first + j);
        add_triangle(s, high, last + j, last + k);
        for (uint32_t i = 0; i + 1 < (uint32_t)rings; i++) {
            uint32_t row = first + i * n, next = row + n;
            add_quad(s, row + j, row + k, next + k, next + j);
        }
    }
}

void scene_add_sphere(scene *s, const double centre[3], double radius, int rings, int segments) {
    double profile[64][2];
    assert(rings <= 64);
    for (int i = 0; i < rings; i++) {
        double latitude = PI * ((i + 1.0) / (rings + 1.0) - 0.5);
        profile[i][0] = radius * sin(latitude);
        profile[i][1] = radius * cos(latitude);
    }
    add_revolved(s, centre, -radius, radius, rings, segments, (const double(*)[2])profile);
}

void scene_add_capsule(scene *s, double length, double radius, int rings, int segments) {
    static const double centre[3] = {0, 0, 0};
    double profile[64][2];
    assert(rings <= 64);
    for (int i = 0; i < rings; i++) {
        double z = length * ((i + 0.5) / rings - 0.5), past = fabs(z) - (0.5 * length - radius);
        profile[i][0] = z;
        profile[i][1] = past > 0 ? sqrt(fmax(radius * radius - past * past, 0.01 * radius * radius)) : radius;
    }
    add_revolved(s, centre, -0.5 * length, 0.5 * length, rings, segments, (const double(*)[2])profile);
}

void scene_add_torus(scene *s, const double centre[3], double major, double minor, int rings, int segments,
                     bool standing) {
    uint32_t first = s->vertex_count, m = (uint32_t)rings, n = (uint32_t)segments;
    for (uint32_t i = 0; i < m; i++) {
        double around = 2.0 * PI * i / m;
        for (uint32_t j = 0; j < n; j++) {
            double across = 2.0 * PI * j / n, reach = major + minor * cos(across);
            double p[3] = {reach * cos(around), reach * sin(around), minor * sin(across)};
            if (standing) /* a rotation, so the orientation does not change */
                add_vertex(s, centre[0] + p[0], centre[1] - p[2], centre[2] + p[1]);
            else
                add_vertex(s, centre[0] + p[0], centre[1] + p[1], centre[2] + p[2]);
        }
    }
    for (uint32_t i = 0; i < m; i++) {
        for (uint32_t j = 0; j < n; j++) {
            uint32_t row = first + i * n, next = first + (i + 1) % m * n, k = (j + 1) % n;
            add_quad(s, row + j, next + j, next + k, row + k);
        }
    }
}

void scene_add_sheet(scene *s, double width, double height, int columns, int rows) {
    uint32_t first = s->vertex_count, n = (uint32_t)columns + 1;
    for (int i = 0; i <= rows; i++) {
        for (int j = 0; j <= columns; j++)
            add_vertex(s, width * ((double)j / columns - 0.5), height * ((double)i / rows - 0.5), 0.0);
    }
    for (uint32_t i = 0; i < (uint32_t)rows; i++) {
        for (uint32_t j = 0; j < (uint32_t)columns; j++) {
            uint32_t corner = first + i * n + j;
            add_quad(s, corner, corner + 1, corner + n + 1, corner + n);
        }
    }
}

/* ---- families ------------------------------------------------------------------------------------------ */

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

/* ---- sequences ----------------------------------------------------------------------------------------- */

static void turn_inwards(scene *s) {
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        uint32_t *corners = s->triangles + (size_t)t * 3, first = corners[0];
        corners[0] = corners[1];
        corners[1] = first;
    }
}

/* ---- scenes ------------------------------------------------------------------------------------------ */

/* Pulls the surface around a vertex towards another vertex, and through it. */
typedef struct dent {
    uint32_t from, to;
    double width, depth;
} dent;

enum { DENTS = 2 };

static dent make_dent(const scene *s, random_stream *random) {
    return (dent){stream_below(random, s->vertex_count), stream_below(random, s->vertex_count),
                  stream_between(random, 0.1, 0.6), 0.0};
}

static void press_dent(const scene *s, const dent *d, double *x) {
    const double *from = s->x0 + (size_t)d->from * 3, *to = s->x0 + (size_t)d->to * 3;
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        const double *p = s->x0 + (size_t)v * 3;
        double away = hypot(hypot(p[0] - from[0], p[1] - from[1]), p[2] - from[2]) / d->width;
        for (int k = 0; k < 3; k++)
            x[v * 3 + (uint32_t)k] += d->depth * exp(-away * away) * (to[k] - from[k]);
    }
}

static void make_scene_sequence(sequence *q, random_stream *random) {
    static const scene_family families[] = {SCENE_NOISY_SPHERE, SCENE_BENT_CAPSULE,   SCENE_SQUASHED_TORUS,
                                            SCENE_TWO_SPHERES,  SCENE_NESTED_SPHERES, SCENE_LINKED_TORI,
                                            SCENE_SPIKE,        SCENE_SPIKE,          SCENE_FAR_AWAY};
    const uint64_t seed = stream_bits(random) >> 40;
    scene_make(families[stream_below(random, sizeof families / sizeof *families)], seed, &q->shape);
    dent dents[DENTS];
    for (int i = 0; i < DENTS; i++) dents[i] = make_dent(&q->shape, random);
    double at = stream_between(random, -0.5, 0.5), noise = 0.0;
    for (uint32_t f = 0; f < q->frame_count; f++) {
        for (uint32_t i = 0; i < q->shape.vertex_count * 3; i++) {
            double step = stream_between(random, -noise, noise);
            q->frames[f][i] = q->shape.x0[i] + at * (q->shape.x1[i] - q->shape.x0[i]) + step;
        }
        for (int i = 0; i < DENTS; i++) press_dent(&q->shape, &dents[i], q->frames[f]);
        if (stream_below(random, 8) == 0) continue; /* the mesh rests, or almost */
        at += stream_between(random, -0.5, 0.5);
        if (at > 2.0 || at < -1.0) at = 0.5;
        noise = stream_below(random, 3) == 0 ? stream_between(random, 0.0, 0.03) : 0.0;
        for (int i = 0; i < DENTS; i++) {
            dents[i].depth += stream_between(random, -0.6, 0.6);
            if (dents[i].depth < -0.2 || dents[i].depth > 1.5) dents[i].depth = 0.0;
        }
    }
}

/* ---- grids ------------------------------------------------------------------------------------------- */

/* Adds a polyhedron with vertices at 4 i and 4 i + 1, the corners of a box: with 12 triangles, an
 * octahedron, or a tetrahedron. */
static void add_polyhedron(scene *s, uint32_t kind, const double centre[3]) {
    static const double corners[3][8][3] = {
        {{2, 2, 2}, {-2, -2, 2}, {-2, 2, -2}, {2, -2, -2}},
        {{3, 0, 0}, {-3, 0, 0}, {0, 3, 0}, {0, -3, 0}, {0, 0, 3}, {0, 0, -3}},
        {{-2, -2, -2}, {2, -2, -2}, {2, 2, -2}, {-2, 2, -2}, {-2, -2, 2}, {2, -2, 2}, {2, 2, 2}, {-2, 2, 2}}};
    static const uint32_t triangles[3][12][3] = {
        {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}},
        {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}},
        {{0, 2, 1},
         {0, 3, 2},
         {4, 5, 6},
         {4, 6, 7},
         {0, 1, 5},
         {0, 5, 4},
         {1, 2, 6},
         {1, 6, 5},
         {2, 3, 7},
         {2, 7, 6},
         {3, 0, 4},
         {3, 4, 7}}};
    static const uint32_t vertex_counts[3] = {4, 6, 8}, triangle_counts[3] = {4, 8, 12};
    uint32_t first = s->vertex_count;
    for (uint32_t v = 0; v < vertex_counts[kind]; v++, s->vertex_count++) {
        for (int k = 0; k < 3; k++)
            s->x0[s->vertex_count * 3 + (uint32_t)k] = centre[k] + corners[kind][v][k];
    }
    for (uint32_t t = 0; t < triangle_counts[kind]; t++, s->triangle_count++) {
        for (int i = 0; i < 3; i++)
            s->triangles[s->triangle_count * 3 + (uint32_t)i] = first + triangles[kind][t][i];
    }
}

static void add_grid_shape(scene *s, random_stream *random) {
    double centre[3];
    for (int k = 0; k < 3; k++) centre[k] = (double)stream_below(random, 9) - 4.0;
    uint32_t kind = stream_below(random, 6), first = s->vertex_count;
    if (kind < 3)
        add_polyhedron(s, kind, centre);
    else if (kind < 5) {
        const int columns = 4 + (int)stream_below(random, 4);
        scene_add_sphere(s, centre, 5.0, 3 + (int)stream_below(random, 3), columns);
    } else
        scene_add_torus(s, centre, 6.0, 3.0, 5 + (int)stream_below(random, 3), 4, false);
    for (uint32_t i = first * 3; i < s->vertex_count * 3; i++) s->x0[i] = round(s->x0[i]);
}

/* Moves some vertices on the grid and returns a few to their places; at times all return. */
static void move_on_grid(sequence *q, const double *from, double *to, random_stream *random) {
    uint32_t vertex_count = q->shape.vertex_count, movers = stream_below(random, 5),
             reach = 1 + stream_below(random, 5);
    memcpy(to, from, vertex_count * sizeof(double[3]));
    if (stream_below(random, 6) == 0) {
        memcpy(to, q->shape.x0, vertex_count * sizeof(double[3]));
        return;
    }
    if (stream_below(random, 12) == 0) movers = vertex_count;
    for (uint32_t i = 0; i < movers; i++) {
        uint32_t v = stream_below(random, vertex_count);
        bool home = stream_below(random, 3) == 0;
        for (uint32_t k = 0; k < 3; k++) {
            double step = (double)stream_below(random, 2 * reach + 1) - reach;
            to[v * 3 + k] = home ? q->shape.x0[v * 3 + k] : to[v * 3 + k] + step;
        }
    }
}

static void make_grid_sequence(sequence *q, random_stream *random) {
    uint32_t shapes = 1 + (stream_below(random, 4) == 0);
    scene_clear(&q->shape);
    for (uint32_t i = 0; i < shapes; i++) add_grid_shape(&q->shape, random);
    memcpy(q->frames[0], q->shape.x0, sizeof q->frames[0]);
    for (uint32_t f = 1; f < q->frame_count; f++) move_on_grid(q, q->frames[f - 1], q->frames[f], random);
}

void sequence_make(sequence_kind kind, uint64_t seed, uint32_t frame_count, sequence *out) {
    random_stream random = stream_start(seed * SEQUENCE_KIND_COUNT + (uint64_t)kind);
    out->frame_count = frame_count;
    (kind == SEQUENCE_SCENE ? make_scene_sequence : make_grid_sequence)(out, &random);
    if (stream_below(&random, 2) == 0) turn_inwards(&out->shape);
}

/* ---- meshes without positions -------------------------------------------------------------------------- */

void shape_add_triangle(mesh_shape *s, uint32_t a, uint32_t b, uint32_t c) {
    assert_true(s->triangle_count < SHAPE_TRIANGLES_MAX);
    memcpy(s->triangles[s->triangle_count++], (uint32_t[]){a, b, c}, sizeof s->triangles[0]);
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t v = s->triangles[s->triangle_count - 1][i];
        if (v >= s->vertex_count) s->vertex_count = v + 1;
    }
}

void shape_add_quad(mesh_shape *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    shape_add_triangle(s, a, b, c);
    shape_add_triangle(s, a, c, d);
}

void shape_add_tetrahedron(mesh_shape *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    shape_add_triangle(s, a, b, c);
    shape_add_triangle(s, a, c, d);
    shape_add_triangle(s, a, d, b);
    shape_add_triangle(s, b, d, c);
}

void shape_add_cube(mesh_shape *s) {
    shape_add_quad(s, 0, 2, 3, 1);
    shape_add_quad(s, 4, 5, 7, 6);
    shape_add_quad(s, 0, 1, 5, 4);
    shape_add_quad(s, 2, 6, 7, 3);
    shape_add_quad(s, 0, 4, 6, 2);
    shape_add_quad(s, 1, 3, 7, 5);
}

void shape_add_grid(mesh_shape *s, uint32_t rows, uint32_t columns, bool rows_close, bool columns_close) {
    uint32_t width = columns_close ? columns : columns + 1, height = rows_close ? rows : rows + 1;
    for (uint32_t i = 0; i < rows; i++) {
        for (uint32_t j = 0; j < columns; j++) {
            uint32_t below = (i + 1) % height * width, here = i * width, next = (j + 1) % width;
            shape_add_quad(s, here + j, here + next, below + next, below + j);
        }
    }
}

void shape_add_moebius_strip(mesh_shape *s, uint32_t count) {
    for (uint32_t i = 0; i + 1 < count; i++) shape_add_quad(s, 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
    shape_add_quad(s, 2 * count - 2, 1, 0, 2 * count - 1);
}
