/* The scenes of the recordings, and their run frame by frame: the soft body moves, cscd finds its contacts with itself, the body
 * responds. */
#include "models/softbody/softbody.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- scenes -------------------------------------------------------------------------------------------- */

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

/* ---- recordings ---------------------------------------------------------------------------------------- */

static bool explain_status(const recorder *r, cscd_status status, io_error *error) {
    if (status == CSCD_OK) return true;
    return io_fail(error, "%s: %s: %s", r->scene->name, cscd_status_string(status),
                   cscd_context_detail(r->context));
}

/* Makes the plan at rest: regions are the parts that hardly bend. */
static cscd_status open_detector(recorder *r, const double *rest) {
    const cscd_object_desc desc =
        cscd_object_of_triangles(r->shape.vertex_count, r->shape.triangle_count, r->shape.triangles);
    cscd_plan_options options = cscd_plan_defaults();
    options.method =
        CSCD_METHOD_KMEANS; /* ready a hundred times sooner than charge, and good enough for 300 steps */
    cscd_status status = r->own_context ? cscd_context_create(NULL, &r->context) : CSCD_OK;
    if (status == CSCD_OK) status = cscd_mesh_create(r->context, &desc, 1, &r->mesh);
    if (status == CSCD_OK)
        status = cscd_plan_create(r->context, r->mesh, CSCD_DOUBLES(rest, cscd_mesh_vertex_count(r->mesh)),
                                  &options, &r->plan);
    if (status == CSCD_OK) status = cscd_detector_create(r->context, r->mesh, r->plan, NULL, &r->detector);
    return status;
}

/* Takes the frame in single precision, as it is recorded; the simulation goes on in double precision. */
static void take_frame(recorder *r) {
    body rounded = {.vertex_count = r->shape.vertex_count, .positions = r->frame};
    memcpy(r->frame, r->soft.vertices, (size_t)r->shape.vertex_count * 3 * sizeof *r->frame);
    body_round(&rounded);
}

bool recorder_open(const soft_scene *s, cscd_context *context, recorder *out, io_error *error) {
    recorder r = {.scene = s, .around = s->around, .context = context, .own_context = context == NULL};
    if (!body_make(s->kind, 0, &r.shape, error)) return false;
    size_t bytes = (size_t)r.shape.vertex_count * 3 * sizeof *r.frame;
    r.frame = body_allocate(bytes, 1);
    r.start = body_allocate(bytes, 1);
    r.soft = soft_scene_begin(s, &r.shape);
    cscd_status status = open_detector(&r, r.shape.positions);
    if (status == CSCD_OK) {
        r.contacts = self_contacts_make(r.mesh, r.shape.positions, 2.0 * s->spacing);
        take_frame(&r);
        memcpy(r.shape.positions, r.frame, bytes);
        *out = r;
        return true;
    }
    explain_status(&r, status, error);
    recorder_close(&r);
    return false;
}

void recorder_close(recorder *r) {
    self_contacts_free(&r->contacts);
    soft_body_free(&r->soft);
    cscd_detector_destroy(r->detector);
    cscd_plan_destroy(r->plan);
    cscd_mesh_destroy(r->mesh);
    if (r->own_context) cscd_context_destroy(r->context);
    body_free(&r->shape);
    free(r->frame);
    free(r->start);
    *r = (recorder){0};
}

bool recorder_advance(recorder *r, io_error *error) {
    const soft_scene *s = r->scene;
    for (uint32_t i = 0; i < s->checks; i++) {
        cscd_contacts found = {.count = 0};
        memcpy(r->start, r->soft.vertices, (size_t)r->shape.vertex_count * 3 * sizeof *r->start);
        simulation_advance(&r->soft, &r->around, &r->contacts, s->frame_seconds / s->checks, s->steps);
        cscd_status status =
            cscd_detector_step(r->detector, CSCD_DOUBLES(r->start, cscd_mesh_vertex_count(r->mesh)),
                               CSCD_DOUBLES(r->soft.vertices, cscd_mesh_vertex_count(r->mesh)), &found);
        if (!explain_status(r, status, error)) return false;
        r->detect_ms += cscd_detector_timings(r->detector).total_ms;
        self_contacts_add(&r->contacts, &found, r->start, r->soft.vertices);
    }
    take_frame(r);
    return true;
}

double recorder_energy(const recorder *r) {
    return soft_body_energy(&r->soft, r->around.gravity) + obstacles_energy(&r->around);
}
