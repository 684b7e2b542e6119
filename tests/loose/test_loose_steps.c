/* Contacts of wires, points and half-spaces in a step, against every pair of features by itself. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/loose/loose_scene.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static loose_scene scene;
static loose_pair pairs[LOOSE_LIST_MAX];
static cscd_contact sorted[LOOSE_LIST_MAX];

/* What a run of scenes has seen. */
typedef struct kind_tally {
    size_t by_kind[CSCD_CONTACT_VH + 1], at_start, pairs;
} kind_tally;

static int compare_names(const void *left, const void *right) {
    const cscd_contact *l = left, *r = right;
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return l->b < r->b ? -1 : l->b > r->b;
}

static void check_order(const cscd_contacts *found) {
    for (size_t i = 1; i < found->count; i++) {
        const cscd_contact *before = &found->items[i - 1], *now = &found->items[i];
        assert_true(before->toi < now->toi || (before->toi == now->toi && compare_names(before, now) < 0));
    }
}

/* The vertices that the header promises for each kind. */
static void check_vertices(const cscd_contact *c) {
    cscd_stencil stencil = cscd_mesh_stencil(scene.mesh, c->kind, c->a, c->b, c->u, c->v);
    double weights[4], sum = 0.0;
    cscd_stencil_weights(c->kind, c->u, c->v, weights);
    assert_memory_equal(stencil.vertices, c->vertices, sizeof c->vertices);
    assert_memory_equal(stencil.weights, weights, sizeof weights);
    for (int i = 0; i < 4; i++) sum += weights[i];
    assert_true(fabs(sum) < 1e-12);
    if (c->kind == CSCD_CONTACT_VV || c->kind == CSCD_CONTACT_VH) assert_int_equal(c->vertices[0], c->a);
    if (c->kind == CSCD_CONTACT_VV || c->kind == CSCD_CONTACT_EV) assert_int_equal(c->vertices[3], c->b);
    if (c->kind == CSCD_CONTACT_VH)
        assert_int_equal(c->vertices[3], cscd_mesh_object(scene.mesh, c->b).first_vertex);
    if (c->kind == CSCD_CONTACT_VV) assert_true(c->u == 0.0 && c->v == 0.0 && c->a < c->b);
    if (c->kind == CSCD_CONTACT_EV) assert_true(c->u >= 0.0 && c->u <= 1.0 && c->v == 0.0);
}

static void at_time(const loose_scene *s, double t, double *out) {
    for (size_t i = 0; i < (size_t)s->vertex_count * 3; i++) out[i] = (1.0 - t) * s->x0[i] + t * s->x1[i];
}

/* At its time a contact is at its distance, or nearer at the start. */
static void check_contact(const loose_pair *pair, const cscd_contact *c, double toi) {
    double x[LOOSE_VERTICES_MAX * 3];
    if (c->kind == CSCD_CONTACT_VH)
        assert_true(c->toi <= toi + 1e-12 && c->toi >= toi - 1e-9 - 1e-5 * (pair->distance > 0.0));
    else
        assert_true(c->toi == toi);
    at_time(&scene, c->toi, x);
    double apart = loose_pair_apart(&scene, pair, x);
    assert_true(apart <= pair->distance * (1.0 + 1e-5) + 1e-7);
    if (c->toi > 0.0) assert_true(apart >= pair->distance * (1.0 - 1e-9) - 1e-12);
    check_vertices(c);
}

/* Every pair that comes within its distance is reported, and none that stays farther apart than the tolerance allows. */
static void compare_contacts(const cscd_contacts *found, kind_tally *tally) {
    size_t count = loose_scene_pairs(&scene, false, pairs), at = 0;
    assert_true(found->count < LOOSE_LIST_MAX);
    if (found->count > 0) memcpy(sorted, found->items, found->count * sizeof *sorted);
    qsort(sorted, found->count, sizeof *sorted, compare_names);
    for (size_t i = 0; i < count; i++) {
        const loose_pair *p = &pairs[i];
        const cscd_contact *c = &sorted[at];
        double toi, surely;
        bool reported = at < found->count && c->kind == p->kind && c->a == p->a && c->b == p->b;
        bool may = loose_pair_meets(&scene, p, scene.x0, scene.x1, p->distance, &toi);
        if (p->kind == CSCD_CONTACT_VH && !may)
            may = loose_pair_meets(&scene, p, scene.x0, scene.x1, p->distance * (1.0 + 1e-12), &toi);
        bool must =
            may && loose_pair_meets(&scene, p, scene.x0, scene.x1, p->distance * (1.0 - 4e-6), &surely);
        if (reported != may && (reported || must))
            fail_msg("%s %u %u at %g of %g", cscd_contact_kind_name(p->kind), p->a, p->b, toi, p->distance);
        if (!reported) continue;
        check_contact(p, c, toi);
        tally->by_kind[p->kind]++;
        tally->at_start += c->toi == 0.0;
        at++;
    }
    tally->pairs += count;
    assert_int_equal(at, found->count);
}

