/* Scenes of closed objects that touch and part by formula: a table, and the objects of a scene in one mesh. */
#include "models/objects/objects.h"

#include "models/common/vec3.h"
#include "models/softbody/softbody.h"

#include <stddef.h>
#include <string.h>

/* Balls of radius 1 and 1/2 with edges of equal length. */
#define WHOLE .kind = BODY_SPHERE, .triangle_count = 1200, .scale = 1.0
#define HALF  .kind = BODY_SPHERE, .triangle_count = 300, .scale = 0.5
#define U     .kind = BODY_LETTER_U, .scale = 1.0

/* At `place`, surfaces overlap by about the length of an edge: 0.15 for the spheres, 0.11 for the letters
 * of 1,380 triangles, 0.05 for the W. */
const object_scene object_scenes[] = {
    {.name = "t-pair",
     .text = "two letters T turn, touch three times and part",
     .frame_count = 120,
     .object_count = 2,
     .objects = {{.kind = BODY_LETTER_T,
                  .scale = 1.0,
                  .place = {-0.575, 0.0, 0.0},
                  .away = {-0.5, 0.0, 0.0},
                  .visits = 3.0,
                  .axis = {0.0, 0.1, 1.0},
                  .spin = 80.0},
                 {.kind = BODY_LETTER_T,
                  .scale = 1.0,
                  .place = {0.575, 0.0, 0.0},
                  .away = {0.5, 0.2, 0.2},
                  .visits = 3.0,
                  .axis = {0.0, 1.0, 0.0},
                  .degrees = 180.0,
                  .spin = 16.0}}},
    {.name = "w-pair",
     .text = "two letters W of 11,920 triangles turn, touch twice and part",
     .frame_count = 80,
     .object_count = 2,
     .objects = {{.kind = BODY_LETTER_W,
                  .scale = 1.0,
                  .place = {0.0, 0.0, -0.975},
                  .away = {0.0, 0.0, -0.4},
                  .visits = 2.0,
                  .axis = {0.0, 0.0, 1.0},
                  .spin = 60.0},
                 {.kind = BODY_LETTER_W,
                  .scale = 1.0,
                  .place = {0.5, 0.0, 0.975},
                  .away = {0.4, 0.2, 0.4},
                  .visits = 2.0,
                  .axis = {0.0, 0.0, 1.0},
                  .spin = 20.0}}},
    {.name = "two-spheres",
     .text = "two equal spheres touch twice (case 1)",
     .frame_count = 90,
     .object_count = 2,
     .objects = {{WHOLE, .place = {-0.925, 0.0, 0.0}, .away = {-0.7, 0.2, 0.0}, .visits = 2.0,
                  .axis = {0.0, 1.0, 1.0}, .spin = 120.0},
                 {WHOLE, .place = {0.925, 0.0, 0.0}, .away = {0.5, 0.0, 0.3}, .visits = 2.0,
                  .axis = {1.0, 0.5, 0.0}, .spin = -90.0}}},
    {.name = "two-spheres-unequal",
     .text = "a sphere and one of half its size touch twice",
     .frame_count = 90,
     .object_count = 2,
     .objects = {{WHOLE, .axis = {0.0, 1.0, 1.0}, .spin = 120.0},
                 {HALF, .place = {1.1, 0.6, 0.6}, .away = {0.8, 0.3, -0.4}, .visits = 2.0,
                  .axis = {1.0, 0.5, 0.0}, .spin = -90.0}}},
    {.name = "three-spheres",
     .text = "three equal spheres in a row touch, one a little later (case 2)",
     .frame_count = 90,
     .object_count = 3,
     .objects = {{WHOLE, .place = {-1.85, 0.0, 0.0}, .away = {-0.8, 0.2, 0.0}, .visits = 2.0,
                  .axis = {0.0, 0.0, 1.0}, .spin = 90.0},
                 {WHOLE, .axis = {1.0, 0.0, 1.0}, .spin = 60.0, .stretch = 0.04},
                 {WHOLE, .place = {1.85, 0.0, 0.0}, .away = {0.8, 0.0, 0.3}, .visits = 2.0, .late = 0.05,
                  .axis = {0.0, 1.0, 0.0}, .spin = -120.0}}},
    {.name = "three-spheres-unequal",
     .text = "three spheres in a row, the middle one of half the size, touch (case 3)",
     .frame_count = 90,
     .object_count = 3,
     .objects = {{WHOLE, .place = {-1.36, 0.0, 0.0}, .away = {-0.8, 0.2, 0.0}, .visits = 2.0,
                  .axis = {0.0, 0.0, 1.0}, .spin = 90.0},
                 {HALF, .axis = {1.0, 0.0, 1.0}, .spin = 60.0},
                 {WHOLE, .place = {1.36, 0.0, 0.0}, .away = {0.8, 0.0, 0.3}, .visits = 2.0, .late = 0.05,
                  .axis = {0.0, 1.0, 0.0}, .spin = -120.0}}},
    {.name = "v-shape",
     .text = "a ball hits one arm of a V, while another stays near the other arm",
     .frame_count = 90,
     .object_count = 3,
     .objects = {{.kind = BODY_LETTER_V, .scale = 1.0, .axis = {0.0, 1.0, 0.0}, .spin = 4.0},
                 {.kind = BODY_SPHERE,
                  .triangle_count = 280,
                  .scale = 0.35,
                  .place = {-0.91, 0.0, -0.15},
                  .away = {-0.8, 0.1, -0.2},
                  .visits = 2.0,
                  .axis = {0.0, 1.0, 0.0},
                  .spin = 180.0},
                 {.kind = BODY_SPHERE,
                  .triangle_count = 280,
                  .scale = 0.35,
                  .place = {1.14, 0.0, -0.25},
                  .away = {0.05, 0.1, 0.2},
                  .visits = 3.0,
                  .axis = {0.0, 1.0, 0.0},
                  .spin = -90.0}}},
    {.name = "u-pair",
     .text = "two letters U, an arm of each in the other's bay, touch on both sides (case 4)",
     .frame_count = 90,
     .object_count = 2,
     .objects = {{U, .axis = {0.0, 1.0, 0.0}, .spin = 6.0},
                 {U, .place = {0.88, 0.0, 0.8}, .away = {-0.46, 0.05, 0.1}, .visits = 2.0,
                  .axis = {0.0, 1.0, 0.0}, .degrees = 180.0, .spin = -6.0}}},
    {.name = "u-three",
     .text = "three letters U hang in each other and touch (case 5)",
     .frame_count = 90,
     .object_count = 3,
     .objects = {{U, .axis = {0.0, 1.0, 0.0}, .spin = 6.0},
                 {U, .place = {0.88, 0.0, 0.8}, .away = {-0.25, 0.05, 0.1}, .visits = 2.0,
                  .axis = {0.0, 1.0, 0.0}, .degrees = 180.0, .spin = -6.0},
                 {U, .place = {0.0, 0.0, -0.42}, .away = {0.1, 0.0, -0.25}, .visits = 2.0, .late = 0.1,
                  .axis = {0.0, 0.0, 1.0}, .degrees = 90.0, .spin = 10.0}}},
    {.name = "mixed",
     .text = "two letters U, one in the other's bay, and two spheres touch (case 6)",
     .frame_count = 120,
     .object_count = 4,
     .objects = {{U, .axis = {0.0, 1.0, 0.0}, .spin = 6.0},
                 {U, .place = {0.88, 0.0, 0.8}, .away = {-0.25, 0.05, 0.1}, .visits = 2.0,
                  .axis = {0.0, 1.0, 0.0}, .degrees = 180.0, .spin = -6.0},
                 {WHOLE, .place = {-1.8, 0.0, 0.0}, .away = {-0.9, 0.2, 0.2}, .visits = 2.0, .late = 0.1,
                  .axis = {0.0, 0.0, 1.0}, .spin = 90.0},
                 {HALF, .place = {0.88, 0.0, 2.2}, .away = {-0.2, 0.2, 0.8}, .visits = 3.0,
                  .axis = {1.0, 0.0, 0.0}, .spin = 90.0}}},
};

