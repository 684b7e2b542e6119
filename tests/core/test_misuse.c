/* Every mistake of a caller has an answer: a status, and a sentence that says what is wrong, where, and what to do. */
#include "tests/support/misuse.h"

/* ---- contexts ------------------------------------------------------------------------------------------ */

static void expect_no_context(const cscd_context_options *changed, cscd_status expected, const char *words) {
    char reason[256] = "";
    cscd_context *none = NULL;
    cscd_context_options options = *changed;
    options.reason = reason;
    options.reason_size = sizeof reason;
    assert_int_equal(cscd_context_create(&options, &none), expected);
    assert_null(none);
    if (strstr(reason, words) == NULL) fail_msg("\"%s\" has no \"%s\"", reason, words);
}

static void *refuse_memory(void *user, size_t size, size_t alignment) {
    (void)user;
    (void)size;
    (void)alignment;
    return NULL;
}

static void release_nothing(void *user, void *block, size_t size) {
    (void)user;
    (void)block;
    (void)size;
}

TEST(contexts_that_cannot_be) {
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = 1000;
    expect_no_context(&options, CSCD_INVALID_ARGUMENT, "thread_count is 1000, expected at most 256");
    options = cscd_context_defaults();
    options.allocator.allocate = refuse_memory; /* and not the system's release beside it */
    expect_no_context(&options, CSCD_INVALID_ARGUMENT, "allocator has only one of allocate and release");
    options = cscd_context_defaults();
    options.simd = (cscd_simd)77;
    expect_no_context(&options, CSCD_INVALID_ARGUMENT, "simd");
    options = cscd_context_defaults();
    options.struct_size = 8;
    expect_no_context(&options, CSCD_INVALID_ARGUMENT, "");
    options = cscd_context_defaults();
    options.allocator = (cscd_allocator){refuse_memory, release_nothing, NULL};
    expect_no_context(&options, CSCD_OUT_OF_MEMORY, "out of memory");
    assert_int_equal(cscd_context_create(NULL, NULL), CSCD_INVALID_ARGUMENT);
    assert_string_equal(cscd_context_detail(NULL), "");
}

/* A longer sentence is cut, and nothing is written behind its end. */
TEST(short_places_for_reasons) {
    cscd_context *none = NULL;
    for (size_t size = 0; size < 60; size++) {
        char reason[64];
        memset(reason, '#', sizeof reason);
        cscd_context_options options = cscd_context_defaults();
        options.thread_count = 1000;
        options.reason = reason;
        options.reason_size = size;
        assert_int_equal(cscd_context_create(&options, &none), CSCD_INVALID_ARGUMENT);
        if (size > 0) assert_true(strlen(reason) < size);
        if (size > 1)
            assert_memory_equal(reason, "thread_count is 1000, expected at most 256", strlen(reason));
        for (size_t i = size; i < sizeof reason; i++) assert_int_equal(reason[i], '#');
    }
}

/* ---- meshes -------------------------------------------------------------------------------------------- */

TEST(meshes_that_cannot_be) {
    static const uint32_t twice[] = {0, 1, 2, 2, 3, 2};
    const cscd_object_desc second_is_bad[] = {*OBJECT(VERTICES, 8, triangles), *OBJECT(7, 8, triangles)};
    const cscd_object_desc too_many[] = {*OBJECT(4294967290u, 8, triangles),
                                         *OBJECT(4294967290u, 8, triangles)};
    cscd_mesh *none = NULL;
    EXPECT_ARGUMENT(cscd_mesh_create(context, NULL, 1, &none), "cscd_mesh_create: objects is NULL");
    EXPECT_ARGUMENT(cscd_mesh_create(context, second_is_bad, 1, NULL), "cscd_mesh_create: out is NULL");
    EXPECT_MESH(cscd_mesh_create(context, second_is_bad, 0, &none), "the mesh is empty: object_count is 0");
    EXPECT_ARGUMENT(cscd_mesh_create(context, OBJECT(VERTICES, 8, NULL), 1, &none),
                    "triangles is NULL, but there are to be 8");
    EXPECT_MESH(cscd_mesh_create(context, OBJECT(VERTICES, 0, triangles), 1, &none),
                "the mesh is empty: 8 vertices, 0 triangles");
    EXPECT_MESH(cscd_mesh_create(context, OBJECT(0, 8, triangles), 1, &none),
                "the mesh is empty: 0 vertices, 8 triangles");
    EXPECT_MESH(cscd_mesh_create(context, OBJECT(5, 8, triangles), 1, &none),
                "triangle 4 names vertex 6, but there are 5 vertices");
    EXPECT_MESH(cscd_mesh_create(context, OBJECT(4, 2, twice), 1, &none),
                "triangle 1 (2 3 2) repeats a vertex; remove it or weld differently");
    EXPECT_MESH(cscd_mesh_create(context, second_is_bad, 2, &none),
                "object 1: triangle 5 names vertex 7, but there are 7 vertices");
    EXPECT_MESH(cscd_mesh_create(context, too_many, 2, &none), "8589934580 vertices are too many");
    EXPECT_MESH(cscd_mesh_create(context, too_many, 1, &none),
                "4294967290 vertices are too many for 8 triangles");
    assert_null(none);
}

