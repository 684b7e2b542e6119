/* A recording with a plan and a detector, and the report of its replay. */
#include "tests/support/report/report_rig.h"
#include "tests/support/packed.h"
#include "tests/support/test.h"

report_rig report_rig_create(recorded shape, cscd_method method) {
    report_rig rig = {.shape = shape};
    cscd_object_desc desc =
        cscd_object_of_triangles(shape.vertex_count, shape.triangle_count, shape.triangles);
    cscd_plan_options plan_options = cscd_plan_defaults();
    cscd_detector_options options = cscd_detector_defaults();
    plan_options.method = options.method = method;
    assert_int_equal(cscd_context_create(NULL, &rig.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(rig.context, &desc, 1, &rig.mesh), CSCD_OK);
    assert_int_equal(plan_create_packed(rig.mesh, shape.frames, &plan_options, &rig.plan), CSCD_OK);
    assert_int_equal(detector_create_here(rig.mesh, rig.plan, &options, &rig.detector), CSCD_OK);
    return rig;
}

void report_rig_destroy(report_rig *rig) {
    cscd_detector_destroy(rig->detector);
    cscd_plan_destroy(rig->plan);
    cscd_mesh_destroy(rig->mesh);
    cscd_context_destroy(rig->context);
    recorded_free(&rig->shape);
}

report_options report_rig_options(const report_rig *rig) {
    return (report_options){.kind = REPORT_REPLAY,
                            .title = "a.obj",
                            .generator = "cscd",
                            .mesh = rig->mesh,
                            .plan = rig->plan,
                            .last = rig->shape.frame_count - 1,
                            .oriented = true};
}

bool report_rig_replay(const report_rig *rig, report *r, io_error *error) {
    if (!report_begin(r, rig->shape.frames, error)) return false;
    for (uint32_t k = 0; k + 1 < rig->shape.frame_count; k++) {
        cscd_contacts contacts;
        const double *start = recorded_position(&rig->shape, k, 0),
                     *end = recorded_position(&rig->shape, k + 1, 0);
        assert_int_equal(step_packed(rig->detector, start, end, &contacts), CSCD_OK);
        orientation_row row;
        if (!orientation_row_create(rig->detector, rig->mesh, &row))
            return io_fail(error, "out of memory for the report");
        orientation_row_take(&row, rig->detector);
        const bool added = report_add_interval(r, &row, &contacts, end, error);
        orientation_row_free(&row);
        if (!added) return false;
    }
    return true;
}

bool report_rig_write(const report_rig *rig, const char *path, io_error *error) {
    const report_options options = report_rig_options(rig);
    const report_summary summary = {"a.obj", "{\"intervals\":[]}"};
    report *r = NULL;
    bool written = report_create(&options, &r, error) && report_rig_replay(rig, r, error) &&
                   report_write(r, path, &summary, 1, NULL, error);
    report_destroy(r);
    return written;
}
