/* The stages of untangling, one by one: pushing, shrinking, approaching, descending, shortening curves; and what the host is told. */
#include "runtime/untangle/untangle.h"
#include "tests/support/calls.h"
#include "tests/support/scenes.h"

#include <math.h>
#include <stdlib.h>

/* One object, and what a stage begins with. */
typedef struct stage_rig {
    scene shape;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    untangle_work w;
    double weights[SCENE_VERTICES_MAX];
    double x[SCENE_VERTICES_MAX * 3], goal[SCENE_VERTICES_MAX * 3], reached[SCENE_VERTICES_MAX * 3];
    double side[SCENE_VERTICES_MAX * 3], inverse_masses[SCENE_VERTICES_MAX];
} stage_rig;

static stage_rig *rig_begin(void) {
    stage_rig *r = calloc(1, sizeof *r);
    assert_non_null(r);
    scene_clear(&r->shape);
    for (size_t v = 0; v < SCENE_VERTICES_MAX; v++) r->weights[v] = 1.0;
    return r;
}

static void rig_open(stage_rig *r, const cscd_context_options *host, const cscd_detector_options *options) {
    const cscd_object_desc object =
        cscd_object_of_triangles(r->shape.vertex_count, r->shape.triangle_count, r->shape.triangles);
    expect_ok(cscd_context_create(host, &r->context));
    expect_ok(cscd_mesh_create(r->context, &object, 1, &r->mesh));
    expect_ok(detector_create_here(r->mesh, NULL, options, &r->detector));
    r->w = (untangle_work){.detector = r->detector,
                           .context = r->context,
                           .mesh = r->mesh,
                           .options = cscd_untangle_defaults(),
                           .input = r->shape.x0,
                           .goal = r->goal,
                           .system = {.context = r->context},
                           .right_side = r->side,
                           .inverse_masses = r->inverse_masses,
                           .reached = r->reached,
                           .until_ms = (double)INFINITY,
                           .stage_end = 1.0};
    const graph_source source = {.positions = r->shape.x0, .weights = r->weights};
    expect_ok(vertex_graph_make(&r->w.graph, r->context, r->mesh, &source));
    assert_true(vertex_region_make(&r->w.region, &r->w.graph));
    expect_ok(energy_create(r->context, r->mesh, &r->w.energy));
    memcpy(r->x, r->shape.x0, sizeof r->x);
    memcpy(r->goal, r->shape.x0, sizeof r->goal);
    for (uint32_t v = 0; v < r->shape.vertex_count; v++)
        r->inverse_masses[v] = r->w.graph.fixed[v] ? 0.0 : 1.0;
}

static void rig_close(stage_rig *r) {
    vertex_graph_free(&r->w.graph);
    vertex_region_free(&r->w.region, r->context);
    block_system_free(&r->w.system);
    cscd_energy_destroy(r->w.energy);
    cscd_detector_destroy(r->detector);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
    free(r);
}

static void add_spheres(stage_rig *r, double distance) {
    scene_add_sphere(&r->shape, (const double[]){0.0, 0.0, 0.0}, 1.0, 8, 12);
    scene_add_sphere(&r->shape, (const double[]){distance, 0.1, 0.05}, 1.0, 8, 12);
}

static size_t pairs_at(stage_rig *r, const double *x) {
    tangle_count count;
    expect_ok(work_count(&r->w, x, &count));
    return count.pairs;
}

static double squared_way(const stage_rig *r, const double *to) {
    double sum = 0.0;
    for (size_t k = 0; k < 3 * (size_t)r->shape.vertex_count; k++) sum += pow(r->x[k] - to[k], 2.0);
    return sum;
}

/* ---- pushing --------------------------------------------------------------------------------------------- */

/* However many rounds there are, what is given back are the best positions that were met, and how many pairs they have. */
TEST(pushing_gives_the_fewest_pairs) {
    static const push_rules rules = {30.0, 0.02, 2.0, false};
    size_t before = SIZE_MAX;
    for (uint32_t rounds = 0; rounds < 12; rounds++) {
        stage_rig *r = rig_begin();
        add_spheres(r, 1.2);
        rig_open(r, NULL, NULL);
        r->w.options.max_rounds = rounds;
        size_t left;
        expect_ok(push_out(&r->w, &rules, r->x, &left));
        assert_int_equal(left, pairs_at(r, r->x));
        assert_true(left <= before);
        assert_true(rounds > 0 || left == pairs_at(r, r->shape.x0));
        assert_true(r->w.found.rounds <= rounds);
        before = left;
        rig_close(r);
    }
    assert_int_equal(before, 0);
}

