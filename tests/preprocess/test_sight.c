/* What points see in the frames of a motion: the mean of what they see in each of them alone. */
#include "tests/support/preprocess/tiled_body.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 3 };

/* A body with frames, and its tiles in each frame alone. */
typedef struct moving_tiles {
    tiled_body *body;
    double *frames[FRAMES];
    tile_graph all;           /* at rest, with the frames */
    tile_graph alone[FRAMES]; /* of the same triangles, as if a frame were the rest */
    double scales[FRAMES];
} moving_tiles;

/* Shears, twists and stretches the body, and carries it away, more in each frame. */
static void deform_body(const body *b, int frame, double *out) {
    const double much = 0.4 * (frame + 1);
    for (uint32_t v = 0; v < b->vertex_count; v++) {
        const double *p = b->positions + (size_t)v * 3, turn = much * p[2];
        double *q = out + (size_t)v * 3;
        q[0] = cos(turn) * p[0] - sin(turn) * p[1] + 30.0 * much;
        q[1] = sin(turn) * p[0] + cos(turn) * p[1] + much * p[0];
        q[2] = (1.0 + much) * p[2] - 7.0;
    }
}

static moving_tiles make_moving(body_kind kind, bool turned) {
    moving_tiles m = {.body = tiled_body_make(kind, 1500)};
    tiled_body *b = m.body;
    const double *frames[FRAMES];
    if (turned) /* a mirror image */
        for (uint32_t v = 0; v < b->shape.vertex_count; v++) b->shape.positions[(size_t)v * 3] *= -1.0;
    for (int f = 0; f < FRAMES; f++) {
        m.frames[f] = body_allocate((size_t)b->shape.vertex_count * 3, sizeof(double));
        deform_body(&b->shape, f, m.frames[f]);
        frames[f] = m.frames[f];
        tile_surface surface = b->surface;
        surface.positions = m.frames[f];
        const tile_component c = tiles_component(&surface, b->list, b->shape.triangle_count);
        m.scales[f] = c.scale;
        expect_ok(tiles_create(&surface, &c, b->tile_of, b->tile_count, &m.alone[f]));
        assert_int_equal(m.alone[f].turned, turned);
    }
    tile_surface surface = b->surface;
    surface.frames = frames;
    surface.frame_count = FRAMES;
    b->component = tiles_component(&surface, b->list, b->shape.triangle_count);
    expect_ok(tiles_create(&surface, &b->component, b->tile_of, b->tile_count, &m.all));
    return m;
}

static void free_moving(moving_tiles *m) {
    for (int f = 0; f < FRAMES; f++) {
        tiles_destroy(&m->alone[f]);
        free(m->frames[f]);
    }
    tiles_destroy(&m->all);
    tiled_body_free(m->body);
}

static sight_point random_point(void) {
    sight_point point;
    for (int k = 0; k < 3; k++) {
        point.rest[k] = random_between(-0.3, 0.3);
        for (int f = 0; f < FRAMES; f++) point.moved[f][k] = random_between(-0.3, 0.3);
    }
    return point;
}

TEST(blindness_is_a_mean) {
    random_seed(11);
    for (int round = 0; round < 4; round++) {
        moving_tiles m = make_moving(round < 2 ? BODY_FIGURE : BODY_TORUS, round % 2 == 1);
        double least = 1.0, most = 0.0;
        for (int i = 0; i < 20; i++) {
            const sight_point point = random_point();
            for (uint32_t t = 0; t < m.all.count; t++) {
                double mean = frame_blindness(&m.all.items[t], point.rest) / (FRAMES + 1);
                for (int f = 0; f < FRAMES; f++) {
                    double there[3]; /* the same point, in the scale of the frame alone */
                    for (int k = 0; k < 3; k++)
                        there[k] = point.moved[f][k] * m.scales[f] / m.body->component.scale;
                    mean += frame_blindness(&m.alone[f].items[t], there) / (FRAMES + 1);
                }
                assert_true(fabs(tile_blindness(&m.all, t, &point) - mean) < 1e-9);
                least = fmin(least, mean);
                most = fmax(most, mean);
            }
        }
        assert_true(least < 0.1 && most > 0.9);
        free_moving(&m);
    }
}

/* Wherever a point is moved to, it stays as far from the centroid in all frames. */
TEST(points_move_with_centroids) {
    random_seed(12);
    moving_tiles m = make_moving(BODY_FIGURE, false);
    for (int i = 0; i < 10; i++) {
        const uint32_t first = (uint32_t)random_integer(0, (int)m.all.count / 2);
        const tile_set set = {&m.all, m.body->list + first, m.all.count / 3}; /* the list counts up */
        sight_point middle, point = random_point();
        tiles_centroid(&set, &middle);
        const double cost = tiles_best_point(&set, &point);
        for (int f = 0; f < FRAMES; f++)
            for (int k = 0; k < 3; k++)
                assert_true(fabs((point.moved[f][k] - middle.moved[f][k]) -
                                 (point.rest[k] - middle.rest[k])) < 1e-12);
        assert_true(tiles_unseen(&set, &point) <= cost);
    }
    free_moving(&m);
}
