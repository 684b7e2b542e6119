/* Single pairs: every bit is that of a detector on a mesh with just these features. */
#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/ccd/elementary_generator.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The queries of one kind, as the arrays that a call takes: four points each. */
enum { QUERIES_PER_FAMILY = 60, QUERY_COUNT = FAMILY_COUNT * QUERIES_PER_FAMILY, POINTS = 4 * QUERY_COUNT };

static double x0[POINTS][3], x1[POINTS][3];
static cscd_pair_contact contacts[QUERY_COUNT], other_contacts[QUERY_COUNT];
static cscd_pair_distance nearest[QUERY_COUNT], other_nearest[QUERY_COUNT];

static void make_queries(cscd_contact_kind kind, uint64_t seed) {
    random_stream random = stream_start(seed);
    for (int i = 0; i < QUERY_COUNT; i++) {
        elementary_query query = generate_query(&random, kind, (query_family)(i % FAMILY_COUNT));
        memcpy(x0[4 * i], query.x0, sizeof query.x0);
        memcpy(x1[4 * i], query.x1, sizeof query.x1);
    }
}

static cscd_pairs all_of(cscd_contact_kind kind) {
    return (cscd_pairs){kind, POINTS, QUERY_COUNT, NULL};
}

/* ---- a detector for one pair -------------------------------------------------------------------------------- */

/* Two triangles that share no vertex: the vertex 0 and the triangle 1 2 3, or the edges 0 1 and 2 3. The vertices
 * 4 and 5 lie on vertex 0, and seams make the first triangle a wire: pairs of two surfaces that have collapsed are not
 * looked at. */
typedef struct pair_rig {
    cscd_contact_kind kind;
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector; /* a new one for each query */
    uint32_t a, b;
} pair_rig;

static uint32_t find_edge(const cscd_mesh *mesh, uint32_t first, uint32_t second) {
    for (uint32_t e = 0; e < cscd_mesh_edge_count(mesh); e++) {
        uint32_t ends[2];
        cscd_mesh_edge(mesh, e, ends);
        if (ends[0] == first && ends[1] == second) return e;
    }
    fail_msg("no edge %u %u", first, second);
    return 0;
}

