/* A closed surface with deep folds, as of a cortex, and 100 frames in which its ridges swell into each other.
 *
 * A sphere of 20,480 triangles, five times subdivided from an icosahedron, has trenches where a field of waves is 0. Vertices lie on
 * rays from the centre, so no two triangles meet in the first frame. Then each vertex moves along its normal of that frame, most in some
 * places and not at all in others, until the banks of some trenches have passed through each other, and back again. */
#include "tool/io/mesh_file.h"
#include "tool/io/point_cache.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum {
    FOLDS_FRAMES = 100,
    FOLDS_VERTICES = 10242,
    FOLDS_TRIANGLES = 20480,
};

typedef struct folds {
    uint32_t triangles[FOLDS_TRIANGLES][3];
    double positions[FOLDS_VERTICES][3]; /* of the first frame */
    double swelling[FOLDS_VERTICES][3];  /* where a vertex is, less where it was, when it has swollen most */
} folds;

static const double pi = 3.14159265358979323846;

/* The trenches: how often they come, how wide and how deep they are; and how far the ridges swell. The radius is 1. */
static const double wave_number = 9.0, trench_width = 0.45, trench_depth = 0.3, swelling_height = 0.045,
                    swelling_wave_number = 2.5, axes[3] = {0.85, 1.1, 0.9};

/* ---- the sphere ---------------------------------------------------------------------------------------- */

typedef struct icosphere {
    double points[FOLDS_VERTICES][3];
    uint32_t triangles[FOLDS_TRIANGLES][3];
    uint32_t point_count, triangle_count;
} icosphere;

static void push_point(icosphere *s, double x, double y, double z) {
    const double length = sqrt(x * x + y * y + z * z);
    double *p = s->points[s->point_count++];
    p[0] = x / length, p[1] = y / length, p[2] = z / length;
}

static void begin_icosahedron(icosphere *s) {
    static const uint32_t faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                          {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                          {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                          {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    const double t = (1.0 + sqrt(5.0)) / 2.0;
    s->point_count = 0;
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < 4; i++) {
            const double a = i % 2 == 0 ? -1.0 : 1.0, b = i < 2 ? t : -t;
            if (axis == 0) push_point(s, a, b, 0.0);
            if (axis == 1) push_point(s, 0.0, a, b);
            if (axis == 2) push_point(s, b, 0.0, a);
        }
    }
    memcpy(s->triangles, faces, sizeof faces);
    s->triangle_count = 20;
}

/* Halves every edge. The middle of an edge is known by its two ends, of which few begin at the same point. */
typedef struct edge_middles {
    uint32_t ends[FOLDS_VERTICES][8], middles[FOLDS_VERTICES][8];
    uint8_t counts[FOLDS_VERTICES];
} edge_middles;

static uint32_t middle_of(edge_middles *known, icosphere *s, uint32_t a, uint32_t b) {
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    for (int i = 0; i < known->counts[low]; i++)
        if (known->ends[low][i] == high) return known->middles[low][i];
    const double *p = s->points[low], *q = s->points[high];
    push_point(s, p[0] + q[0], p[1] + q[1], p[2] + q[2]);
    const int place = known->counts[low]++;
    assert(place < 8);
    known->ends[low][place] = high;
    known->middles[low][place] = s->point_count - 1;
    return s->point_count - 1;
}

static void subdivide_sphere(icosphere *s) {
    static edge_middles known;
    static uint32_t coarse[FOLDS_TRIANGLES][3];
    const uint32_t count = s->triangle_count;
    memset(&known, 0, sizeof known);
    memcpy(coarse, s->triangles, count * sizeof *coarse);
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t *c = coarse[t];
        const uint32_t x = middle_of(&known, s, c[0], c[1]), y = middle_of(&known, s, c[1], c[2]),
                       z = middle_of(&known, s, c[2], c[0]);
        const uint32_t fine[4][3] = {{c[0], x, z}, {c[1], y, x}, {c[2], z, y}, {x, y, z}};
        memcpy(s->triangles[4 * t], fine, sizeof fine);
    }
    s->triangle_count = 4 * count;
}

/* ---- waves --------------------------------------------------------------------------------------------- */

enum { WAVES_MAX = 24 };

typedef struct waves {
    double directions[WAVES_MAX][3], phases[WAVES_MAX];
    int count;
} waves;

