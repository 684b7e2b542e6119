/* Scenes of open cloth: sheets through each other, ribbons that roll into themselves, tubes in tubes, a bag with seams, cloth
 * through an obstacle. */
#include "benchmarks/untangle/tangle_scene.h"

#include "models/cloth/cloth_scene.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

enum { RIBBON_FRAMES = 24, BAG_FRAMES = 16 };

static bool end_moment(tangle_scene *s) {
    tangle_begin_frames(s, 1);
    tangle_round_frames(s);
    return true;
}

static uint32_t sheet_side(uint32_t triangle_count) {
    return (uint32_t)lround(sqrt(0.5 * triangle_count));
}

/* A number of triangles that each object has of the whole. */
static body *add_sheet(tangle_scene *s, uint32_t triangle_count) {
    body *b = tangle_add_object(s);
    const uint32_t side = sheet_side(triangle_count);
    body_add_grid(b, side, side, 1.0, 1.0);
    return b;
}

/* Layers of cloth with waves, nearer to each other than the waves are high. */
bool tangle_make_layers(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(3000 + seed);
    const uint32_t count = 2 + seed % 4;
    const double gap = tangle_random(&state, 0.015, 0.035);
    (void)error;
    for (uint32_t i = 0; i < count; i++) {
        body *b = add_sheet(s, triangle_count / count);
        const tangle_waves w = tangle_random_waves(&state, 2.0);
        for (uint32_t v = 0; v < b->vertex_count; v++) {
            double *p = b->positions + 3 * (size_t)v;
            p[2] = gap * i + 0.025 * tangle_wave_height(&w, p[0], p[1]);
        }
        body_move(b, tangle_random(&state, -0.1, 0.1), tangle_random(&state, -0.1, 0.1), 0.0);
    }
    return end_moment(s);
}

/* The way of a ribbon seen from its edge: its direction is a random wave, which grows until it meets itself. */
static void roll_ribbon(tangle_scene *s, const tangle_waves *w, double most, double lean) {
    enum { STEPS = 4000 };
    double line[STEPS + 1][2];
    for (uint32_t f = 0; f < s->frame_count; f++) {
        const double t = (double)f / (s->frame_count - 1);
        line[0][0] = line[0][1] = 0.0;
        for (int i = 0; i < STEPS; i++) {
            const double angle = t * most * tangle_wave_height(w, (i + 0.5) / STEPS, 0.0);
            line[i + 1][0] = line[i][0] + 8.0 / STEPS * cos(angle);
            line[i + 1][1] = line[i][1] + 8.0 / STEPS * sin(angle);
        }
        for (uint32_t v = 0; v < s->vertex_count; v++) {
            double *p = s->frames + ((size_t)f * s->vertex_count + v) * 3;
            const double along = fmin(fmax(p[0] / 8.0, 0.0), 1.0) * STEPS;
            const int i = (int)fmin(along, STEPS - 1);
            p[1] += t * lean * p[0];
            for (int k = 0; k < 2; k++) p[2 * k] = line[i][k] + (along - i) * (line[i + 1][k] - line[i][k]);
            p[2] += 0.05 * t * p[1];
        }
    }
}

bool tangle_make_ribbon(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(3100 + seed);
    const tangle_waves w = tangle_random_waves(&state, 1.0);
    const uint32_t columns = (uint32_t)lround(sqrt(triangle_count / 16.0));
    (void)error;
    body_add_grid(tangle_add_object(s), 8 * columns, columns, 8.0, 1.0);
    tangle_begin_frames(s, RIBBON_FRAMES);
    roll_ribbon(s, &w, tangle_random(&state, 7.5, 10.0), tangle_random(&state, 0.0, 0.1));
    tangle_round_frames(s);
    return true;
}

