/* Runs a scene frame by frame: the soft body moves, cscd finds its contacts with itself, the body
 * responds. */
#include "models/softbody/recorder.h"

#include <stdlib.h>
#include <string.h>

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