const uint32_t object_scene_count = sizeof object_scenes / sizeof *object_scenes;

const object_scene *object_scene_find(const char *name) {
    for (uint32_t i = 0; i < object_scene_count; i++) {
        if (strcmp(object_scenes[i].name, name) == 0) return &object_scenes[i];
    }
    return NULL;
}

/* ---- the objects of a scene in one mesh ---------------------------------------------------------------- */

static const double pi = 3.14159265358979323846;

/* Adds an object, centred at the middle of its box and scaled. */
static void add_object(object_stage *s, const moving_object *o, const body *b) {
    double low[3], high[3];
    uint32_t first = s->rest.vertex_count;
    for (uint32_t k = 0; k < 3; k++) low[k] = high[k] = b->positions[k];
    for (uint32_t i = 0; i < b->vertex_count * 3; i++) {
        low[i % 3] = fmin(low[i % 3], b->positions[i]);
        high[i % 3] = fmax(high[i % 3], b->positions[i]);
    }
    body_append(&s->rest, b, (double[3]){0.0, 0.0, 0.0});
    for (uint32_t i = first * 3; i < s->rest.vertex_count * 3; i++)
        s->rest.positions[i] = o->scale * (s->rest.positions[i] - 0.5 * (low[i % 3] + high[i % 3]));
}

