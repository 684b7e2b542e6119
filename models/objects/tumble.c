/* Eight soft bodies that fall into a tray and tumble together. */
#include "models/common/vec3.h"
#include "models/objects/objects.h"
#include "models/shapes/catalogue.h"
#include "models/softbody/softbody.h"

#include <stdlib.h>
#include <string.h>

enum { CHECKS = 3, SMALL_STEPS = 8 }; /* checks in a frame; small steps in a check */

const char tumble_name[] = "tumble";
const char tumble_text[] = "eight soft bodies fall into a tray and tumble together";

static const double spacing = 0.14, frame_seconds = 1.0 / 50.0;

/* The start of each body: its turn about its own middle, and the place of that. */
static const struct falling_body {
    body_kind kind;
    uint32_t triangle_count;
    double scale, axis[3], degrees, place[3];
} bodies[TUMBLE_BODIES] = {
    {BODY_PAWN, 1400, 0.5, {1.0, 0.2, 0.0}, -70.0, {-0.75, -0.9, 1.2}},
    {BODY_DUMBBELL, 1000, 0.38, {0.0, 1.0, 0.3}, 50.0, {0.75, -0.75, 1.4}},
    {BODY_TORUS, 1200, 0.55, {1.0, 0.5, 0.0}, 40.0, {-0.75, 0.75, 1.3}},
    {BODY_CAPSULE, 700, 0.5, {0.3, 1.0, 0.0}, 60.0, {0.75, 0.75, 1.2}},
    {BODY_SPHERE, 800, 0.6, {0.0, 0.0, 1.0}, 0.0, {-0.65, -0.65, 2.9}},
    {BODY_ELLIPSOID, 900, 0.5, {0.0, 1.0, 0.0}, 30.0, {0.7, -0.7, 3.0}},
    {BODY_CUBE, 768, 0.45, {1.0, 1.0, 0.3}, 40.0, {-0.7, 0.7, 3.1}},
    {BODY_LETTER_T, 1380, 0.65, {1.0, 0.3, 0.5}, 80.0, {0.7, 0.7, 3.0}},
};

static void add_body(body *all, const struct falling_body *which, const body *b) {
    double turn[3][3], middle[3] = {0.0, 0.0, 0.0};
    uint32_t first = all->vertex_count;
    for (uint32_t v = 0; v < b->vertex_count; v++)
        vec3_add_scaled(middle, 1.0 / b->vertex_count, b->positions + (size_t)v * 3);
    turn_matrix(which->axis, which->degrees, turn);
    body_append(all, b, (double[3]){-middle[0], -middle[1], -middle[2]});
    for (uint32_t v = first; v < all->vertex_count; v++) {
        double *p = all->positions + (size_t)v * 3, own[3] = {p[0], p[1], p[2]};
        for (int k = 0; k < 3; k++) p[k] = which->place[k] + which->scale * vec3_dot(turn[k], own);
    }
}

static bool make_bodies(body *out, io_error *error) {
    body all = {0};
    for (uint32_t i = 0; i < TUMBLE_BODIES; i++) {
        body b = {0};
        if (!body_make(bodies[i].kind, bodies[i].triangle_count, &b, error)) {
            body_free(&all);
            return false;
        }
        add_body(&all, &bodies[i], &b);
        body_free(&b);
    }
    body_round(&all);
    *out = all;
    return true;
}

static bool explain_status(const tumble *t, cscd_status status, io_error *error) {
    return status == CSCD_OK || io_fail(error, "%s: %s: %s", tumble_name, cscd_status_string(status),
                                        cscd_context_detail(t->context));
}

static cscd_status open_detector(tumble *t) {
    const cscd_object_desc desc =
        cscd_object_of_triangles(t->shape.vertex_count, t->shape.triangle_count, t->shape.triangles);
    cscd_status status = cscd_mesh_create(t->context, &desc, 1, &t->mesh);
    return status == CSCD_OK ? cscd_detector_create(t->context, t->mesh, NULL, NULL, &t->detector) : status;
}

bool tumble_open(cscd_context *context, tumble *out, io_error *error) {
    static const material stuff = {.density = 1.0, .young = 250.0, .poisson = 0.4, .damping = 3.0};
    tumble t = {.context = context, .around = {.friction = 0.4, .gravity = 10.0, .tray = 1.7}};
    if (!make_bodies(&t.shape, error)) return false;
    size_t count = (size_t)t.shape.vertex_count * 3;
    t.frame = body_allocate(count, sizeof *t.frame);
    t.start = body_allocate(count, sizeof *t.start);
    memcpy(t.frame, t.shape.positions, count * sizeof *t.frame);
    if (!explain_status(&t, open_detector(&t), error)) {
        tumble_close(&t);
        return false;
    }
    t.soft = soft_body_make(t.shape.positions, t.shape.vertex_count, t.shape.triangles,
                            t.shape.triangle_count, spacing, &stuff);
    t.contacts = self_contacts_make(t.mesh, t.shape.positions, 2.0 * spacing);
    soft_body_throw(&t.soft, (double[3]){0.0, 0.0, 0.0}, (double[3]){0.0, 0.0, 2.0});
    *out = t;
    return true;
}

void tumble_close(tumble *t) {
    self_contacts_free(&t->contacts);
    soft_body_free(&t->soft);
    cscd_detector_destroy(t->detector);
    cscd_mesh_destroy(t->mesh);
    body_free(&t->shape);
    free(t->frame);
    free(t->start);
    *t = (tumble){0};
}

bool tumble_advance(tumble *t, io_error *error) {
    size_t bytes = (size_t)t->shape.vertex_count * 3 * sizeof *t->frame;
    for (int i = 0; i < CHECKS; i++) {
        cscd_contacts found;
        memcpy(t->start, t->soft.vertices, bytes);
        simulation_advance(&t->soft, &t->around, &t->contacts, frame_seconds / CHECKS, SMALL_STEPS);
        if (!explain_status(
                t,
                cscd_detector_step(t->detector, CSCD_DOUBLES(t->start, cscd_mesh_vertex_count(t->mesh)),
                                   CSCD_DOUBLES(t->soft.vertices, cscd_mesh_vertex_count(t->mesh)), &found),
                error))
            return false;
        self_contacts_add(&t->contacts, &found, t->start, t->soft.vertices);
    }
    body rounded = {.vertex_count = t->shape.vertex_count, .positions = t->frame};
    memcpy(t->frame, t->soft.vertices, bytes);
    body_round(&rounded);
    return true;
}
