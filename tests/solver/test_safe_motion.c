/* Motions made safe: nothing touches on the way, momentum is kept, friction holds, and what presses goes on moving. */
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/solver/exact_distance.h"
#include "tests/support/solver/solver_rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

static scene interval; /* large; one test at a time */
static double end[SCENE_VERTICES_MAX * 3];

static cscd_safe_motion make_safe(const rig *r, const cscd_response_options *options) {
    cscd_safe_motion out;
    expect_ok(make_safe_packed(r->detector, interval.x0, interval.x1, options, end, &out));
    return out;
}

static void move_triangle(uint32_t which, double by) {
    for (uint32_t i = 3 * which; i < 3 * which + 3; i++) interval.x1[3 * i + 2] = interval.x0[3 * i + 2] + by;
}

/* ---- what is promised ---------------------------------------------------------------------------------- */

static bool names_held_vertices(const cscd_contact *c, const cscd_safe_motion *out) {
    for (int i = 0; i < 4; i++) {
        if (out->responses[c->vertices[i]] != CSCD_RESPONSE_HELD) return false;
    }
    return true;
}

/* Brute force finds nothing on the way but what is held. Returns how many contacts the wanted motion had. */
static size_t check_certificate(const cscd_safe_motion *out, double apart) {
    static uint8_t responses[SCENE_VERTICES_MAX];
    memcpy(responses, out->responses, interval.vertex_count);
    rig brute = rig_apart(&interval, apart, CSCD_METHOD_BRUTE, 1);
    cscd_contacts found;
    expect_ok(step_packed(brute.detector, interval.x0, interval.x1, &found));
    size_t before = found.count;
    expect_ok(cscd_detector_set_separation(brute.detector, 0.0, 0.0));
    expect_ok(step_packed(brute.detector, interval.x0, end, &found));
    const cscd_safe_motion copied = {.responses = responses};
    for (size_t i = 0; i < found.count; i++) {
        assert_true(names_held_vertices(&found.items[i], &copied));
        assert_true(found.items[i].toi == 0.0);
    }
    rig_destroy(&brute);
    return before;
}

/* By rational numbers: pairs that are farther apart than the separation at x0 are so at the end, and no other one has sunk
 * by more than a tenth. */
static void check_separation(const rig *r, const cscd_safe_motion *out, double apart) {
    cscd_proximities near;
    static uint8_t responses[SCENE_VERTICES_MAX];
    memcpy(responses, out->responses, interval.vertex_count);
    expect_ok(cscd_detector_find_near(r->detector, CSCD_DOUBLES(interval.x0, interval.vertex_count),
                                      4.0 * apart, CSCD_NEAR_PAIRS, &near));
    for (size_t i = 0; i < near.count; i++) {
        const cscd_proximity *p = &near.items[i];
        double x0[4][3], x1[4][3];
        for (int j = 0; j < 4; j++) {
            memcpy(x0[j], interval.x0 + (size_t)p->vertices[j] * 3, sizeof x0[j]);
            memcpy(x1[j], end + (size_t)p->vertices[j] * 3, sizeof x1[j]);
        }
        const double(*from)[3] = (const double(*)[3])x0, (*to)[3] = (const double(*)[3])x1;
        if (distance_sign_of_sum(p->kind, from, apart * (1.0 + 2e-6), 0.0, 1.0) > 0)
            assert_true(distance_sign_of_sum(p->kind, to, apart, 0.0, 1.0) > 0);
        else if (p->distance > 1e-9)
            assert_true(distance_sign_of_sum(p->kind, to, p->distance * (0.9 - 1e-5), 0.0, 1.0) > 0);
    }
}