static void check_counters(cscd_detector *detector, const cscd_contacts *found) {
    cscd_counters counters = cscd_detector_counters(detector);
    size_t vf = 0, ee = 0;
    for (size_t i = 0; i < found->count; i++) {
        vf += found->items[i].kind == CSCD_CONTACT_VF;
        ee += found->items[i].kind == CSCD_CONTACT_EE;
    }
    assert_true(counters.vf == vf && counters.ee == ee && counters.loose == found->count - vf - ee);
    assert_true(counters.tests <= counters.feature_pairs);
}

static void run_scene(const loose_recipe *recipe, cscd_method method, uint64_t seed, kind_tally *tally) {
    random_stream random = stream_start(seed);
    loose_scene_make(&scene, recipe, &random, 1 + (uint32_t)seed % 3, CSCD_SIMD_AUTO);
    cscd_detector_options options = loose_scene_options(&scene);
    cscd_detector *detector = NULL;
    options.method = method;
    options.volume = seed % 2 == 0 ? CSCD_VOLUME_BOX : CSCD_VOLUME_KDOP14;
    assert_int_equal(detector_create_here(scene.mesh, NULL, &options, &detector), CSCD_OK);
    for (int step = 0; step < 4; step++) {
        cscd_contacts found;
        cscd_status status = step_packed(detector, scene.x0, scene.x1, &found);
        if (status != CSCD_OK) fail_msg("%s", cscd_context_detail(scene.context));
        check_order(&found);
        check_counters(detector, &found);
        compare_contacts(&found, tally);
        loose_scene_move(&scene, &random);
    }
    cscd_detector_destroy(detector);
    loose_scene_free(&scene);
}

static kind_tally run_scenes(const char *name, loose_recipe recipe, cscd_method method, int count,
                             uint64_t seed) {
    kind_tally tally = {.pairs = 0};
    recipe.triangles |= !recipe.wires && !recipe.points;
    for (int i = 0; i < count; i++) run_scene(&recipe, method, seed + (uint64_t)i, &tally);
    print_message("  %s: %zu pairs, %zu vf, %zu ee, %zu vv, %zu ev, %zu vh, %zu at the start\n", name,
                  tally.pairs, tally.by_kind[CSCD_CONTACT_VF], tally.by_kind[CSCD_CONTACT_EE],
                  tally.by_kind[CSCD_CONTACT_VV], tally.by_kind[CSCD_CONTACT_EV],
                  tally.by_kind[CSCD_CONTACT_VH], tally.at_start);
    return tally;
}

static const loose_recipe everything = {
    .triangles = true, .wires = true, .points = true, .half_spaces = true, .motion = 0.5};

TEST(touching_pairs) {
    loose_recipe grid = everything, still = everything;
    grid.grid = true;
    still.motion = 0.0;
    kind_tally t = run_scenes("doubles", everything, CSCD_METHOD_NONE, 24, 100);
    assert_true(t.by_kind[CSCD_CONTACT_VF] > 100 && t.by_kind[CSCD_CONTACT_EE] > 100 &&
                t.by_kind[CSCD_CONTACT_VH] > 50);
    assert_true(t.by_kind[CSCD_CONTACT_VV] == 0 && t.by_kind[CSCD_CONTACT_EV] == 0);
    t = run_scenes("on a grid", grid, CSCD_METHOD_NONE, 24, 200);
    assert_true(t.at_start > 50);
    run_scenes("at rest", still, CSCD_METHOD_NONE, 8, 300);
    run_scenes("single", everything, CSCD_METHOD_SINGLE, 12, 400);
    run_scenes("brute force", grid, CSCD_METHOD_BRUTE, 8, 500);
    run_scenes("ICCD", grid, method_or_none(CSCD_METHOD_ICCD), 8, 600);
}

