/* The variants that tests go through: the methods of this build, and the instruction sets of this processor. */
#include "tests/support/variants.h"

#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <string.h>

#ifdef WITH_BASELINES
static const bool has_baselines = true;
#else
static const bool has_baselines = false;
#endif

static bool is_baseline(cscd_method method) {
    return method == CSCD_METHOD_PUBLISHED || method == CSCD_METHOD_ICCD ||
           method == CSCD_METHOD_ICCD_PUBLISHED || method == CSCD_METHOD_CONES;
}

uint64_t ours_of_method(cscd_method method) {
    const bool published = method == CSCD_METHOD_PUBLISHED || method == CSCD_METHOD_ICCD_PUBLISHED;
    return published ? CSCD_OURS_TESTS : 0;
}

cscd_method method_or_none(cscd_method method) {
    static const double corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const uint32_t triangles[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_plan *plan = NULL;
    cscd_detector *detector = NULL;
    cscd_object_desc desc = cscd_object_of_triangles(4, 4, triangles);
    cscd_plan_options plan_options = cscd_plan_defaults();
    cscd_detector_options options = cscd_detector_defaults();
    cscd_context_options context_options = cscd_context_defaults();
    context_options.thread_count = 1;
    assert_int_equal(cscd_context_create(&context_options, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    plan_options.method = options.method = method;
    options.ours = has_baselines ? ours_of_method(method) : 0;
    if (method == CSCD_METHOD_KMEANS || method == CSCD_METHOD_CHARGE)
        assert_int_equal(plan_create_packed(mesh, corners, &plan_options, &plan), CSCD_OK);
    cscd_status status = detector_create_here(mesh, plan, &options, &detector);
    bool present = has_baselines || !is_baseline(method);
    assert_int_equal(status, present ? CSCD_OK : CSCD_INVALID_ARGUMENT);
    if (!present) {
        assert_null(detector);
        assert_non_null(strstr(cscd_context_detail(context), cscd_method_name(method)));
        assert_non_null(strstr(cscd_context_detail(context), "built without runtime/baselines"));
    }
    cscd_detector_destroy(detector);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return present ? method : CSCD_METHOD_NONE;
}

/* ---- instruction sets ---------------------------------------------------------------------------------- */

cscd_context *contexts[LEVEL_COUNT];

int open_levels(void **state) {
    (void)state;
    for (int i = 0; i < LEVEL_COUNT; i++) {
        cscd_context_options options = cscd_context_defaults();
        options.simd = (cscd_simd)(CSCD_SIMD_SCALAR + i);
        bool created = cscd_context_create(&options, &contexts[i]) == CSCD_OK;
        if (created != processor_has_simd(options.simd)) return 1;
        if (!created) contexts[i] = NULL;
        print_message("%s: %s\n", cscd_name(CSCD_SIMDS, options.simd),
                      contexts[i] != NULL ? "compared" : "absent");
    }
    return 0;
}

int close_levels(void **state) {
    (void)state;
    for (int i = 0; i < LEVEL_COUNT; i++) cscd_context_destroy(contexts[i]);
    return 0;
}