static void check_counts(const cscd_safe_motion *out) {
    uint32_t counts[CSCD_RESPONSE_COUNT] = {0};
    bool moved = false;
    for (uint32_t v = 0; v < interval.vertex_count; v++) {
        assert_true(out->responses[v] < CSCD_RESPONSE_COUNT);
        counts[out->responses[v]]++;
        bool same = memcmp(end + 3 * (size_t)v, interval.x1 + 3 * (size_t)v, sizeof(double[3])) == 0;
        bool stays = memcmp(end + 3 * (size_t)v, interval.x0 + 3 * (size_t)v, sizeof(double[3])) == 0;
        if (out->responses[v] == CSCD_RESPONSE_FREE) assert_true(same);
        if (out->responses[v] == CSCD_RESPONSE_HELD) assert_true(stays);
        moved |= !stays;
    }
    assert_memory_equal(counts, out->response_counts, sizeof counts);
    assert_true(moved == out->moved);
    assert_true(out->least_share >= 0.0 && out->least_share <= out->mean_share && out->mean_share <= 1.0);
}

/* Where half of the vertices go where they want, planes must truncate what no impulse can stop. */
static const cscd_response_options *immovable_half(uint64_t seed, cscd_response_options *out) {
    static double inverse_masses[SCENE_VERTICES_MAX];
    random_seed(seed);
    for (uint32_t v = 0; v < interval.vertex_count; v++) inverse_masses[v] = random_unit() > 0.0;
    inverse_masses[0] = 1.0;
    *out = cscd_response_defaults();
    out->inverse_masses = inverse_masses;
    return out;
}

TEST(safe_motions_are_certified) {
    size_t contacts = 0, held = 0, moved = 0;
    uint32_t of_response[CSCD_RESPONSE_COUNT] = {0};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 0; seed < NIGHTLY(8, 80); seed++) {
            cscd_response_options options;
            scene_make((scene_family)family, seed / 2, &interval);
            double apart = seed / 2 % 2 == 0 ? 0.0 : 0.003;
            rig r = rig_apart(&interval, apart, seed % 8 < 4 ? CSCD_METHOD_NONE : CSCD_METHOD_SINGLE, 1);
            cscd_safe_motion out = make_safe(&r, seed % 2 == 0 ? NULL : immovable_half(seed, &options));
            check_counts(&out);
            contacts += check_certificate(&out, apart);
            held += out.held_count;
            moved += out.moved;
            for (int i = 0; i < CSCD_RESPONSE_COUNT; i++) of_response[i] += out.response_counts[i];
            if (apart > 0.0) check_separation(&r, &out, apart);
            rig_destroy(&r);
        }
    }
    assert_true(contacts > 2000 && held > 20 && moved > 40);
    assert_true(of_response[CSCD_RESPONSE_FREE] > 2000 && of_response[CSCD_RESPONSE_STOPPED] > 300);
    assert_true(of_response[CSCD_RESPONSE_TRUNCATED] > 20 && of_response[CSCD_RESPONSE_HELD] > 20);
}

/* Random motions, again and again from where the last one ended: nothing ever touches, and all goes on moving. So far from the origin
 * floats are as coarse as the motions, and the very floats that are written count. */
TEST(a_march_goes_on) {
    random_seed(5);
    for (int scalar = 0; scalar < 2; scalar++) {
        scene_make(SCENE_BENT_CAPSULE, 7, &interval);
        rig r = rig_apart(&interval, 0.001, CSCD_METHOD_NONE, 1);
        size_t size = (size_t)interval.vertex_count * 3;
        static float x0[SCENE_VERTICES_MAX * 3], x1[SCENE_VERTICES_MAX * 3];
        for (size_t i = 0; i < size; i++) {
            x0[i] = (float)(interval.x0[i] + 131072.0);
            interval.x0[i] = scalar == 1 ? (double)x0[i] : interval.x0[i];
        }
        double shares = 0.0;
        for (int step = 0; step < 40; step++) {
            cscd_safe_motion out;
            for (size_t i = 0; i < size; i++) interval.x1[i] = interval.x0[i] + 0.02 * random_unit();
            for (size_t i = 0; scalar == 1 && i < size; i++) {
                x1[i] = (float)interval.x1[i];
                interval.x1[i] = (double)x1[i];
            }
            if (scalar == 0) {
                out = make_safe(&r, NULL);
            } else {
                uint32_t n = interval.vertex_count;
                expect_ok(cscd_detector_make_safe(r.detector, CSCD_FLOATS(x0, n), CSCD_FLOATS(x1, n), NULL,
                                                  CSCD_MUTABLE_FLOATS(x1, n), &out));
                for (size_t i = 0; i < size; i++) end[i] = (double)x1[i];
                memcpy(x0, x1, size * sizeof *x0);
            }
            check_certificate(&out, 0.001);
            assert_int_equal(out.held_count, 0);
            shares += out.mean_share;
            memcpy(interval.x0, end, size * sizeof *end);
        }
        assert_true(shares > 0.9 * 40.0);
        rig_destroy(&r);
    }
}

