/* What cscd_detector_untangle promises, on random scenes and on small ones. */
#include "tests/support/calls.h"
#include "tests/support/intersections/answer_lists.h"
#include "tests/support/scenes.h"

#include <math.h>
#include <stdlib.h>

/* One mesh with one detector, and what was found. */
typedef struct tangle_rig {
    scene shape;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector, *judge;
    cscd_untangle_options options;
    cscd_untangled found;
    double reached[SCENE_VERTICES_MAX * 3];
} tangle_rig;

static void open_with(tangle_rig *r, const cscd_context_options *host, const cscd_detector_options *options) {
    const cscd_object_desc object =
        cscd_object_of_triangles(r->shape.vertex_count, r->shape.triangle_count, r->shape.triangles);
    expect_ok(cscd_context_create(host, &r->context));
    expect_ok(cscd_mesh_create(r->context, &object, 1, &r->mesh));
    expect_ok(detector_create_here(r->mesh, NULL, options, &r->detector));
    expect_ok(detector_create_here(r->mesh, NULL, NULL, &r->judge));
    r->options = cscd_untangle_defaults();
}

static void close_rig(tangle_rig *r) {
    cscd_detector_destroy(r->judge);
    cscd_detector_destroy(r->detector);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    free(r);
}

static tangle_rig *make_rig(scene_family family, uint64_t seed) {
    tangle_rig *r = calloc(1, sizeof *r);
    scene_make(family, seed, &r->shape);
    open_with(r, NULL, NULL);
    return r;
}

static cscd_status untangle_at(tangle_rig *r, const double *x) {
    const uint32_t n = r->shape.vertex_count;
    return cscd_detector_untangle(r->detector, CSCD_DOUBLES(x, n), &r->options,
                                  CSCD_MUTABLE_DOUBLES(r->reached, n), &r->found);
}

/* By another detector, and by trying each pair. */
static size_t count_pairs(tangle_rig *r, const double *x) {
    cscd_intersections found;
    static scene copy;
    copy = r->shape;
    memcpy(copy.x0, x, r->shape.vertex_count * sizeof(double[3]));
    expect_ok(find_intersections_packed(r->judge, x, NULL, &found));
    if (r->shape.triangle_count <= 200) compare_with_each_pair(&copy, &found);
    return found.count;
}

static void expect_promises(tangle_rig *r, const double *x) {
    const size_t size = r->shape.vertex_count * sizeof(double[3]);
    const bool same = memcmp(x, r->reached, size) == 0;
    const size_t before = count_pairs(r, x), after = count_pairs(r, r->reached);
    assert_int_equal(r->found.pairs_before, before);
    assert_int_equal(r->found.pairs_after, after);
    assert_true(r->found.moved == !same);
    assert_true(same || after < before);
    assert_true(r->found.clean == (after == 0));
    assert_true(r->found.moved_vertices > 0 || same);
}

/* ---- random scenes ------------------------------------------------------------------------------------- */

TEST(results_keep_their_promises) {
    size_t clean = 0, tangled = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 1; seed <= NIGHTLY(PACED(4, 1), 200); seed++) {
            tangle_rig *r = make_rig((scene_family)family, seed);
            r->options.max_rounds = PACED(30, 10);
            for (int end = 0; end < 2; end++) {
                const double *x = end == 0 ? r->shape.x0 : r->shape.x1;
                expect_ok(untangle_at(r, x));
                expect_promises(r, x);
                tangled += r->found.pairs_before > 0;
                clean += r->found.pairs_before > 0 && r->found.clean;
            }
            close_rig(r);
        }
    }
    assert_true(tangled > 0 && 2 * clean > tangled); /* soups and grids are among them */
}

