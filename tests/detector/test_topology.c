/* Connectivity that changes while the context lives: sheets that tear, regions carried over, memory. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/oracle.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 10, ROWS = 8, CUT = 5, TIP = 6, TEARS = 6, REGIONS_MAX = 16 };

static scene whole, torn; /* large; one test at a time */

/* A detector whose context lives on. */
static rig make_objects(cscd_context *context, const scene *s, const cscd_detector_options *options) {
    rig r = {.mesh = mesh_of_scene(context, s)};
    expect_ok(detector_create_here(r.mesh, NULL, options, &r.detector));
    return r;
}

/* Returns the number of contacts. */
static size_t check_against_brute_force(const scene *s, cscd_contacts found) {
    oracle_list expected = {NULL, 0, 0};
    oracle_find(s, &expected);
    oracle_expect(&expected, &found);
    oracle_free(&expected);
    return found.count;
}

/* ---- a sheet that tears ------------------------------------------------------------------------------ */

/* Places the sheet in a wave that moves all of it. */
static void wave_at(scene *s, double phase, double *x) {
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        x[3 * v] = s->x0[3 * v];
        x[3 * v + 1] = s->x0[3 * v + 1];
        x[3 * v + 2] = 0.1 * sin(3.0 * s->x0[3 * v] + phase) + 0.01 * s->x0[3 * v + 1];
    }
}

static void make_sheet(uint64_t seed) {
    random_stream random = stream_start(seed);
    scene_clear(&whole);
    scene_add_sheet(&whole, 2.0, 1.6, COLUMNS, ROWS);
    wave_at(&whole, stream_between(&random, 0.0, 6.0), whole.x1);
}

/* Cuts the sheet along column CUT, from the first row to TIP. The part to the right gets new vertices,
 * numbered after the others, in the old places. Lists the pairs of vertices that were one. */
static void tear_sheet(uint32_t pairs[TIP][2]) {
    torn = whole;
    memcpy(torn.x0, whole.x1, sizeof whole.x1);
    for (uint32_t row = 0; row < TIP; row++) {
        uint32_t old = row * (COLUMNS + 1) + CUT, new = torn.vertex_count++;
        pairs[row][0] = old;
        pairs[row][1] = new;
        memcpy(torn.x0 + (size_t) new * 3, torn.x0 + (size_t)old * 3, sizeof(double[3]));
        for (uint32_t t = 0; t < torn.triangle_count; t++) {
            uint32_t *corners = torn.triangles + (size_t)t * 3;
            bool right = t / 2 % COLUMNS >= CUT; /* two triangles per cell, row by row */
            for (int k = 0; right && k < 3; k++) corners[k] = corners[k] == old ? new : corners[k];
        }
    }
    memcpy(torn.x1, torn.x0, sizeof torn.x0);
}

static bool is_new(uint32_t vertex) {
    return vertex >= (COLUMNS + 1) * (ROWS + 1);
}

/* Moves the right part of the sheet, most where it is torn. */
static void move_right(double dx, double dz) {
    for (uint32_t v = 0; v < torn.vertex_count; v++) {
        uint32_t row = is_new(v) ? v - (COLUMNS + 1) * (ROWS + 1) : v / (COLUMNS + 1);
        bool right = is_new(v) || v % (COLUMNS + 1) > CUT;
        double share = right && row < TIP ? (double)(TIP - row) / TIP : 0.0;
        torn.x1[3 * v] = torn.x0[3 * v] + dx * share;
        torn.x1[3 * v + 2] = torn.x0[3 * v + 2] + dz * share;
    }
}