TEST(safe_motions_are_the_same_for_all_threads_and_methods) {
    static double first[SCENE_VERTICES_MAX * 3];
    for (uint64_t seed = 0; seed < 4; seed++) {
        scene_make(seed % 2 == 0 ? SCENE_BENT_CAPSULE : SCENE_SOUP, seed, &interval);
        size_t size = (size_t)interval.vertex_count * 3 * sizeof *end;
        for (int i = 0; i < 3; i++) {
            rig r = rig_apart(&interval, 0.01, i == 2 ? CSCD_METHOD_BRUTE : CSCD_METHOD_NONE, i == 1 ? 4 : 1);
            make_safe(&r, NULL);
            if (i == 0)
                memcpy(first, end, size);
            else
                assert_memory_equal(first, end, size);
            rig_destroy(&r);
        }
    }
}

/* ---- momentum, friction, what goes on moving ----------------------------------------------------------- */

static void sum_momentum(const double *to, const double *inverse_masses, double out[3]) {
    out[0] = out[1] = out[2] = 0.0;
    for (size_t i = 0; i < (size_t)interval.vertex_count * 3; i++)
        out[i % 3] += (to[i] - interval.x0[i]) / (inverse_masses != NULL ? inverse_masses[i / 3] : 1.0);
}

/* Impulses are equal and opposite, with any masses and with friction. */
TEST(momentum_is_kept) {
    size_t changed = 0;
    for (uint64_t seed = 0; seed < 12; seed++) {
        double before[3], after[3], inverse_masses[SCENE_VERTICES_MAX], friction[SCENE_VERTICES_MAX];
        random_seed(seed);
        scene_make(seed % 3 == 0 ? SCENE_SOUP : SCENE_TWO_SPHERES, seed, &interval);
        for (uint32_t v = 0; v < interval.vertex_count; v++) {
            inverse_masses[v] = pow(10.0, random_unit());
            friction[v] = 0.4;
        }
        rig r = rig_apart(&interval, 0.001, CSCD_METHOD_NONE, 1);
        cscd_response_options options = cscd_response_defaults();
        options.inverse_masses = inverse_masses;
        options.friction = friction;
        cscd_safe_motion out = make_safe(&r, &options);
        if (out.response_counts[CSCD_RESPONSE_TRUNCATED] + out.response_counts[CSCD_RESPONSE_HELD] == 0) {
            sum_momentum(interval.x1, inverse_masses, before);
            sum_momentum(end, inverse_masses, after);
            for (int k = 0; k < 3; k++)
                assert_true(fabs(after[k] - before[k]) <= 1e-10 * interval.vertex_count);
            changed += out.response_counts[CSCD_RESPONSE_STOPPED];
        }
        rig_destroy(&r);
    }
    assert_true(changed > 100);
}

/* A triangle falls and slides along a heavy one. Without friction it keeps its sliding, with little it loses some, and with
 * much all of it. */
