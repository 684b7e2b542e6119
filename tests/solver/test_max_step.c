/* Steps that are certified free of contact, by brute force and by marches of many steps. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/scenes.h"
#include "tests/support/solver/solver_rig.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene interval; /* large; one test at a time */
static sequence frames;
static free_step_call call;

/* How the detectors of a test are made. */
typedef struct setting {
    cscd_method method;
    cscd_mode mode;
    cscd_start start;
    double distance, step_factor;
    uint32_t threads;
} setting;

static const setting plain = {CSCD_METHOD_SINGLE, CSCD_MODE_ALL, CSCD_START_PROVE, 0.0, 0.8, 1};

static cscd_detector_options options_of(const setting *s) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = s->method;
    options.mode = s->mode;
    options.start = s->start;
    options.min_separation = s->distance;
    options.step_factor = s->step_factor;
    return options;
}

/* A detector with the plan that its method needs. */
typedef struct tested {
    rig r;
    cscd_plan *plan;
} tested;

static tested tested_create(const scene *s, const setting *chosen) {
    bool of_plan = chosen->method == CSCD_METHOD_KMEANS || chosen->method == CSCD_METHOD_CHARGE;
    cscd_detector_options options = options_of(chosen);
    if (of_plan) options.method = CSCD_METHOD_NONE;
    tested t = {rig_create(s, chosen->threads, &options), NULL};
    if (!of_plan) return t;
    cscd_plan_options plan_options = cscd_plan_defaults();
    plan_options.method = options.method = chosen->method;
    cscd_detector_destroy(t.r.detector);
    expect_ok(plan_create_packed(t.r.mesh, s->x0, &plan_options, &t.plan));
    expect_ok(detector_create_here(t.r.mesh, t.plan, &options, &t.r.detector));
    return t;
}

static void tested_destroy(tested *t) {
    cscd_detector_destroy(t->r.detector);
    cscd_plan_destroy(t->plan);
    t->r.detector = NULL;
    rig_destroy(&t->r);
}

static void step_from(const rig *r, const double *x0, const double *x1, const setting *s) {
    free_step_prepare(x0, x1, 1.0, s->step_factor, &call);
    call.status = max_step_packed(r->detector, x0, x1, call.end, &call.step);
}

static bool all_closed(const rig *r) {
    bool closed = true;
    for (uint32_t c = 0; c < cscd_mesh_component_count(r->mesh); c++)
        closed &= cscd_mesh_component(r->mesh, c).closed_manifold;
    return closed;
}

/* ---- one step ------------------------------------------------------------------------------------------ */

static bool is_culling(const setting *s) {
    bool by_orientation =
        s->method == CSCD_METHOD_SINGLE || s->method == CSCD_METHOD_KMEANS || s->method == CSCD_METHOD_CHARGE;
    return by_orientation && s->distance == 0.0;
}

/* Steps from the end of the certified step to x1: the detector knows the start, and finds the contacts
 * that brute force finds. */
static void check_next(const rig *r, const rig *reference, const setting *s, bool embedded) {
    cscd_contacts truth, found;
    expect_ok(step_packed(reference->detector, call.end, call.x1, &truth));
    expect_ok(step_packed(r->detector, call.end, call.x1, &found));
    cscd_counters counters = cscd_detector_counters(r->detector);
    if (embedded && is_culling(s)) {
        assert_int_equal(counters.static_checks, 0);
        if (all_closed(r)) assert_int_equal(counters.clean, cscd_mesh_triangle_count(r->mesh));
    }
    if (s->mode == CSCD_MODE_ALL) {
        assert_int_equal(found.count, truth.count);
        if (found.count > 0) assert_memory_equal(found.items, truth.items, found.count * sizeof *found.items);
    }
    assert_int_equal(found.count > 0, truth.count > 0);
}

typedef struct step_tally {
    size_t calls, in_contact, limited, whole, embedded;
} step_tally;