/* From a clean start the result is clean, however the positions are. */
TEST(clean_starts_give_clean_results) {
    size_t followed = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 1; seed <= NIGHTLY(PACED(4, 1), 200); seed++) {
            tangle_rig *r = make_rig((scene_family)family, seed);
            const uint32_t n = r->shape.vertex_count;
            if (count_pairs(r, r->shape.x0) == 0) {
                r->options.start = CSCD_DOUBLES(r->shape.x0, n);
                r->options.start_input = r->options.start;
                r->options.steady = 0.5;
                expect_ok(untangle_at(r, r->shape.x1));
                expect_promises(r, r->shape.x1);
                assert_true(r->found.clean);
                assert_true(r->found.start ==
                            (r->found.pairs_before > 0 ? CSCD_UNTANGLE_GIVEN : CSCD_UNTANGLE_NO_START));
                followed += r->found.pairs_before > 0;
            }
            close_rig(r);
        }
    }
    assert_true(followed > 0);
}

/* ---- two spheres --------------------------------------------------------------------------------------- */

/* Two spheres of radius 1 that are a length in each other. */
static tangle_rig *make_spheres(double depth, const cscd_context_options *host,
                                const cscd_detector_options *options) {
    tangle_rig *r = calloc(1, sizeof *r);
    scene_clear(&r->shape);
    scene_add_sphere(&r->shape, (const double[]){0.0, 0.0, 0.0}, 1.0, 10, 14);
    scene_add_sphere(&r->shape, (const double[]){2.0 - depth, 0.1, 0.05}, 1.0, 10, 14);
    open_with(r, host, options);
    return r;
}

TEST(spheres_part_by_half_of_their_depth) {
    tangle_rig *r = make_spheres(0.3, NULL, NULL);
    expect_ok(untangle_at(r, r->shape.x0));
    expect_promises(r, r->shape.x0);
    assert_true(r->found.clean && r->found.start == CSCD_UNTANGLE_PUSHED);
    assert_true(r->found.thickness > 0.2 && r->found.thickness < 0.4);
    assert_true(r->found.displacement > 0.5 * r->found.thickness &&
                r->found.displacement < 0.8 * r->found.thickness);
    close_rig(r);
}

TEST(gaps_are_kept) {
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = 0.05;
    for (int i = 0; i < 3; i++) { /* the last ones do not touch, and are too near */
        tangle_rig *r = make_spheres((const double[]){0.3, 0.0, -0.02}[i], NULL, &options);
        cscd_proximities near;
        expect_ok(untangle_at(r, r->shape.x0));
        assert_true(r->found.clean && r->found.near_after == 0);
        assert_int_equal(count_pairs(r, r->reached), 0);
        expect_ok(find_near_packed(r->judge, r->reached, 0.05 * (1.0 - 1e-6), &near));
        assert_int_equal(near.count, 0);
        close_rig(r);
    }
}

TEST(pinned_vertices_do_not_move) {
    tangle_rig *r = make_spheres(0.3, NULL, NULL);
    static double weights[SCENE_VERTICES_MAX];
    const uint32_t n = r->shape.vertex_count, half = n / 2;
    for (uint32_t v = 0; v < n; v++) weights[v] = v < half ? (double)INFINITY : 2.0;
    r->options.weights = weights;
    expect_ok(untangle_at(r, r->shape.x0));
    assert_true(r->found.clean);
    assert_memory_equal(r->reached, r->shape.x0, half * sizeof(double[3]));
    assert_true(r->found.displacement > 0.9 * r->found.thickness); /* one of the two goes all the way */
    for (uint32_t v = 0; v < n; v++) weights[v] = (double)INFINITY;
    expect_ok(untangle_at(r, r->shape.x0));
    expect_promises(r, r->shape.x0);
    assert_true(!r->found.clean && !r->found.moved);
    close_rig(r);
}