TEST(friction_slows_what_slides) {
    static const double coefficients[] = {0.0, 0.1, 2.0};
    static const double kept[] = {0.01, 0.01 - 0.1 * 0.05, 0.0};
    const double inverse_masses[] = {0.0, 0.0, 0.0, 1.0, 1.0, 1.0};
    for (int i = 0; i < 3; i++) {
        scene_two_triangles(&interval, 0.015);
        for (int v = 0; v < 3; v++)
            for (int k = 0; k < 2; k++)
                interval.x0[3 * v + k] = interval.x1[3 * v + k] = 10.0 * (interval.x0[3 * v + k] - 0.2);
        move_triangle(1, -0.05);
        for (int v = 3; v < 6; v++) interval.x1[3 * v] += 0.01;
        rig r = rig_apart(&interval, 0.01, CSCD_METHOD_NONE, 1);
        cscd_response_options options = cscd_response_defaults();
        options.inverse_masses = inverse_masses;
        options.friction = &coefficients[i];
        cscd_safe_motion out = make_safe(&r, &options);
        assert_int_equal(out.response_counts[CSCD_RESPONSE_STOPPED], 3);
        for (int v = 3; v < 6; v++) {
            assert_true(fabs(end[3 * v + 2] - 0.015) < 1e-3);
            assert_true(fabs(end[3 * v] - interval.x0[3 * v] - kept[i]) < 1e-3);
        }
        rig_destroy(&r);
    }
}

/* Two triangles fall together: the upper one, which is faster, must not stop the lower one's fall. */
TEST(a_pile_falls_together) {
    double before[3], after[3];
    scene_two_triangles(&interval, 0.02);
    move_triangle(0, -1.0);
    move_triangle(1, -1.5);
    rig r = rig_apart(&interval, 0.01, CSCD_METHOD_NONE, 1);
    cscd_safe_motion out = make_safe(&r, NULL);
    assert_true(out.mean_share > 0.8 && out.least_share > 0.8);
    sum_momentum(interval.x1, NULL, before);
    sum_momentum(end, NULL, after);
    assert_true(fabs(before[2] - after[2]) < 1e-12);
    rig_destroy(&r);
}

/* ---- obstacles, seams, what touches --------------------------------------------------------------------- */

static rig rig_of_two(bool first_is_obstacle, bool second_is_obstacle, double apart) {
    static const uint32_t triangle[] = {0, 1, 2};
    cscd_object_desc objects[2] = {cscd_object_of_triangles(3, 1, triangle),
                                   cscd_object_of_triangles(3, 1, triangle)};
    objects[0].obstacle = first_is_obstacle;
    objects[1].obstacle = second_is_obstacle;
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = apart;
    return rig_of_objects(context_of(0, NULL), objects, 2, NULL, &options);
}

TEST(obstacles_push_what_is_in_their_way) {
    scene_two_triangles(&interval, 0.05);
    move_triangle(0, 0.4);
    rig r = rig_of_two(true, false, 0.01);
    cscd_safe_motion out = make_safe(&r, NULL);
    assert_true(out.obstacle_share == 1.0 && out.response_counts[CSCD_RESPONSE_FREE] == 3);
    assert_memory_equal(end, interval.x1, 9 * sizeof *end);
    for (int v = 3; v < 6; v++) assert_true(end[3 * v + 2] > 0.4);
    rig_destroy(&r);
}

