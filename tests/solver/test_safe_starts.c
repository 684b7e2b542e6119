/* Motions made safe of what touches at the start, is sewn to obstacles, or is at the end of what numbers hold. */
#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { VERTICES_MAX = 12 };

/* Triangles 0 1 2, 3 4 5, ..., each an object of its own. */
typedef struct small_scene {
    cscd_object_desc objects[4];
    uint32_t object_count, vertex_count;
    double x0[VERTICES_MAX * 3], x1[VERTICES_MAX * 3], end[VERTICES_MAX * 3];
    cscd_detector_options options;
    cscd_response_options response;
    cscd_safe_motion safe;
    uint8_t responses[VERTICES_MAX];
} small_scene;

static small_scene scene_of(uint32_t object_count, const double *x0) {
    static const uint32_t triangle[3] = {0, 1, 2};
    small_scene s = {.object_count = object_count,
                     .vertex_count = 3 * object_count,
                     .options = cscd_detector_defaults(),
                     .response = cscd_response_defaults()};
    for (uint32_t o = 0; o < object_count; o++) s.objects[o] = cscd_object_of_triangles(3, 1, triangle);
    memcpy(s.x0, x0, s.vertex_count * sizeof(double[3]));
    memcpy(s.x1, x0, s.vertex_count * sizeof(double[3]));
    return s;
}

static void move_object(small_scene *s, uint32_t object, int axis, double way) {
    for (uint32_t v = 3 * object; v < 3 * object + 3; v++) s->x1[3 * v + (uint32_t)axis] += way;
}

static void make_scene_safe(small_scene *s, bool of_floats) {
    static float f0[VERTICES_MAX * 3], f1[VERTICES_MAX * 3];
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    const uint32_t n = s->vertex_count;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, s->objects, s->object_count, &mesh), CSCD_OK);
    assert_int_equal(detector_create_here(mesh, NULL, &s->options, &detector), CSCD_OK);
    for (size_t i = 0; i < 3 * (size_t)n; i++) {
        f0[i] = (float)s->x0[i];
        f1[i] = (float)s->x1[i];
    }
    if (of_floats)
        assert_int_equal(cscd_detector_make_safe(detector, CSCD_FLOATS(f0, n), CSCD_FLOATS(f1, n),
                                                 &s->response, CSCD_MUTABLE_FLOATS(f1, n), &s->safe),
                         CSCD_OK);
    else
        assert_int_equal(make_safe_packed(detector, s->x0, s->x1, &s->response, s->end, &s->safe), CSCD_OK);
    for (size_t i = 0; of_floats && i < 3 * (size_t)n; i++) s->end[i] = (double)f1[i];
    memcpy(s->responses, s->safe.responses, n);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

static bool at_same_place(const small_scene *s, uint32_t a, uint32_t b) {
    return memcmp(s->end + 3 * (size_t)a, s->end + 3 * (size_t)b, sizeof(double[3])) == 0;
}

/* ---- what touches -------------------------------------------------------------------------------------- */

/* The second triangle stands on the first one and wants to go through it, to a third one that rests far below. */
static small_scene standing_triangle(void) {
    static const double x0[] = {0, 0,  1,  1, 0,  1,  0,  1, 1,  .2, .2, 1, .2, .5,
                                2, .5, .2, 2, -1, -1, .5, 3, -1, .5, -1, 3, .5};
    small_scene s = scene_of(3, x0);
    move_object(&s, 1, 2, -0.7);
    s.options.min_separation = 0.01;
    return s;
}

/* A vertex that is held gets nowhere, so that it pushes nothing that it would have reached. */
TEST(what_is_held_pushes_nothing) {
    small_scene s = standing_triangle();
    make_scene_safe(&s, false);
    assert_true(s.safe.held_count > 0);
    assert_int_equal(s.safe.pushed, 0);
    assert_memory_equal(s.end + 18, s.x0 + 18, sizeof(double[9]));
}

/* An obstacle that rests is on time, whatever touches it. */
TEST(resting_obstacles_are_never_late) {
    small_scene s = standing_triangle();
    s.objects[0].obstacle = true;
    make_scene_safe(&s, false);
    assert_true(s.safe.held_count > 0 && s.safe.obstacle_share == 1.0);
}

/* ---- seams of obstacles -------------------------------------------------------------------------------- */