/* The next number from [0,1) of a linear congruential generator. */
static double next_random(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

static waves make_waves(uint64_t seed, int count, double number) {
    waves w = {.count = count};
    for (int i = 0; i < count; i++) {
        const double z = 2.0 * next_random(&seed) - 1.0, turn = 2.0 * pi * next_random(&seed),
                     radius = sqrt(1.0 - z * z);
        w.directions[i][0] = number * radius * cos(turn);
        w.directions[i][1] = number * radius * sin(turn);
        w.directions[i][2] = number * z;
        w.phases[i] = 2.0 * pi * next_random(&seed);
    }
    return w;
}

/* The mean square is 1. */
static double height_of(const waves *w, const double p[3]) {
    double sum = 0.0;
    for (int i = 0; i < w->count; i++) {
        const double *d = w->directions[i];
        sum += cos(d[0] * p[0] + d[1] * p[1] + d[2] * p[2] + w->phases[i]);
    }
    return sum / sqrt(w->count / 2.0);
}

/* ---- folds --------------------------------------------------------------------------------------------- */

static void dig_trenches(folds *f, const icosphere *s) {
    const waves w = make_waves(7, 24, wave_number);
    for (uint32_t v = 0; v < FOLDS_VERTICES; v++) {
        const double height = height_of(&w, s->points[v]) / trench_width;
        const double radius = 1.0 - trench_depth * exp(-height * height);
        for (int c = 0; c < 3; c++) f->positions[v][c] = radius * axes[c] * s->points[v][c];
    }
}

/* Adds the area vector of each triangle to its vertices. */
static void add_normals(folds *f) {
    for (uint32_t t = 0; t < FOLDS_TRIANGLES; t++) {
        const uint32_t *corners = f->triangles[t];
        const double *p = f->positions[corners[0]], *q = f->positions[corners[1]],
                     *r = f->positions[corners[2]];
        double a[3], b[3];
        for (int c = 0; c < 3; c++) {
            a[c] = q[c] - p[c];
            b[c] = r[c] - p[c];
        }
        for (int i = 0; i < 3; i++)
            for (int c = 0; c < 3; c++)
                f->swelling[corners[i]][c] +=
                    a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
    }
}

/* Returns the swelling of a vertex, from 0 to 1: a slow wave where it is above 0. */
static void weigh_swelling(folds *f, const icosphere *s) {
    static double shares[FOLDS_VERTICES];
    const waves w = make_waves(11, 8, swelling_wave_number);
    double most = 0.0;
    for (uint32_t v = 0; v < FOLDS_VERTICES; v++) {
        shares[v] = fmax(height_of(&w, s->points[v]), 0.0);
        most = fmax(most, shares[v]);
    }
    for (uint32_t v = 0; v < FOLDS_VERTICES; v++) {
        double *n = f->swelling[v];
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int c = 0; c < 3; c++) n[c] *= swelling_height * shares[v] / most / length;
    }
}

static void folds_make(folds *f) {
    static icosphere s;
    begin_icosahedron(&s);
    while (s.triangle_count < FOLDS_TRIANGLES) subdivide_sphere(&s);
    assert(s.point_count == FOLDS_VERTICES);
    memset(f, 0, sizeof *f);
    memcpy(f->triangles, s.triangles, sizeof f->triangles);
    dig_trenches(f, &s);
    add_normals(f);
    weigh_swelling(f, &s);
}

static void folds_pose(const folds *f, int frame, double (*positions)[3]) {
    const double wave = sin(pi * frame / (FOLDS_FRAMES - 1));
    const double share = frame == FOLDS_FRAMES - 1 ? 0.0 : wave * wave;
    for (uint32_t v = 0; v < FOLDS_VERTICES; v++)
        for (int c = 0; c < 3; c++) positions[v][c] = f->positions[v][c] + share * f->swelling[v][c];
}

/* ---- the program --------------------------------------------------------------------------------------- */

static const char help[] =
    "usage: folds FOLDER\n"
    "\n"
    "Writes folds.obj, a closed surface of 20,480 triangles with deep folds, and folds.pc2, 100 frames in which ridges swell\n"
    "until the banks of some folds have passed through each other, and back again. Nothing meets in the first frames.\n";

typedef double frame_positions[FOLDS_VERTICES][3];

static bool write_cache(const char *path, const folds *f, io_error *error) {
    static frame_positions positions;
    point_cache_writer *writer;
    if (!point_cache_writer_open(path, FOLDS_VERTICES, FOLDS_FRAMES, &writer, error)) return false;
    for (int frame = 0; frame < FOLDS_FRAMES; frame++) {
        folds_pose(f, frame, positions);
        if (!point_cache_writer_write(writer, positions[0], error)) break;
    }
    return point_cache_writer_close(writer, error);
}

static bool write_folds(const char *folder, folds *f, io_error *error) {
    char path[4096];
    const mesh_file model = mesh_file_of(FOLDS_VERTICES, FOLDS_TRIANGLES, f->positions[0], f->triangles[0]);
    snprintf(path, sizeof path, "%s/folds.obj", folder);
    if (!mesh_file_write_obj(path, &model, error)) return false;
    snprintf(path, sizeof path, "%s/folds.pc2", folder);
    return write_cache(path, f, error);
}

int main(int argument_count, char **arguments) {
    static folds f;
    io_error error;
    if (argument_count == 2 && strcmp(arguments[1], "--help") == 0) {
        fputs(help, stdout);
        return 0;
    }
    if (argument_count != 2 || strlen(arguments[1]) > 4000) {
        fputs("folds: expected a folder; see --help\n", stderr);
        return 2;
    }
    folds_make(&f);
    if (!write_folds(arguments[1], &f, &error)) {
        fprintf(stderr, "folds: %s\n", error.text);
        return 1;
    }
    printf("%d vertices, %d triangles, %d frames\n", FOLDS_VERTICES, FOLDS_TRIANGLES, FOLDS_FRAMES);
    return 0;
}
