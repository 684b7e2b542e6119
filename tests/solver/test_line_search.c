/* The steps of line searches are compared with brute force, their candidates and proximity with the
 * detector's. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "runtime/solver/solver.h"
#include "tests/support/calls.h"
#include "tests/support/oracle.h"
#include "tests/support/random.h"
#include "tests/support/solver/solver_rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene interval; /* large; one test at a time */
static free_step_call call;
static double moment[SCENE_VERTICES_MAX * 3], exact[SCENE_VERTICES_MAX * 3];

static const cscd_method methods[] = {CSCD_METHOD_SINGLE, CSCD_METHOD_NONE, CSCD_METHOD_ICCD,
                                      CSCD_METHOD_BRUTE, CSCD_METHOD_PUBLISHED};
enum { METHOD_COUNT = sizeof methods / sizeof *methods };

/* A detector with a line search. */
typedef struct step_search {
    rig r;
    cscd_line_search *line;
    cscd_detector_options options;
} step_search;

static step_search search_create(cscd_method method, double min_separation, uint32_t threads) {
    step_search s = {.options = cscd_detector_defaults()};
    s.options.method = method_or_none(method);
    s.options.ours = ours_of_method(s.options.method);
    s.options.min_separation = min_separation;
    s.r = rig_create(&interval, threads, &s.options);
    expect_ok(cscd_line_search_create(s.r.detector, &s.line));
    return s;
}

static void search_destroy(step_search *s) {
    cscd_line_search_destroy(s->line);
    rig_destroy(&s->r);
}

static void begin_line(const step_search *s, const double *x0, const double *x1, double reach) {
    expect_ok(line_begin_packed(s->line, x0, x1, reach));
}

static void step_on(cscd_line_search *line, const double *x0, const double *x1, double longest) {
    free_step_prepare(x0, x1, longest, 0.8, &call);
    call.status = line_max_step_packed(line, longest, call.end, &call.step);
}

static void far_from_the_origin(void) {
    for (uint32_t i = 0; i < interval.vertex_count * 3; i++) {
        double shift = i % 3 == 0 ? 1e9 : i % 3 == 1 ? -7e8 : 123456.789;
        interval.x0[i] += shift;
        interval.x1[i] += shift;
    }
}

/* ---- steps --------------------------------------------------------------------------------------------- */

typedef struct line_tally {
    size_t calls, in_contact, limited, whole;
} line_tally;

static void check_steps(const step_search *s, const rig *reference, line_tally *sum) {
    static const double longest[] = {1.0, 0.37, 0x1p-20, 1e-300};
    for (size_t i = 0; i < sizeof longest / sizeof *longest; i++) {
        step_on(s->line, interval.x0, interval.x1, longest[i]);
        sum->calls++;
        if (free_step_check(reference, s->r.context, &call)) {
            sum->limited += call.step.limited;
            sum->whole += !call.step.limited;
        } else {
            sum->in_contact++;
        }
    }
}

TEST(steps_are_certified) {
    static const double distances[] = {0.0, 0.0, 1e-3, 0.02};
    line_tally sum = {0};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 1; seed < 4; seed++) {
            uint64_t turn = seed + (uint64_t)family;
            scene_make((scene_family)family, 40 + seed, &interval);
            if (seed == 3) far_from_the_origin();
            step_search s =
                search_create(methods[turn % METHOD_COUNT], distances[turn % 4], 1 + (uint32_t)seed % 3);
            rig reference = free_step_reference(&interval, &s.options);
            begin_line(&s, interval.x0, interval.x1, seed % 2 == 0 ? 0.0 : 0.01);
            check_steps(&s, &reference, &sum);
            rig_destroy(&reference);
            search_destroy(&s);
        }
    }
    print_message("  %zu calls: %zu in contact, %zu limited, %zu whole\n", sum.calls, sum.in_contact,
                  sum.limited, sum.whole);
    assert_true(sum.limited > 15 && sum.whole > 50 && sum.in_contact > 2);
}