/* Triangle 1 touches triangle 0, which wants to rise with the obstacle that it is sewn to by the given vertex. */
static void hold_what_is_sewn(uint32_t obstacle, uint32_t soft) {
    static const double x0[] = {0, 0,   0, 4, 0, 0, 0, 4,  0, 1, 1,  0,  1, 1.5,
                                1, 1.5, 1, 1, 0, 0, 0, -1, 0, 3, -1, -1, 3};
    static const uint32_t seam[] = {0, 6};
    small_scene s = scene_of(3, x0);
    s.objects[obstacle].obstacle = true;
    s.options.seams = seam;
    s.options.seam_count = 1;
    for (uint32_t o = 0; o < 3; o++) move_object(&s, o, 2, 0.25);
    make_scene_safe(&s, false);
    assert_true(s.safe.held_count > 0 && s.safe.obstacle_share == 0.0);
    assert_true(at_same_place(&s, 0, 6));
    for (uint32_t v = 3 * obstacle; v < 3 * obstacle + 3; v++) {
        assert_int_equal(s.responses[v], CSCD_RESPONSE_HELD);
        assert_memory_equal(s.end + 3 * v, s.x0 + 3 * v, sizeof(double[3]));
    }
    assert_int_equal(s.responses[soft], CSCD_RESPONSE_HELD);
}

TEST(obstacles_are_held_by_their_seams_and_hold_them) {
    hold_what_is_sewn(2, 0);
    hold_what_is_sewn(0, 6);
}

/* A lid waits above what lies on the floor, and what is sewn to it waits, too. */
TEST(what_is_sewn_waits_with_its_obstacle) {
    static const double x0[] = {-2, -2, 1,  4,  -2, 1,  -2, 4,  1,  -2, -2, 0, 4, -2, 0,   -2, 4, 0,
                                0,  0,  .5, .2, 0,  .5, 0,  .2, .5, 4,  -2, 1, 6, -2, 1.5, 6,  0, 1.5};
    static const uint32_t seam[] = {1, 9};
    small_scene s = scene_of(4, x0);
    s.objects[0].obstacle = s.objects[1].obstacle = true;
    s.options.seams = seam;
    s.options.seam_count = 1;
    move_object(&s, 0, 2, -2.0);
    move_object(&s, 3, 2, -2.0);
    make_scene_safe(&s, false);
    assert_true(s.safe.obstacle_share > 0.0 && s.safe.obstacle_share < 1.0);
    assert_true(at_same_place(&s, 1, 9));
    assert_int_equal(s.responses[9], CSCD_RESPONSE_TRUNCATED);
    assert_memory_equal(s.end + 9, s.x0 + 9, sizeof(double[9]));
}

/* ---- half-spaces, numbers ------------------------------------------------------------------------------ */

/* Impulses move neither the rising floor nor what falls onto it: planes stop what falls. */
TEST(half_spaces_come_before_what_no_impulse_moves) {
    static const double x0[] = {0, 0, 1, 1, 0, 1, 0, 1, 1, 9, 9, 9, 10, 9, 9, 9, 10, 9, 0, 0, 0};
    static const double up[] = {0.0, 0.0, 1.0}, inverse_masses[] = {0, 0, 0, 1, 1, 1, 1};
    small_scene s = scene_of(2, x0);
    s.objects[2] = cscd_object_half_space(up);
    s.object_count = 3;
    s.vertex_count = 7;
    memcpy(s.x0 + 18, x0 + 18, sizeof(double[3]));
    memcpy(s.x1 + 18, x0 + 18, sizeof(double[3]));
    move_object(&s, 0, 2, -2.0);
    s.x1[20] = 0.5;
    s.response.inverse_masses = inverse_masses;
    make_scene_safe(&s, false);
    assert_true(s.safe.obstacle_share == 1.0 && s.end[20] == 0.5);
    for (int v = 0; v < 3; v++) assert_true(s.end[3 * v + 2] > 0.5 && s.end[3 * v + 2] < 0.51);
}

TEST(ends_are_numbers_that_floats_hold) {
    static const double x0[] = {-3e38, -3e38, 3.3e38, 3e38,    -3e38, 3.3e38, -3e38, 3e38,    3.3e38,
                                -2e38, -2e38, 3.4e38, -2.5e38, -2e38, 3.4e38, -2e38, -2.5e38, 3.4e38};
    small_scene s = scene_of(2, x0);
    move_object(&s, 0, 2, 0.1e38);
    make_scene_safe(&s, true);
    for (uint32_t i = 0; i < 18; i++) assert_true(fabs(s.end[i]) <= (double)FLT_MAX);
}

TEST(zeros_keep_their_sign) {
    static const double x0[] = {-0.0, 0, 0, 1, 0, 0, 0, 1, 0};
    small_scene s = scene_of(1, x0);
    make_scene_safe(&s, false);
    assert_memory_equal(s.end, s.x1, sizeof(double[9]));
    assert_false(s.safe.moved);
}
