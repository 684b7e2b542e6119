/* What solvers ask about wires, points and half-spaces: proximity, certified steps, line searches, bounds, truncation. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "src/core/vec3.h"
#include "src/mesh/mesh.h"
#include "tests/support/calls.h"
#include "tests/support/loose/loose_scene.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static loose_scene scene;
static loose_pair pairs[LOOSE_LIST_MAX];
static size_t pair_count;
static double reached[LOOSE_VERTICES_MAX * 3];

static const loose_recipe everything = {
    .triangles = true, .wires = true, .points = true, .half_spaces = true, .motion = 0.5};

static cscd_detector *open_scene(const loose_recipe *recipe, cscd_method method, uint64_t seed,
                                 random_stream *random) {
    cscd_detector *detector = NULL;
    *random = stream_start(seed);
    loose_scene_make(&scene, recipe, random, 1 + (uint32_t)seed % 3, CSCD_SIMD_AUTO);
    cscd_detector_options options = loose_scene_options(&scene);
    options.method = method;
    cscd_status status = detector_create_here(scene.mesh, NULL, &options, &detector);
    if (status != CSCD_OK) fail_msg("%s", cscd_context_detail(scene.context));
    pair_count = loose_scene_pairs(&scene, false, pairs);
    return detector;
}

static void close_scene(cscd_detector *detector) {
    cscd_detector_destroy(detector);
    loose_scene_free(&scene);
}

/* The scenes of which the start is free of touching: vertices that are in the way go up or down. */
static bool lift_above_half_spaces(void) {
    for (size_t i = 0; i < pair_count; i++) {
        double apart = pairs[i].kind == CSCD_CONTACT_VH ? loose_pair_apart(&scene, &pairs[i], scene.x0) : 1.0;
        if (apart <= 0.0) return false;
    }
    return true;
}

/* Copies of a scene's rules would be left behind by a new scene, so half-spaces go far below. */
static void lower_half_spaces(void) {
    for (uint32_t i = 0; i < scene.object_count; i++) {
        const double *n = scene.objects[i].normal;
        double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        size_t at = (size_t)cscd_mesh_object(scene.mesh, i).first_vertex * 3;
        for (size_t k = 0; scene.objects[i].kind == CSCD_OBJECT_HALF_SPACE && k < 3; k++) {
            scene.x0[at + k] = -1.75 * n[k] / length;
            scene.x1[at + k] = scene.x0[at + k] + 0.5 * n[k] / length;
        }
    }
}

/* From where the vertices are, half-spaces rise and everything else goes anywhere. */
static void go_on(random_stream *random) {
    memcpy(scene.x0, reached, sizeof scene.x0);
    for (size_t i = 0; i < (size_t)scene.vertex_count * 3; i++) {
        const cscd_object_desc *object =
            &scene.objects[cscd_mesh_vertex_object(scene.mesh, (uint32_t)(i / 3))];
        bool half_space = object->kind == CSCD_OBJECT_HALF_SPACE;
        scene.x1[i] =
            scene.x0[i] + (half_space ? 0.3 * object->normal[i % 3] : stream_between(random, -0.2, 0.2));
    }
}

/* ---- proximity ------------------------------------------------------------------------------------------ */

static bool has_weights_of(const cscd_proximity *p) {
    cscd_stencil stencil = stencil_of_item(scene.mesh, p);
    return memcmp(stencil.weights, p->weights, sizeof p->weights) == 0 &&
           memcmp(stencil.vertices, p->vertices, sizeof p->vertices) == 0;
}