/* ---- detectors ----------------------------------------------------------------------------------------- */

static void expect_no_detector(cscd_detector_options options, const char *words) {
    cscd_detector *none = NULL;
    EXPECT_ARGUMENT(cscd_detector_create(context, mesh, NULL, &options, &none), words);
    assert_null(none);
}

#define EXPECT_NO_DETECTOR(member, value, words)                                                             \
    do {                                                                                                     \
        cscd_detector_options changed = cscd_detector_defaults();                                            \
        changed.member = (value);                                                                            \
        expect_no_detector(changed, words);                                                                  \
    } while (0)

TEST(options_of_detectors) {
    EXPECT_ARGUMENT(cscd_detector_create(context, mesh, NULL, NULL, NULL),
                    "cscd_detector_create: out is NULL");
    expect_no_detector((cscd_detector_options){.struct_size = 0}, "were not made by cscd_detector_defaults");
    EXPECT_NO_DETECTOR(struct_size, 4, "were not made by cscd_detector_defaults");
    EXPECT_NO_DETECTOR(method, CSCD_METHOD_CHARGE, "method charge wants a plan of that method");
    EXPECT_NO_DETECTOR(method, (cscd_method)99, "unknown method 99");
    EXPECT_NO_DETECTOR(mode, (cscd_mode)7, "unknown mode 7");
    EXPECT_NO_DETECTOR(start, (cscd_start)-1, "unknown start -1");
    EXPECT_NO_DETECTOR(volume, (cscd_volume)9, "unknown volume 9");
    EXPECT_NO_DETECTOR(coherence, (cscd_coherence)2, "unknown coherence 2");
    EXPECT_NO_DETECTOR(min_separation, (double)NAN, "min_separation is nan, expected 0 or a length");
    EXPECT_NO_DETECTOR(min_separation, (double)INFINITY, "min_separation is inf, expected 0 or a length");
    EXPECT_NO_DETECTOR(tolerance, 1.5, "tolerance is 1.5, expected a share in (0,1]");
    EXPECT_NO_DETECTOR(step_factor, 1.0, "step_factor is 1, expected a number in (0,1)");
    EXPECT_NO_DETECTOR(step_factor, 0.0, "step_factor is 0, expected a number in (0,1)");
    EXPECT_NO_DETECTOR(seam_count, 1, "seams is NULL, but there are to be 1 pairs");
    EXPECT_NO_DETECTOR(ignored_count, 1, "ignored is NULL, but there are to be 1 pairs");
    EXPECT_NO_DETECTOR(seam_reach, -1.0, "seam_reach is -1, expected 0 (the default), a length");
}

TEST(lists_of_detectors) {
    static const uint32_t beyond[] = {0, 1, 0, 99}, equal[] = {0, 1, 3, 3};
    cscd_detector_options options = cscd_detector_defaults();
    options.seams = beyond;
    options.seam_count = 2;
    expect_no_detector(options, "pair 1 of seams names vertex 99, but there are 8");
    options.seams = equal;
    expect_no_detector(options, "pair 1 of seams has vertex 3 twice");
    options.seam_count = 0;
    options.ignored = beyond;
    options.ignored_count = 2;
    expect_no_detector(options, "pair 1 of ignored names triangle 99, but there are 8");
}

