/* The cloth scenes, whole and small: there is no contact in any step, and yet much happens. */
#include "cscd/research.h"
#include "models/cloth/cloth.h"
#include "models/common/vec3.h"
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

/* Sanitizers run only the first frames, which have no folds. Some intervals are also tested by brute
 * force. */
enum {
    FRAMES = PACED(1000, 75),
    THREADED_FRAMES = PACED(30, 16),
    SEWN_FRAMES = PACED(70, 48),
    BRUTE_EVERY = PACED(70, 70)
};

enum { RESOLUTION = 18 };

/* A run of a scene and separate detectors, which check the positions that a recording keeps: in single
 * precision. */
typedef struct cloth_trial {
    cscd_context *context;
    cloth_simulation run;
    uint32_t vertex_count, garment_count;
    cscd_detector *judge, *brute; /* detectors of the whole scene that find all contacts */
    double *before, *after;       /* rounded */
} cloth_trial;

static void round_positions(const double *from, uint32_t vertex_count, double *to) {
    body rounded = {.vertex_count = vertex_count, .positions = to};
    memcpy(to, from, vertex_count * 3 * sizeof *to);
    body_round(&rounded);
}

static cscd_detector *make_detector(const cloth_simulation *run, cscd_method method) {
    cscd_detector *detector;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    options.seams = run->seams;
    options.seam_count = run->seam_count;
    assert_int_equal(detector_create_here(run->mesh, NULL, &options, &detector), CSCD_OK);
    return detector;
}

static cloth_trial begin_trial(const char *name, uint32_t thread_count) {
    cloth_trial t = {0};
    io_error error;
    cscd_context_options options = cscd_context_defaults();
    options.thread_count = thread_count;
    assert_int_equal(cscd_context_create(&options, &t.context), CSCD_OK);
    if (!cloth_open(cloth_scene_find(name), RESOLUTION, t.context, &t.run, &error))
        fail_msg("%s", error.text);
    t.vertex_count = cscd_mesh_vertex_count(t.run.mesh);
    t.garment_count = t.run.garment.vertex_count;
    t.judge = make_detector(&t.run, CSCD_METHOD_NONE);
    t.brute = make_detector(&t.run, CSCD_METHOD_BRUTE);
    t.before = body_allocate(t.vertex_count * 3, sizeof *t.before);
    t.after = body_allocate(t.vertex_count * 3, sizeof *t.after);
    round_positions(t.run.positions, t.vertex_count, t.after);
    return t;
}

static void end_trial(cloth_trial *t) {
    cscd_detector_destroy(t->judge);
    cscd_detector_destroy(t->brute);
    cloth_close(&t->run);
    cscd_context_destroy(t->context);
    free(t->before);
    free(t->after);
}

static void advance_trial(cloth_trial *t) {
    io_error error;
    double *kept = t->before;
    if (!cloth_advance(&t->run, &error)) fail_msg("%s", error.text);
    t->before = t->after;
    t->after = kept;
    round_positions(t->run.positions, t->vertex_count, t->after);
}

static void expect_nothing(cscd_detector *detector, const double *from, const double *to, uint32_t frame) {
    cscd_contacts found;
    assert_int_equal(step_packed(detector, from, to, &found), CSCD_OK);
    if (found.count > 0)
        fail_msg("frame %u: %zu contacts, the first of %s %u and %u at %g", frame, found.count,
                 cscd_contact_kind_name(found.items[0].kind), found.items[0].a, found.items[0].b,
                 found.items[0].toi);
}

static void expect_embedded(cscd_detector *detector, const double *positions) {
    cscd_intersections intersections;
    assert_int_equal(check_packed(detector, positions, &intersections), CSCD_OK);
    assert_int_equal(intersections.count, 0);
    assert_int_equal(intersections.zero_area_triangles, 0);
}

/* Counts pairs nearer than twice the separation: folds, whose sides were more than six spacings apart at the
 * start, and pairs of the garment with each obstacle. */