/* One tear: the sheet moves, tears, the two sides of the tear part, and one flies through the other. */
static size_t tear_once(cscd_context *context, uint64_t seed) {
    uint32_t pairs[TIP][2];
    make_sheet(seed);
    rig before = make_objects(context, &whole, NULL);
    assert_int_equal(check_against_brute_force(&whole, rig_step(&before, &whole)), 0);
    rig_destroy(&before);

    tear_sheet(pairs);
    rig after = make_objects(context, &torn, NULL);
    cscd_component c = cscd_mesh_component(after.mesh, 0);
    assert_true(cscd_mesh_component_count(after.mesh) == 1 && c.non_manifold_vertices == 0);
    assert_int_equal(c.open_edges, 2 * (COLUMNS + ROWS) + 2 * TIP);
    move_right(0.15, 0.2);
    size_t parting = check_against_brute_force(&torn, rig_step(&after, &torn));
    assert_true(parting > 0); /* the sides touch where they are still in one place */
    memcpy(torn.x0, torn.x1, sizeof torn.x1);
    move_right(-0.7, -0.5);
    size_t count = check_against_brute_force(&torn, rig_step(&after, &torn));
    rig_destroy(&after);
    return count;
}

TEST(a_sheet_tears_while_the_context_lives) {
    for (uint32_t threads = 1; threads <= 2; threads++) {
        cscd_context *context = context_of(threads, NULL);
        size_t at_rest = cscd_context_describe(context).bytes, count = 0;
        for (uint64_t seed = 0; seed < TEARS; seed++) {
            count += tear_once(context, seed);
            assert_int_equal(cscd_context_describe(context).bytes, at_rest);
        }
        assert_true(count > TEARS);
        cscd_context_destroy(context);
    }
}

TEST(seams_keep_the_lips_quiet_until_they_have_parted) {
    uint32_t pairs[TIP][2];
    cscd_context *context = context_of(1, NULL);
    make_sheet(1);
    tear_sheet(pairs);
    move_right(0.15, 0.2);
    cscd_detector_options options = cscd_detector_defaults();
    rig bare = make_objects(context, &torn, &options);
    assert_true(rig_step(&bare, &torn).count > 0);
    options.seams = pairs[0];
    options.seam_count = TIP;
    rig sewn = make_objects(context, &torn, &options);
    assert_int_equal(rig_step(&sewn, &torn).count, 0);

    memcpy(torn.x0, torn.x1, sizeof torn.x1);
    move_right(-0.7, -0.5); /* from here on nothing is ignored: no two vertices are in one place any more */
    assert_true(check_against_brute_force(&torn, rig_step(&bare, &torn)) > 0);
    rig_destroy(&sewn);
    rig_destroy(&bare);
    cscd_context_destroy(context);
}

/* ---- regions carried over ---------------------------------------------------------------------------- */

/* A capsule that bends until it touches itself, and a sphere that it may touch. */
static void make_bodies(uint64_t seed) {
    static scene sphere;
    random_stream random = stream_start(seed ^ 0xb0d7);
    double centre[3] = {stream_between(&random, 0.2, 0.9), stream_between(&random, -0.5, 0.5), 0.4};
    scene_make(SCENE_BENT_CAPSULE, seed, &whole);
    scene_clear(&sphere);
    scene_add_sphere(&sphere, centre, 0.3, 6, 9);
    assert_true(whole.vertex_count + sphere.vertex_count <= SCENE_VERTICES_MAX);
    assert_true(whole.triangle_count + sphere.triangle_count <= SCENE_TRIANGLES_MAX);
    memcpy(whole.x0 + whole.vertex_count * 3, sphere.x0, sphere.vertex_count * sizeof(double[3]));
    memcpy(whole.x1 + whole.vertex_count * 3, sphere.x0, sphere.vertex_count * sizeof(double[3]));
    for (uint32_t i = 0; i < sphere.triangle_count * 3; i++)
        whole.triangles[whole.triangle_count * 3 + i] = whole.vertex_count + sphere.triangles[i];
    whole.vertex_count += sphere.vertex_count;
    whole.triangle_count += sphere.triangle_count;
}

/* Removes triangles of the second component and renumbers the rest; origin is each triangle's old number. */
static void remove_and_renumber(const cscd_mesh *mesh, random_stream *random, uint32_t *origin) {
    torn = whole;
    torn.triangle_count = 0;
    for (uint32_t t = 0; t < whole.triangle_count; t++) {
        if (cscd_mesh_triangle_component(mesh, t) == 1 && stream_below(random, 4) == 0) continue;
        uint32_t at = stream_below(random, torn.triangle_count + 1); /* builds a random order */
        origin[torn.triangle_count] = origin[at];
        origin[at] = t;
        torn.triangle_count++;
    }
    for (uint32_t t = 0; t < torn.triangle_count; t++)
        memcpy(torn.triangles + (size_t)t * 3, whole.triangles + (size_t)origin[t] * 3, sizeof(uint32_t[3]));
}