TEST(plans_of_other_meshes) {
    cscd_mesh *other = NULL;
    cscd_plan *plan = NULL;
    cscd_detector *none = NULL;
    cscd_plan_options by_single = cscd_plan_defaults();
    by_single.method = CSCD_METHOD_SINGLE;
    expect_success(cscd_mesh_create(context, OBJECT(VERTICES, 7, triangles), 1, &other));
    expect_success(cscd_plan_create(context, other, AT_START, &by_single, &plan));
    EXPECT_ARGUMENT(cscd_detector_create(context, mesh, plan, NULL, &none),
                    "the plan was made for another mesh");
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(other);
    by_single.method = CSCD_METHOD_NONE;
    plan = NULL;
    EXPECT_ARGUMENT(cscd_plan_create(context, mesh, AT_START, &by_single, &plan),
                    "method none makes no plan");
    EXPECT_ARGUMENT(cscd_plan_create(context, mesh, AT_START, NULL, NULL), "cscd_plan_create: out is NULL");
    EXPECT_ARGUMENT(cscd_plan_create(context, mesh, NULL, NULL, &plan), "positions is NULL");
    assert_null(plan);
}

/* ---- no object ------------------------------------------------------------------------------------------ */

/* A call without the object that has the context leaves that one's sentence as it was. */
static void expect_null_object(cscd_status status) {
    assert_int_equal(status, CSCD_NULL_OBJECT);
    assert_string_equal(cscd_context_detail(context), "unknown method 99");
}

static void expect_missing(cscd_status status, const char *sentence) {
    assert_int_equal(status, CSCD_NULL_OBJECT);
    assert_string_equal(cscd_context_detail(context), sentence);
}

/* A call that has a context, and lacks another object, says which. */
TEST(other_objects_that_are_null) {
    cscd_plan *no_plan = NULL;
    cscd_detector *no_detector = NULL;
    cscd_event_tracker *no_tracker = NULL;
    cscd_mesh_change *no_change = NULL;
    expect_missing(cscd_plan_create(context, NULL, AT_START, NULL, &no_plan),
                   "cscd_plan_create: mesh is NULL");
    expect_missing(cscd_plan_create_from_parts(context, NULL, AT_START, &(cscd_plan_parts){0}, &no_plan),
                   "cscd_plan_create_from_parts: mesh is NULL");
    expect_missing(cscd_detector_create(context, NULL, NULL, NULL, &no_detector),
                   "cscd_detector_create: mesh is NULL");
    expect_missing(cscd_detector_clone(context, NULL, &no_detector), "cscd_detector_clone: detector is NULL");
    expect_missing(cscd_detector_change_mesh(detector, NULL), "cscd_detector_change_mesh: change is NULL");
    expect_missing(cscd_event_tracker_create(context, NULL, NULL, &no_tracker),
                   "cscd_event_tracker_create: mesh is NULL");
    expect_missing(cscd_mesh_change_create(context, NULL, NULL, 0, &no_change),
                   "cscd_mesh_change_create: old is NULL");
    assert_true(no_plan == NULL && no_detector == NULL && no_tracker == NULL && no_change == NULL);
}

