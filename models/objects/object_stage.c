/* Places the objects of a scene, frame by frame. */
#include "models/common/vec3.h"
#include "models/objects/object_scene.h"
#include "models/softbody/turn.h"

#include <string.h>

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
