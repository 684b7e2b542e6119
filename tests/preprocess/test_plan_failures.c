/* Plans by method auto of several objects, for a motion and soft places: every allocation fails once, every report of progress cancels
 * once, and sizes near the limits of coordinates change nothing. */
#include "src/core/context.h"
#include "tests/support/calls.h"
#include "tests/support/models/bodies.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OBJECTS = 3, FRAMES = 2, TRIANGLES = 120 };

/* A body, another one as an obstacle, and a wire, each with positions of its own at rest and in the frames. */
typedef struct plan_scene {
    body bodies[2];
    double *positions[FRAMES + 1][OBJECTS];
    cscd_view views[FRAMES + 1][OBJECTS];
    const cscd_view *frames[FRAMES];
    double *stiffness;
    cscd_context *context;
    cscd_mesh *mesh;
} plan_scene;

static const double wire[] = {9.0, 0.0, 0.0, 9.0, 1.0, 0.0};
static const uint32_t wire_ends[] = {0, 1};

static uint32_t vertices_of(const plan_scene *s, int object) {
    return object < 2 ? s->bodies[object].vertex_count : 2;
}

/* Of a coordinate that is 0 but for roundings nothing is left that could be too small. */
static double round_coordinate(double x) {
    return nearbyint(x * 0x1p20) * 0x1p-20;
}

/* Shears an object, more in each frame. */
static double *place_object(const plan_scene *s, int object, int frame, double scale) {
    const double *rest = object < 2 ? s->bodies[object].positions : wire;
    double *out = body_allocate(vertices_of(s, object), sizeof(double[3]));
    for (uint32_t v = 0; v < vertices_of(s, object); v++) {
        const double *p = rest + (size_t)v * 3, shear = 0.25 * frame * p[2] + 4.0 * object;
        out[(size_t)v * 3] = scale * round_coordinate(p[0] + shear);
        out[(size_t)v * 3 + 1] = scale * round_coordinate(p[1]);
        out[(size_t)v * 3 + 2] = scale * round_coordinate(p[2]);
    }
    return out;
}

static plan_scene *make_scene(const cscd_context_options *options, double scale) {
    plan_scene *s = body_allocate(1, sizeof *s);
    cscd_object_desc objects[OBJECTS];
    for (int i = 0; i < 2; i++) {
        s->bodies[i] = body_of(i == 0 ? BODY_TORUS : BODY_SPHERE, TRIANGLES);
        objects[i] = cscd_object_of_triangles(s->bodies[i].vertex_count, s->bodies[i].triangle_count,
                                              s->bodies[i].triangles);
    }
    objects[1].obstacle = true;
    objects[2] = cscd_object_of_wires(2, 1, wire_ends);
    for (int f = 0; f <= FRAMES; f++) {
        for (int i = 0; i < OBJECTS; i++) {
            s->positions[f][i] = place_object(s, i, f, scale);
            s->views[f][i] = cscd_view_doubles(s->positions[f][i], vertices_of(s, i));
            s->views[f][i].object_count = 1;
        }
        if (f > 0) s->frames[f - 1] = s->views[f];
    }
    const uint32_t count = s->bodies[0].triangle_count + s->bodies[1].triangle_count;
    s->stiffness = body_allocate(count, sizeof *s->stiffness);
    for (uint32_t t = 0; t < count; t++) s->stiffness[t] = t % 7 == 0 ? 0.2 : 1.0;
    expect_ok(cscd_context_create(options, &s->context));
    expect_ok(cscd_mesh_create(s->context, objects, OBJECTS, &s->mesh));
    return s;
}

static void free_scene(plan_scene *s) {
    cscd_mesh_destroy(s->mesh);
    cscd_context_destroy(s->context);
    for (int i = 0; i < 2; i++) body_free(&s->bodies[i]);
    for (int f = 0; f <= FRAMES; f++)
        for (int i = 0; i < OBJECTS; i++) free(s->positions[f][i]);
    free(s->stiffness);
    free(s);
}

static cscd_status make_plan(const plan_scene *s, cscd_plan **out) {
    cscd_plan_options options = cscd_plan_defaults();
    options.method = CSCD_METHOD_AUTO;
    options.frames = s->frames;
    options.frame_count = FRAMES;
    options.stiffness = s->stiffness;
    return cscd_plan_create(s->context, s->mesh, s->views[0], &options, out);
}

