/* How scenes are built: objects, their frames, and random numbers that are the same every time. */
#include "benchmarks/untangle/tangle_scene.h"

#include "models/shapes/rings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

void tangle_scene_free(tangle_scene *s) {
    for (uint32_t i = 0; i < s->object_count; i++) body_free(&s->objects[i]);
    free(s->triangles);
    free(s->frames);
    free(s->weights);
    free(s->seams);
    *s = (tangle_scene){.object_count = 0};
}

const double *tangle_scene_frame(const tangle_scene *s, uint32_t frame) {
    return s->frames + (size_t)frame * s->vertex_count * 3;
}

/* ---- objects ------------------------------------------------------------------------------------------- */

body *tangle_add_object(tangle_scene *s) {
    return &s->objects[s->object_count++];
}

bool tangle_add_body(tangle_scene *s, body_kind kind, uint32_t triangle_count, io_error *error) {
    return body_make(kind, body_nearest_count(kind, triangle_count), tangle_add_object(s), error);
}

void tangle_begin_frames(tangle_scene *s, uint32_t frame_count) {
    for (uint32_t i = 0; i < s->object_count; i++) {
        s->vertex_count += s->objects[i].vertex_count;
        s->triangle_count += s->objects[i].triangle_count;
    }
    const size_t size = (size_t)s->vertex_count * 3;
    s->triangles = body_allocate((size_t)s->triangle_count * 3, sizeof *s->triangles);
    s->frames = body_allocate(frame_count * size, sizeof *s->frames);
    s->frame_count = frame_count;
    uint32_t first = 0, *corner = s->triangles;
    for (uint32_t i = 0; i < s->object_count; i++) {
        const body *b = &s->objects[i];
        memcpy(s->frames + (size_t)first * 3, b->positions, b->vertex_count * sizeof(double[3]));
        for (uint32_t j = 0; j < 3 * b->triangle_count; j++) *corner++ = first + b->triangles[j];
        first += b->vertex_count;
    }
    for (uint32_t f = 1; f < frame_count; f++)
        memcpy(s->frames + f * size, s->frames, size * sizeof *s->frames);
}

void tangle_pin_below(tangle_scene *s, double height) {
    s->weights = body_allocate(s->vertex_count, sizeof *s->weights);
    for (size_t v = 0; v < s->vertex_count; v++)
        s->weights[v] = s->frames[3 * v + 2] < height ? INFINITY : 1.0;
}

void tangle_round_frames(tangle_scene *s) {
    const size_t count = (size_t)s->frame_count * s->vertex_count * 3;
    for (size_t i = 0; i < count; i++) {
        volatile float rounded = (float)s->frames[i];
        s->frames[i] = rounded;
    }
}

/* ---- shapes -------------------------------------------------------------------------------------------- */

void body_add_rod(body *b, uint32_t triangle_count, double radius, double length) {
    const double half = 0.5 * length - radius;
    outline o = {.end = {0.0, -0.5 * length}};
    outline_arc(&o, 0.0, -half, radius, -90.0, 0.0);
    outline_line(&o, radius, half);
    outline_arc(&o, 0.0, half, radius, 0.0, 90.0);
    body_add_rings(b, &o, triangle_count & ~1u, NULL);
}

/* Vertices at edges are found again by their places, which are whole numbers of squares. */
typedef struct block_places {
    uint32_t *vertices; /* by place on the grid of the block; UINT32_MAX: none yet */
    uint32_t size[3];
    double square[3];
} block_places;

static uint32_t block_place(block_places *k, body *b, const uint32_t at[3]) {
    uint32_t *found = &k->vertices[(at[2] * (k->size[1] + 1) + at[1]) * (k->size[0] + 1) + at[0]];
    if (*found == UINT32_MAX)
        *found = body_add_vertex(b, at[0] * k->square[0], at[1] * k->square[1], at[2] * k->square[2]);
    return *found;
}

static void add_block_side(block_places *k, body *b, int axis, bool upper) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (uint32_t i = 0; i < k->size[u]; i++) {
        for (uint32_t j = 0; j < k->size[v]; j++) {
            uint32_t corners[4], at[3];
            for (uint32_t c = 0; c < 4; c++) {
                at[axis] = upper ? k->size[axis] : 0;
                at[u] = i + (c == 1 || c == 2);
                at[v] = j + (c >= 2);
                corners[upper ? c : 3 - c] = block_place(k, b, at);
            }
            body_add_triangle(b, corners[0], corners[1], corners[2]);
            body_add_triangle(b, corners[0], corners[2], corners[3]);
        }
    }
}