static void check_step(const setting *s, step_tally *sum) {
    tested t = tested_create(&interval, s);
    cscd_detector_options options = options_of(s);
    rig reference = free_step_reference(&interval, &options);
    bool embedded = free_step_embedded(&reference, interval.x0);
    step_from(&t.r, interval.x0, interval.x1, s);
    sum->calls++;
    if (free_step_check(&reference, t.r.context, &call)) {
        if (embedded) assert_true(free_step_embedded(&reference, call.end) || !all_closed(&t.r));
        sum->limited += call.step.limited;
        sum->whole += !call.step.limited;
        sum->embedded += embedded;
        check_next(&t.r, &reference, s, embedded);
    } else {
        sum->in_contact++;
        assert_false(embedded && s->distance == 0.0);
    }
    rig_destroy(&reference);
    tested_destroy(&t);
}

TEST(is_certified) {
    static const cscd_method methods[] = {CSCD_METHOD_SINGLE, CSCD_METHOD_NONE,  CSCD_METHOD_KMEANS,
                                          CSCD_METHOD_ICCD,   CSCD_METHOD_BRUTE, CSCD_METHOD_CHARGE};
    step_tally sum = {0};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 0; seed < 5; seed++) {
            scene_make((scene_family)family, seed, &interval);
            setting s = plain;
            s.method = method_or_none(methods[(seed + (uint64_t)family * 5) % 6]);
            if (s.method == CSCD_METHOD_CHARGE && seed > 0) s.method = CSCD_METHOD_SINGLE;
            s.mode = seed % 3 == 1 ? CSCD_MODE_EARLIEST : CSCD_MODE_ALL;
            s.threads = 1 + (uint32_t)(seed % 3);
            s.distance = seed % 4 == 3 ? 1e-3 : 0.0;
            s.step_factor = seed % 5 == 2 ? 0.95 : 0.8;
            check_step(&s, &sum);
        }
    }
    print_message("  %zu calls: %zu in contact, %zu limited, %zu whole; %zu embedded\n", sum.calls,
                  sum.in_contact, sum.limited, sum.whole, sum.embedded);
    assert_true(sum.limited > 10 && sum.whole > 20 && sum.in_contact > 1 && sum.embedded > 30);
}

/* ---- marches ------------------------------------------------------------------------------------------- */

/* Marches towards an end that cannot be reached until parts are a rounding error apart. */
static void march_to(const rig *r, const rig *reference, const setting *s, uint32_t steps, step_tally *sum) {
    static double x[SCENE_VERTICES_MAX * 3];
    size_t bytes = interval.vertex_count * sizeof(double[3]);
    memcpy(x, interval.x0, bytes);
    for (uint32_t i = 0; i < steps; i++) {
        step_from(r, x, interval.x1, s);
        sum->calls++;
        assert_true(free_step_check(reference, r->context, &call));
        cscd_counters counters = cscd_detector_counters(r->detector);
        if (i > 0 && is_culling(s)) assert_int_equal(counters.static_checks, 0);
        sum->limited += call.step.limited;
        sum->whole += !call.step.limited;
        sum->in_contact += memcmp(x, call.end, bytes) == 0;
        if (s->distance == 0.0 && all_closed(r)) assert_true(free_step_embedded(reference, call.end));
        memcpy(x, call.end, bytes);
    }
}

/* Returns whether closed surfaces start embedded, or apart, and end in contact. */
static bool starts_well(const rig *reference) {
    cscd_contacts found;
    expect_ok(step_packed(reference->detector, interval.x0, interval.x0, &found));
    if (found.count > 0 || !free_step_embedded(reference, interval.x0)) return false;
    expect_ok(step_packed(reference->detector, interval.x0, interval.x1, &found));
    return found.count > 0;
}

