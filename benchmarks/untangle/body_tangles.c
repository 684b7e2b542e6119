/* Scenes of several closed bodies: at random places in each other, with rods through them, stacked and flush. */
#include "benchmarks/untangle/tangle_scene.h"

#include "benchmarks/lib/made_scenes.h"

#include <math.h>
#include <string.h>

enum { PLACES_MAX = 16 };

/* Ends a scene of one frame. */
static bool end_moment(tangle_scene *s) {
    tangle_begin_frames(s, 1);
    tangle_round_frames(s);
    return true;
}

/* ---- bodies at random places --------------------------------------------------------------------------- */

/* Each new body is next to one that is there, at a distance of `near` to `far` times the sum of both radii, and at least
 * near times that from all others. */
typedef struct random_places {
    double places[PLACES_MAX][3], radii[PLACES_MAX];
    int count;
    double near, far;
} random_places;

static bool is_room(const random_places *r, const double at[3], double radius) {
    for (int i = 0; i < r->count; i++) {
        const double *p = r->places[i];
        double squared = 0.0;
        for (int c = 0; c < 3; c++) squared += (at[c] - p[c]) * (at[c] - p[c]);
        if (sqrt(squared) < r->near * (radius + r->radii[i])) return false;
    }
    return true;
}

static void add_place(random_places *r, uint64_t *state, double radius) {
    double at[3] = {0.0, 0.0, 0.0}, turn[3][3];
    for (int attempt = 0; r->count > 0 && attempt < 1000; attempt++) {
        const int next = (int)tangle_random(state, 0.0, r->count);
        const double distance = tangle_random(state, r->near, r->far) * (radius + r->radii[next]);
        tangle_random_rotation(state, turn);
        for (int c = 0; c < 3; c++) at[c] = r->places[next][c] + distance * turn[c][0];
        if (is_room(r, at, radius)) break;
    }
    memcpy(r->places[r->count], at, sizeof at);
    r->radii[r->count++] = radius;
}

static bool add_random_body(tangle_scene *s, random_places *r, uint64_t *state, body_kind kind,
                            uint32_t triangle_count, double scale, double radius, io_error *error) {
    double turn[3][3];
    if (!tangle_add_body(s, kind, triangle_count, error)) return false;
    body *b = &s->objects[s->object_count - 1];
    add_place(r, state, radius);
    tangle_random_rotation(state, turn);
    body_scale(b, scale, scale, scale);
    body_rotate(b, turn);
    const double *at = r->places[r->count - 1];
    body_move(b, at[0], at[1], at[2]);
    return true;
}

bool tangle_make_balls(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(seed);
    random_places r = {.near = 0.62, .far = 0.95};
    const uint32_t count = 2 + seed * 2 % 11;
    for (uint32_t i = 0; i < count; i++) {
        const double radius = tangle_random(&state, 0.5, 1.0);
        if (!add_random_body(s, &r, &state, BODY_SPHERE, triangle_count / count, radius, radius, error))
            return false;
    }
    return end_moment(s);
}

/* Cubes of half edge 1 reach from 1 to 1.73. */
bool tangle_make_boxes(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(100 + seed);
    random_places r = {.near = 0.78, .far = 1.0};
    const uint32_t count = 2 + seed % 6;
    for (uint32_t i = 0; i < count; i++) {
        const double scale = tangle_random(&state, 0.6, 1.0);
        if (!add_random_body(s, &r, &state, BODY_CUBE, triangle_count / count, scale, 1.2 * scale, error))
            return false;
    }
    return end_moment(s);
}

bool tangle_make_tori(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(200 + seed);
    random_places r = {.near = 0.6, .far = 0.8};
    const uint32_t count = 2 + seed % 4;
    for (uint32_t i = 0; i < count; i++)
        if (!add_random_body(s, &r, &state, BODY_TORUS, triangle_count / count, 1.0, 1.2, error))
            return false;
    return end_moment(s);
}

