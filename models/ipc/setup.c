/* Makes and frees an IPC solver: one mesh of all objects, masses, springs, the detector and its line
 * search. */
#include "models/ipc/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static cscd_status open_detector(const ipc_object *objects, uint32_t count, cscd_context *context,
                                 ipc_solver *p) {
    cscd_object_desc descs[IPC_OBJECTS_MAX];
    for (uint32_t i = 0; i < count; i++) {
        const body *b = &objects[i].shape;
        descs[i] = cscd_object_of_triangles(b->vertex_count, b->triangle_count, b->triangles);
        descs[i].obstacle = objects[i].obstacle;
    }
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = p->scene->min_separation;
    cscd_status status = cscd_mesh_create(context, descs, count, &p->mesh);
    if (status == CSCD_OK) status = cscd_detector_create(context, p->mesh, NULL, &options, &p->detector);
    if (status == CSCD_OK)
        status = cscd_detector_set_rest(p->detector, CSCD_DOUBLES(p->shape.positions, p->shape.vertex_count));
    if (status == CSCD_OK) status = cscd_line_search_create(p->detector, &p->line);
    return status;
}

static void add_object(ipc_solver *p, const ipc_object *object, uint32_t first_vertex) {
    const ipc_stuff *stuff = &p->scene->stuff;
    const body *b = &object->shape;
    for (uint32_t v = 0; object->obstacle && v < b->vertex_count; v++)
        memcpy(p->travels + (size_t)(first_vertex + v) * 3, object->travel, sizeof object->travel);
    if (object->obstacle) return;
    double *areas = body_allocate(b->vertex_count, sizeof *areas), area = 0.0;
    double mass = stuff->density * body_volume(b), step = p->scene->step_seconds;
    ipc_vertex_areas(b, areas);
    for (uint32_t v = 0; v < b->vertex_count; v++) area += areas[v];
    for (uint32_t v = 0; v < b->vertex_count; v++)
        p->inertia[first_vertex + v] = mass * areas[v] / area / (step * step);
    free(areas);
    ipc_springs_add_body(&p->springs, b, first_vertex, stuff);
}

static void allocate_arrays(ipc_solver *p) {
    double **arrays[] = {&p->positions, &p->velocities, &p->travels, &p->before, &p->predicted,
                         &p->gradient,  &p->direction,  &p->end,     &p->trial};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        *arrays[i] = body_allocate(p->shape.vertex_count, 3 * sizeof(double));
    p->inertia = body_allocate(p->shape.vertex_count, sizeof *p->inertia);
}

/* Finds the first contacts; the line search finds the later ones. */
static cscd_status find_first_contacts(ipc_solver *p) {
    const ipc_barrier_options *barrier = &p->scene->barrier;
    cscd_proximities near;
    cscd_status status =
        cscd_detector_find_near(p->detector, CSCD_DOUBLES(p->positions, cscd_mesh_vertex_count(p->mesh)),
                                barrier->reach, CSCD_NEAR_UNIQUE, &near);
    if (status == CSCD_OK) ipc_contacts_find(&p->contacts, p->positions, &near, barrier);
    return status;
}

cscd_status ipc_solver_make(const ipc_scene *scene, uint32_t triangle_count, cscd_context *context,
                            ipc_solver *out) {
    ipc_solver p = {.scene = scene, .statistics.least_distance = INFINITY};
    ipc_object objects[IPC_OBJECTS_MAX] = {{.obstacle = false}};
    uint32_t count = scene->make(triangle_count > 0 ? triangle_count : scene->triangle_count, objects);
    for (uint32_t i = 0; i < count; i++) body_append(&p.shape, &objects[i].shape, (double[3]){0.0, 0.0, 0.0});
    allocate_arrays(&p);
    memcpy(p.positions, p.shape.positions, (size_t)p.shape.vertex_count * 3 * sizeof *p.positions);
    uint32_t first_vertex = 0;
    for (uint32_t i = 0; i < count; i++) {
        add_object(&p, &objects[i], first_vertex);
        first_vertex += objects[i].shape.vertex_count;
    }
    cscd_status status = open_detector(objects, count, context, &p);
    if (status == CSCD_OK) status = find_first_contacts(&p);
    for (uint32_t i = 0; i < count; i++) body_free(&objects[i].shape);
    if (status != CSCD_OK) {
        ipc_solver_free(&p);
        return status;
    }
    p.system = ipc_system_make(p.shape.vertex_count, p.inertia, &p.springs);
    *out = p;
    return CSCD_OK;
}

void ipc_solver_free(ipc_solver *p) {
    cscd_line_search_destroy(p->line);
    cscd_detector_destroy(p->detector);
    cscd_mesh_destroy(p->mesh);
    ipc_system_free(&p->system);
    ipc_contacts_free(&p->contacts);
    ipc_contacts_free(&p->trial_contacts);
    ipc_springs_free(&p->springs);
    double *arrays[] = {p->positions, p->velocities, p->travels, p->before, p->predicted,
                        p->gradient,  p->direction,  p->end,     p->trial,  p->inertia};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
    body_free(&p->shape);
    *p = (ipc_solver){0};
}
