/* A context, a mesh, perhaps a plan, and a detector; any failure fails the test. */
#include "tests/support/rig.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

cscd_context *context_of(uint32_t thread_count, counting_allocator *counter) {
    cscd_context_options options = cscd_context_defaults();
    cscd_context *context = NULL;
    options.thread_count = thread_count;
    if (counter != NULL) options.allocator = counting_allocator_interface(counter);
    expect_ok(cscd_context_create(&options, &context));
    return context;
}

static cscd_object_desc object_of_scene(const scene *s) {
    return cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
}

cscd_mesh *mesh_of_scene(cscd_context *context, const scene *s) {
    const cscd_object_desc object = object_of_scene(s);
    cscd_mesh *mesh = NULL;
    expect_ok(cscd_mesh_create(context, &object, 1, &mesh));
    return mesh;
}

rig rig_of_objects(cscd_context *context, const cscd_object_desc *objects, uint32_t count,
                   const double *positions, const cscd_detector_options *options) {
    rig r = {.context = context};
    expect_ok(cscd_mesh_create(context, objects, count, &r.mesh));
    if (options != NULL && options->method == CSCD_METHOD_KMEANS) {
        cscd_plan_options by_kmeans = cscd_plan_defaults();
        by_kmeans.method = CSCD_METHOD_KMEANS;
        expect_ok(plan_create_packed(r.mesh, positions, &by_kmeans, &r.plan));
    }
    expect_ok(detector_create_here(r.mesh, r.plan, options, &r.detector));
    return r;
}

rig rig_create(const scene *s, uint32_t thread_count, const cscd_detector_options *options) {
    const cscd_object_desc object = object_of_scene(s);
    return rig_of_objects(context_of(thread_count, NULL), &object, 1, s->x0, options);
}

void rig_destroy(rig *r) {
    cscd_detector_destroy(r->detector);
    cscd_plan_destroy(r->plan);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

cscd_contacts rig_step(const rig *r, const scene *s) {
    cscd_contacts found;
    expect_ok(step_packed(r->detector, s->x0, s->x1, &found));
    return found;
}