TEST(objects_that_are_null) {
    cscd_mesh *no_mesh;
    cscd_plan *no_plan;
    cscd_detector *no_detector;
    cscd_line_search *no_search;
    cscd_contacts contacts;
    cscd_intersections intersections;
    cscd_proximities near;
    cscd_free_step step;
    cscd_displacement_bounds bounds;
    cscd_truncation truncation;
    cscd_safe_motion safe;
    EXPECT_NO_DETECTOR(method, (cscd_method)99, "unknown method 99");
    cscd_object_desc marked = cscd_object_of_triangles(VERTICES, 8, triangles);
    marked.reserved[3] = 1;
    assert_int_equal(cscd_mesh_create(context, &marked, 1, &no_mesh), CSCD_INVALID_ARGUMENT);
    assert_string_equal(cscd_context_detail(context), "reserved is not 0");
    EXPECT_NO_DETECTOR(method, (cscd_method)99, "unknown method 99");
    expect_null_object(cscd_mesh_create(NULL, OBJECT(VERTICES, 8, triangles), 1, &no_mesh));
    expect_null_object(cscd_plan_create(NULL, mesh, AT_START, NULL, &no_plan));
    expect_null_object(cscd_plan_create_from_parts(NULL, mesh, AT_START, &(cscd_plan_parts){0}, &no_plan));
    expect_null_object(cscd_detector_create(NULL, mesh, NULL, NULL, &no_detector));
    expect_null_object(cscd_detector_step(NULL, AT_START, AT_END, &contacts));
    expect_null_object(cscd_detector_check(NULL, AT_START, &intersections));
    expect_null_object(cscd_detector_find_intersections(NULL, AT_START, NULL, NULL));
    expect_null_object(cscd_detector_find_near(NULL, AT_START, 1.0, CSCD_NEAR_PAIRS, &near));
    expect_null_object(cscd_detector_max_step(NULL, AT_START, AT_END, NULL, &step));
    expect_null_object(cscd_detector_set_separation(NULL, 1.0, 0.0));
    expect_null_object(cscd_detector_set_rest(NULL, AT_START));
    expect_null_object(cscd_detector_set_parts(NULL, NULL, 0));
    expect_null_object(cscd_detector_set_bodies(NULL, NULL, 0));
    expect_null_object(cscd_event_tracker_add_contacts(NULL, NULL, 0));
    expect_null_object(cscd_event_tracker_add_frame(NULL, 0, NULL));
    expect_null_object(cscd_event_tracker_take(NULL, NULL));
    expect_null_object(cscd_event_tracker_finish(NULL, NULL));
    expect_null_object(cscd_detector_contact_parts(NULL, NULL, 0, NULL));
    expect_null_object(cscd_detector_set_rules(NULL, NULL, 0, NULL, 0));
    expect_null_object(
        cscd_detector_displacement_bounds(NULL, AT_START, 1.0, CSCD_SCALAR_DOUBLE, NULL, 0, &bounds));
    expect_null_object(cscd_detector_truncate(NULL, AT_START, AT_END, 1.0, NULL, &truncation));
    expect_null_object(cscd_detector_make_safe(NULL, AT_START, AT_END, NULL, NULL, &safe));
    expect_null_object(cscd_pairs_step(NULL, NULL, AT_START, AT_END, 0.0, 0.0, NULL));
    expect_null_object(cscd_pairs_find_near(NULL, NULL, AT_START, 1.0, NULL));
    expect_null_object(cscd_line_search_create(NULL, &no_search));
    expect_null_object(cscd_line_search_begin(NULL, AT_START, AT_END, 0.0));
    expect_null_object(cscd_line_search_positions(NULL, 0.5, NULL));
    expect_null_object(cscd_line_search_max_step(NULL, 1.0, NULL, &step));
    expect_null_object(cscd_line_search_find_near(NULL, 0.5, 1.0, CSCD_NEAR_PAIRS, &near));
    assert_string_equal(cscd_status_string(CSCD_NULL_OBJECT), "an object that the call needs is NULL");
    expect_success(cscd_detector_step(detector, AT_START, AT_END, &contacts));
    cscd_context_destroy(NULL);
    cscd_mesh_destroy(NULL);
    cscd_plan_destroy(NULL);
    cscd_detector_destroy(NULL);
    cscd_line_search_destroy(NULL);
}

/* What is no mistake: odd, but defined. */
TEST(oddities_that_are_allowed) {
    static const uint32_t doubled[] = {0, 1, 2, 0, 1, 2};
    static const double nowhere[COORDINATES];
    cscd_mesh *odd = NULL;
    cscd_contacts contacts;
    cscd_intersections intersections;
    cscd_free_step step;
    expect_success(cscd_mesh_create(context, OBJECT(4, 2, doubled), 1, &odd));
    cscd_mesh_destroy(odd);
    expect_success(cscd_detector_step(detector, CSCD_DOUBLES(nowhere, VERTICES),
                                      CSCD_DOUBLES(nowhere, VERTICES), &contacts));
    assert_true(contacts.count == 0 && cscd_detector_collapsed(detector, 0));
    expect_success(cscd_detector_check(detector, CSCD_DOUBLES(nowhere, VERTICES), &intersections));
    assert_int_equal(intersections.zero_area_triangles, 8);
    expect_failure(cscd_detector_max_step(detector, CSCD_DOUBLES(nowhere, VERTICES),
                                          CSCD_DOUBLES(nowhere, VERTICES), NULL, &step),
                   CSCD_IN_CONTACT, "touch at the start");
    expect_success(cscd_detector_step(detector, AT_START, AT_END, &contacts));
    assert_string_equal(cscd_status_string((cscd_status)99), "unknown status");
    assert_string_equal(cscd_contact_kind_name((cscd_contact_kind)9), "unknown");
    assert_string_equal(cscd_reason_text((cscd_reason)99), "unknown");
}

AROUND_ALL(set_up, tear_down)