typedef struct meetings {
    size_t folds, obstacles[CLOTH_OBSTACLES_MAX];
} meetings;

static meetings count_meetings(cloth_trial *t) {
    meetings m = {0};
    cscd_proximities near;
    const double reach = 2.0 * cloth_separation(&t->run);
    assert_int_equal(find_near_packed(t->judge, t->run.positions, reach, &near), CSCD_OK);
    for (size_t i = 0; i < near.count; i++) {
        const cscd_proximity *p = &near.items[i];
        cscd_stencil s = stencil_of_item(t->run.mesh, p);
        uint32_t first = cscd_mesh_vertex_object(t->run.mesh, s.vertices[0]);
        uint32_t last = cscd_mesh_vertex_object(t->run.mesh, s.vertices[3]);
        double between[3];
        if (first > 0 || last > 0) {
            m.obstacles[(first > last ? first : last) - 1]++;
            continue;
        }
        vec3_subtract(t->run.garment.positions + s.vertices[0] * 3,
                      t->run.garment.positions + s.vertices[3] * 3, between);
        m.folds += vec3_norm(between) > 6.0 * t->run.spacing;
    }
    return m;
}

/* Returns the largest motion of a vertex of the garment in the last frame. */
static double largest_motion(const cloth_trial *t) {
    double most = 0.0, between[3];
    for (uint32_t v = 0; v < t->garment_count; v++) {
        vec3_subtract(t->run.positions + v * 3, t->run.start + v * 3, between);
        most = fmax(most, vec3_norm(between));
    }
    return most;
}

/* Runs a scene and checks that there is no contact from frame to frame, that no frame has intersections,
 * and that no obstacle waits. *most_folds is the largest number in a frame. Returns true when this was the
 * whole scene, which ends nearly at rest. */
static bool run_scene(cloth_trial *t, size_t *most_folds) {
    *most_folds = 0;
    uint32_t frame_count = t->run.scene->frame_count < FRAMES ? t->run.scene->frame_count : FRAMES;
    expect_embedded(t->judge, t->after);
    for (uint32_t frame = 1; frame < frame_count; frame++) {
        advance_trial(t);
        expect_nothing(t->judge, t->before, t->after, frame);
        if (frame % BRUTE_EVERY == 0) expect_nothing(t->brute, t->before, t->after, frame);
        if (frame % 20 > 0) continue;
        expect_embedded(t->judge, t->after);
        meetings m = count_meetings(t);
        if (m.folds > *most_folds) *most_folds = m.folds;
    }
    assert_true(t->run.statistics.waited == 0.0);
    if (frame_count < t->run.scene->frame_count) return false;
    assert_true(largest_motion(t) < 0.5 * t->run.spacing);
    return true;
}

/* The sheet lies on the ball and the floor: above both, and near the ball's top where it covers it. */
TEST(the_sheet_drapes_over_the_ball) {
    cloth_trial t = begin_trial("cloth-drape", 1);
    const cloth_obstacle *ball = &t.run.scene->obstacles[1];
    double top = ball->centre[2] + ball->rise + ball->size, highest = 0.0;
    size_t most_folds;
    bool whole = run_scene(&t, &most_folds);
    meetings m = count_meetings(&t);
    assert_true(m.obstacles[1] > 10);
    for (uint32_t v = 0; v < t.garment_count; v++) {
        assert_true(t.run.positions[v * 3 + 2] > 0.0);
        highest = fmax(highest, t.run.positions[v * 3 + 2]);
    }
    if (whole) {
        assert_true(most_folds > 20 && m.obstacles[0] > 10);
        assert_true(highest > top && highest < top + 2.0 * t.run.spacing);
    }
    end_trial(&t);
}