/* The gradient of the distance is weights times normal. */
static void check_gradient(const cscd_proximity *p) {
    double moved[LOOSE_VERTICES_MAX * 3], step = 1e-6, slope = 0.0;
    const loose_pair pair = {p->kind, p->a, p->b, 0.0};
    if (p->distance < 0.01) return;
    memcpy(moved, scene.x0, sizeof moved);
    for (size_t i = 0; i < 4; i++) {
        if (p->weights[i] == 0.0) continue;
        for (size_t k = 0; k < 3; k++) {
            double direction = sin((double)(3 * i + k) + 1.0);
            moved[p->vertices[i] * 3 + k] += step * direction;
            slope += p->weights[i] * p->normal[k] * direction;
        }
    }
    double change =
        (loose_pair_apart(&scene, &pair, moved) - loose_pair_apart(&scene, &pair, scene.x0)) / step;
    assert_true(fabs(change - slope) < 1e-2);
}

/* Every pair within the distance, once; and the sums of the form without repetitions. */
static void compare_near(cscd_detector *detector, double reach, cscd_near_form beyond, size_t by_kind[]) {
    cscd_proximities near;
    size_t at = 0, merged = 0, loose = 0;
    double energy = 0.0, energy_merged = 0.0;
    const cscd_view *x = CSCD_DOUBLES(scene.x0, scene.vertex_count);
    pair_count = loose_scene_pairs(&scene, true, pairs);
    expect_ok(cscd_detector_find_near(detector, x, reach, CSCD_NEAR_PAIRS | beyond, &near));
    for (size_t i = 0; i < pair_count; i++) {
        double apart = loose_pair_apart(&scene, &pairs[i], scene.x0);
        double distance = reach + (beyond != 0 ? pairs[i].distance : 0.0);
        const cscd_proximity *p = &near.items[at];
        bool listed = at < near.count && p->kind == pairs[i].kind && p->a == pairs[i].a && p->b == pairs[i].b;
        assert_true(listed ? apart <= distance * (1.0 + 1e-6) : apart >= distance * (1.0 - 1e-12));
        if (!listed) continue;
        assert_true(fabs(p->distance - apart) < 1e-12 && p->count == 1 && has_weights_of(p));
        assert_true(p->separation == pairs[i].distance && p->weight == 1.0);
        assert_true(p->vf_count == (p->kind == CSCD_CONTACT_VF) &&
                    p->ee_count == (p->kind == CSCD_CONTACT_EE));
        check_gradient(p);
        energy += exp(-p->distance);
        loose += p->kind != CSCD_CONTACT_VF && p->kind != CSCD_CONTACT_EE;
        by_kind[p->kind]++;
        at++;
    }
    assert_int_equal(at, near.count);
    size_t all = near.count;
    expect_ok(cscd_detector_find_near(detector, x, reach, CSCD_NEAR_UNIQUE | beyond, &near));
    for (size_t i = 0; i < near.count; i++) {
        const cscd_proximity *p = &near.items[i];
        assert_true(has_weights_of(p) && p->vf_count + p->ee_count <= p->count && p->weight == p->count);
        energy_merged += p->count * exp(-p->distance);
        merged += p->count;
        loose -= p->count - p->vf_count - p->ee_count;
        if (p->kind == CSCD_CONTACT_EV) assert_true(p->weights[0] > 0.0 && p->weights[1] > 0.0);
    }
    assert_true(merged == all && loose == 0 && fabs(energy - energy_merged) < 1e-9 * (1.0 + energy));
}

TEST(proximity_of_all_kinds) {
    size_t by_kind[CSCD_CONTACT_VH + 1] = {0};
    for (uint64_t seed = 0; seed < PACED(24, 12); seed++) {
        random_stream random;
        loose_recipe recipe = everything;
        recipe.rules = seed % 3 == 1;
        recipe.obstacles = seed % 4 == 1;
        recipe.grid = seed % 5 == 0;
        recipe.triangles = seed % 6 != 0;
        cscd_detector *detector =
            open_scene(&recipe, seed % 7 == 0 ? CSCD_METHOD_BRUTE : CSCD_METHOD_NONE, seed, &random);
        compare_near(detector, 0.25, CSCD_NEAR_PAIRS, by_kind);
        close_scene(detector);
    }
    for (int k = 0; k <= CSCD_CONTACT_VH; k++) assert_true(k == CSCD_CONTACT_TT || by_kind[k] > PACED(20, 5));
}

