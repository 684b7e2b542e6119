/* The scenes of the recordings: a body, how it falls, and its obstacles. */
#include "models/softbody/scene.h"
#include "models/softbody/turn.h"

#include <math.h>
#include <string.h>

#define FLOOR                                                                                                \
    { .friction = 0.6, .gravity = 10.0 }
#define STAIRS                                                                                               \
    { .friction = 0.6, .gravity = 10.0, .step_count = 5, .start = 0.5, .tread = 1.6, .riser = 1.0 }
#define BALLS                                                                                                \
    {                                                                                                        \
        .friction = 0.6, .gravity = 10.0, .ball_count = 3, .balls = {                                        \
            {.centre = {0.0, 0.1, 0.4}, .radius = 0.4, .mass = 0.3},                                         \
            {.centre = {-0.7, 0.4, 0.3}, .radius = 0.3, .mass = 0.1},                                        \
            {.centre = {0.8, -0.3, 0.3}, .radius = 0.3, .mass = 0.1},                                        \
        }                                                                                                    \
    }

/* In the scenes without contact, bodies are stiffer and fall more softly, or lie across the stairs. */
const soft_scene soft_scenes[] = {
    {
        .name = "pawn-drop",
        .text = "a pawn falls on its foot, bows and hits itself",
        .kind = BODY_PAWN,
        .spacing = 0.2,
        .stuff = {.density = 1.0, .young = 160.0, .poisson = 0.4, .damping = 4.0},
        .axis = {0.3, 1.0, 0.0},
        .degrees = 4.0,
        .height = 1.5,
        .around = FLOOR,
        .frame_count = 150,
        .frame_seconds = 1.0 / 40.0,
        .checks = 2,
        .steps = 10,
    },
    {
        .name = "pawn-drop-free",
        .text = "a stiffer pawn falls on its foot and sways",
        .kind = BODY_PAWN,
        .spacing = 0.2,
        .stuff = {.density = 1.0, .young = 350.0, .poisson = 0.4, .damping = 4.0},
        .axis = {0.3, 1.0, 0.0},
        .degrees = 4.0,
        .height = 1.0,
        .around = FLOOR,
        .frame_count = 150,
        .frame_seconds = 1.0 / 40.0,
        .checks = 2,
        .steps = 10,
    },
    {
        .name = "dumbbell-stairs",
        .text = "a springy dumbbell walks down stairs, ball over ball",
        .kind = BODY_DUMBBELL,
        .spacing = 0.2,
        .stuff = {.density = 1.0, .young = 150.0, .poisson = 0.4, .damping = 2.0},
        .axis = {0.0, 1.0, 0.0},
        .degrees = 20.0,
        .height = 6.0,
        .velocity = {2.0, 0.0, 0.0},
        .around = STAIRS,
        .frame_count = 150,
        .frame_seconds = 1.0 / 40.0,
        .checks = 2,
        .steps = 10,
    },
    {
        .name = "dumbbell-stairs-free",
        .text = "a stiffer dumbbell rolls down the stairs sideways",
        .kind = BODY_DUMBBELL,
        .spacing = 0.2,
        .stuff = {.density = 1.0, .young = 300.0, .poisson = 0.4, .damping = 2.0},
        .axis = {1.0, 0.0, 0.0},
        .degrees = 80.0,
        .height = 5.3,
        .velocity = {2.0, 0.0, 0.0},
        .around = STAIRS,
        .frame_count = 150,
        .frame_seconds = 1.0 / 40.0,
        .checks = 2,
        .steps = 10,
    },
    {
        .name = "figure-balls",
        .text = "a figure falls onto balls, turns over, and its limbs fold onto the trunk",
        .kind = BODY_FIGURE,
        .spacing = 0.09,
        .stuff = {.density = 1.0, .young = 80.0, .poisson = 0.4, .damping = 2.0},
        .axis = {1.0, 0.0, 0.0},
        .degrees = 60.0,
        .height = 1.5,
        .around = BALLS,
        .frame_count = 150,
        .frame_seconds = 1.0 / 60.0,
        .checks = 2,
        .steps = 10,
    },
    {
        .name = "figure-balls-free",
        .text = "a stiffer figure falls flat onto the balls",
        .kind = BODY_FIGURE,
        .spacing = 0.09,
        .stuff = {.density = 1.0, .young = 150.0, .poisson = 0.4, .damping = 2.0},
        .axis = {1.0, 0.0, 0.0},
        .degrees = 80.0,
        .height = 1.0,
        .around = BALLS,
        .frame_count = 150,
        .frame_seconds = 1.0 / 60.0,
        .checks = 2,
        .steps = 10,
    },
};

const uint32_t soft_scene_count = sizeof soft_scenes / sizeof *soft_scenes;

const soft_scene *soft_scene_find(const char *name) {
    for (uint32_t i = 0; i < soft_scene_count; i++) {
        if (strcmp(soft_scenes[i].name, name) == 0) return &soft_scenes[i];
    }
    return NULL;
}

soft_body soft_scene_begin(const soft_scene *s, const body *shape) {
    double turn[3][3], low[3], high[3];
    soft_body b = soft_body_make(shape->positions, shape->vertex_count, shape->triangles,
                                 shape->triangle_count, s->spacing, &s->stuff);
    turn_matrix(s->axis, s->degrees, turn);
    soft_body_place(&b, turn, (double[3]){0.0, 0.0, 0.0});
    for (uint32_t k = 0; k < 3; k++) low[k] = high[k] = b.vertices[k];
    for (uint32_t i = 0; i < shape->vertex_count * 3; i++) {
        low[i % 3] = fmin(low[i % 3], b.vertices[i]);
        high[i % 3] = fmax(high[i % 3], b.vertices[i]);
    }
    for (int k = 0; k < 3; k++) {
        for (int j = 0; j < 3; j++) turn[k][j] = k == j;
    }
    const double offset[3] = {-0.5 * (low[0] + high[0]), -0.5 * (low[1] + high[1]), s->height - low[2]};
    soft_body_place(&b, turn, offset);
    soft_body_throw(&b, s->velocity, (double[3]){0.0, 0.0, 0.0});
    return b;
}