TEST(with_a_distance) {
    loose_recipe apart = everything, thick = everything;
    apart.min_separation = 0.15;
    thick.thickness = true;
    kind_tally t = run_scenes("separation", apart, CSCD_METHOD_NONE, 16, 700);
    for (int k = 0; k <= CSCD_CONTACT_VH; k++) assert_true(k == CSCD_CONTACT_TT || t.by_kind[k] > 20);
    run_scenes("separation, brute force", apart, CSCD_METHOD_BRUTE, 6, 800);
    run_scenes("thickness", thick, CSCD_METHOD_NONE, 16, 900);
    thick.matrix = thick.rules = thick.obstacles = true;
    run_scenes("matrix, rules, obstacles", thick, CSCD_METHOD_SINGLE, 16, 1000);
    thick.grid = true;
    run_scenes("the same on a grid, brute force", thick, CSCD_METHOD_BRUTE, 8, 1100);
}

TEST(with_rules) {
    loose_recipe rules = everything, obstacles = everything;
    rules.rules = true;
    obstacles.obstacles = true;
    run_scenes("rules", rules, CSCD_METHOD_NONE, 16, 1200);
    run_scenes("obstacles", obstacles, CSCD_METHOD_NONE, 16, 1300);
    rules.obstacles = rules.grid = true;
    run_scenes("both", rules, CSCD_METHOD_SINGLE, 16, 1400);
    run_scenes("both, ICCD", rules, method_or_none(CSCD_METHOD_ICCD), 8, 1500);
}

/* ICCD as published loses contacts of triangles, but has none that the rules leave out. */
TEST(as_published_with_rules) {
    loose_recipe rules = everything;
    rules.rules = true;
    size_t edges = 0;
    for (uint64_t seed = 1600; seed < PACED(1616, 1609); seed++) {
        random_stream random = stream_start(seed);
        loose_scene_make(&scene, &rules, &random, 1, CSCD_SIMD_AUTO);
        cscd_detector_options options = loose_scene_options(&scene);
        cscd_detector *plain = loose_scene_detector(&scene, &options), *published = NULL;
        cscd_contacts all, found;
        options.method = method_or_none(CSCD_METHOD_ICCD_PUBLISHED);
        options.ours = ours_of_method(options.method);
        published = loose_scene_detector(&scene, &options);
        assert_int_equal(step_packed(plain, scene.x0, scene.x1, &all), CSCD_OK);
        assert_int_equal(step_packed(published, scene.x0, scene.x1, &found), CSCD_OK);
        size_t at = 0;
        for (size_t i = 0; i < found.count; i++, at++) {
            while (at < all.count && memcmp(&all.items[at], &found.items[i], sizeof *all.items) != 0) at++;
            assert_true(at < all.count);
            edges += found.items[i].kind == CSCD_CONTACT_EE;
        }
        cscd_detector_destroy(plain);
        cscd_detector_destroy(published);
        loose_scene_free(&scene);
    }
    assert_true(edges > 100);
}

/* Any kinds may be missing, triangles among them. */
TEST(without_some) {
    for (int set = 1; set < 16; set++) {
        loose_recipe r = {.triangles = set & 1,
                          .wires = (set & 2) != 0,
                          .points = (set & 4) != 0,
                          .half_spaces = (set & 8) != 0,
                          .motion = 0.5,
                          .grid = set % 3 == 0};
        char name[64];
        snprintf(name, sizeof name, "%s%s%s%s", r.triangles ? "triangles " : "", r.wires ? "wires " : "",
                 r.points ? "points " : "", r.half_spaces ? "half-spaces" : "");
        if (set == 8) continue;
        run_scenes(name, r, CSCD_METHOD_SINGLE, 3, 1600 + (uint64_t)set * 10);
        r.min_separation = 0.1;
        run_scenes(name, r, CSCD_METHOD_NONE, 3, 2000 + (uint64_t)set * 10);
    }
}