/* Each pair is found within its own distance and so much more; and where all have one, within the sum. */
TEST(proximity_beyond_separations) {
    size_t by_kind[CSCD_CONTACT_VH + 1] = {0};
    for (uint64_t seed = 0; seed < PACED(24, 12); seed++) {
        random_stream random;
        loose_recipe recipe = everything;
        recipe.rules = seed % 3 == 1;
        recipe.thickness = seed % 4 != 0;
        recipe.matrix = seed % 4 == 2;
        recipe.min_separation = seed % 8 == 4 ? 0.1 : 0.0;
        recipe.triangles = seed % 6 != 0;
        cscd_detector *detector =
            open_scene(&recipe, seed % 7 == 0 ? CSCD_METHOD_BRUTE : CSCD_METHOD_NONE, 50 + seed, &random);
        compare_near(detector, seed % 2 == 0 ? 0.15 : 0.04, CSCD_NEAR_BEYOND, by_kind);
        compare_near(detector, 0.2, CSCD_NEAR_PAIRS, by_kind);
        close_scene(detector);
    }
    for (int k = 0; k <= CSCD_CONTACT_VH; k++) assert_true(k == CSCD_CONTACT_TT || by_kind[k] > PACED(20, 5));
}

/* Of a wire the length of an edge, and half of those at a vertex; a point has 1. */
static double area_of(const uint32_t *vertices, int count) {
    const cscd_mesh *mesh = scene.mesh;
    double area = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        int found = 0;
        double u[3], v[3], across[3];
        for (int i = 0; i < 3 * count; i++) found += mesh->triangles[t][i % 3] == vertices[i / 3];
        if (found < count) continue;
        for (size_t k = 0; k < 3; k++) {
            u[k] = scene.x1[mesh->triangles[t][1] * 3 + k] - scene.x1[mesh->triangles[t][0] * 3 + k];
            v[k] = scene.x1[mesh->triangles[t][2] * 3 + k] - scene.x1[mesh->triangles[t][0] * 3 + k];
        }
        vec3_cross(u, v, across);
        area += sqrt(vec3_dot(across, across)) / 6.0;
    }
    for (uint32_t e = 0; e < mesh->edge_count; e++) {
        const uint32_t *ends = mesh->edges[e];
        int found = 0;
        for (int i = 0; i < 2 * count; i++) found += ends[i % 2] == vertices[i / 2];
        if (!edge_is_loose(mesh, e) || found < count) continue;
        area += 0.5 * count *
                sqrt(vec3_squared_distance(scene.x1 + (size_t)ends[0] * 3, scene.x1 + (size_t)ends[1] * 3));
    }
    const uint32_t object = cscd_mesh_vertex_object(mesh, vertices[0]);
    return scene.objects[object].kind == CSCD_OBJECT_POINTS ? 1.0 : area;
}

static double weight_of(const cscd_proximity *p) {
    const bool vertex = p->kind != CSCD_CONTACT_EE && p->kind != CSCD_CONTACT_EV;
    const double a = area_of(p->vertices, vertex ? 1 : 2);
    if (p->kind == CSCD_CONTACT_VH) return a;
    if (p->kind == CSCD_CONTACT_VF) return 0.25 * a;
    const uint32_t *b = p->vertices + (vertex ? 1 : 2);
    return 0.25 * (a + area_of(b, p->kind == CSCD_CONTACT_EE ? 2 : 1));
}