TEST(never_crosses_when_pressed) {
    static const double distances[] = {0.0, 0.0, 1e-3, 1e-7};
    step_tally sum = {0};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        uint32_t marches = 0;
        for (uint64_t seed = 100 + (uint64_t)family % 4; seed < 114 && marches < 1; seed++) {
            setting s = plain;
            scene_make((scene_family)family, seed, &interval);
            s.distance = distances[seed % 4];
            s.method = seed % 2 == 0 ? CSCD_METHOD_SINGLE : CSCD_METHOD_NONE;
            s.step_factor = seed % 3 == 0 ? 0.98 : 0.99;
            cscd_detector_options options = options_of(&s);
            rig reference = free_step_reference(&interval, &options);
            if (starts_well(&reference)) {
                rig r = rig_create(&interval, 1, &options);
                march_to(&r, &reference, &s, 14, &sum);
                rig_destroy(&r);
                marches++;
            }
            rig_destroy(&reference);
        }
    }
    print_message("  %zu steps, %zu limited, %zu to where they began\n", sum.calls, sum.limited,
                  sum.in_contact);
    assert_true(sum.limited > 60 && sum.in_contact > 2);
}

/* Marches to one pose after another, each step no longer than is free: hundreds of steps without an
 * intersection, and without a check after the first. */
static void march_through(uint64_t seed, const setting *s, step_tally *sum) {
    static double x[SCENE_VERTICES_MAX * 3];
    sequence_make(seed % 4 == 0 ? SEQUENCE_SCENE : SEQUENCE_GRID, seed, 24, &frames);
    size_t bytes = frames.shape.vertex_count * sizeof(double[3]);
    cscd_detector_options options = options_of(s);
    rig reference = free_step_reference(&frames.shape, &options);
    rig r = rig_create(&frames.shape, s->threads, &options);
    memcpy(x, frames.frames[0], bytes);
    bool embedded = free_step_embedded(&reference, x) && all_closed(&r);
    for (uint32_t f = 1; f < frames.frame_count; f++) {
        step_from(&r, x, frames.frames[f], s);
        sum->calls++;
        if (free_step_check(&reference, r.context, &call)) {
            if (embedded) assert_true(free_step_embedded(&reference, call.end));
            cscd_counters counters = cscd_detector_counters(r.detector);
            if (embedded && f > 1) assert_int_equal(counters.static_checks, 0);
            sum->limited += call.step.limited;
            memcpy(x, call.end, bytes);
        } else {
            assert_false(embedded);
            sum->in_contact++;
            memcpy(x, frames.frames[f], bytes);
            embedded = free_step_embedded(&reference, x) && all_closed(&r);
        }
        sum->embedded += embedded;
    }
    rig_destroy(&r);
    rig_destroy(&reference);
}

TEST(never_crosses_on_the_way) {
    step_tally sum = {0};
    for (uint64_t seed = 0; seed < 7; seed++) {
        setting s = plain;
        s.threads = 1 + (uint32_t)(seed % 2);
        march_through(seed, &s, &sum);
    }
    print_message("  %zu steps, %zu limited, %zu in contact, %zu embedded\n", sum.calls, sum.limited,
                  sum.in_contact, sum.embedded);
    assert_true(sum.limited > 40 && sum.embedded > 60);
}

/* ---- arguments and guarantees ------------------------------------------------------------------------- */

/* Makes a spike that goes through the far wall. */
static void make_limited(void) {
    for (uint64_t seed = 1;; seed++) {
        scene_make(SCENE_SPIKE, seed, &interval);
        rig r = rig_create(&interval, 1, NULL);
        size_t count = rig_step(&r, &interval).count;
        rig_destroy(&r);
        if (count > 0) return;
    }
}