bool object_stage_open(const object_scene *scene, object_stage *out, io_error *error) {
    object_stage s = {.scene = scene};
    body b = {0};
    bool good = true;
    for (uint32_t i = 0; good && i < scene->object_count; i++) {
        const moving_object *o = &scene->objects[i];
        if (i == 0 || o->kind != o[-1].kind || o->triangle_count != o[-1].triangle_count) {
            body_free(&b);
            good = body_make(o->kind, o->triangle_count, &b, error);
        }
        if (good) add_object(&s, o, &b);
        s.first_vertex[i + 1] = s.rest.vertex_count;
    }
    body_free(&b);
    if (!good) {
        object_stage_close(&s);
        return false;
    }
    body_append(&s.placed, &s.rest, (double[3]){0.0, 0.0, 0.0});
    object_stage_go(&s, 0);
    *out = s;
    return true;
}

void object_stage_close(object_stage *s) {
    body_free(&s->rest);
    body_free(&s->placed);
    *s = (object_stage){0};
}

/* Places the vertices of an object; its stretch keeps the volume. */
static void place_object(const moving_object *o, double time, const double *rest, uint32_t vertex_count,
                         double *placed) {
    double turn[3][3], far = 0.5 + 0.5 * cos(2.0 * pi * (o->visits * (time - o->late)));
    double longer = 1.0 + o->stretch * sin(2.0 * pi * time), thinner = 1.0 / sqrt(longer);
    turn_matrix(o->axis, o->degrees + o->spin * (time - 0.5), turn);
    for (uint32_t v = 0; v < vertex_count; v++) {
        const double *p = rest + (size_t)v * 3, own[3] = {thinner * p[0], thinner * p[1], longer * p[2]};
        for (int k = 0; k < 3; k++)
            placed[(size_t)v * 3 + (size_t)k] = o->place[k] + far * o->away[k] + vec3_dot(turn[k], own);
    }
}

void object_stage_go(object_stage *s, uint32_t frame) {
    double time = (double)frame / (s->scene->frame_count - 1);
    for (uint32_t i = 0; i < s->scene->object_count; i++) {
        size_t first = (size_t)s->first_vertex[i] * 3;
        place_object(&s->scene->objects[i], time, s->rest.positions + first,
                     s->first_vertex[i + 1] - s->first_vertex[i], s->placed.positions + first);
    }
    body_round(&s->placed);
}