/* ---- proximity ------------------------------------------------------------------------------------------ */

/* Checks that line search and detector find the same pairs, bit for bit, at the positions of a length, and
 * that brute force agrees. */
static size_t check_near(const step_search *s, const rig *other, const rig *brute, double length,
                         double distance, cscd_near_form form) {
    cscd_proximities on_line, by_trees, truth;
    expect_ok(line_positions_packed(s->line, length, moment));
    free_step_positions(&s->r, interval.x0, interval.x1, length, exact);
    assert_memory_equal(moment, exact, interval.vertex_count * sizeof(double[3]));
    const cscd_view *at = CSCD_DOUBLES(moment, interval.vertex_count);
    expect_ok(cscd_detector_find_near(other->detector, at, distance, form, &by_trees));
    expect_ok(cscd_detector_find_near(brute->detector, at, distance, form, &truth));
    expect_ok(cscd_line_search_find_near(s->line, length, distance, form, &on_line));
    assert_int_equal(on_line.count, by_trees.count);
    assert_int_equal(on_line.count, truth.count);
    assert_true(cscd_line_search_candidate_count(s->line) >= truth.count);
    size_t bytes = truth.count * sizeof *truth.items;
    if (bytes == 0) return 0;
    assert_memory_equal(on_line.items, by_trees.items, bytes);
    assert_memory_equal(on_line.items, truth.items, bytes);
    return truth.count;
}

static size_t check_moments(const step_search *s, double reach, uint64_t seed) {
    cscd_detector_options options = s->options;
    rig other = rig_create(&interval, 1, &options);
    options.method = CSCD_METHOD_BRUTE;
    options.ours = 0;
    rig brute = rig_create(&interval, 1, &options);
    random_stream random = stream_start(seed);
    size_t pairs = 0;
    for (int i = 0; i < 5; i++) {
        double length = i == 0 ? 0.0 : i == 1 ? 1.0 : i == 2 ? 0x1p-40 : stream_between(&random, 0.0, 1.0);
        double distance = i % 2 == 0 ? reach : reach * stream_between(&random, 0.01, 1.0);
        pairs += check_near(s, &other, &brute, length, distance, CSCD_NEAR_PAIRS);
        pairs += check_near(s, &other, &brute, length, distance, CSCD_NEAR_BEYOND);
    }
    rig_destroy(&brute);
    rig_destroy(&other);
    return pairs;
}

TEST(near_equals_the_detectors) {
    static const double reaches[] = {1e-6, 0.02, 0.15};
    size_t pairs = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 1; seed < 3; seed++) {
            uint64_t turn = seed + (uint64_t)family;
            scene_make((scene_family)family, 70 + seed, &interval);
            if (seed == 2) far_from_the_origin();
            step_search s = search_create(methods[turn % METHOD_COUNT], turn % 4 == 0 ? 1e-3 : 0.0,
                                          1 + (uint32_t)seed % 3);
            begin_line(&s, interval.x0, interval.x1, reaches[turn % 3]);
            pairs += check_moments(&s, reaches[turn % 3], seed);
            search_destroy(&s);
        }
    }
    print_message("  %zu pairs\n", pairs);
    assert_true(pairs > 3000);
}

TEST(scales_do_not_matter) {
    static const int exponents[] = {-250, 270};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        int exponent = exponents[family % 2];
        scene_make((scene_family)family, 90, &interval);
        for (uint32_t i = 0; i < interval.vertex_count * 3; i++) {
            interval.x0[i] = ldexp(interval.x0[i], exponent);
            interval.x1[i] = ldexp(interval.x1[i], exponent);
        }
        step_search s = search_create(CSCD_METHOD_SINGLE, 0.0, 1);
        rig reference = free_step_reference(&interval, &s.options);
        line_tally sum = {0};
        begin_line(&s, interval.x0, interval.x1, ldexp(0.05, exponent));
        check_steps(&s, &reference, &sum);
        if (family % 3 == 0) check_moments(&s, ldexp(0.05, exponent), 1);
        rig_destroy(&reference);
        search_destroy(&s);
    }
}