static pair_rig pair_rig_make(cscd_contact_kind kind) {
    static const uint32_t vf[] = {0, 4, 5, 1, 2, 3}, ee[] = {0, 1, 4, 2, 3, 5};
    pair_rig r = {.kind = kind, .b = 1};
    const cscd_object_desc desc = {
        .vertex_count = 6, .triangle_count = 2, .triangles = kind == CSCD_CONTACT_VF ? vf : ee};
    assert_int_equal(cscd_context_create(NULL, &r.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(r.context, &desc, 1, &r.mesh), CSCD_OK);
    if (kind == CSCD_CONTACT_EE) {
        r.a = find_edge(r.mesh, 0, 1);
        r.b = find_edge(r.mesh, 2, 3);
    }
    return r;
}

static void pair_rig_free(pair_rig *r) {
    cscd_detector_destroy(r->detector);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

static double largest_offset(const double (*points)[3], const double first[3]) {
    double largest = 0.0;
    for (int i = 0; i < 12; i++) largest = fmax(largest, fabs(points[i / 3][i % 3] - first[i % 3]));
    return largest;
}

static void renew_detector(pair_rig *r, double min_separation, double tolerance) {
    cscd_detector_options options = cscd_detector_defaults();
    static const uint32_t seams[] = {0, 4, 0, 5};
    options.min_separation = min_separation;
    options.tolerance = tolerance;
    options.seams = seams;
    options.seam_count = r->kind == CSCD_CONTACT_VF ? 2 : 1;
    cscd_detector_destroy(r->detector);
    assert_int_equal(cscd_detector_create(r->context, r->mesh, NULL, &options, &r->detector), CSCD_OK);
}

static void place_points(const double (*points)[3], double out[6][3]) {
    memcpy(out, points, 4 * sizeof *out);
    memcpy(out[4], points, sizeof *out);
    memcpy(out[5], points, sizeof *out);
}

/* The detector's contact of the pair; NULL: there is none. */
static const cscd_contact *step_pair(pair_rig *r, int query, double min_separation, double tolerance) {
    double start[6][3], end[6][3];
    cscd_contacts found;
    renew_detector(r, min_separation, tolerance);
    place_points((const double(*)[3])x0 + 4 * query, start);
    place_points((const double(*)[3])x1 + 4 * query, end);
    assert_int_equal(step_packed(r->detector, start[0], end[0], &found), CSCD_OK);
    for (size_t i = 0; i < found.count; i++) {
        const cscd_contact *c = &found.items[i];
        if (c->kind == r->kind && c->a == r->a && c->b == r->b) return c;
    }
    return NULL;
}

static const cscd_proximity *measure_pair(pair_rig *r, int query, double distance) {
    double points[6][3];
    cscd_proximities found;
    renew_detector(r, 0.0, 0.0);
    place_points((const double(*)[3])x0 + 4 * query, points);
    assert_int_equal(find_near_packed(r->detector, points[0], distance, &found), CSCD_OK);
    for (size_t i = 0; i < found.count; i++) {
        const cscd_proximity *p = &found.items[i];
        if (p->kind == r->kind && p->a == r->a && p->b == r->b) return p;
    }
    return NULL;
}

/* Of the points at both ends. */
static double extent_of(int query) {
    const double *first = x0[4 * query];
    double start = largest_offset((const double(*)[3])x0 + 4 * query, first),
           end = largest_offset((const double(*)[3])x1 + 4 * query, first);
    return fmin(fmax(fmax(start, end), 0x1p-300), 0x1p299);
}

/* ---- against the detector ------------------------------------------------------------------------------------- */

static void expect_same_contact(const cscd_pair_contact *found, const cscd_contact *expected) {
    static const cscd_pair_contact none = {.toi = INFINITY};
    if (expected == NULL) {
        assert_memory_equal(found, &none, sizeof none);
        return;
    }
    assert_int_equal(found->contact, 1);
    assert_true(found->bounded == expected->bounded && found->toi == expected->toi);
    assert_memory_equal(&found->u, &expected->u, sizeof found->u);
    assert_memory_equal(&found->v, &expected->v, sizeof found->v);
    assert_memory_equal(found->point, expected->point, sizeof found->point);
    assert_memory_equal(found->normal, expected->normal, sizeof found->normal);
}

static size_t compare_contacts(pair_rig *r) {
    size_t touching = 0;
    for (int i = 0; i < QUERY_COUNT; i++) {
        const cscd_contact *expected = step_pair(r, i, 0.0, 0.0);
        expect_same_contact(&contacts[i], expected);
        touching += expected != NULL;
    }
    return touching;
}

TEST(contacts_are_those_of_a_step) {
    for (int kind = 0; kind < 2; kind++) {
        pair_rig r = pair_rig_make((cscd_contact_kind)kind);
        const cscd_pairs all = all_of(r.kind);
        make_queries(r.kind, 1 + (uint64_t)kind);
        assert_int_equal(pairs_step_packed(r.context, &all, x0[0], x1[0], 0.0, 0.0, contacts), CSCD_OK);
        size_t moving = compare_contacts(&r);
        assert_int_equal(pairs_step_packed(r.context, &all, x0[0], NULL, 0.0, 0.0, contacts), CSCD_OK);
        memcpy(x1, x0, sizeof x1);
        size_t still = compare_contacts(&r);
        print_message("  of %d: %zu contacts moving, %zu at rest\n", QUERY_COUNT, moving, still);
        assert_true(moving > QUERY_COUNT / 4 && moving < QUERY_COUNT * 9 / 10 && still > 20);
        pair_rig_free(&r);
    }
}

/* Each query has a separation of its own size, so it is a call of its own. */
TEST(separations_are_those_of_a_step) {
    static const double shares[] = {1e-6, 0.01, 0.3};
    for (int kind = 0; kind < 2; kind++) {
        pair_rig r = pair_rig_make((cscd_contact_kind)kind);
        const cscd_pairs one = {r.kind, 4, 1, NULL};
        size_t touching = 0;
        make_queries(r.kind, 3 + (uint64_t)kind);
        for (int i = 0; i < QUERY_COUNT; i++) {
            double distance = fmax(0x1p-300, shares[i % 3] * extent_of(i)),
                   tolerance = i % 2 == 0 ? 0.0 : 0.1;
            if (i % 4 == 3) memcpy(x1[4 * i], x0[4 * i], 4 * sizeof *x1);
            assert_int_equal(pairs_step_packed(r.context, &one, x0[4 * i], i % 4 == 3 ? NULL : x1[4 * i],
                                               distance, tolerance, contacts),
                             CSCD_OK);
            const cscd_contact *expected = step_pair(&r, i, distance, tolerance);
            expect_same_contact(contacts, expected);
            touching += expected != NULL;
        }
        print_message("  of %d: %zu within the separation\n", QUERY_COUNT, touching);
        assert_true(touching > QUERY_COUNT / 4 && touching < QUERY_COUNT * 95 / 100);
        pair_rig_free(&r);
    }
}

/* The middle between the nearest points, up to the rounding of a few sums. Where features touch but for rounding the normal
 * lies across both. */
static void expect_same_point(const cscd_pair_distance *found, const cscd_proximity *expected, int query) {
    double point[3], largest = 0.0;
    cscd_proximity_point(expected, x0[4 * query], point);
    for (int i = 0; i < 12; i++) largest = fmax(largest, fabs(x0[4 * query + i / 3][i % 3]));
    for (int k = 0; k < 3; k++) assert_true(fabs(found->point[k] - point[k]) <= 0x1p-46 * largest);
}

static void expect_same_distance(const cscd_pair_distance *found, const cscd_proximity *expected, int query) {
    double u, v;
    static const cscd_pair_distance none = {.distance = INFINITY};
    if (expected == NULL) {
        assert_memory_equal(found, &none, sizeof none);
        return;
    }
    assert_memory_equal(&found->distance, &expected->distance, sizeof found->distance);
    cscd_stencil_parameters(expected->kind, expected->weights, &u, &v);
    assert_memory_equal(&found->u, &u, sizeof u);
    assert_memory_equal(&found->v, &v, sizeof v);
    assert_memory_equal(found->normal, expected->normal, sizeof found->normal);
    expect_same_point(found, expected, query);
}

TEST(distances_are_those_of_find_near) {
    static const double shares[] = {1e-3, 0.1, 0.5};
    for (int kind = 0; kind < 2; kind++) {
        pair_rig r = pair_rig_make((cscd_contact_kind)kind);
        const cscd_pairs one = {r.kind, 4, 1, NULL}, all = all_of(r.kind);
        size_t near = 0;
        make_queries(r.kind, 5 + (uint64_t)kind);
        assert_int_equal(pairs_near_packed(r.context, &all, x0[0], INFINITY, nearest), CSCD_OK);
        for (int i = 0; i < QUERY_COUNT; i++) {
            double distance = fmax(0x1p-300, shares[i % 3] * extent_of(i));
            assert_true(isfinite(nearest[i].distance));
            if (nearest[i].distance < 0x1p299)
                expect_same_distance(&nearest[i], measure_pair(&r, i, 0x1p300), i);
            assert_int_equal(pairs_near_packed(r.context, &one, x0[4 * i], distance, other_nearest), CSCD_OK);
            const cscd_proximity *expected = measure_pair(&r, i, distance);
            expect_same_distance(other_nearest, expected, i);
            near += expected != NULL;
        }
        print_message("  of %d: %zu near\n", QUERY_COUNT, near);
        assert_true(near > QUERY_COUNT / 10 && near < QUERY_COUNT * 9 / 10);
        pair_rig_free(&r);
    }
}

static void expect_refused(cscd_context *context, cscd_status status, const char *words) {
    assert_int_equal(status, CSCD_INVALID_ARGUMENT);
    if (strstr(cscd_context_detail(context), words) == NULL)
        fail_msg("\"%s\" in \"%s\"", words, cscd_context_detail(context));
}

/* ---- the same in other ways ----------------------------------------------------------------------------------- */

static void expect_same_results(cscd_context *context, const cscd_pairs *desc, const double *start,
                                const double *end) {
    assert_int_equal(pairs_step_packed(context, desc, start, end, 0.0, 0.0, other_contacts), CSCD_OK);
    assert_memory_equal(other_contacts, contacts, sizeof contacts);
    assert_int_equal(pairs_near_packed(context, desc, start, INFINITY, other_nearest), CSCD_OK);
    assert_memory_equal(other_nearest, nearest, sizeof nearest);
}

/* Points that are named by numbers, in another order. */
TEST(points_may_be_named) {
    static double start[POINTS][3], end[POINTS][3];
    static uint32_t points[POINTS];
    random_stream random = stream_start(7);
    for (uint32_t i = 0; i < POINTS; i++) points[i] = i;
    for (uint32_t i = POINTS; i > 1; i--) {
        uint32_t j = stream_below(&random, i), moved = points[j];
        points[j] = points[i - 1];
        points[i - 1] = moved;
    }
    for (int kind = 0; kind < 2; kind++) {
        const cscd_pairs all = all_of((cscd_contact_kind)kind),
                         named = {all.kind, POINTS, QUERY_COUNT, points};
        make_queries(all.kind, 8 + (uint64_t)kind);
        for (int i = 0; i < POINTS; i++) {
            memcpy(start[points[i]], x0[i], sizeof *start);
            memcpy(end[points[i]], x1[i], sizeof *end);
        }
        assert_int_equal(pairs_step_packed(contexts[0], &all, x0[0], x1[0], 0.0, 0.0, contacts), CSCD_OK);
        assert_int_equal(pairs_near_packed(contexts[0], &all, x0[0], INFINITY, nearest), CSCD_OK);
        expect_same_results(contexts[0], &named, start[0], end[0]);
    }
}

/* Floats by columns give what the same numbers give as packed doubles. */
TEST(any_layout_will_do) {
    static float columns[2][3][POINTS];
    for (int kind = 0; kind < 2; kind++) {
        const cscd_pairs all = all_of((cscd_contact_kind)kind);
        make_queries(all.kind, 11 + (uint64_t)kind);
        for (int i = 0; i < 3 * POINTS; i++) {
            float narrow[2] = {(float)x0[i / 3][i % 3], (float)x1[i / 3][i % 3]};
            for (int end = 0; end < 2; end++) {
                if (!isfinite(narrow[end])) narrow[end] = 1.0f;
                columns[end][i % 3][i / 3] = narrow[end];
            }
            x0[i / 3][i % 3] = (double)narrow[0];
            x1[i / 3][i % 3] = (double)narrow[1];
        }
        cscd_view views[2];
        for (int end = 0; end < 2; end++)
            views[end] = (cscd_view){.data = columns[end],
                                     .size = sizeof columns[end],
                                     .stride = sizeof(float),
                                     .coordinate_stride = sizeof columns[end][0],
                                     .scalar = CSCD_SCALAR_FLOAT};
        assert_int_equal(pairs_step_packed(contexts[0], &all, x0[0], x1[0], 0.0, 0.0, contacts), CSCD_OK);
        assert_int_equal(pairs_near_packed(contexts[0], &all, x0[0], INFINITY, nearest), CSCD_OK);
        assert_int_equal(cscd_pairs_step(contexts[0], &all, &views[0], &views[1], 0.0, 0.0, other_contacts),
                         CSCD_OK);
        assert_int_equal(cscd_pairs_find_near(contexts[0], &all, &views[0], INFINITY, other_nearest),
                         CSCD_OK);
        assert_memory_equal(other_contacts, contacts, sizeof contacts);
        assert_memory_equal(other_nearest, nearest, sizeof nearest);
        views[0].size--;
        expect_refused(contexts[0],
                       cscd_pairs_find_near(contexts[0], &all, &views[0], INFINITY, other_nearest),
                       "positions");
    }
}

/* ---- arguments ------------------------------------------------------------------------------------------------- */

TEST(bad_arguments_are_named) {
    static const uint32_t points[8] = {0, 1, 2, 3, 4, 5, 8, 7};
    const cscd_pairs two = {CSCD_CONTACT_EE, 8, 2, NULL}, few = {CSCD_CONTACT_EE, 7, 2, NULL},
                     wild = {CSCD_CONTACT_VF, 8, 2, points}, vv = {CSCD_CONTACT_VV, 8, 2, NULL};
    cscd_context *c = contexts[0];
    memset(contacts, 0xaa, sizeof *contacts);
    memset(nearest, 0xaa, sizeof *nearest);
    cscd_pair_contact before = *contacts;
    make_queries(CSCD_CONTACT_EE, 10);
    assert_int_equal(pairs_step_packed(NULL, &two, x0[0], x1[0], 0.0, 0.0, contacts), CSCD_NULL_OBJECT);
    expect_refused(c, pairs_step_packed(c, NULL, x0[0], x1[0], 0.0, 0.0, contacts), "pairs is NULL");
    expect_refused(c, pairs_step_packed(c, &two, x0[0], x1[0], 0.0, 0.0, NULL), "out is NULL");
    expect_refused(c, pairs_step_packed(c, &two, NULL, x1[0], 0.0, 0.0, contacts), "x0 is NULL");
    expect_refused(c, pairs_step_packed(c, &few, x0[0], x1[0], 0.0, 0.0, contacts),
                   "2 pairs need four points");
    expect_refused(c, pairs_step_packed(c, &wild, x0[0], x1[0], 0.0, 0.0, contacts), "pair 1 names point 8");
    expect_refused(c, pairs_step_packed(c, &vv, x0[0], x1[0], 0.0, 0.0, contacts), "kind 3");
    expect_refused(c, pairs_step_packed(c, &two, x0[0], x1[0], -1.0, 0.0, contacts), "min_separation is -1");
    expect_refused(c, pairs_step_packed(c, &two, x0[0], x1[0], 1.0, 1.5, contacts), "tolerance is 1.5");
    expect_refused(c, pairs_near_packed(c, &two, x0[0], 0.0, nearest), "distance is 0");
    expect_refused(c, pairs_near_packed(c, &two, x0[0], NAN, nearest), "distance is");
    x0[5][1] = NAN;
    expect_refused(c, pairs_near_packed(c, &two, x0[0], 1.0, nearest), "positions: vertex 5 has y");
    assert_memory_equal(contacts, &before, sizeof before);
}

AROUND_ALL(open_levels, close_levels)