/* Makes regions by where triangles come from: one per old region and new component, and none without
 * triangles. */
static cscd_plan *carry_over(const cscd_plan *old, const cscd_mesh *mesh, const uint32_t *origin) {
    static uint32_t regions[SCENE_TRIANGLES_MAX];
    uint32_t components = cscd_mesh_component_count(mesh), count = 0;
    uint32_t *number = calloc((size_t)cscd_plan_region_count(old) * components, sizeof *number);
    double *points = calloc(cscd_mesh_triangle_count(mesh), sizeof(double[3]));
    assert_true(number != NULL && points != NULL);
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh); t++) {
        uint32_t region = cscd_plan_triangle_region(old, origin[t]);
        uint32_t *n = &number[region * components + cscd_mesh_triangle_component(mesh, t)];
        if (*n == 0) {
            cscd_region r = cscd_plan_region(old, region);
            memcpy(points + (size_t)count * 3, r.detector_point, sizeof(double[3]));
            *n = ++count;
        }
        regions[t] = *n - 1;
    }
    const cscd_plan_parts parts = {CSCD_METHOD_KMEANS, count, regions, points, NULL, NULL, NULL};
    cscd_plan *plan = NULL;
    expect_ok(plan_from_parts_packed(mesh, torn.x0, &parts, &plan));
    free(number);
    free(points);
    return plan;
}

static void assert_same_contacts(cscd_contacts a, cscd_contacts b) {
    assert_int_equal(a.count, b.count);
    for (size_t i = 0; i < a.count; i++) {
        const cscd_contact *p = &a.items[i], *q = &b.items[i];
        assert_true(p->kind == q->kind && p->a == q->a && p->b == q->b && p->toi == q->toi && p->u == q->u &&
                    p->v == q->v);
        assert_memory_equal(p->point, q->point, sizeof p->point);
        assert_memory_equal(p->normal, q->normal, sizeof p->normal);
    }
}

typedef struct carried {
    size_t contacts;
    uint64_t oriented;
} carried;

static carried carry_once(cscd_context *context, uint64_t seed) {
    static uint32_t origin[SCENE_TRIANGLES_MAX];
    random_stream random = stream_start(seed);
    cscd_plan_options options = cscd_plan_defaults();
    options.method = CSCD_METHOD_KMEANS;
    make_bodies(seed);
    rig old = make_objects(context, &whole, NULL);
    assert_int_equal(cscd_mesh_component_count(old.mesh), 2);
    expect_ok(plan_create_packed(old.mesh, whole.x0, &options, &old.plan));

    remove_and_renumber(old.mesh, &random, origin);
    rig plain = make_objects(context, &torn, NULL), planned = {.mesh = mesh_of_scene(context, &torn)};
    planned.plan = carry_over(old.plan, planned.mesh, origin);
    expect_ok(detector_create_here(planned.mesh, planned.plan, NULL, &planned.detector));
    cscd_contacts found = rig_step(&planned, &torn);
    carried result = {check_against_brute_force(&torn, found), 0};
    assert_same_contacts(found, rig_step(&plain, &torn));
    cscd_counters n = cscd_detector_counters(planned.detector);
    result.oriented = n.plus + n.minus;
    rig_destroy(&planned);
    rig_destroy(&plain);
    rig_destroy(&old);
    return result;
}

TEST(regions_carried_over_change_no_contact) {
    cscd_context *context = context_of(1, NULL);
    size_t at_rest = cscd_context_describe(context).bytes;
    carried sum = {0, 0};
    for (uint64_t seed = 0; seed < TEARS; seed++) {
        carried one = carry_once(context, seed);
        sum.contacts += one.contacts;
        sum.oriented += one.oriented;
        assert_int_equal(cscd_context_describe(context).bytes, at_rest);
    }
    assert_true(sum.contacts > 0 && sum.oriented > 0);
    cscd_context_destroy(context);
}