/* ---- states -------------------------------------------------------------------------------------------- */

/* Makes an embedded start of closed surfaces, and an end in contact. */
static void make_limited(scene_family family, uint64_t seed) {
    for (;; seed++) {
        scene_make(family, seed, &interval);
        rig r = rig_create(&interval, 1, NULL);
        bool fits = rig_step(&r, &interval).count > 0 && free_step_embedded(&r, interval.x0);
        rig_destroy(&r);
        if (fits) return;
    }
}

static void expect_known(const step_search *s, const rig *reference, const double *x0, const double *x1) {
    cscd_contacts found, truth;
    expect_ok(step_packed(s->r.detector, x0, x1, &found));
    assert_int_equal(cscd_detector_counters(s->r.detector).static_checks, 0);
    assert_int_equal(cscd_detector_counters(s->r.detector).clean, interval.triangle_count);
    expect_ok(step_packed(reference->detector, x0, x1, &truth));
    assert_int_equal(found.count, truth.count);
    if (found.count > 0) assert_memory_equal(found.items, truth.items, found.count * sizeof *found.items);
}

/* The detector knows the state at the end of each step of the line search, however many there are and
 * whatever lies between them. */
TEST(the_detector_knows_the_end) {
    static const scene_family families[] = {SCENE_SPIKE, SCENE_TWO_SPHERES, SCENE_NESTED_SPHERES,
                                            SCENE_BENT_CAPSULE};
    static const double longest[] = {1.0, 0.5, 0.01, 1.0};
    for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
        make_limited(families[f], 1);
        step_search s = search_create(CSCD_METHOD_SINGLE, 0.0, 2);
        rig reference = free_step_reference(&interval, &s.options);
        cscd_contacts found;
        expect_ok(step_packed(s.r.detector, interval.x0, interval.x0, &found));
        begin_line(&s, interval.x0, interval.x1, 0.0);
        for (size_t i = 0; i < sizeof longest / sizeof *longest; i++) {
            step_on(s.line, interval.x0, interval.x1, longest[i]);
            assert_true(free_step_check(&reference, s.r.context, &call));
            expect_known(&s, &reference, call.end, interval.x1);
        }
        rig_destroy(&reference);
        search_destroy(&s);
    }
}

/* The detector did not know the start, so its next step checks its own start. */
TEST(what_is_not_known_stays_so) {
    make_limited(SCENE_SPIKE, 1);
    for (size_t i = 0; i < (size_t)interval.vertex_count * 3; i++) moment[i] = interval.x0[i] + 1.0;
    for (int elsewhere = 0; elsewhere < 2;
         elsewhere++) { /* nothing is known, or where the line does not begin */
        step_search s = search_create(CSCD_METHOD_SINGLE, 0.0, 1);
        cscd_contacts found;
        if (elsewhere) expect_ok(step_packed(s.r.detector, moment, moment, &found));
        begin_line(&s, interval.x0, interval.x1, 0.0);
        step_on(s.line, interval.x0, interval.x1, 1.0);
        expect_ok(call.status);
        expect_ok(step_packed(s.r.detector, call.end, interval.x1, &found));
        assert_int_equal(cscd_detector_counters(s.r.detector).static_checks, 1);
        search_destroy(&s);
    }
}

/* The pole of a sphere has been pushed through the other one. The cap there intersects nothing, but is cut
 * off. */
static void make_cut_off(void) {
    static const int segments = 9;
    scene_clear(&interval);
    scene_add_sphere(&interval, (double[3]){0, 0, 0}, 1.0, 6, segments);
    for (int v = 0; v <= segments; v++) interval.x0[v * 3 + 2] = v == 0 ? 2.5 : 2.0;
    memcpy(interval.x1, interval.x0, sizeof interval.x1);
    interval.x1[2] += 0.1;
}