/* A sheet that stands in another: its lower edge, or a corner, has gone through. */
bool tangle_make_flap(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(3200 + seed);
    double turn[3][3];
    (void)error;
    const tangle_waves w = tangle_random_waves(&state, 1.0);
    for (int i = 0; i < 2; i++) {
        body *b = add_sheet(s, triangle_count / 2);
        body_move(b, -0.5, -0.5, 0.0);
        for (uint32_t v = 0; v < b->vertex_count; v++) {
            double *p = b->positions + 3 * (size_t)v;
            p[2] = 0.04 * tangle_wave_height(&w, p[0] + i, p[1]);
        }
    }
    body_scale(&s->objects[1], 0.5, 0.5, 1.0);
    tangle_random_rotation(&state, turn);
    body_rotate(&s->objects[1], turn);
    double low = 0.0, high = 0.0;
    for (uint32_t v = 0; v < s->objects[1].vertex_count; v++) {
        low = fmin(low, s->objects[1].positions[3 * v + 2]);
        high = fmax(high, s->objects[1].positions[3 * v + 2]);
    }
    body_move(&s->objects[1], tangle_random(&state, -0.2, 0.2), tangle_random(&state, -0.2, 0.2),
              -low - tangle_random(&state, 0.1, 0.5) * (high - low));
    return end_moment(s);
}

/* A cone, closed, whose point has gone through a sheet. */
bool tangle_make_spike(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(3300 + seed);
    body *sheet = add_sheet(s, triangle_count / 2);
    const tangle_waves w = tangle_random_waves(&state, 1.0);
    for (uint32_t v = 0; v < sheet->vertex_count; v++) {
        double *p = sheet->positions + 3 * (size_t)v;
        p[2] = 0.02 * tangle_wave_height(&w, p[0], p[1]);
    }
    if (!tangle_add_body(s, BODY_SPHERE, triangle_count / 2, error)) return false;
    body *cone = &s->objects[1];
    const double width = tangle_random(&state, 0.08, 0.2);
    for (uint32_t v = 0; v < cone->vertex_count; v++) {
        double *p = cone->positions + 3 * (size_t)v;
        const double taper = width * (0.15 + 0.85 * fmin(1.0, 0.5 * (p[2] + 1.0)));
        p[0] *= taper;
        p[1] *= taper;
        p[2] = 0.3 * (p[2] + 1.0);
    }
    body_move(cone, tangle_random(&state, 0.3, 0.7), tangle_random(&state, 0.3, 0.7),
              -tangle_random(&state, 0.08, 0.4));
    return end_moment(s);
}

static void add_open_tube(tangle_scene *s, uint32_t triangle_count, double radius, double length) {
    body *b = tangle_add_object(s);
    const double around = 2.0 * pi * radius, side = sqrt(2.0 * around * length / triangle_count);
    const uint32_t columns = (uint32_t)fmax(8.0, round(around / side)), rows = (uint32_t)round(length / side);
    for (uint32_t i = 0; i <= rows; i++)
        for (uint32_t j = 0; j < columns; j++)
            body_add_vertex(b, radius * cos(2.0 * pi * j / columns), radius * sin(2.0 * pi * j / columns),
                            length * ((double)i / rows - 0.5));
    for (uint32_t i = 0; i < rows; i++) {
        for (uint32_t j = 0; j < columns; j++) {
            const uint32_t v = i * columns + j, w = i * columns + (j + 1) % columns;
            body_add_triangle(b, v, w, w + columns);
            body_add_triangle(b, v, w + columns, v + columns);
        }
    }
}