TEST(weights_of_all_kinds) {
    for (uint64_t seed = 0; seed < 6; seed++) {
        random_stream random;
        double sum = 0.0, sum_merged = 0.0;
        cscd_proximities near;
        cscd_detector *detector = open_scene(&everything, CSCD_METHOD_NONE, 80 + seed, &random);
        expect_ok(set_rest_packed(detector, scene.x1));
        expect_ok(find_near_packed(detector, scene.x0, 0.3, &near));
        assert_true(near.count > 100);
        for (size_t i = 0; i < near.count; i++) {
            const cscd_proximity *p = &near.items[i];
            assert_true(fabs(p->weight - weight_of(p)) <= 1e-12);
            sum += p->weight * exp(-p->distance);
        }
        expect_ok(find_unique_packed(detector, scene.x0, 0.3, &near));
        for (size_t i = 0; i < near.count; i++)
            sum_merged += near.items[i].weight * exp(-near.items[i].distance);
        assert_true(fabs(sum - sum_merged) <= 1e-11 * sum);
        close_scene(detector);
    }
}

/* ---- steps ------------------------------------------------------------------------------------------------ */

/* What a pair that starts above its distance keeps, and none touches. */
static void check_certified(const double *end) {
    for (size_t i = 0; i < pair_count; i++) {
        double toi, keeps = pairs[i].distance;
        double start = loose_pair_apart(&scene, &pairs[i], scene.x0);
        while (keeps > 1e-6 && start <= keeps * (1.0 + 2e-6)) keeps *= 0.9;
        if (keeps <= 1e-6) keeps = 0.0;
        if (loose_pair_meets(&scene, &pairs[i], scene.x0, end, keeps * (1.0 - 2e-6), &toi))
            fail_msg("%s %u %u comes within %g of %g", cscd_contact_kind_name(pairs[i].kind), pairs[i].a,
                     pairs[i].b, toi, keeps);
        double after = loose_pair_apart(&scene, &pairs[i], end);
        if (start > pairs[i].distance * (1.0 + 1e-5)) assert_true(after > pairs[i].distance);
    }
}

/* The first time at which a pair comes within what it has to keep; the pairs start farther apart. */
static double first_time(void) {
    double first = 1.0;
    for (size_t i = 0; i < pair_count; i++) {
        double toi;
        if (loose_pair_meets(&scene, &pairs[i], scene.x0, scene.x1, pairs[i].distance, &toi))
            first = fmin(first, toi);
    }
    return first;
}

static bool all_above(void) {
    for (size_t i = 0; i < pair_count; i++) {
        if (loose_pair_apart(&scene, &pairs[i], scene.x0) <= pairs[i].distance * (1.0 + 1e-4)) return false;
    }
    return true;
}

typedef struct solver_tally {
    size_t limited[CSCD_CONTACT_VH + 1], above, steps;
} solver_tally;

/* A step by the detector, by brute force and by a line search are one step. */
static void check_step(cscd_detector *detector, cscd_detector *brute, cscd_line_search *line,
                       solver_tally *tally) {
    cscd_free_step step, by_brute, on_line;
    double other[LOOSE_VERTICES_MAX * 3];
    expect_ok(max_step_packed(detector, scene.x0, scene.x1, reached, &step));
    expect_ok(max_step_packed(brute, scene.x0, scene.x1, other, &by_brute));
    assert_memory_equal(reached, other, scene.vertex_count * sizeof(double[3]));
    assert_memory_equal(&step, &by_brute, sizeof step);
    expect_ok(line_begin_packed(line, scene.x0, scene.x1, 0.1));
    expect_ok(line_max_step_packed(line, 1.0, other, &on_line));
    assert_memory_equal(reached, other, scene.vertex_count * sizeof(double[3]));
    assert_true(step.fraction == on_line.fraction && step.limited == on_line.limited);
    check_certified(reached);
    tally->steps++;
    if (step.limited) tally->limited[step.limit.kind]++;
    if (!all_above()) return;
    double first = first_time();
    tally->above++;
    assert_true(step.fraction >= 0.79 * first - 1e-5 && (first < 1.0 || step.fraction > 0.99));
}