TEST(end_may_be_nowhere_or_an_argument) {
    make_limited();
    cscd_detector_options options = options_of(&plain);
    rig r = rig_create(&interval, 1, &options);
    static double x0[SCENE_VERTICES_MAX * 3], x1[SCENE_VERTICES_MAX * 3];
    size_t bytes = interval.vertex_count * sizeof(double[3]);
    step_from(&r, interval.x0, interval.x1, &plain);
    expect_ok(call.status);
    assert_true(call.step.limited);
    cscd_free_step nowhere, into_x1, into_x0;
    expect_ok(max_step_packed(r.detector, interval.x0, interval.x1, NULL, &nowhere));
    memcpy(x0, interval.x0, bytes);
    memcpy(x1, interval.x1, bytes);
    expect_ok(max_step_packed(r.detector, x0, x1, x1, &into_x1));
    assert_memory_equal(x1, call.end, bytes);
    expect_ok(max_step_packed(r.detector, x0, interval.x1, x0, &into_x0));
    assert_memory_equal(x0, call.end, bytes);
    assert_true(nowhere.fraction == call.step.fraction && into_x1.fraction == call.step.fraction &&
                into_x0.fraction == call.step.fraction);
    step_from(&r, x0, x0, &plain);
    expect_ok(call.status);
    assert_true(call.step.fraction == 1.0 && !call.step.limited);
    rig_destroy(&r);
}

/* A limited step tries the whole motion, and then a shorter one: its counters are the sums of both. */
TEST(counters_are_of_all_tries) {
    make_limited();
    cscd_detector_options options = options_of(&plain);
    options.mode = CSCD_MODE_EARLIEST;
    rig r = rig_create(&interval, 1, &options), other = rig_create(&interval, 1, &options);
    cscd_contacts found;
    step_from(&r, interval.x0, interval.x1, &plain);
    assert_true(call.status == CSCD_OK && call.step.limited);
    cscd_counters sums = cscd_detector_counters(r.detector);
    expect_ok(step_packed(other.detector, interval.x0, call.end, &found));
    cscd_counters last = cscd_detector_counters(other.detector);
    assert_true(sums.boxes_tested > last.boxes_tested && sums.feature_pairs > last.feature_pairs);
    rig_destroy(&other);
    rig_destroy(&r);
}

TEST(step_factor_is_honoured) {
    static const double factors[] = {0x1p-20, 0.1, 0.5, 0.8, 0.99, 1.0 - 0x1p-53};
    make_limited();
    for (size_t i = 0; i < sizeof factors / sizeof *factors; i++) {
        setting s = plain;
        s.step_factor = factors[i];
        cscd_detector_options options = options_of(&s);
        rig r = rig_create(&interval, 1, &options);
        step_from(&r, interval.x0, interval.x1, &s);
        expect_ok(call.status);
        assert_true(call.step.fraction <= factors[i] * call.step.limit.toi);
        if (i + 1 < sizeof factors / sizeof *factors)
            assert_true(call.step.fraction == factors[i] * call.step.limit.toi);
        rig_destroy(&r);
    }
}

static void expect_refused(const rig *r, const double *x0, const double *x1, cscd_free_step *out,
                           const char *words) {
    expect_invalid(r->context, max_step_packed(r->detector, x0, x1, call.end, out), words);
}

TEST(bad_arguments_are_named) {
    static double bad[SCENE_VERTICES_MAX * 3];
    cscd_free_step out = {.fraction = -1.0};
    make_limited();
    memcpy(bad, interval.x0, sizeof bad);
    bad[4] = NAN;
    rig r = rig_create(&interval, 1, NULL);
    assert_int_equal(max_step_packed(NULL, interval.x0, interval.x1, NULL, &out), CSCD_NULL_OBJECT);
    expect_refused(&r, NULL, interval.x1, &out, "x0 is NULL");
    expect_refused(&r, interval.x0, NULL, &out, "x1 is NULL");
    expect_refused(&r, interval.x0, interval.x1, NULL, "out is NULL");
    expect_refused(&r, bad, interval.x1, &out, "x0: vertex 1 has y");
    expect_refused(&r, interval.x0, bad, &out, "x1: vertex 1 has y");
    rig_destroy(&r);
    assert_true(out.fraction == -1.0);
}