/* Where rounds do not help, the last one is not the best. */
TEST(pushing_gives_back_the_best_round) {
    static const push_rules rules = {1000.0, 1.0, 3.0, true};
    size_t tangled = 0;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        stage_rig *r = rig_begin();
        scene_make(SCENE_SOUP, seed, &r->shape);
        rig_open(r, NULL, NULL);
        size_t left;
        r->w.options.max_rounds = 6;
        expect_ok(push_out(&r->w, &rules, r->x, &left));
        assert_int_equal(left, pairs_at(r, r->x));
        assert_true(left <= pairs_at(r, r->shape.x0));
        tangled += left > 0;
        rig_close(r);
    }
    assert_true(tangled > 0);
}

/* Without memory for one thing or the other, no round goes on. */
TEST(pushing_ends_where_memory_does) {
    static const push_rules rules = {30.0, 0.02, 2.0, false};
    size_t failed = 0;
    for (bool ended = false; !ended; failed += !ended) {
        counting_allocator counter = counting_allocator_start();
        cscd_context_options host = cscd_context_defaults();
        host.allocator = counting_allocator_interface(&counter);
        stage_rig *r = rig_begin();
        add_spheres(r, 1.7);
        rig_open(r, &host, NULL);
        r->w.options.max_rounds = 1;
        size_t left;
        counter.fail_at = counter.calls + failed;
        const cscd_status status = push_out(&r->w, &rules, r->x, &left);
        ended = counter.calls <= counter.fail_at;
        assert_int_equal(status, ended ? CSCD_OK : CSCD_OUT_OF_MEMORY);
        rig_close(r);
        assert_int_equal(counter.live, 0);
    }
    assert_true(failed > 20);
}

/* ---- shrinking ------------------------------------------------------------------------------------------- */

/* Bodies shrink around their middles, as little as is enough. */
TEST(bodies_shrink_around_their_middles) {
    stage_rig *r = rig_begin();
    add_spheres(r, 1.7);
    rig_open(r, NULL, NULL);
    const uint32_t n = r->shape.vertex_count, half = n / 2;
    bool clean;
    expect_ok(shrink_apart(&r->w, r->x, &clean));
    assert_true(clean);
    assert_int_equal(pairs_at(r, r->x), 0);
    for (uint32_t v = 0; v < n; v++) { /* a sphere of 0.8 */
        for (size_t k = 0; k < 3; k++) {
            const double centre = v < half ? 0.0 : (const double[]){1.7, 0.1, 0.05}[k];
            const double way = r->x[3 * (size_t)v + k] - centre,
                         from = r->shape.x0[3 * (size_t)v + k] - centre;
            assert_true(fabs(way - 0.8 * from) < 1e-9);
        }
    }
    rig_close(r);
}

/* What is pinned does not shrink; two pinned bodies, or one that crosses itself, are left. */
TEST(shrinking_keeps_what_is_pinned) {
    for (int pinned = 1; pinned <= 2; pinned++) {
        stage_rig *r = rig_begin();
        add_spheres(r, 1.7);
        const uint32_t n = r->shape.vertex_count, half = n / 2;
        for (int i = 0; i < pinned; i++) r->weights[(uint32_t)i * half] = (double)INFINITY;
        rig_open(r, NULL, NULL);
        bool clean;
        expect_ok(shrink_apart(&r->w, r->x, &clean));
        assert_true(clean == (pinned == 1));
        assert_memory_equal(r->x, r->shape.x0, (pinned == 1 ? half : n) * sizeof(double[3]));
        rig_close(r);
    }
}

/* ---- approaching and descending -------------------------------------------------------------------------- */

/* Nothing is in the way: one motion leads to the goal. Something is: the result is clean, and nearer to it. */
TEST(approaches_end_clean_and_nearer) {
    for (int blocked = 0; blocked < 2; blocked++) {
        stage_rig *r = rig_begin();
        add_spheres(r, blocked ? 1.7 : 2.5);
        rig_open(r, NULL, NULL);
        for (uint32_t v = r->shape.vertex_count / 2; v < r->shape.vertex_count; v++) {
            r->x[3 * (size_t)v] += 2.0;
            r->x[3 * (size_t)v + 1] += 1.0;
        }
        const double before = squared_way(r, r->goal);
        expect_ok(approach_goal(&r->w, r->x));
        assert_int_equal(pairs_at(r, r->x), 0);
        if (blocked)
            assert_true(squared_way(r, r->goal) < 0.05 * before && squared_way(r, r->goal) > 0.0);
        else
            assert_memory_equal(r->x, r->goal, r->shape.vertex_count * sizeof(double[3]));
        rig_close(r);
    }
}