/* Between two plates there is no way out, so that the upper one stops, as a whole and just in time. */
TEST(obstacles_stop_where_something_is_caught) {
    static const uint32_t triangle[] = {0, 1, 2};
    cscd_object_desc objects[3];
    for (int i = 0; i < 3; i++) objects[i] = cscd_object_of_triangles(3, 1, triangle);
    objects[0].obstacle = objects[2].obstacle = true;
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = 0.01;
    scene_two_triangles(&interval, 0.05);
    for (int i = 0; i < 9; i++) interval.x0[18 + i] = interval.x0[i] + (i % 3 == 2 ? 0.1 : 0.0);
    memcpy(interval.x1, interval.x0, 27 * sizeof *interval.x1);
    interval.vertex_count = 9;
    interval.x1[26] -= 0.3; /* it turns, too */
    interval.x1[23] -= 0.2;
    interval.x1[20] -= 0.2;
    rig r = rig_of_objects(context_of(0, NULL), objects, 3, NULL, &options);
    cscd_safe_motion out = make_safe(&r, NULL);
    assert_true(out.obstacle_share > 0.1 && out.obstacle_share < 0.5);
    for (int i = 18; i < 27; i++) {
        double wanted = interval.x0[i] + out.obstacle_share * (interval.x1[i] - interval.x0[i]);
        assert_true(fabs(end[i] - wanted) < 1e-12);
    }
    check_counts(&out);
    rig_destroy(&r);
}

TEST(what_touches_is_held_and_the_rest_moves) {
    scene_make(SCENE_TWO_SPHERES, 3, &interval);
    for (size_t i = 0; i < (size_t)interval.vertex_count * 3; i++)
        interval.x1[i] = interval.x0[i] + (i % 3 == 0 ? 0.01 : 0.0);
    uint32_t far = interval.vertex_count - 1;
    memcpy(interval.x0, interval.x0 + 3 * (size_t)far, sizeof(double[3])); /* two vertices at one place */
    rig r = rig_apart(&interval, 0.0, CSCD_METHOD_NONE, 1);
    cscd_safe_motion out = make_safe(&r, NULL);
    assert_true(out.held_count > 0 && out.moved && out.response_counts[CSCD_RESPONSE_FREE] > 0);
    assert_int_equal(out.responses[far], CSCD_RESPONSE_HELD);
    for (size_t i = 0; i < out.held_count; i++) assert_true(out.held[i].toi == 0.0);
    check_counts(&out);
    check_certificate(&out, 0.0);
    rig_destroy(&r);
}

/* Layers fall onto one that rests, and no impulse can stop them. */
static cscd_safe_motion drop_layers(uint32_t count, double spacing, double way) {
    static double inverse_masses[SCENE_VERTICES_MAX];
    memset(&interval, 0, sizeof interval);
    interval.vertex_count = 3 * count + 3;
    interval.triangle_count = count + 1;
    for (uint32_t i = 0; i < interval.vertex_count; i++) {
        const uint32_t layer = i / 3;
        interval.triangles[i] = i;
        interval.x0[3 * i + i % 3] = 1.0;
        interval.x0[3 * i + 2] = layer == count ? 10.0 : spacing * layer;
        inverse_masses[i] = layer == count;
        memcpy(interval.x1 + 3 * i, interval.x0 + 3 * i, sizeof(double[3]));
        if (layer > 0) interval.x1[3 * i + 2] -= way;
    }
    rig r = rig_apart(&interval, 0.01, CSCD_METHOD_NONE, 1);
    cscd_response_options options = cscd_response_defaults();
    options.inverse_masses = inverse_masses;
    cscd_safe_motion out = make_safe(&r, &options);
    check_counts(&out);
    check_certificate(&out, 0.01);
    check_separation(&r, &out, 0.01);
    rig_destroy(&r);
    return out;
}

/* Each layer is in the way of the next one only when it has been truncated, so that planes do not come to an end, and all go half of
 * their ways. */
TEST(what_planes_do_not_end_goes_half_of_its_way) {
    cscd_safe_motion out = drop_layers(30, 0.0105, 0.0012);
    assert_true(out.truncations > 15 && out.least_share > 0.4 && out.mean_share < 0.6);
    assert_int_equal(out.response_counts[CSCD_RESPONSE_TRUNCATED], 90);
}

/* Contacts may be reported beyond the separation, by its tolerance. */
TEST(planes_keep_pairs_beyond_the_tolerance) {
    assert_int_equal(drop_layers(2, 0.01 * (1.0 + 1.5e-6), 0.001).truncations, 1);
}

