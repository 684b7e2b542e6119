/* A context, a mesh and a detector for a scene; any failure fails the test. */
#include "tests/support/rig.h"
#include "tests/support/packed.h"
#include "tests/support/test.h"

rig rig_create(const scene *s, uint32_t thread_count, const cscd_detector_options *options) {
    rig r = {NULL, NULL, NULL};
    cscd_context_options context_options = cscd_context_defaults();
    context_options.thread_count = thread_count;
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    assert_int_equal(cscd_context_create(&context_options, &r.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(r.context, &desc, 1, &r.mesh), CSCD_OK);
    assert_int_equal(detector_create_here(r.mesh, NULL, options, &r.detector), CSCD_OK);
    return r;
}

void rig_destroy(rig *r) {
    cscd_detector_destroy(r->detector);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

cscd_contacts rig_step(const rig *r, const scene *s) {
    cscd_contacts found;
    assert_int_equal(step_packed(r->detector, s->x0, s->x1, &found), CSCD_OK);
    return found;
}