TEST(floats_are_clean_as_stored) {
    tangle_rig *r = make_spheres(0.3, NULL, NULL);
    static float x[SCENE_VERTICES_MAX * 3], reached[SCENE_VERTICES_MAX * 3];
    static double stored[SCENE_VERTICES_MAX * 3];
    const uint32_t n = r->shape.vertex_count;
    for (size_t i = 0; i < 3 * (size_t)n; i++) x[i] = (float)r->shape.x0[i];
    expect_ok(cscd_detector_untangle(r->detector, CSCD_FLOATS(x, n), &r->options,
                                     CSCD_MUTABLE_FLOATS(reached, n), &r->found));
    for (size_t i = 0; i < 3 * (size_t)n; i++) stored[i] = (double)reached[i];
    assert_true(r->found.clean);
    assert_int_equal(count_pairs(r, stored), 0);
    expect_invalid(r->context,
                   cscd_detector_untangle(r->detector, CSCD_DOUBLES(r->shape.x0, n), NULL,
                                          CSCD_MUTABLE_FLOATS(reached, n), &r->found),
                   "doubles");
    close_rig(r);
}

/* The pole of a sphere is pushed in so far that it comes out on the other side: there the body winds -1 times around it. */
TEST(folds_open) {
    tangle_rig *r = calloc(1, sizeof *r);
    scene_clear(&r->shape);
    scene_add_sphere(&r->shape, (const double[]){0.0, 0.0, 0.0}, 1.0, 16, 20);
    for (uint32_t v = 0; v < r->shape.vertex_count; v++) {
        double *x = r->shape.x0 + 3 * (size_t)v;
        if (x[2] > 0.6) x[2] -= 6.5 * (x[2] - 0.6);
    }
    open_with(r, NULL, NULL);
    expect_ok(untangle_at(r, r->shape.x0));
    expect_promises(r, r->shape.x0);
    assert_true(r->found.pairs_before > 0 && r->found.clean);
    close_rig(r);
}

/* A curve from the border of one strip to the border of the other divides neither. */
TEST(crossed_strips_part) {
    tangle_rig *r = calloc(1, sizeof *r);
    scene_clear(&r->shape);
    scene_add_sheet(&r->shape, 2.5, 2.0, 11, 9);
    const uint32_t first = r->shape.vertex_count;
    scene_add_sheet(&r->shape, 2.5, 2.0, 11, 9);
    double middle[2][3] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    for (uint32_t v = 0; v < r->shape.vertex_count; v++) {
        for (size_t k = 0; k < 3; k++) middle[v >= first][k] += r->shape.x0[3 * (size_t)v + k] / first;
    }
    for (uint32_t v = 0; v < r->shape.vertex_count; v++) {
        double *x = r->shape.x0 + 3 * (size_t)v, from[3];
        for (size_t k = 0; k < 3; k++) from[k] = x[k] - middle[v >= first][k];
        x[0] = from[0] + (v < first ? -0.75 : 0.77);
        x[1] = v < first ? from[1] : from[2] + 0.013;
        x[2] = v < first ? from[2] : from[1] + 0.017;
    }
    open_with(r, NULL, NULL);
    expect_ok(untangle_at(r, r->shape.x0));
    expect_promises(r, r->shape.x0);
    assert_true(r->found.pairs_before > 0 && r->found.clean);
    assert_true(r->found.start == CSCD_UNTANGLE_PUSHED); /* shrinking would part them, too */
    close_rig(r);
}

/* ---- the elastic energy -------------------------------------------------------------------------------- */