/* From a rough start, far away and clean, a descent leads nearer to the goal, and stays clean on the way. */
TEST(descents_take_back_displacements) {
    stage_rig *r = rig_begin();
    add_spheres(r, 1.8);
    rig_open(r, NULL, NULL);
    for (uint32_t v = r->shape.vertex_count / 2; v < r->shape.vertex_count; v++) r->x[3 * (size_t)v] += 0.6;
    assert_int_equal(pairs_at(r, r->x), 0);
    double before = squared_way(r, r->goal);
    r->w.options.max_steps = 1;
    for (int i = 0; i < 3; i++) {
        expect_ok(descent_run(&r->w, 1.0, r->x));
        assert_int_equal(pairs_at(r, r->x), 0);
        assert_true(squared_way(r, r->goal) < before);
        before = squared_way(r, r->goal);
    }
    assert_int_equal(r->w.found.steps, 3);
    r->w.options.max_steps = 40;
    expect_ok(descent_run(&r->w, 1.0, r->x));
    assert_int_equal(pairs_at(r, r->x), 0);
    double farthest = 0.0;
    for (size_t k = 0; k < 3 * (size_t)r->shape.vertex_count; k++)
        farthest = fmax(farthest, fabs(r->x[k] - r->goal[k]));
    assert_true(farthest < 0.25); /* both go, instead of one by 0.6 */
    rig_close(r);
}

/* ---- curves ---------------------------------------------------------------------------------------------- */

/* Two strips that cross in a curve from border to border. */
static void add_crossed_strips(stage_rig *r) {
    scene_add_sheet(&r->shape, 2.5, 2.0, 11, 9);
    const uint32_t first = r->shape.vertex_count;
    scene_add_sheet(&r->shape, 2.5, 2.0, 11, 9);
    double middle[3] = {0.0, 0.0, 0.0};
    for (uint32_t v = 0; v < first; v++) {
        for (size_t k = 0; k < 3; k++) middle[k] += r->shape.x0[3 * (size_t)v + k] / first;
    }
    for (uint32_t v = 0; v < r->shape.vertex_count; v++) {
        double *x = r->shape.x0 + 3 * (size_t)v, from[3];
        for (size_t k = 0; k < 3; k++) from[k] = x[k] - middle[k];
        x[0] = from[0] + (v < first ? -0.75 : 0.77);
        x[1] = v < first ? from[1] : from[2] + 0.013;
        x[2] = v < first ? from[2] : from[1] + 0.017;
    }
}

static double length_of_curves(stage_rig *r) {
    cscd_measures lengths;
    expect_ok(detector_curve_lengths(r->detector, WORK_VIEW(&r->w, r->x), NULL, &lengths));
    return lengths.sum;
}

/* Curves become shorter with every step, and no vertex goes farther than it may. */
TEST(curves_become_shorter) {
    for (int i = 0; i < 3; i++) {
        stage_rig *r = rig_begin();
        add_crossed_strips(r);
        rig_open(r, NULL, NULL);
        const double farthest = (const double[]){1e-3, 1e-2, 0.1}[i], before = length_of_curves(r);
        double longest = 0.0;
        expect_ok(shorten_curves(&r->w, 0.75, farthest, r->x));
        for (size_t v = 0; v < r->shape.vertex_count; v++) {
            double squared = 0.0;
            for (size_t k = 3 * v; k < 3 * v + 3; k++) squared += pow(r->x[k] - r->shape.x0[k], 2.0);
            longest = fmax(longest, sqrt(squared));
        }
        assert_true(longest < farthest * (1.0 + 1e-9) && longest > 0.9 * farthest);
        assert_true(length_of_curves(r) < before);
        rig_close(r);
    }
}

/* ---- the call -------------------------------------------------------------------------------------------- */

static cscd_status untangle_rig(stage_rig *r, cscd_untangled *out) {
    const uint32_t n = r->shape.vertex_count;
    return cscd_detector_untangle(r->detector, CSCD_DOUBLES(r->shape.x0, n), &r->w.options,
                                  CSCD_MUTABLE_DOUBLES(r->reached, n), out);
}

