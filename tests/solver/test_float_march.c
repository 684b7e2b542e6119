/* A solver that stores floats marches on: what it stores is what was certified, and it goes as far as in doubles. */
#include "runtime/detector/detector.h"
#include "runtime/solver/solver.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Small bodies in a cage that does not move. */
enum { BODIES = 4, CORNERS = 4, CAGE = BODIES * CORNERS, VERTICES = CAGE + 8, TRIANGLES = BODIES * 4 + 12 };

static const double cage_size = 40.0, body_size = 8.0;

typedef struct cage_march {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector, *judge; /* the judge has no separation, and is brute force */
    cscd_scalar scalars[2];          /* of bodies and cage */
    double place;                    /* the least coordinate */
    double x0[VERTICES * 3], x1[VERTICES * 3];
} cage_march;

static const double body_shape[CORNERS][3] = {
    {0.1, 0.2, 0.0}, {1.0, 0.1, 0.2}, {0.3, 0.9, 0.1}, {0.4, 0.3, 0.8}};

static double stored_in(cscd_scalar scalar, double x) {
    return scalar == CSCD_SCALAR_FLOAT ? (double)(float)x : x;
}

static cscd_mesh *make_mesh(cscd_context *context) {
    static const uint32_t body[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    static const uint32_t cage[36] = {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                                      2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
    uint32_t bodies[BODIES * 12];
    for (uint32_t i = 0; i < BODIES * 12; i++) bodies[i] = body[i % 12] + i / 12 * CORNERS;
    cscd_object_desc objects[2] = {cscd_object_of_triangles(CAGE, BODIES * 4, bodies),
                                   cscd_object_of_triangles(8, 12, cage)};
    objects[1].obstacle = true;
    cscd_mesh *mesh = NULL;
    expect_ok(cscd_mesh_create(context, objects, 2, &mesh));
    return mesh;
}

/* Coordinates from `place` on, which floats can hold. */
static void place_all(cage_march *c) {
    for (int v = 0; v < CAGE; v++) {
        for (int k = 0; k < 3; k++) {
            double corner = (v / CORNERS >> (k % 2) & 1) * 16.0 + 6.0;
            c->x0[3 * v + k] = c->place + corner + body_size * body_shape[v % CORNERS][k];
        }
    }
    for (int v = 0; v < 8; v++) {
        for (int k = 0; k < 3; k++) c->x0[3 * (CAGE + v) + k] = c->place + cage_size * (v >> k & 1);
    }
    for (int i = 0; i < VERTICES * 3; i++) c->x0[i] = (double)(float)c->x0[i];
}

static void open_march(cage_march *c, double place, double distance, cscd_scalar scalar) {
    cscd_detector_options options = cscd_detector_defaults();
    *c = (cage_march){.place = place, .scalars = {scalar, scalar}};
    expect_ok(cscd_context_create(NULL, &c->context));
    c->mesh = make_mesh(c->context);
    options.method = CSCD_METHOD_BRUTE;
    expect_ok(detector_create_here(c->mesh, NULL, &options, &c->judge));
    options.method = CSCD_METHOD_AUTO;
    options.min_separation = distance;
    expect_ok(detector_create_here(c->mesh, NULL, &options, &c->detector));
    place_all(c);
}

static void close_march(cage_march *c) {
    cscd_detector_destroy(c->judge);
    cscd_detector_destroy(c->detector);
    cscd_mesh_destroy(c->mesh);
    cscd_context_destroy(c->context);
}

static const double tremble = 0.05;

/* Each body flies somewhere, trembles, and regains its shape, as far as the scalar holds it. */
static void aim_bodies(cage_march *c, random_stream *random) {
    memcpy(c->x1, c->x0, sizeof c->x1);
    for (int b = 0; b < BODIES; b++) {
        for (int k = 0; k < 3; k++) {
            double *x = c->x1 + 3 * (b * CORNERS) + k, mean = 0.0;
            for (int i = 0; i < CORNERS; i++) mean += (x[3 * i] - body_size * body_shape[i][k]) / CORNERS;
            mean += stream_between(random, -8.0, 8.0);
            for (int i = 0; i < CORNERS; i++) {
                double shape = body_size * body_shape[i][k] + tremble * stream_between(random, -1.0, 1.0);
                x[3 * i] = stored_in(c->scalars[0], mean + shape);
            }
        }
    }
}

typedef struct march_tally {
    double sum;
    uint32_t still, limited;
} march_tally;

static void check_stored(const cage_march *c, const double *reached) {
    for (int i = 0; i < VERTICES * 3; i++) assert_true(reached[i] == stored_in(c->scalars[0], reached[i]));
}

static march_tally march_on(cage_march *c, int steps, uint64_t seed) {
    random_stream random = stream_start(seed);
    march_tally sum = {.sum = 0.0};
    for (int i = 0; i < steps; i++) {
        cscd_free_step step;
        straight_motion m = {c->mesh, c->x0, c->x1, c->scalars};
        aim_bodies(c, &random);
        expect_ok(step_check_positions(c->detector, c->x0, c->x1));
        expect_ok(max_step_find(c->detector, &m, &step));
        const double *reached = c->detector->reached;
        check_stored(c, reached);
        assert_int_equal(step.moved, memcmp(reached, c->x0, sizeof c->x0) != 0);
        if (i % 16 == 0) {
            cscd_contacts found;
            expect_ok(step_packed(c->judge, c->x0, reached, &found));
            assert_int_equal(found.count, 0);
        }
        sum.sum += step.fraction;
        sum.still += !step.moved;
        sum.limited += step.limited;
        memcpy(c->x0, reached, sizeof c->x0);
    }
    return sum;
}

/* Floats are up to 2^-10 apart at 10,000, a hundredth of the gaps of 0.1 here. */
TEST(floats_go_as_far_as_doubles) {
    enum { STEPS = PACED(10000, 5000) };
    static const double places[] = {1.0, 100.0, 1000.0, 9900.0};
    static const double distances[] = {0.1, 0.0, 0.1, 0.1};
    for (int i = 0; i < 4; i++) {
        march_tally tally[2];
        for (int s = 0; s < 2; s++) {
            cage_march c;
            open_march(&c, places[i], distances[i], s == 0 ? CSCD_SCALAR_DOUBLE : CSCD_SCALAR_FLOAT);
            tally[s] = march_on(&c, STEPS, 17);
            close_march(&c);
        }
        print_message("  at %5g, d %g: mean %.4f in doubles, %.4f in floats; %u limited, %u still\n",
                      places[i], distances[i], tally[0].sum / STEPS, tally[1].sum / STEPS, tally[1].limited,
                      tally[1].still);
        assert_true(fabs(tally[1].sum / tally[0].sum - 1.0) < 0.05);
        assert_true(tally[1].limited > STEPS / 5);
    }
}

/* Views of one array of floats, and of another of doubles. */
typedef struct stored_views {
    float floats[VERTICES * 3];
    double doubles[VERTICES * 3];
    cscd_view views[2];
    cscd_mutable_view mutable[2];
} stored_views;

static void view_stored(const cage_march *c, const double *x, stored_views *out) {
    static const size_t begin[2] = {0, CAGE * 3}, end[2] = {CAGE * 3, VERTICES * 3};
    for (int i = 0; i < VERTICES * 3; i++) {
        out->floats[i] = (float)x[i];
        out->doubles[i] = x[i];
    }
    for (int o = 0; o < 2; o++) {
        bool in_floats = c->scalars[o] == CSCD_SCALAR_FLOAT;
        size_t size = in_floats ? sizeof(float) : sizeof(double), bytes = (end[o] - begin[o]) * size;
        void *data = in_floats ? (void *)(out->floats + begin[o]) : (void *)(out->doubles + begin[o]);
        out->views[o] = (cscd_view){.data = data, .size = bytes, .scalar = c->scalars[o], .object_count = 1};
        out->mutable[o] =
            (cscd_mutable_view){.data = data, .size = bytes, .scalar = c->scalars[o], .object_count = 1};
    }
}

static void read_stored(const cage_march *c, const stored_views *v, double *out) {
    for (int i = 0; i < VERTICES * 3; i++)
        out[i] = c->scalars[i >= CAGE * 3] == CSCD_SCALAR_FLOAT ? (double)v->floats[i] : v->doubles[i];
}

/* ---- lines --------------------------------------------------------------------------------------------- */

static void begin_line(const cage_march *c, cscd_line_search *line) {
    stored_views x0;
    view_stored(c, c->x0, &x0);
    const cscd_view x1 = cscd_view_doubles(c->x1, VERTICES);
    expect_ok(cscd_line_search_begin(line, x0.views, &x1, 0.0));
}

static cscd_free_step go_on_line(const cage_march *c, cscd_line_search *line, double *reached) {
    stored_views end;
    cscd_free_step step;
    view_stored(c, c->x0, &end);
    expect_ok(cscd_line_search_max_step(line, 1.0, end.mutable, &step));
    read_stored(c, &end, reached);
    return step;
}

/* One line search from where the bodies are: the step that it certifies, and all moments on it, in floats. */
static cscd_free_step step_on_line(cage_march *c, cscd_line_search *line, double *reached, double *at) {
    stored_views moment;
    cscd_contacts found;
    begin_line(c, line);
    cscd_free_step step = go_on_line(c, line, reached);
    check_stored(c, reached);
    view_stored(c, c->x0, &moment);
    expect_ok(cscd_line_search_positions(line, step.fraction, moment.mutable));
    read_stored(c, &moment, at);
    assert_memory_equal(reached, at, sizeof c->x0);
    expect_ok(step_packed(c->judge, c->x0, reached, &found));
    assert_int_equal(found.count, 0);
    return step;
}

/* At 2^22 floats are 0.5 apart. The bodies rise by 0.3, which is rounded to 0.5; the lid of the cage, in doubles, is 0.4
 * above them. No bounding volume of the line comes near it. */
TEST(rounding_reaches_beyond_the_line) {
    cage_march c;
    cscd_line_search *line = NULL;
    double reached[VERTICES * 3], top = 0.0;
    open_march(&c, 0x1p22, 0.0, CSCD_SCALAR_FLOAT);
    c.scalars[1] = CSCD_SCALAR_DOUBLE;
    for (int v = 0; v < CAGE; v++) top = fmax(top, c.x0[3 * v + 2]);
    for (int v = CAGE + 4; v < VERTICES; v++) c.x0[3 * v + 2] = top + 0.4;
    memcpy(c.x1, c.x0, sizeof c.x1);
    for (int v = 0; v < CAGE; v++) c.x1[3 * v + 2] += 0.3;
    expect_ok(cscd_line_search_create(c.detector, &line));
    begin_line(&c, line);
    cscd_free_step step = go_on_line(&c, line, reached);
    assert_true(step.limited && step.fraction < 1.0);
    for (int v = 0; v < CAGE; v++) assert_true(reached[3 * v + 2] <= top);
    cscd_line_search_destroy(line);
    close_march(&c);
}

/* Far from the origin floats are coarser than many a gap: what a line certifies is what is stored. */
TEST(lines_certify_floats) {
    enum { STEPS = 1000 };
    static const double places[] = {3e5, 4e6};
    for (int i = 0; i < 2; i++) {
        cage_march c;
        cscd_line_search *line = NULL;
        random_stream random = stream_start(3);
        double reached[VERTICES * 3], at[VERTICES * 3];
        uint32_t limited = 0;
        open_march(&c, places[i], 0.0, CSCD_SCALAR_FLOAT);
        expect_ok(cscd_line_search_create(c.detector, &line));
        for (int s = 0; s < STEPS; s++) {
            aim_bodies(&c, &random);
            limited += step_on_line(&c, line, reached, at).limited;
            memcpy(c.x0, reached, sizeof c.x0);
        }
        print_message("  at %g: %u of %d steps limited\n", places[i], limited, STEPS);
        assert_true(limited > STEPS / 4);
        cscd_line_search_destroy(line);
        close_march(&c);
    }
}

/* What does not fit into a float is refused, by name. */
TEST(overflow_is_refused) {
    cage_march c;
    cscd_free_step step;
    open_march(&c, 1.0, 0.0, CSCD_SCALAR_FLOAT);
    straight_motion m = {c.mesh, c.x0, c.x1, c.scalars};
    memcpy(c.x1, c.x0, sizeof c.x1);
    c.x1[7] = 2.0 * (double)FLT_MAX; /* a vertex of the bodies */
    expect_invalid(c.context, max_step_find(c.detector, &m, &step),
                   "x1: vertex 2 has y = 6.80565e+38, which is infinite");
    c.scalars[0] = CSCD_SCALAR_DOUBLE;
    expect_ok(max_step_find(c.detector, &m, &step));
    assert_true(step.limited && step.moved);
    close_march(&c);
}

/* Objects have their own scalars: only floats are rounded. */
TEST(each_object_has_its_scalar) {
    cage_march c;
    double at[VERTICES * 3];
    open_march(&c, 1.0, 0.0, CSCD_SCALAR_FLOAT);
    c.scalars[1] = CSCD_SCALAR_DOUBLE;
    straight_motion m = {c.mesh, c.x0, c.x1, c.scalars};
    for (int i = 0; i < VERTICES * 3; i++) c.x1[i] = c.x0[i] + 0.1;
    motion_at(&m, 0.3, at);
    for (int i = 0; i < VERTICES * 3; i++) {
        double exact = c.x0[i] + 0.3 * (c.x1[i] - c.x0[i]);
        assert_true(at[i] == (i < CAGE * 3 ? (double)(float)exact : exact));
    }
    assert_true(motion_rounding(&m) > 41.0 * 0x1p-22 && motion_rounding(&m) < 42.0 * 0x1p-22);
    m.scalars = NULL;
    assert_true(motion_rounding(&m) < 42.0 * 0x1p-47);
    close_march(&c);
}
