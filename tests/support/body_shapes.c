/* Closed bodies with necks and limbs: pawn-like, dumbbell-like, human-like. */
#include "tests/support/body_shapes.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

enum { PROFILE_MAX = 400, RINGS_MAX = 2000 };

/* An outline in the half plane (radius, z) from the lower pole to the upper one. */
typedef struct profile {
    uint32_t count;
    double points[PROFILE_MAX][2];
} profile;

const char *body_kind_name(body_kind kind) {
    static const char *const names[] = {"pawn", "dumbbell", "human", "ball"};
    return names[kind];
}

static void *grown(void *block, uint32_t *capacity, size_t item_size) {
    *capacity = *capacity == 0 ? 1024 : *capacity * 2;
    block = realloc(block, *capacity * item_size);
    if (block == NULL) abort();
    return block;
}

uint32_t body_add_vertex(body *b, double x, double y, double z) {
    if (b->vertex_count == b->vertex_capacity)
        b->positions = grown(b->positions, &b->vertex_capacity, 3 * sizeof *b->positions);
    memcpy(b->positions + (size_t)b->vertex_count * 3, (double[3]){x, y, z}, 3 * sizeof(double));
    return b->vertex_count++;
}

void body_add_triangle(body *b, uint32_t v0, uint32_t v1, uint32_t v2) {
    if (b->triangle_count == b->triangle_capacity)
        b->triangles = grown(b->triangles, &b->triangle_capacity, 3 * sizeof *b->triangles);
    memcpy(b->triangles + (size_t)b->triangle_count++ * 3, (uint32_t[3]){v0, v1, v2}, 3 * sizeof(uint32_t));
}

void body_free(body *b) {
    free(b->positions);
    free(b->triangles);
    *b = (body){0};
}

static void profile_line(profile *p, double radius, double z) {
    assert(p->count < PROFILE_MAX);
    p->points[p->count][0] = radius;
    p->points[p->count++][1] = z;
}

/* An arc about a point, from one angle to another; degrees, 0 outwards, 90 up. */
static void profile_arc(profile *p, double centre_radius, double centre_z, double size, double from,
                        double to) {
    for (int i = 0; i <= 40; i++) {
        double angle = (from + (to - from) * i / 40.0) * PI / 180.0;
        profile_line(p, fmax(centre_radius + size * cos(angle), 0.0), centre_z + size * sin(angle));
    }
}

static double segment_length(const profile *p, uint32_t i) {
    return hypot(p->points[i + 1][0] - p->points[i][0], p->points[i + 1][1] - p->points[i][1]);
}

/* count + 1 points at equal distances along the outline, both ends included. */
static void resample(const profile *p, uint32_t count, double (*out)[2]) {
    double total = 0.0, passed = 0.0;
    for (uint32_t i = 0; i + 1 < p->count; i++) total += segment_length(p, i);
    uint32_t segment = 0;
    for (uint32_t k = 0; k <= count; k++) {
        double wanted = total * k / count;
        while (segment + 2 < p->count && passed + segment_length(p, segment) < wanted)
            passed += segment_length(p, segment++);
        double length = segment_length(p, segment);
        double part = length > 0.0 ? fmin((wanted - passed) / length, 1.0) : 0.0;
        for (int i = 0; i < 2; i++)
            out[k][i] = p->points[segment][i] + part * (p->points[segment + 1][i] - p->points[segment][i]);
    }
}

typedef struct ring {
    uint32_t first, count;
    double turn; /* of the first vertex, in whole turns */
} ring;

static ring add_ring(body *b, double radius, double z, double edge_length, bool odd) {
    ring r = {b->vertex_count, (uint32_t)fmax(6.0, 2.0 * PI * radius / edge_length + 0.5), 0.0};
    if (odd) r.turn = 0.5 / r.count;
    for (uint32_t i = 0; i < r.count; i++) {
        double angle = 2.0 * PI * (r.turn + (double)i / r.count);
        body_add_vertex(b, radius * cos(angle), radius * sin(angle), z);
    }
    return r;
}

/* Two rings of any two sizes: the one whose next vertex comes first moves on. */
static void stitch(body *b, ring low, ring high) {
    uint32_t i = 0, j = 0;
    while (i < low.count || j < high.count) {
        uint32_t here = low.first + i % low.count, above = high.first + j % high.count;
        double next_low = low.turn + (i + 1.0) / low.count, next_high = high.turn + (j + 1.0) / high.count;
        if (i < low.count && (j == high.count || next_low <= next_high))
            body_add_triangle(b, here, low.first + ++i % low.count, above);
        else
            body_add_triangle(b, here, high.first + ++j % high.count, above);
    }
}

static void revolve(body *b, const profile *p, double edge_length) {
    static double points[RINGS_MAX][2];
    double total = 0.0;
    for (uint32_t i = 0; i + 1 < p->count; i++) total += segment_length(p, i);
    uint32_t count = (uint32_t)(total / (0.87 * edge_length)) + 2;
    assert(count < RINGS_MAX);
    resample(p, count, points);
    uint32_t pole = body_add_vertex(b, 0.0, 0.0, points[0][1]);
    ring last = {0, 0, 0.0};
    for (uint32_t k = 1; k < count; k++) {
        ring next = add_ring(b, points[k][0], points[k][1], edge_length, k % 2 == 1);
        if (k > 1) stitch(b, last, next);
        for (uint32_t i = 0; k == 1 && i < next.count; i++)
            body_add_triangle(b, pole, next.first + (i + 1) % next.count, next.first + i);
        last = next;
    }
    pole = body_add_vertex(b, 0.0, 0.0, points[count][1]);
    for (uint32_t i = 0; i < last.count; i++)
        body_add_triangle(b, pole, last.first + i, last.first + (i + 1) % last.count);
}