/* A long sheet, and a sphere in one of its ends. */
TEST(vertices_far_away_stay_bit_for_bit) {
    tangle_rig *r = calloc(1, sizeof *r);
    scene_clear(&r->shape);
    scene_add_sheet(&r->shape, 20.0, 2.0, 61, 7);
    const uint32_t n = r->shape.vertex_count;
    double end[3] = {(double)INFINITY, 0.0, 0.0}, longest = 0.0;
    for (uint32_t v = 0; v < n; v++) {
        if (r->shape.x0[3 * v] < end[0]) memcpy(end, r->shape.x0 + 3 * v, sizeof end);
    }
    scene_add_sphere(&r->shape, (const double[]){end[0] + 1.4, end[1] + 1.0, end[2] + 0.45}, 0.5, 10, 14);
    open_with(r, NULL, NULL);
    expect_ok(untangle_at(r, r->shape.x0));
    expect_promises(r, r->shape.x0);
    assert_true(r->found.pairs_before > 0 && r->found.clean);
    size_t moved = 0;
    double shortest = 1.0;
    for (uint32_t v = 0; v < n; v++) {
        const double *from = r->shape.x0 + 3 * v, *to = r->reached + 3 * v;
        const double way =
            sqrt(pow(to[0] - from[0], 2.0) + pow(to[1] - from[1], 2.0) + pow(to[2] - from[2], 2.0));
        longest = fmax(longest, way);
        moved += way > 0.0;
        if (way > 0.0) shortest = fmin(shortest, way);
        if (from[0] > end[0] + 15.0) assert_memory_equal(from, to, sizeof(double[3]));
    }
    assert_true(moved > 0 && longest > 0.01 && shortest > 0.005 * longest);
    close_rig(r);
}

/* The sum over vertices of the square of the sum of differences to neighbours: how displacements bend. */
static double bending_of(const tangle_rig *r) {
    static double sums[SCENE_VERTICES_MAX * 3];
    double total = 0.0;
    memset(sums, 0, sizeof sums);
    for (uint32_t t = 0; t < r->shape.triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            const size_t a = 3 * (size_t)r->shape.triangles[3 * t + (uint32_t)k],
                         b = 3 * (size_t)r->shape.triangles[3 * t + (uint32_t)((k + 1) % 3)];
            for (size_t i = 0; i < 3; i++)
                sums[a + i] +=
                    (r->reached[a + i] - r->shape.x0[a + i]) - (r->reached[b + i] - r->shape.x0[b + i]);
        }
    }
    for (size_t i = 0; i < 3 * (size_t)r->shape.vertex_count; i++) total += sums[i] * sums[i];
    return total;
}

TEST(bending_makes_displacements_smoother) {
    tangle_rig *r = make_spheres(0.3, NULL, NULL);
    expect_ok(untangle_at(r, r->shape.x0));
    const double before = bending_of(r);
    r->options.bending = 0.5;
    expect_ok(untangle_at(r, r->shape.x0));
    expect_promises(r, r->shape.x0);
    assert_true(r->found.clean);
    assert_true(bending_of(r) < 0.7 * before);
    close_rig(r);
}

/* How much the edges of a result differ from those of a shape. */
static double stretch_of(const tangle_rig *r, const double *rest) {
    double total = 0.0;
    for (uint32_t t = 0; t < r->shape.triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            const size_t a = 3 * (size_t)r->shape.triangles[3 * t + (uint32_t)k],
                         b = 3 * (size_t)r->shape.triangles[3 * t + (uint32_t)((k + 1) % 3)];
            double is = 0.0, was = 0.0;
            for (size_t i = 0; i < 3; i++) {
                is += pow(r->reached[a + i] - r->reached[b + i], 2.0);
                was += pow(rest[a + i] - rest[b + i], 2.0);
            }
            total += pow(sqrt(is) - sqrt(was), 2.0);
        }
    }
    return total;
}

