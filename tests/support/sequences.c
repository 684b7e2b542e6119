/* Random recordings whose meshes pass into themselves, rest, come out, and pass in again. */
#include "tests/support/sequences.h"

#include "tests/support/random_stream.h"

#include <math.h>
#include <string.h>

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

static void make_scene(sequence *q, random_stream *random) {
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

static void make_grid(sequence *q, random_stream *random) {
    uint32_t shapes = 1 + (stream_below(random, 4) == 0);
    scene_clear(&q->shape);
    for (uint32_t i = 0; i < shapes; i++) add_grid_shape(&q->shape, random);
    memcpy(q->frames[0], q->shape.x0, sizeof q->frames[0]);
    for (uint32_t f = 1; f < q->frame_count; f++) move_on_grid(q, q->frames[f - 1], q->frames[f], random);
}

void sequence_make(sequence_kind kind, uint64_t seed, uint32_t frame_count, sequence *out) {
    random_stream random = stream_start(seed * SEQUENCE_KIND_COUNT + (uint64_t)kind);
    out->frame_count = frame_count;
    (kind == SEQUENCE_SCENE ? make_scene : make_grid)(out, &random);
    if (stream_below(&random, 2) == 0) turn_inwards(&out->shape);
}