/* Sleeves: a tube in a tube that is not quite wide enough, or beside it; a ball in a tube. */
bool tangle_make_tubes(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(3400 + seed);
    double turn[3][3];
    add_open_tube(s, triangle_count / 2, 0.25, 1.0);
    if (seed % 3 == 0) {
        if (!tangle_add_body(s, BODY_SPHERE, triangle_count / 2, error)) return false;
        const double radius = tangle_random(&state, 0.27, 0.33);
        body_scale(&s->objects[1], radius, radius, radius);
        body_move(&s->objects[1], 0.02, 0.01, tangle_random(&state, -0.3, 0.5));
    } else if (seed % 3 == 1) {
        add_open_tube(s, triangle_count / 2, 0.22, 1.3);
        const double lean = tangle_random(&state, 0.06, 0.12);
        double small_turn[3][3] = {
            {cos(lean), 0.0, sin(lean)}, {0.0, 1.0, 0.0}, {-sin(lean), 0.0, cos(lean)}};
        body_rotate(&s->objects[1], small_turn);
        body_move(&s->objects[1], 0.013, 0.017, 0.019);
    } else {
        add_open_tube(s, triangle_count / 2, 0.15, 1.0);
        tangle_random_rotation(&state, turn);
        body_rotate(&s->objects[1], turn);
        body_move(&s->objects[1], tangle_random(&state, 0.25, 0.35), 0.0, tangle_random(&state, -0.2, 0.2));
    }
    return end_moment(s);
}

/* A bag of two panels, sewn together, one of which is dented until it has gone through the other. */
bool tangle_make_bag(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(3600 + seed);
    const uint32_t columns = (2 + (uint32_t)lround(sqrt(triangle_count / 4.0))) | 1u;
    const double depth = 0.1, x = tangle_random(&state, -0.15, 0.15), z = tangle_random(&state, 0.1, 0.35),
                 dent = depth * tangle_random(&state, 3.0, 4.0), width = tangle_random(&state, 0.1, 0.18);
    (void)error;
    garment_add_bag(tangle_add_object(s), columns, columns, 0.8, 0.8, depth);
    s->seams = garment_bag_seams(columns, columns, &s->seam_count);
    tangle_begin_frames(s, BAG_FRAMES);
    for (uint32_t f = 0; f < BAG_FRAMES; f++) {
        for (uint32_t v = 0; v < columns * columns; v++) {
            double *p = s->frames + ((size_t)f * s->vertex_count + v) * 3;
            const double side = fmax(0.0, 1.0 - 6.25 * p[0] * p[0]), up = fmax(0.0, 1.0 - p[2] / 0.8);
            const double squared = (p[0] - x) * (p[0] - x) + (p[2] - z) * (p[2] - z);
            p[1] += dent * f / (BAG_FRAMES - 1) * exp(-squared / (width * width)) * fmin(1.0, 4.0 * side) *
                    fmin(1.0, 4.0 * up);
        }
    }
    tangle_round_frames(s);
    return true;
}

/* A sheet that lies too low on a ball, which is an obstacle; its corners may be pinned. */
bool tangle_make_drape(uint32_t triangle_count, uint32_t seed, tangle_scene *s, io_error *error) {
    uint64_t state = tangle_seed(3500 + seed);
    body *sheet = add_sheet(s, triangle_count * 2 / 3);
    const double bulge = tangle_random(&state, 0.15, 0.25), low = tangle_random(&state, 0.02, 0.15);
    for (uint32_t v = 0; v < sheet->vertex_count; v++) {
        double *p = sheet->positions + 3 * (size_t)v;
        const double x = p[0] - 0.5, y = p[1] - 0.5;
        p[2] = bulge * exp(-(x * x + y * y) / 0.04) + 0.01 * sin(20.0 * x) * cos(17.0 * y);
    }
    if (!tangle_add_body(s, BODY_SPHERE, triangle_count / 3, error)) return false;
    body *ball = &s->objects[1];
    body_scale(ball, 0.3, 0.3, 0.3);
    body_move(ball, 0.52, 0.49, bulge - 0.3 + low);
    s->obstacles[1] = true;
    if (!end_moment(s)) return false;
    if (seed % 2 == 1) return true;
    const uint32_t side = sheet_side(triangle_count * 2 / 3);
    s->weights = body_allocate(s->vertex_count, sizeof *s->weights);
    for (uint32_t v = 0; v < s->vertex_count; v++) s->weights[v] = 1.0;
    s->weights[0] = s->weights[side] = s->weights[side * (side + 1)] =
        s->weights[(side + 1) * (side + 1) - 1] = INFINITY;
    return true;
}