/* Where memory fails in the charge the other methods go on, and the plan says so. */
TEST(every_allocation_may_fail) {
    counting_allocator counter = counting_allocator_start();
    cscd_context_options options = cscd_context_defaults();
    options.allocator = counting_allocator_interface(&counter);
    options.thread_count = 1;
    plan_scene *s = make_scene(&options, 1.0);
    const size_t bytes = cscd_context_describe(s->context).bytes;
    size_t refused = 0, without_charge = 0;
    for (bool reached = true; reached;) {
        cscd_plan *plan = NULL;
        counter.fail_at = counter.calls + PACED(1, 4) * (refused + without_charge);
        const cscd_status status = make_plan(s, &plan);
        reached = counter.calls > counter.fail_at;
        if (status == CSCD_OK) {
            const cscd_compared_plan first = cscd_plan_compared(plan, 0);
            assert_int_equal(first.failure != NULL, reached);
            if (reached) assert_non_null(strstr(first.failure, "out of memory"));
            without_charge += reached;
        } else {
            assert_int_equal(status, CSCD_OUT_OF_MEMORY);
            assert_null(plan);
            refused++;
        }
        cscd_plan_destroy(plan);
        assert_int_equal(cscd_context_describe(s->context).bytes, bytes);
    }
    assert_true(refused > PACED(20, 4) && without_charge > PACED(40, 8));
    free_scene(s);
    assert_int_equal(counter.live, 0);
}

typedef struct progress_count {
    size_t reports, refuse_at;
    double last;
} progress_count;

static bool report_progress(void *user, const char *stage, double fraction) {
    progress_count *count = user;
    assert_non_null(stage);
    assert_true(fraction >= count->last && fraction <= 1.0);
    count->last = fraction;
    return count->reports++ != count->refuse_at;
}

TEST(every_report_may_cancel) {
    progress_count count = {0};
    cscd_context_options options = cscd_context_defaults();
    options.progress = (cscd_progress){report_progress, &count};
    options.thread_count = 1;
    plan_scene *s = make_scene(&options, 1.0);
    s->context->progress.interval_ms =
        0.0; /* asks as often as it can, so that the machine's speed does not matter */
    const size_t bytes = cscd_context_describe(s->context).bytes;
    cscd_status status = CSCD_CANCELLED;
    size_t rounds = 0;
    for (size_t refused = 0; status != CSCD_OK; rounds++, refused += 1 + refused / PACED(8, 2)) {
        cscd_plan *plan = NULL;
        count = (progress_count){.refuse_at = refused};
        status = make_plan(s, &plan);
        assert_int_equal(status, count.reports > refused ? CSCD_CANCELLED : CSCD_OK);
        assert_int_equal(plan != NULL, status == CSCD_OK);
        cscd_plan_destroy(plan);
        assert_int_equal(cscd_context_describe(s->context).bytes, bytes);
    }
    assert_true(rounds > PACED(20, 8));
    free_scene(s);
}

/* Powers of two, so that every product is the same but for its exponent. */
TEST(sizes_change_nothing) {
    static const double scales[] = {1.0, 0x1p-250, 0x1p290};
    cscd_context_options options = cscd_context_defaults();
    plan_scene *scenes[3];
    cscd_plan *plans[3] = {NULL};
    for (int i = 0; i < 3; i++) {
        scenes[i] = make_scene(&options, scales[i]);
        if (make_plan(scenes[i], &plans[i]) != CSCD_OK)
            fail_msg("%s", cscd_context_detail(scenes[i]->context));
        assert_int_equal(cscd_plan_region_count(plans[i]), cscd_plan_region_count(plans[0]));
        assert_int_equal(cscd_plan_describe(plans[i]).compared_count,
                         cscd_plan_describe(plans[0]).compared_count);
        for (uint32_t t = 0; t < cscd_mesh_triangle_count(scenes[0]->mesh); t++)
            assert_int_equal(cscd_plan_triangle_region(plans[i], t), cscd_plan_triangle_region(plans[0], t));
        for (uint32_t c = 0; c < cscd_plan_describe(plans[0]).compared_count; c++)
            assert_true(cscd_plan_compared(plans[i], c).tested_share ==
                        cscd_plan_compared(plans[0], c).tested_share);
    }
    assert_true(cscd_plan_compared(plans[0], 1).tested_share > 0.01);
    for (int i = 0; i < 3; i++) {
        cscd_plan_destroy(plans[i]);
        free_scene(scenes[i]);
    }
}
