/* A caller that fills every struct that may grow, with bytes behind each that nobody may touch. It is compiled with
 * the headers of today and with those of a later version, and runs on a library of the other. */
#include "tests/install/versions/guard.h"

enum { VERTEX_COUNT = 8, OBJECT_COUNT = 2, OWN_VERTICES = 4, OWN_TRIANGLES = 4 };

/* Two tetrahedra. */
static const uint32_t triangles[OWN_TRIANGLES * 3] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
static const double start[VERTEX_COUNT * 3] = {0, 0, 0,  4, 0, 0,  0, 4, 0,  0, 0, 4,
                                               1, 1, -1, 2, 1, -2, 1, 2, -2, 1, 1, -3};

typedef struct caller_state {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_detector *detector;
    cscd_sensors *sensors;
} caller_state;

static void expect_ok(const caller_state *s, cscd_status status, const char *what) {
    expect_that(status == CSCD_OK, what, s->context != NULL ? cscd_context_detail(s->context) : "failed");
}

/* The member that this library does not know is refused, by its place. */
#ifdef WITH_LATER
static void expect_refused(cscd_status status, const char *what, size_t place, const char *sentence) {
    char expected[64];
    snprintf(expected, sizeof expected, "the member at byte %zu is not 0", place);
    expect_that(status == CSCD_INVALID_ARGUMENT, what, "an unknown member that is not 0 was accepted");
    expect_that(strstr(sentence, expected) != NULL, what, sentence);
}
#define REFUSE(type, member_owner, call, sentence)                                                           \
    do {                                                                                                     \
        (member_owner).later_member[1] = 1;                                                                  \
        expect_refused(call, #type, offsetof(type, later_member) + sizeof(uint32_t), sentence);              \
        (member_owner).later_member[1] = 0;                                                                  \
    } while (0)
#else
#define REFUSE(type, member_owner, call, sentence) ((void)0)
#endif

/* Options: the defaults of this caller's size, which the library takes. */
#define OPTIONS(type, defaults_sized, name)                                                                  \
    GUARDED(type, name);                                                                                     \
    defaults_sized(&name.value, sizeof name.value);                                                          \
    EXPECT_FILLED(type, name);                                                                               \
    expect_that(name.value.struct_size == sizeof name.value, #type, "struct_size is not the caller's")

static void create_context(caller_state *s) {
    char reason[256] = "";
    OPTIONS(cscd_context_options, cscd_context_defaults_sized, options);
    expect_that(options.value.thread_count == 1, "cscd_context_options", "the default of thread_count");
    options.value.reason = reason;
    options.value.reason_size = sizeof reason;
    REFUSE(cscd_context_options, options.value, cscd_context_create(&options.value, &s->context), reason);
    expect_that(cscd_context_create(&options.value, &s->context) == CSCD_OK, "cscd_context_create", reason);
}

/* The size of an object is the stride of their array. */
static void create_mesh(caller_state *s) {
    struct {
        cscd_object_desc values[OBJECT_COUNT];
        unsigned char guard[GUARD_SIZE];
    } objects;
    memset(&objects, 0xa5, sizeof objects);
    for (int i = 0; i < OBJECT_COUNT; i++)
        objects.values[i] = cscd_object_of_triangles(OWN_VERTICES, OWN_TRIANGLES, triangles);
    REFUSE(cscd_object_desc, objects.values[1],
           cscd_mesh_create(s->context, objects.values, OBJECT_COUNT, &s->mesh),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_mesh_create(s->context, objects.values, OBJECT_COUNT, &s->mesh), "cscd_mesh_create");
    expect_guard(objects.guard, "cscd_object_desc");
    puts("cscd_object_desc");
    expect_that(cscd_mesh_vertex_count(s->mesh) == VERTEX_COUNT, "cscd_mesh_create",
                "an object was not taken");
}

/* The size of a change is the stride of their array; descriptions have theirs. */
static void change_mesh(caller_state *s) {
    cscd_object_desc object = cscd_object_of_triangles(OWN_VERTICES, OWN_TRIANGLES, triangles);
    cscd_mesh_change *change = NULL;
    uint32_t count = 0;
    struct {
        cscd_object_change values[OBJECT_COUNT];
        unsigned char guard[GUARD_SIZE];
    } changes;
    memset(&changes, 0xa5, sizeof changes);
    for (uint32_t i = 0; i < OBJECT_COUNT; i++)
        changes.values[i] = (cscd_object_change){.object = i == 0 ? 1 : UINT32_MAX, .desc = &object};
    REFUSE(cscd_object_change, changes.values[1],
           cscd_mesh_change_create(s->context, s->mesh, changes.values, OBJECT_COUNT, &change),
           cscd_context_detail(s->context));
    REFUSE(cscd_object_desc, object,
           cscd_mesh_change_create(s->context, s->mesh, changes.values, OBJECT_COUNT, &change),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_mesh_change_create(s->context, s->mesh, changes.values, OBJECT_COUNT, &change),
              "cscd_mesh_change_create");
    expect_guard(changes.guard, "cscd_object_change");
    puts("cscd_object_change");
    cscd_mesh_change_to_old(change, CSCD_VERTICES, &count);
    expect_that(count == VERTEX_COUNT + OWN_VERTICES, "cscd_mesh_change_create", "an object was not taken");
    cscd_mesh_change_destroy(change);
}

static void create_plan(caller_state *s) {
    const cscd_view *rest = CSCD_DOUBLES(start, VERTEX_COUNT);
    OPTIONS(cscd_plan_options, cscd_plan_defaults_sized, options);
    expect_that(options.value.threshold == 0.1, "cscd_plan_options", "the default of threshold");
    options.value.method = CSCD_METHOD_AUTO;
    REFUSE(cscd_plan_options, options.value,
           cscd_plan_create(s->context, s->mesh, rest, &options.value, &s->plan),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_plan_create(s->context, s->mesh, rest, &options.value, &s->plan), "cscd_plan_create");
}

static void create_plan_from_parts(caller_state *s) {
    const cscd_view *rest = CSCD_DOUBLES(start, VERTEX_COUNT);
    const uint32_t regions[OBJECT_COUNT * OWN_TRIANGLES] = {0, 0, 0, 0, 1, 1, 1, 1};
    const double points[OBJECT_COUNT * 3] = {1, 1, 1, 1.2, 1.2, -2};
    cscd_plan *plan = NULL;
    GUARDED(cscd_plan_parts, parts);
    memset(&parts.value, 0, sizeof parts.value);
    parts.value.method = CSCD_METHOD_SINGLE;
    parts.value.region_count = OBJECT_COUNT;
    parts.value.triangle_regions = regions;
    parts.value.detector_points = points;
    REFUSE(cscd_plan_parts, parts.value,
           cscd_plan_create_from_parts(s->context, s->mesh, rest, &parts.value, &plan),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_plan_create_from_parts(s->context, s->mesh, rest, &parts.value, &plan), "parts");
    EXPECT_FILLED(cscd_plan_parts, parts);
    cscd_plan_destroy(plan);
}

static void create_detector(caller_state *s) {
    OPTIONS(cscd_detector_options, cscd_detector_defaults_sized, options);
    expect_that(options.value.step_factor == 0.8, "cscd_detector_options", "the default of step_factor");
    REFUSE(cscd_detector_options, options.value,
           cscd_detector_create(s->context, s->mesh, s->plan, &options.value, &s->detector),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_detector_create(s->context, s->mesh, s->plan, &options.value, &s->detector),
              "detector");
}

static void ask_detector(caller_state *s) {
    const cscd_view *x0 = CSCD_DOUBLES(start, VERTEX_COUNT);
    cscd_intersections pairs;
    OPTIONS(cscd_intersection_options, cscd_intersection_defaults_sized, options);
    REFUSE(cscd_intersection_options, options.value,
           cscd_detector_find_intersections(s->detector, x0, &options.value, &pairs),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_detector_find_intersections(s->detector, x0, &options.value, &pairs),
              "cscd_detector_find_intersections");
}

static void make_motion_safe(caller_state *s) {
    const cscd_view *x0 = CSCD_DOUBLES(start, VERTEX_COUNT);
    cscd_safe_motion found;
    OPTIONS(cscd_response_options, cscd_response_defaults_sized, options);
    REFUSE(cscd_response_options, options.value,
           cscd_detector_make_safe(s->detector, x0, x0, &options.value, NULL, &found),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_detector_make_safe(s->detector, x0, x0, &options.value, NULL, &found),
              "cscd_detector_make_safe");
}

static void untangle_start(caller_state *s) {
    const cscd_view *x0 = CSCD_DOUBLES(start, VERTEX_COUNT);
    cscd_untangled found;
    OPTIONS(cscd_untangle_options, cscd_untangle_defaults_sized, options);
    expect_that(options.value.max_rounds == 60, "cscd_untangle_options", "the default of max_rounds");
    REFUSE(cscd_untangle_options, options.value,
           cscd_detector_untangle(s->detector, x0, &options.value, NULL, &found),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_detector_untangle(s->detector, x0, &options.value, NULL, &found),
              "cscd_detector_untangle");
}

static void find_lenses(caller_state *s) {
    const cscd_view *x0 = CSCD_DOUBLES(start, VERTEX_COUNT);
    cscd_lenses found;
    OPTIONS(cscd_intersection_options, cscd_intersection_defaults_sized, options);
    REFUSE(cscd_intersection_options, options.value,
           cscd_detector_find_lenses(s->detector, x0, &options.value, &found),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_detector_find_lenses(s->detector, x0, &options.value, &found),
              "cscd_detector_find_lenses");
}

static void sum_energies(caller_state *s) {
    const cscd_view *x0 = CSCD_DOUBLES(start, VERTEX_COUNT);
    cscd_energy *energy = NULL;
    cscd_proximities near_pairs;
    cscd_energy_sum sum;
    OPTIONS(cscd_energy_options, cscd_energy_defaults_sized, options);
    expect_that(options.value.stiffness == 1.0, "cscd_energy_options", "the default of stiffness");
    options.value.reach = 0.5;
    expect_ok(s, cscd_energy_create(s->context, s->mesh, &energy), "cscd_energy_create");
    expect_ok(s, cscd_detector_find_near(s->detector, x0, 0.5, CSCD_NEAR_UNIQUE, &near_pairs),
              "cscd_detector_find_near");
    REFUSE(cscd_energy_options, options.value,
           cscd_energy_evaluate(energy, &near_pairs, x0, &options.value, NULL, &sum),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_energy_evaluate(energy, &near_pairs, x0, &options.value, NULL, &sum),
              "cscd_energy_evaluate");
    cscd_energy_destroy(energy);
}

static void track_events(caller_state *s) {
    cscd_event_tracker *tracker = NULL;
    OPTIONS(cscd_event_options, cscd_event_defaults_sized, options);
    expect_that(options.value.rings == 2, "cscd_event_options", "the default of rings");
    REFUSE(cscd_event_options, options.value,
           cscd_event_tracker_create(s->context, s->mesh, &options.value, &tracker),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_event_tracker_create(s->context, s->mesh, &options.value, &tracker), "tracker");
    cscd_event_tracker_destroy(tracker);
}

static void create_sensors(caller_state *s) {
    const cscd_view *rest = CSCD_DOUBLES(start, VERTEX_COUNT);
    OPTIONS(cscd_sensor_options, cscd_sensor_defaults_sized, sensing);
    expect_that(sensing.value.step_limit == 256, "cscd_sensor_options", "the default of step_limit");
    REFUSE(cscd_sensor_options, sensing.value,
           cscd_sensors_create(s->context, s->mesh, NULL, rest, &sensing.value, &s->sensors),
           cscd_context_detail(s->context));
    expect_ok(s, cscd_sensors_create(s->context, s->mesh, NULL, rest, &sensing.value, &s->sensors),
              "sensors");
}

int main(void) {
    caller_state s = {NULL};
    create_context(&s);
    create_mesh(&s);
    change_mesh(&s);
    create_plan(&s);
    create_plan_from_parts(&s);
    create_detector(&s);
    ask_detector(&s);
    find_lenses(&s);
    untangle_start(&s);
    make_motion_safe(&s);
    sum_energies(&s);
    track_events(&s);
    create_sensors(&s);
    cscd_sensors_destroy(s.sensors);
    cscd_detector_destroy(s.detector);
    cscd_plan_destroy(s.plan);
    cscd_mesh_destroy(s.mesh);
    cscd_context_destroy(s.context);
    return 0;
}