void body_add_block(body *b, uint32_t triangle_count, const double size[3]) {
    const double area = 2.0 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
    const double side = sqrt(2.0 * area / triangle_count);
    block_places k;
    size_t places = 1;
    for (int c = 0; c < 3; c++) {
        k.size[c] = (uint32_t)fmax(1.0, round(size[c] / side));
        k.square[c] = size[c] / k.size[c];
        places *= k.size[c] + 1;
    }
    k.vertices = body_allocate(places, sizeof *k.vertices);
    memset(k.vertices, 255, places * sizeof *k.vertices);
    for (int side_index = 0; side_index < 6; side_index++)
        add_block_side(&k, b, side_index / 2, side_index % 2 == 1);
    free(k.vertices);
}

void body_add_grid(body *b, uint32_t rows, uint32_t columns, double width, double depth) {
    const uint32_t first = b->vertex_count;
    for (uint32_t i = 0; i <= rows; i++)
        for (uint32_t j = 0; j <= columns; j++)
            body_add_vertex(b, width * i / rows, depth * j / columns, 0.0);
    for (uint32_t i = 0; i < rows; i++) {
        for (uint32_t j = 0; j < columns; j++) {
            const uint32_t v = first + i * (columns + 1) + j, w = v + columns + 1;
            if ((i + j) % 2 == 0) {
                body_add_triangle(b, v, w, w + 1);
                body_add_triangle(b, v, w + 1, v + 1);
            } else {
                body_add_triangle(b, v, w, v + 1);
                body_add_triangle(b, w, w + 1, v + 1);
            }
        }
    }
}

void body_scale(body *b, double x, double y, double z) {
    const double factors[3] = {x, y, z};
    for (size_t i = 0; i < (size_t)b->vertex_count * 3; i++) b->positions[i] *= factors[i % 3];
}

void body_rotate(body *b, double matrix[3][3]) {
    for (size_t v = 0; v < b->vertex_count; v++) {
        double *p = b->positions + 3 * v, q[3];
        for (int i = 0; i < 3; i++) q[i] = matrix[i][0] * p[0] + matrix[i][1] * p[1] + matrix[i][2] * p[2];
        memcpy(p, q, sizeof q);
    }
}

void body_move(body *b, double x, double y, double z) {
    const double by[3] = {x, y, z};
    for (size_t i = 0; i < (size_t)b->vertex_count * 3; i++) b->positions[i] += by[i % 3];
}

/* ---- random numbers ------------------------------------------------------------------------------------ */

static uint64_t advance_state(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return *state >> 11;
}

/* The finalizer of splitmix64: seeds that follow each other give states that have nothing in common. */
uint64_t tangle_seed(uint32_t seed) {
    uint64_t state = 0x9e3779b97f4a7c15u * (seed + UINT64_C(1));
    state = (state ^ state >> 30) * 0xbf58476d1ce4e5b9u;
    state = (state ^ state >> 27) * 0x94d049bb133111ebu;
    return state ^ state >> 31;
}

double tangle_random(uint64_t *state, double low, double high) {
    return low + (high - low) * (double)advance_state(state) * 0x1p-53;
}

/* A quaternion within the unit ball, normalized. */
void tangle_random_rotation(uint64_t *state, double matrix[3][3]) {
    double q[4], norm;
    do {
        norm = 0.0;
        for (int i = 0; i < 4; i++) {
            q[i] = tangle_random(state, -1.0, 1.0);
            norm += q[i] * q[i];
        }
    } while (norm > 1.0 || norm < 0.01);
    for (int i = 0; i < 4; i++) q[i] /= sqrt(norm);
    const double w = q[0], *v = q + 1;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        matrix[i][i] = 1.0 - 2.0 * (v[j] * v[j] + v[k] * v[k]);
        matrix[i][j] = 2.0 * (v[i] * v[j] - w * v[k]);
        matrix[i][k] = 2.0 * (v[i] * v[k] + w * v[j]);
    }
}

tangle_waves tangle_random_waves(uint64_t *state, double most) {
    tangle_waves w;
    for (int i = 0; i < TANGLE_WAVES; i++) {
        w.along[i] = 2.0 * pi * tangle_random(state, -most, most);
        w.across[i] = 2.0 * pi * tangle_random(state, -most, most);
        w.phases[i] = 2.0 * pi * tangle_random(state, 0.0, 1.0);
    }
    return w;
}

double tangle_wave_height(const tangle_waves *w, double along, double across) {
    double sum = 0.0;
    for (int i = 0; i < TANGLE_WAVES; i++)
        sum += sin(w->along[i] * along + w->across[i] * across + w->phases[i]);
    return sum / sqrt(2.0 * TANGLE_WAVES);
}