TEST(planes_of_earlier_rounds_remain) {
    assert_int_equal(drop_layers(6, 0.0105, 0.0012).truncations, 5);
}

/* Vertices of a seam are shifted by the same, and as one mass. */
TEST(seams_stay_sewn) {
    static const uint32_t seams[] = {3, 6, 4, 7};
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    scene_two_triangles(&interval, 0.05);
    interval.vertex_count = 9;
    interval.triangle_count = 3;
    memcpy(interval.triangles, triangles, sizeof triangles);
    memcpy(interval.x0 + 18, interval.x0 + 9, 9 * sizeof(double));
    interval.x0[25] = -1.0; /* the third corner lies on the other side of the seam */
    memcpy(interval.x1, interval.x0, 27 * sizeof(double));
    move_triangle(1, -0.3);
    move_triangle(2, -0.3);
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = 0.01;
    options.seams = seams;
    options.seam_count = 2;
    rig r = rig_create(&interval, 1, &options);
    cscd_free_step step;
    expect_ok(max_step_packed(r.detector, interval.x0, interval.x1, end, &step));
    assert_true(step.fraction > 0.1 && step.fraction < 0.15); /* from 0.05 to 0.01, of 0.3 */
    cscd_safe_motion out = make_safe(&r, NULL);
    assert_true(out.response_counts[CSCD_RESPONSE_STOPPED] > 0);
    assert_memory_equal(end + 9, end + 18, 6 * sizeof(double));
    check_counts(&out);
    rig_destroy(&r);
}

TEST(half_spaces_stop_what_falls) {
    static const uint32_t triangle[] = {0, 1, 2};
    static const double up[3] = {0.0, 0.0, 1.0};
    cscd_object_desc objects[2] = {cscd_object_of_triangles(3, 1, triangle), cscd_object_half_space(up)};
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = 0.01;
    memset(interval.x0, 0, 12 * sizeof(double));
    interval.vertex_count = 4;
    interval.x0[3] = interval.x0[7] = 1.0;
    interval.x0[2] = interval.x0[5] = interval.x0[8] = 0.1;
    memcpy(interval.x1, interval.x0, 12 * sizeof(double));
    move_triangle(0, -0.5);
    rig r = rig_of_objects(context_of(0, NULL), objects, 2, NULL, &options);
    cscd_safe_motion out = make_safe(&r, NULL);
    assert_int_equal(out.response_counts[CSCD_RESPONSE_STOPPED], 3);
    for (int v = 0; v < 3; v++) assert_true(end[3 * v + 2] > 0.01 && end[3 * v + 2] < 0.02);
    rig_destroy(&r);
}

/* ---- calls --------------------------------------------------------------------------------------------- */

TEST(wrong_arguments_of_make_safe_are_refused) {
    float floats[18] = {0.0f};
    double inverse_masses[6] = {1.0, 1.0, 1.0, 1.0, 1.0, -1.0}, friction[1] = {NAN};
    cscd_safe_motion out = {.rounds = 4711};
    scene_two_triangles(&interval, 0.25);
    rig r = rig_apart(&interval, 0.0, CSCD_METHOD_NONE, 1);
    cscd_detector *d = r.detector;
    const cscd_view *x0 = CSCD_DOUBLES(interval.x0, 6), *x1 = CSCD_DOUBLES(interval.x1, 6);
    cscd_response_options options = cscd_response_defaults();
    expect_invalid(r.context, cscd_detector_make_safe(d, x0, x1, NULL, NULL, NULL), "out is NULL");
    expect_invalid(r.context, cscd_detector_make_safe(d, NULL, x1, NULL, NULL, &out), "x0 is NULL");
    expect_invalid(r.context, cscd_detector_make_safe(d, x0, x1, NULL, CSCD_MUTABLE_FLOATS(floats, 6), &out),
                   "floats in reached");
    options.inverse_masses = inverse_masses;
    expect_invalid(r.context, cscd_detector_make_safe(d, x0, x1, &options, NULL, &out),
                   "inverse_masses[5] is -1");
    inverse_masses[5] = INFINITY;
    expect_invalid(r.context, cscd_detector_make_safe(d, x0, x1, &options, NULL, &out),
                   "inverse_masses[5] is inf");
    memset(inverse_masses, 0, sizeof inverse_masses);
    expect_invalid(r.context, cscd_detector_make_safe(d, x0, x1, &options, NULL, &out),
                   "is 0 for every vertex");
    inverse_masses[0] = 1.0;
    options.friction = friction;
    expect_invalid(r.context, cscd_detector_make_safe(d, x0, x1, &options, NULL, &out), "friction[0] is nan");
    options.friction = NULL;
    options.struct_size = 7;
    expect_invalid(r.context, cscd_detector_make_safe(d, x0, x1, &options, NULL, &out),
                   "cscd_response_defaults");
    interval.x1[7] = NAN;
    expect_invalid(r.context, cscd_detector_make_safe(d, x0, x1, NULL, NULL, &out), "x1");
    assert_int_equal(out.rounds, 4711);
    rig_destroy(&r);
}