/* Returns how many triangles are clean after the detector has checked the start of a step. */
static uint64_t clean_when_checked(cscd_detector *d, const double *x) {
    cscd_contacts found;
    cscd_intersections crossing;
    expect_ok(check_packed(d, x, &crossing));
    assert_true(crossing.count > 0);
    expect_ok(step_packed(d, x, x, &found));
    return cscd_detector_counters(d).clean;
}

/* A caller's promise is no proof: a check takes it back, even after a line search has passed it on. */
TEST(a_word_stays_a_word) {
    make_cut_off();
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_SINGLE;
    options.start = CSCD_START_VOUCHED;
    rig r = rig_create(&interval, 1, &options), other = rig_create(&interval, 1, &options);
    cscd_line_search *line = NULL;
    cscd_contacts found;
    expect_ok(cscd_line_search_create(r.detector, &line));
    expect_ok(step_packed(r.detector, interval.x0, interval.x0, &found));
    expect_ok(line_begin_packed(line, interval.x0, interval.x1, 0.0));
    clean_when_checked(r.detector, interval.x0);
    step_on(line, interval.x0, interval.x1, 1.0);
    assert_true(call.status == CSCD_OK && !call.step.limited);
    assert_int_equal(clean_when_checked(r.detector, interval.x1),
                     clean_when_checked(other.detector, interval.x1));
    cscd_line_search_destroy(line);
    rig_destroy(&other);
    rig_destroy(&r);
}

/* ---- lines and steps in turn --------------------------------------------------------------------------- */

/* Two line searches and the steps of one detector take turns, and none notices the others. */
TEST(lines_and_steps_take_turns) {
    size_t bytes = sizeof interval.x0;
    double *x2 = malloc(bytes);
    assert_non_null(x2);
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        scene_make((scene_family)family, 21, &interval);
        for (uint32_t i = 0; i < interval.vertex_count * 3; i++)
            x2[i] = 0.5 * (interval.x0[i] + interval.x1[i]);
        step_search s = search_create(methods[family % 3], 0.0, 1);
        rig reference = free_step_reference(&interval, &s.options);
        cscd_line_search *second = NULL;
        cscd_contacts found, truth;
        cscd_free_step ignored;
        expect_ok(cscd_line_search_create(s.r.detector, &second));
        begin_line(&s, interval.x0, interval.x1, 0.01);
        expect_ok(line_begin_packed(second, x2, interval.x1, 0.0));
        for (int round = 0; round < 1 + (family == SCENE_SPIKE); round++) {
            step_on(second, x2, interval.x1, 1.0);
            free_step_check(&reference, s.r.context, &call);
            expect_ok(step_packed(s.r.detector, x2, interval.x1, &found));
            expect_ok(step_packed(reference.detector, x2, interval.x1, &truth));
            assert_int_equal(found.count, truth.count);
            step_on(s.line, interval.x0, interval.x1, 1.0);
            free_step_check(&reference, s.r.context, &call);
            cscd_status status = max_step_packed(s.r.detector, interval.x0, interval.x1, NULL, &ignored);
            assert_int_equal(status, call.status);
            expect_ok(step_packed(s.r.detector, interval.x0, x2, &found));
            expect_ok(step_packed(reference.detector, interval.x0, x2, &truth));
            assert_int_equal(found.count, truth.count);
        }
        cscd_line_search_destroy(second);
        rig_destroy(&reference);
        search_destroy(&s);
    }
    free(x2);
}

/* ---- arguments ----------------------------------------------------------------------------------------- */