/* A rest shape that is the input in another place changes nothing; where the input is squeezed, results stretch again. */
TEST(rest_shapes_give_back_lengths) {
    tangle_rig *r = make_spheres(0.3, NULL, NULL);
    static double rest[SCENE_VERTICES_MAX * 3], plain[SCENE_VERTICES_MAX * 3];
    const uint32_t n = r->shape.vertex_count;
    double *x = r->shape.x0;
    expect_ok(untangle_at(r, x));
    memcpy(plain, r->reached, sizeof plain);
    for (size_t v = 0; v < n; v++) { /* turned by a half around z and moved */
        rest[3 * v] = 5.0 - x[3 * v];
        rest[3 * v + 1] = -2.0 - x[3 * v + 1];
        rest[3 * v + 2] = x[3 * v + 2] + 1.0;
    }
    r->options.rest = CSCD_DOUBLES(rest, n);
    expect_ok(untangle_at(r, x));
    for (size_t i = 0; i < 3 * (size_t)n; i++) assert_true(fabs(r->reached[i] - plain[i]) < 1e-6);
    for (size_t v = 0; v < n / 2; v++) {
        if (x[3 * v] > 0.5) x[3 * v + 1] *= 0.6;
    }
    expect_ok(untangle_at(r, x));
    expect_promises(r, x);
    assert_true(r->found.clean);
    const double drawn = stretch_of(r, rest);
    r->options.rest = NULL;
    expect_ok(untangle_at(r, x));
    assert_true(r->found.clean);
    assert_true(drawn < 0.5 * stretch_of(r, rest));
    close_rig(r);
}

/* ---- the host ------------------------------------------------------------------------------------------ */

typedef struct stage_log {
    int calls, cancel_at;
    double last;
} stage_log;

static bool note_stage(void *user, const char *stage, double fraction) {
    stage_log *log = user;
    assert_true(strlen(stage) > 0 && fraction >= log->last && fraction <= 1.0);
    log->last = fraction;
    return ++log->calls != log->cancel_at;
}

TEST(what_is_cancelled_is_the_best_so_far) {
    stage_log log = {.cancel_at = 0};
    cscd_context_options host = cscd_context_defaults();
    host.progress = (cscd_progress){.user = &log, .report = note_stage};
    tangle_rig *r = make_spheres(0.3, &host, NULL);
    expect_ok(untangle_at(r, r->shape.x0));
    const int calls = log.calls;
    for (int at = 1; at <= calls && at < 20; at++) {
        double before[3];
        memcpy(before, r->reached, sizeof before);
        log = (stage_log){.cancel_at = at};
        const cscd_status status = untangle_at(r, r->shape.x0);
        log = (stage_log){.cancel_at = 0}; /* not even what checks the result */
        if (status == CSCD_CANCELLED) {    /* on a slow machine, before the pairs were counted */
            assert_memory_equal(before, r->reached, sizeof before);
            continue;
        }
        expect_ok(status);
        expect_promises(r, r->shape.x0);
    }
    close_rig(r);
}

TEST(no_time_gives_the_input) {
    tangle_rig *r = make_spheres(0.3, NULL, NULL);
    r->options.max_seconds = 0.0;
    expect_ok(untangle_at(r, r->shape.x0));
    expect_promises(r, r->shape.x0);
    assert_true(r->found.stopped && !r->found.moved);
    close_rig(r);
}

/* ---- misuse -------------------------------------------------------------------------------------------- */

static void expect_refused(tangle_rig *r, const char *words) {
    expect_invalid(r->context, untangle_at(r, r->shape.x0), words);
    r->options = cscd_untangle_defaults();
}

TEST(wrong_options_are_refused) {
    tangle_rig *r = make_spheres(0.3, NULL, NULL);
    static double weights[SCENE_VERTICES_MAX];
    const uint32_t n = r->shape.vertex_count;
    r->options.weights = weights;
    expect_refused(r, "weights[0] is 0");
    r->options.steady = 1.0;
    expect_refused(r, "steady");
    r->options.spread = -1.0;
    expect_refused(r, "spread");
    r->options.bending = (double)INFINITY;
    expect_refused(r, "bending");
    r->options.rest = CSCD_DOUBLES(NULL, n);
    expect_refused(r, "rest");
    r->options.max_seconds = (double)NAN;
    expect_refused(r, "max_seconds");
    r->options.start_input = CSCD_DOUBLES(r->shape.x0, n);
    expect_refused(r, "start");
    r->options.start = CSCD_DOUBLES(r->shape.x0, n);
    expect_refused(r, "start is not clean");
    close_rig(r);
}