/* `reached` may be x1 or x0 itself. */
TEST(make_safe_may_write_to_its_inputs) {
    static double x0[SCENE_VERTICES_MAX * 3], x1[SCENE_VERTICES_MAX * 3];
    scene_make(SCENE_TWO_SPHERES, 1, &interval);
    rig r = rig_apart(&interval, 0.0, CSCD_METHOD_NONE, 1);
    cscd_safe_motion out = make_safe(&r, NULL);
    size_t size = (size_t)interval.vertex_count * 3 * sizeof *x0;
    memcpy(x0, interval.x0, size);
    memcpy(x1, interval.x1, size);
    expect_ok(make_safe_packed(r.detector, x0, x1, NULL, x1, &out));
    assert_memory_equal(x1, end, size);
    memcpy(x1, interval.x1, size);
    expect_ok(make_safe_packed(r.detector, x0, x1, NULL, x0, &out));
    assert_memory_equal(x0, end, size);
    rig_destroy(&r);
}

/* The step from where a safe motion ended need not prove its start. */
TEST(the_end_of_a_safe_motion_is_known) {
    scene_make(SCENE_BENT_CAPSULE, 0, &interval);
    rig r = rig_apart(&interval, 0.0, CSCD_METHOD_SINGLE, 1);
    cscd_contacts found;
    expect_ok(step_packed(r.detector, interval.x0, interval.x0, &found));
    assert_int_equal(found.count, 0);
    make_safe(&r, NULL);
    expect_ok(step_packed(r.detector, end, interval.x1, &found));
    assert_int_equal(cscd_detector_counters(r.detector).static_checks, 0);
    assert_int_equal(cscd_detector_counters(r.detector).clean, interval.triangle_count);
    rig_destroy(&r);
}

/* A motion that ends ever so little above the separation must not be the end of a quick search: the next motion would not be
 * sure of the distance, and sink below it. */
TEST(an_end_is_sure_of_the_separation) {
    const double apart = 0.01;
    static const double excesses[] = {1e-12, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3};
    for (int i = 0; i < 6; i++) {
        cscd_free_step step;
        scene_two_triangles(&interval, 3.0 * apart);
        move_triangle(1, -2.0 * apart + excesses[i] * apart);
        rig r = rig_apart(&interval, apart, CSCD_METHOD_NONE, 1);
        make_safe(&r, NULL);
        memcpy(interval.x0, end, 18 * sizeof(double));
        move_triangle(0, 0.0);
        move_triangle(1, -0.09 * apart);
        expect_ok(max_step_packed(r.detector, interval.x0, interval.x1, end, &step));
        for (int v = 0; v < 9; v++) assert_true(end[3 * (3 + v / 3) + 2] - end[3 * (v % 3) + 2] > apart);
        rig_destroy(&r);
    }
}