TEST(misuse_is_named) {
    static const double bad[] = {-0x1p-1000, 1.0 + 0x1p-52, NAN, INFINITY, -1.0};
    scene_make(SCENE_SPIKE, 1, &interval);
    step_search s = search_create(CSCD_METHOD_NONE, 0.0, 1);
    cscd_proximities near = {.count = 4711};
    cscd_free_step step = {.fraction = -1.0};
    assert_int_equal(cscd_line_search_create(NULL, NULL), CSCD_NULL_OBJECT);
    expect_invalid(s.r.context, cscd_line_search_create(s.r.detector, NULL), "out is NULL");
    expect_invalid(s.r.context, cscd_line_search_find_near(s.line, 0.5, 0.1, CSCD_NEAR_PAIRS, &near),
                   "cscd_line_search_begin first");
    expect_invalid(s.r.context, line_max_step_packed(s.line, 1.0, NULL, &step),
                   "cscd_line_search_begin first");
    expect_invalid(s.r.context, line_positions_packed(s.line, 1.0, moment), "cscd_line_search_begin first");
    assert_int_equal(cscd_line_search_candidate_count(s.line), 0);
    expect_invalid(s.r.context, line_begin_packed(s.line, NULL, interval.x1, 0.1), "x0 is NULL");
    expect_invalid(s.r.context, line_begin_packed(s.line, interval.x0, NULL, 0.1), "x1 is NULL");
    begin_line(&s, interval.x0, interval.x1, 0.1);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        expect_invalid(s.r.context, cscd_line_search_find_near(s.line, bad[i], 0.1, CSCD_NEAR_PAIRS, &near),
                       "fraction is ");
        expect_invalid(s.r.context, line_max_step_packed(s.line, bad[i], NULL, &step), "longest is ");
        expect_invalid(s.r.context, line_positions_packed(s.line, bad[i], moment), "fraction is ");
        if (bad[i] < 1.0 || bad[i] > 2.0 || isnan(bad[i]))
            expect_invalid(s.r.context, line_begin_packed(s.line, interval.x0, interval.x1, bad[i]),
                           "reach is ");
    }
    expect_invalid(s.r.context, line_max_step_packed(s.line, 0.0, NULL, &step), "longest is 0");
    expect_invalid(s.r.context, line_max_step_packed(s.line, 1.0, NULL, NULL), "out is NULL");
    expect_invalid(s.r.context, cscd_line_search_find_near(s.line, 0.5, 0.1 + 1e-12, CSCD_NEAR_PAIRS, &near),
                   "reach of 0.1");
    expect_invalid(s.r.context, cscd_line_search_find_near(s.line, 0.5, 0.0, CSCD_NEAR_PAIRS, &near),
                   "distance is 0");
    expect_invalid(s.r.context, cscd_line_search_find_near(s.line, 0.5, 0.1, CSCD_NEAR_PAIRS, NULL),
                   "out is NULL");
    expect_invalid(s.r.context, line_positions_packed(s.line, 0.5, NULL), "positions is NULL");
    assert_true(near.count == 4711 && step.fraction == -1.0);
    expect_ok(cscd_line_search_find_near(s.line, 0.5, 0.1, CSCD_NEAR_PAIRS, &near));
    expect_ok(cscd_line_search_find_near(s.line, 0.5, 0.1, CSCD_NEAR_BEYOND, &near));
    expect_ok(cscd_detector_set_separation(s.r.detector, 0.05, 0.0));
    expect_ok(cscd_line_search_find_near(s.line, 0.5, 0.1, CSCD_NEAR_PAIRS, &near));
    expect_ok(cscd_line_search_find_near(s.line, 0.5, 0.05, CSCD_NEAR_BEYOND, &near));
    expect_invalid(s.r.context, cscd_line_search_find_near(s.line, 0.5, 0.1, CSCD_NEAR_BEYOND, &near),
                   "min_separation is 0.05");
    expect_ok(cscd_detector_set_separation(s.r.detector, 0.0, 0.0));
    begin_line(&s, interval.x0, interval.x1, 0.0);
    expect_invalid(s.r.context, cscd_line_search_find_near(s.line, 0.5, 0x1p-300, CSCD_NEAR_PAIRS, &near),
                   "reach of 0");
    search_destroy(&s);
    cscd_line_search_destroy(NULL);
}