bool tangle_make_mixed(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    static const struct {
        body_kind kind;
        double scale, radius;
    } choices[] = {{BODY_ELLIPSOID, 1.0, 1.0}, {BODY_CAPSULE, 1.0, 0.9},  {BODY_TORUS, 1.0, 1.1},
                   {BODY_CUBE, 0.7, 0.9},      {BODY_GENUS2, 0.7, 0.9},   {BODY_LETTER_T, 0.8, 0.8},
                   {BODY_DUMBBELL, 0.5, 0.8},  {BODY_LETTER_U, 0.8, 0.8}, {BODY_SPHERE, 0.9, 0.9}};
    enum { CHOICES = sizeof choices / sizeof *choices };
    uint64_t state = tangle_seed(300 + seed);
    random_places r = {.near = 0.6, .far = 0.8};
    const uint32_t count = 2 + seed % 5;
    for (uint32_t i = 0; i < count; i++) {
        const int k = (int)tangle_random(&state, 0.0, CHOICES);
        if (!add_random_body(s, &r, &state, choices[k].kind, triangle_count / count, choices[k].scale,
                             choices[k].radius, error))
            return false;
    }
    return end_moment(s);
}

/* 27 balls, each in its neighbours. */
bool tangle_make_lattice(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    crossing_scene made;
    (void)seed;
    if (!crossing_scene_make(CROSSING_SPHERES, triangle_count, &made, error)) return false;
    for (uint32_t i = 0; i < made.object_count; i++) {
        *tangle_add_object(s) = made.objects[i];
        made.objects[i] = (body){0};
    }
    crossing_scene_free(&made);
    return end_moment(s);
}

/* A ball that reaches through both sides of a slab, or through one. */
bool tangle_make_slab_ball(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(400 + seed);
    body_add_block(tangle_add_object(s), triangle_count / 2, (double[3]){3.0, 3.0, 0.5});
    if (!tangle_add_body(s, BODY_SPHERE, triangle_count / 2, error)) return false;
    const double radius = tangle_random(&state, 0.2, 0.6);
    body_scale(&s->objects[1], radius, radius, radius);
    body_move(&s->objects[1], tangle_random(&state, 1.0, 2.0), tangle_random(&state, 1.0, 2.0),
              0.5 + tangle_random(&state, -0.8, 0.7) * radius);
    return end_moment(s);
}

/* Balls and rings on and in a block that is an obstacle. */
bool tangle_make_obstacle(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(500 + seed);
    const uint32_t count = 1 + seed % 3;
    for (uint32_t i = 0; i < count; i++) {
        double turn[3][3];
        const body_kind kind = (seed + i) % 2 == 0 ? BODY_ELLIPSOID : BODY_TORUS;
        if (!tangle_add_body(s, kind, triangle_count / (count + 1), error)) return false;
        body *b = &s->objects[i];
        tangle_random_rotation(&state, turn);
        body_rotate(b, turn);
        body_scale(b, 0.5, 0.5, 0.5);
        body_move(b, 1.1 * i, tangle_random(&state, -0.2, 0.2), tangle_random(&state, 0.1, 0.4));
    }
    body *floor = tangle_add_object(s);
    body_add_block(floor, triangle_count / (count + 1), (double[3]){2.0 + 1.1 * count, 2.0, 0.5});
    body_move(floor, -1.0, -1.0, -0.5);
    s->obstacles[s->object_count - 1] = true;
    return end_moment(s);
}

/* ---- rods ---------------------------------------------------------------------------------------------- */

static void add_random_rod(tangle_scene *s, uint64_t *state, uint32_t triangle_count, double radius,
                           double length, double spread) {
    double turn[3][3];
    body *rod = tangle_add_object(s);
    body_add_rod(rod, triangle_count, radius, length);
    tangle_random_rotation(state, turn);
    body_rotate(rod, turn);
    body_move(rod, tangle_random(state, -spread, spread), tangle_random(state, -spread, spread),
              tangle_random(state, -spread, spread));
}

/* One rod through one body. */
bool tangle_make_rods(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    static const body_kind kinds[] = {BODY_SPHERE, BODY_CUBE, BODY_ELLIPSOID, BODY_CAPSULE, BODY_TORUS};
    uint64_t state = tangle_seed(600 + seed);
    if (!tangle_add_body(s, kinds[seed % 5], triangle_count / 2, error)) return false;
    add_random_rod(s, &state, triangle_count / 2, tangle_random(&state, 0.05, 0.2), 4.5,
                   seed % 5 == 4 ? 0.9 : 0.4);
    return end_moment(s);
}