/* A foot with a rounded rim, a waist, a ring below the head, the head. */
static void add_pawn(body *b, double edge_length) {
    profile p = {0};
    profile_line(&p, 0.0, 0.0);
    profile_arc(&p, 0.88, 0.12, 0.12, -90.0, 0.0);
    profile_arc(&p, 0.80, 0.30, 0.20, 0.0, 70.0);
    profile_line(&p, 0.62, 0.62);
    profile_line(&p, 0.46, 1.05);
    profile_line(&p, 0.36, 1.75);
    profile_arc(&p, 0.52, 1.86, 0.08, -90.0, 90.0);
    profile_line(&p, 0.34, 1.98);
    profile_arc(&p, 0.0, 2.55, 0.58, -54.0, 90.0);
    revolve(b, &p, edge_length);
}

static void add_dumbbell(body *b, double edge_length) {
    profile p = {0};
    profile_arc(&p, 0.0, -1.25, 0.8, -90.0, 68.0);
    profile_arc(&p, 0.0, 1.25, 0.8, -68.0, 90.0);
    revolve(b, &p, edge_length);
}

static double to_capsule(const double p[3], const double a[3], const double b[3], double radius_a,
                         double radius_b) {
    double along = 0.0, length = 0.0, squared = 0.0;
    for (int k = 0; k < 3; k++) {
        along += (p[k] - a[k]) * (b[k] - a[k]);
        length += (b[k] - a[k]) * (b[k] - a[k]);
    }
    double t = fmin(fmax(along / length, 0.0), 1.0);
    for (int k = 0; k < 3; k++) {
        double d = p[k] - a[k] - t * (b[k] - a[k]);
        squared += d * d;
    }
    return sqrt(squared) - (radius_a + t * (radius_b - radius_a));
}

/* The smaller of the two, rounded where they are less than `blend` apart. */
static double united(double a, double b, double blend) {
    double h = fmax(blend - fabs(a - b), 0.0) / blend;
    return fmin(a, b) - h * h * blend * 0.25;
}

/* Standing, arms half raised, legs apart; the left half mirrors the right. */
static double to_human(const double point[3]) {
    static const struct limb {
        double a[3], b[3], radius_a, radius_b, blend;
    } limbs[] = {
        {{0.00, 0.0, 1.46}, {0.00, 0.0, 1.58}, 0.085, 0.080, 0.04}, /* neck */
        {{0.18, 0.0, 1.38}, {0.48, 0.0, 1.14}, 0.095, 0.085, 0.05}, /* upper arm */
        {{0.48, 0.0, 1.14}, {0.70, -.06, 0.95}, 0.085, 0.085, 0.02},
        {{0.14, 0.0, 0.88}, {0.22, 0.0, 0.48}, 0.130, 0.105, 0.04}, /* thigh */
        {{0.22, 0.0, 0.48}, {0.28, 0.0, 0.10}, 0.105, 0.095, 0.02},
        {{0.28, 0.0, 0.10}, {0.31, -.15, 0.09}, 0.095, 0.085, 0.02}, /* foot */
    };
    double p[3] = {fabs(point[0]), point[1], point[2]};
    double distance = to_capsule(p, (double[3]){0, 0, 1.72}, (double[3]){0, 0, 1.75}, 0.150, 0.150);
    double chest = to_capsule(p, (double[3]){0, 0, 1.32}, (double[3]){0.11, 0, 1.34}, 0.150, 0.140);
    double belly = to_capsule(p, (double[3]){0, 0, 1.25}, (double[3]){0, 0, 0.98}, 0.170, 0.170);
    distance = united(distance, united(chest, belly, 0.10), 0.02);
    for (size_t i = 0; i < sizeof limbs / sizeof *limbs; i++) {
        const struct limb *l = &limbs[i];
        distance = united(distance, to_capsule(p, l->a, l->b, l->radius_a, l->radius_b), l->blend);
    }
    return distance;
}

body body_make(body_kind kind, double edge_length) {
    body b = {0};
    if (kind == BODY_PAWN) add_pawn(&b, edge_length);
    if (kind == BODY_DUMBBELL) add_dumbbell(&b, edge_length);
    if (kind == BODY_HUMAN)
        body_add_implicit(&b, to_human, (double[3]){-1.0, -0.45, -0.2}, (double[3]){1.0, 0.45, 2.1},
                          0.9 * edge_length);
    if (kind == BODY_BALL) {
        profile p = {0};
        profile_arc(&p, 0.0, 0.0, 1.0, -90.0, 90.0);
        revolve(&b, &p, edge_length);
    }
    return b;
}

body body_make_sized(body_kind kind, uint32_t triangle_count) {
    double edge_length = 0.05;
    for (int i = 0; i < 3; i++) {
        body b = body_make(kind, edge_length);
        edge_length *= sqrt((double)b.triangle_count / triangle_count);
        body_free(&b);
    }
    return body_make(kind, edge_length);
}