static void march_on(const loose_recipe *recipe, uint64_t seed, solver_tally *tally) {
    random_stream random;
    cscd_detector *detector =
        open_scene(recipe, seed % 2 == 0 ? CSCD_METHOD_NONE : CSCD_METHOD_SINGLE, seed, &random);
    cscd_detector_options options = loose_scene_options(&scene);
    cscd_detector *brute = NULL;
    cscd_line_search *line = NULL;
    options.method = CSCD_METHOD_BRUTE;
    expect_ok(detector_create_here(scene.mesh, NULL, &options, &brute));
    expect_ok(cscd_line_search_create(detector, &line));
    lower_half_spaces();
    assert_true(lift_above_half_spaces());
    for (int step = 0; step < 8; step++) {
        check_step(detector, brute, line, tally);
        go_on(&random);
    }
    cscd_line_search_destroy(line);
    cscd_detector_destroy(brute);
    close_scene(detector);
}

TEST(certified_steps) {
    solver_tally tally = {.steps = 0};
    for (uint64_t seed = 0; seed < PACED(24, 12); seed++) {
        loose_recipe recipe = everything;
        recipe.triangles = seed % 5 != 0;
        recipe.half_spaces = seed % 5 != 1;
        recipe.wires = seed % 8 != 7;
        recipe.triangles &= recipe.wires;
        recipe.thickness = seed % 2 == 1;
        recipe.rules = seed % 6 == 1;
        recipe.min_separation = seed % 2 == 0 && seed % 3 > 0 ? 0.02 : 0.0;
        march_on(&recipe, 100 + seed, &tally);
    }
    print_message("  %zu steps, limited by %zu vf, %zu ee, %zu vv, %zu ev, %zu vh, %zu from above\n",
                  tally.steps, tally.limited[CSCD_CONTACT_VF], tally.limited[CSCD_CONTACT_EE],
                  tally.limited[CSCD_CONTACT_VV], tally.limited[CSCD_CONTACT_EV],
                  tally.limited[CSCD_CONTACT_VH], tally.above);
    assert_true(tally.limited[CSCD_CONTACT_VV] > 0 && tally.limited[CSCD_CONTACT_EV] > 0 &&
                tally.limited[CSCD_CONTACT_VH] > 10 && tally.above > 20);
}

/* On a line, proximity at any moment is that of the detector there. */
TEST(moments_on_a_line) {
    for (uint64_t seed = 0; seed < 8; seed++) {
        random_stream random;
        loose_recipe recipe = everything;
        recipe.rules = recipe.thickness = seed % 2 == 1;
        cscd_detector *detector = open_scene(&recipe, CSCD_METHOD_NONE, 200 + seed, &random);
        cscd_line_search *line = NULL;
        double at[LOOSE_VERTICES_MAX * 3];
        static cscd_proximity kept[LOOSE_LIST_MAX];
        expect_ok(cscd_line_search_create(detector, &line));
        expect_ok(line_begin_packed(line, scene.x0, scene.x1, 0.2));
        for (int i = 0; i <= 4; i++) {
            for (int form = CSCD_NEAR_PAIRS; form <= (CSCD_NEAR_UNIQUE | CSCD_NEAR_BEYOND); form++) {
                cscd_proximities near;
                expect_ok(cscd_line_search_find_near(line, 0.25 * i, 0.2, (cscd_near_form)form, &near));
                assert_true(near.count > 0 && near.count < LOOSE_LIST_MAX);
                size_t count = near.count;
                memcpy(kept, near.items, count * sizeof *kept);
                expect_ok(line_positions_packed(line, 0.25 * i, at));
                expect_ok(cscd_detector_find_near(detector, CSCD_DOUBLES(at, scene.vertex_count), 0.2,
                                                  (cscd_near_form)form, &near));
                assert_int_equal(near.count, count);
                assert_memory_equal(near.items, kept, count * sizeof *kept);
            }
        }
        cscd_line_search_destroy(line);
        close_scene(detector);
    }
}