/* Pairs that are too near, and do not touch, part without a push. */
TEST(gaps_heal_without_a_push) {
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = 0.1;
    stage_rig *r = rig_begin();
    add_spheres(r, 2.02);
    rig_open(r, NULL, &options);
    cscd_untangled found;
    expect_ok(untangle_rig(r, &found));
    assert_true(found.pairs_before == 0 && found.near_before > 0);
    assert_true(found.clean && found.near_after == 0 && found.rounds == 0);
    assert_true(found.displacement > 0.0 && found.displacement < 0.15);
    rig_close(r);
}

/* Where there are pairs, what is best has fewer of them, however few rounds there are. */
TEST(more_rounds_are_not_worse) {
    size_t before = SIZE_MAX;
    for (uint32_t rounds = 0; rounds < 6; rounds++) {
        stage_rig *r = rig_begin();
        add_spheres(r, 1.2);
        for (uint32_t v = 0; v < r->shape.vertex_count; v += r->shape.vertex_count / 2)
            r->weights[v] = (double)INFINITY; /* shrinking does not help */
        rig_open(r, NULL, NULL);
        r->w.options.max_rounds = rounds;
        r->w.options.weights = r->weights;
        cscd_untangled found;
        expect_ok(untangle_rig(r, &found));
        assert_true(found.pairs_after <= found.pairs_before);
        assert_true(found.pairs_after == pairs_at(r, r->reached));
        assert_true(found.pairs_after <= before);
        before = found.pairs_after;
        rig_close(r);
    }
    assert_true(before < 10);
}

typedef struct share_log {
    size_t calls, shares; /* of them: those that differ from the one before */
    size_t pushing, others;
    double last;
} share_log;

static bool note_share(void *user, const char *stage, double fraction) {
    share_log *log = user;
    assert_true(fraction >= log->last && fraction <= 1.0);
    log->calls++;
    log->shares += fraction > log->last;
    log->pushing += strcmp(stage, "pushing out") == 0;
    log->others += strcmp(stage, "pushing out") != 0 && strcmp(stage, "descending") != 0 &&
                   strcmp(stage, "looking") != 0;
    log->last = fraction;
    return true;
}

/* The host hears of the stages of untangling alone, and of shares of the whole call; a later call tells its own. */
TEST(the_host_hears_of_the_whole_call) {
    share_log log = {.calls = 0};
    cscd_context_options host = cscd_context_defaults();
    host.progress = (cscd_progress){.user = &log, .report = note_share};
    stage_rig *r = rig_begin();
    add_spheres(r, 1.2);
    rig_open(r, &host, NULL);
    r->context->progress.interval_ms = 0.0;
    for (int i = 0; i < 2; i++) { /* the second one begins at 0 again */
        cscd_untangled found;
        cscd_intersections pairs;
        log = (share_log){.calls = 0};
        expect_ok(untangle_rig(r, &found));
        assert_true(log.others == 0 && log.pushing > 0 && log.calls > log.shares);
        assert_true(log.shares >= found.rounds);
        assert_true(found.start == CSCD_UNTANGLE_PUSHED && log.last > 0.0 &&
                    log.last < 0.1); /* of 1 of 5 starts */
        log = (share_log){.calls = 0};
        expect_ok(find_intersections_packed(r->detector, r->shape.x0, NULL, &pairs));
        assert_true(log.calls > 0 && log.others == log.calls);
    }
    rig_close(r);
}

/* Each allocation fails once: the context says that memory is out, and there is nothing to free twice. */
TEST(failed_allocations_say_so) {
    counting_allocator counter = counting_allocator_start();
    cscd_context_options host = cscd_context_defaults();
    host.allocator = counting_allocator_interface(&counter);
    stage_rig *r = rig_begin();
    add_spheres(r, 1.2);
    rig_open(r, &host, NULL);
    r->w.options.max_rounds = 3;
    r->w.options.max_steps = 2;
    size_t failed = 0;
    for (size_t n = 0; n < PACED(80, 30); n++) {
        cscd_untangled found;
        counter.fail_at = counter.calls + n + 1;
        const cscd_status status = untangle_rig(r, &found);
        counter.fail_at = SIZE_MAX;
        if (status == CSCD_OK) continue;
        assert_int_equal(status, CSCD_OUT_OF_MEMORY);
        assert_non_null(strstr(cscd_context_detail(r->context), "memory"));
        failed++;
    }
    assert_true(failed > 20);
    rig_close(r);
    assert_int_equal(counter.live, 0);
}