/* The sleeve ends flat on the floor, below the height of the ball. */
TEST(the_sleeve_lies_in_folds) {
    cloth_trial t = begin_trial("sleeve", 1);
    double highest = 0.0;
    size_t most_folds;
    bool whole = run_scene(&t, &most_folds);
    meetings m = count_meetings(&t);
    assert_true(m.obstacles[0] > 10);
    for (uint32_t v = 0; v < t.garment_count; v++) {
        assert_true(t.run.positions[v * 3 + 2] > 0.0);
        highest = fmax(highest, t.run.positions[v * 3 + 2]);
    }
    if (whole) {
        assert_true(most_folds > 20 && m.folds > 20 && m.obstacles[1] > 10);
        assert_true(highest < 0.4 * t.run.scene->height);
    }
    end_trial(&t);
}

/* The panels of the bag touch only each other, at their seams, where their vertices stay equal bit for
 * bit. */
TEST(seams_hold) {
    cloth_trial t = begin_trial("bag", 1);
    expect_embedded(t.judge, t.after);
    assert_true(t.run.seam_count > 3 * (RESOLUTION - 1));
    for (uint32_t frame = 1; frame < SEWN_FRAMES; frame++) {
        advance_trial(&t);
        expect_nothing(t.judge, t.before, t.after, frame);
        for (uint32_t i = 0; i < t.run.seam_count; i++)
            assert_memory_equal(t.run.positions + t.run.seams[2 * i] * 3,
                                t.run.positions + t.run.seams[2 * i + 1] * 3, 3 * sizeof(double));
    }
    expect_embedded(t.judge, t.after);
    assert_true(t.run.statistics.cut > 0);
    assert_true(count_meetings(&t).obstacles[1] > 10);
    end_trial(&t);
}

/* Steps the garment alone with a method that culls where it pays: nothing of the open sheet can be culled, and the
 * sleeve is known to be embedded throughout. From frame 37 on it is folded, and culling pays no longer. */
static void expect_reason(const char *name, cscd_reason reason, bool culls) {
    cloth_trial t = begin_trial(name, 1);
    cscd_mesh *mesh;
    cscd_plan *plan;
    cscd_detector *detector;
    const body *garment = &t.run.garment;
    const cscd_object_desc desc =
        cscd_object_of_triangles(garment->vertex_count, garment->triangle_count, garment->triangles);
    cscd_plan_options options = cscd_plan_defaults();
    options.method = CSCD_METHOD_KMEANS;
    assert_int_equal(cscd_mesh_create(t.context, &desc, 1, &mesh), CSCD_OK);
    assert_int_equal(plan_create_packed(mesh, garment->positions, &options, &plan), CSCD_OK);
    assert_int_equal(detector_create_here(mesh, plan, NULL, &detector), CSCD_OK);
    for (uint32_t frame = 1; frame < 37; frame++) {
        advance_trial(&t);
        expect_nothing(detector, t.before, t.after, frame);
        cscd_guarantee guarantee = cscd_detector_guarantee(detector, 0);
        assert_int_equal(guarantee.reason, reason);
        assert_true(guarantee.complete);
        assert_int_equal(cscd_detector_counters(detector).clean == garment->triangle_count, culls);
        assert_int_equal(cscd_detector_counters(detector).plus > garment->triangle_count / 4, culls);
    }
    cscd_detector_destroy(detector);
    cscd_plan_destroy(plan);
    cscd_mesh_destroy(mesh);
    end_trial(&t);
}

TEST(guarantees_say_what_was_culled) {
    expect_reason("cloth-drape", CSCD_REASON_SURFACE, false);
    expect_reason("sleeve", CSCD_REASON_CLEAN, true);
}

TEST(threads_change_nothing) {
    for (uint32_t i = 0; i < cloth_scene_count; i++) {
        cloth_trial one = begin_trial(cloth_scenes[i].name, 1), three = begin_trial(cloth_scenes[i].name, 3);
        for (uint32_t frame = 1; frame < THREADED_FRAMES; frame++) {
            advance_trial(&one);
            advance_trial(&three);
            assert_memory_equal(one.run.positions, three.run.positions,
                                one.vertex_count * 3 * sizeof *one.run.positions);
        }
        assert_int_equal(one.run.statistics.pushed, three.run.statistics.pushed);
        end_trial(&one);
        end_trial(&three);
    }
}