/* ---- bounds, truncation --------------------------------------------------------------------------------- */

/* Motions within the bounds keep every pair apart that is not blocked. */
static void check_bounds(cscd_detector *detector, random_stream *random) {
    double bounds[LOOSE_VERTICES_MAX], end[LOOSE_VERTICES_MAX * 3], nearest[LOOSE_VERTICES_MAX];
    cscd_displacement_bounds found;
    expect_ok(displacement_bounds_packed(detector, scene.x0, 0.4, bounds, &found));
    for (uint32_t v = 0; v < scene.vertex_count; v++) nearest[v] = 0.4;
    for (size_t i = 0; i < pair_count; i++) {
        cscd_stencil s = cscd_mesh_stencil(scene.mesh, pairs[i].kind, pairs[i].a, pairs[i].b, 0.0, 0.0);
        double gap = fmax(loose_pair_apart(&scene, &pairs[i], scene.x0) - pairs[i].distance, 0.0);
        for (int k = 0; k < 4; k++) nearest[s.vertices[k]] = fmin(nearest[s.vertices[k]], gap);
    }
    for (uint32_t v = 0; v < scene.vertex_count; v++) {
        if (bounds[v] < 0.49 * nearest[v] - 1e-12 || bounds[v] > 0.5 * nearest[v] + 1e-12)
            fail_msg("vertex %u of object %u: %g, %g", v, cscd_mesh_vertex_object(scene.mesh, v), bounds[v],
                     nearest[v]);
        double direction[3], length = 0.0;
        for (int k = 0; k < 3; k++) direction[k] = stream_between(random, -1.0, 1.0);
        for (int k = 0; k < 3; k++) length += direction[k] * direction[k];
        for (size_t k = 0; k < 3; k++)
            end[v * 3 + k] = scene.x0[v * 3 + k] + (1.0 - 1e-9) * bounds[v] * direction[k] / sqrt(length);
    }
    for (size_t i = 0; i < pair_count; i++) {
        double toi, keeps = pairs[i].distance * (1.0 - 4e-6);
        if (loose_pair_apart(&scene, &pairs[i], scene.x0) <= pairs[i].distance) continue;
        assert_false(loose_pair_meets(&scene, &pairs[i], scene.x0, end, keeps, &toi));
    }
}

/* Pairs above their distance stay there, others come no nearer, and no vertex leaves its ball. */
static void check_truncation(cscd_detector *detector, size_t *shortened) {
    cscd_truncation found;
    expect_ok(truncate_packed(detector, scene.x0, scene.x1, 0.4, reached, &found));
    *shortened += found.shortened;
    for (size_t i = 0; i < pair_count; i++) {
        double toi, start = loose_pair_apart(&scene, &pairs[i], scene.x0),
                    keeps = fmin(start, pairs[i].distance);
        if (start <= 0.0) continue;
        if (loose_pair_meets(&scene, &pairs[i], scene.x0, reached, keeps * (1.0 - 4e-6), &toi) &&
            keeps > 1e-6)
            fail_msg("%s %u %u", cscd_contact_kind_name(pairs[i].kind), pairs[i].a, pairs[i].b);
    }
}

TEST(bounds_and_truncation) {
    size_t shortened = 0;
    for (uint64_t seed = 0; seed < PACED(24, 12); seed++) {
        random_stream random;
        loose_recipe recipe = everything;
        recipe.triangles = seed % 4 != 0;
        recipe.thickness = seed % 3 == 1;
        recipe.obstacles = seed % 3 == 2;
        recipe.motion = 0.2;
        cscd_detector *detector = open_scene(&recipe, CSCD_METHOD_SINGLE, 300 + seed, &random);
        lower_half_spaces();
        for (int i = 0; i < 3; i++) {
            check_bounds(detector, &random);
            check_truncation(detector, &shortened);
            go_on(&random);
        }
        close_scene(detector);
    }
    assert_true(shortened > 100);
}