/* Two or three rods through one body, or one through two bodies. */
bool tangle_make_skewers(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(700 + seed);
    if (seed % 3 == 0) {
        for (int i = 0; i < 2; i++) {
            if (!tangle_add_body(s, i == 0 ? BODY_CUBE : BODY_SPHERE, triangle_count / 3, error))
                return false;
            body_scale(&s->objects[i], 0.7, 0.7, 0.7);
            body_move(&s->objects[i], 0.1 * i, 0.05 * i, i == 0 ? -1.0 : 1.0);
        }
        body *rod = tangle_add_object(s);
        body_add_rod(rod, triangle_count / 3, 0.12, 5.0);
        body_move(rod, tangle_random(&state, -0.2, 0.2), tangle_random(&state, -0.2, 0.2), 0.013);
        return end_moment(s);
    }
    const uint32_t rods = 1 + seed % 3;
    if (!tangle_add_body(s, BODY_ELLIPSOID, triangle_count / 2, error)) return false;
    for (uint32_t i = 0; i < rods; i++) {
        body *rod = tangle_add_object(s);
        body_add_rod(rod, triangle_count / (2 * rods), 0.1, 3.5);
        body_move(rod, -0.8 + 0.7 * i + tangle_random(&state, -0.1, 0.1), tangle_random(&state, -0.3, 0.3),
                  tangle_random(&state, -0.3, 0.3));
    }
    return end_moment(s);
}

/* ---- flush --------------------------------------------------------------------------------------------- */

/* Blocks one on the other; by the seed shifted, with the same squares, or a little in each other. */
bool tangle_make_stack(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    const uint32_t count = 2 + seed % 4;
    const double depth = seed % 3 == 2 ? 0.04 : 0.0, shift = seed % 2 == 0 ? 0.0 : 0.137;
    (void)error;
    for (uint32_t i = 0; i < count; i++) {
        body *b = tangle_add_object(s);
        body_add_block(b, triangle_count / count, (double[3]){1.0, 1.0, 0.5});
        body_move(b, shift * (i % 2), 0.7 * shift * i, (0.5 - depth) * i);
    }
    return end_moment(s);
}

/* Bricks in a bond, each flush with its neighbours. */
bool tangle_make_wall(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    const uint32_t rows = 2 + seed % 2, columns = 2 + seed / 2 % 2;
    (void)error;
    for (uint32_t i = 0; i < rows * columns; i++) {
        const uint32_t row = i / columns, column = i % columns;
        body *b = tangle_add_object(s);
        body_add_block(b, triangle_count / (rows * columns), (double[3]){1.0, 0.5, 0.3});
        body_move(b, column + 0.5 * (row % 2), 0.0, 0.3 * row);
    }
    return end_moment(s);
}

/* Two cubes with parallel sides, which share parts of one, two or three planes. */
bool tangle_make_aligned(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(800 + seed);
    (void)error;
    for (int i = 0; i < 2; i++)
        body_add_block(tangle_add_object(s), triangle_count / 2, (double[3]){1.0, 1.0, 1.0});
    body_move(&s->objects[1], tangle_random(&state, 0.7, 0.95),
              seed % 3 >= 1 ? 0.0 : tangle_random(&state, 0.01, 0.2),
              seed % 3 == 2 ? 0.0 : tangle_random(&state, 0.01, 0.2));
    return end_moment(s);
}

/* A body and its copy, at the same place or hardly beside it. */
bool tangle_make_copies(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    static const body_kind kinds[] = {BODY_SPHERE, BODY_CUBE, BODY_TORUS, BODY_LETTER_T};
    for (int i = 0; i < 2; i++)
        if (!tangle_add_body(s, kinds[seed % 4], triangle_count / 2, error)) return false;
    if (seed > 2) body_move(&s->objects[1], 0.011 * seed, 0.003, 0.007);
    return end_moment(s);
}

/* Letters on each other: their flat sides meet. */
bool tangle_make_letters(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    static const body_kind kinds[] = {BODY_LETTER_T, BODY_LETTER_U};
    const uint32_t count = 2 + seed % 2;
    for (uint32_t i = 0; i < count; i++) {
        if (!tangle_add_body(s, kinds[(seed + i) % 2], triangle_count / count, error)) return false;
        body_move(&s->objects[i], 0.1 * i, 0.5 * i, 0.02 * (seed % 4) * i);
    }
    return end_moment(s);
}
