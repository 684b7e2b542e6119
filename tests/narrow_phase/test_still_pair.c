/* Pairs that do not move: the same verdicts as integers give, alone and in steps, and the same contacts as without the short
 * cut. */
#include "cscd/cscd.h"
#include "runtime/ccd/exact.h"
#include "runtime/narrow_phase/feature_queue.h"
#include "tests/support/calls.h"
#include "tests/support/ccd/elementary_cases.h"
#include "tests/support/ccd/elementary_generator.h"
#include "tests/support/oracle.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <math.h>
#include <string.h>

enum { QUERIES_A_FAMILY = 400, SCENES_AT_REST = 600 };

typedef struct still_tally {
    int touching, apart;
} still_tally;

/* The query as it is at one of its ends, for good. */
static elementary_query stopped_query(random_stream *random, cscd_contact_kind kind, query_family family) {
    elementary_query query = generate_query(random, kind, family);
    if (stream_below(random, 2) == 0)
        memcpy(query.x1, query.x0, sizeof query.x1);
    else
        memcpy(query.x0, query.x1, sizeof query.x0);
    return query;
}

static void check_still(cscd_contact_kind kind, const elementary_query *query, still_tally *tally) {
    elementary_contact contact, expected, queued;
    elementary_verdict verdict;
    double toi = 2.0;
    bool touching = exact_touch(query, kind, &toi);
    assert_true(still_pair_decide(query, kind, &verdict, &contact));
    assert_int_equal(verdict.touching, touching);
    assert_int_equal(verdict.level, ELEMENTARY_EXACT);
    assert_int_equal(pair_test(kind, query, &queued).touching, touching);
    tally->touching += touching;
    tally->apart += !touching;
    if (!touching) return;
    assert_true(toi == 0.0);
    assert_true(elementary_after_signs(query, kind, &expected).touching);
    assert_memory_equal(&contact, &expected, sizeof contact);
    assert_memory_equal(&queued, &expected, sizeof queued);
}

static void check_kind(cscd_contact_kind kind) {
    random_stream random = stream_start(91 + (uint64_t)kind);
    for (int family = 0; family < FAMILY_COUNT; family++) {
        still_tally tally = {0};
        for (int i = 0; i < QUERIES_A_FAMILY; i++) {
            elementary_query query = stopped_query(&random, kind, (query_family)family);
            check_still(kind, &query, &tally);
        }
        if (family >= FAMILY_END_CONTACT && family <= FAMILY_STATIC)
            assert_true(tally.touching >= QUERIES_A_FAMILY / 50 && tally.apart >= QUERIES_A_FAMILY / 5);
        print_message("%-15s touching %d apart %d\n", query_family_name((query_family)family), tally.touching,
                      tally.apart);
    }
}

TEST(vf_agrees_with_integers) {
    check_kind(CSCD_CONTACT_VF);
}

TEST(ee_agrees_with_integers) {
    check_kind(CSCD_CONTACT_EE);
}

/* One coordinate of one point moves, by as little as it can. */
TEST(leaves_what_moves) {
    random_stream random = stream_start(93);
    for (int i = 0; i < 24 * QUERIES_A_FAMILY; i++) {
        cscd_contact_kind kind = (cscd_contact_kind)(i % 2);
        elementary_contact contact;
        elementary_verdict verdict;
        elementary_query query = stopped_query(&random, kind, FAMILY_AXIS_PLANE);
        double *moved = &query.x1[i / 2 % 12 / 3][i / 2 % 3];
        *moved = nextafter(*moved, 1e9);
        assert_false(still_pair_decide(&query, kind, &verdict, &contact));
    }
}

/* ---- steps ------------------------------------------------------------------------------------------------ */

static scene at_rest; /* large; one test at a time */
static bool collapsed[SCENE_VERTICES_MAX];

static bool touch_by_integers(cscd_contact_kind kind, const uint32_t v[4]) {
    elementary_query query;
    double toi;
    for (int i = 0; i < 4; i++) {
        memcpy(query.x0[i], at_rest.x0 + (size_t)v[i] * 3, sizeof query.x0[i]);
        memcpy(query.x1[i], at_rest.x1 + (size_t)v[i] * 3, sizeof query.x1[i]);
    }
    return exact_touch(&query, kind, &toi);
}

/* The pair is the next contact if integers say that it touches. */
static void expect_next(const cscd_contacts *found, size_t *next, cscd_contact_kind kind,
                        const uint32_t pair[2], const uint32_t v[4]) {
    for (int i = 0; i < 4; i++) {
        for (int j = kind == CSCD_CONTACT_VF ? 1 : 2; j < 4 && i < (kind == CSCD_CONTACT_VF ? 1 : 2); j++)
            if (v[i] == v[j]) return;
    }
    if (collapsed[v[0]] && collapsed[v[3]]) return;
    if (!touch_by_integers(kind, v)) return;
    assert_true(*next < found->count);
    const cscd_contact *c = &found->items[(*next)++];
    assert_true(c->kind == kind && c->a == pair[0] && c->b == pair[1] && c->toi == 0.0);
}

static void expect_all(const cscd_mesh *mesh, const cscd_contacts *found) {
    size_t next = 0;
    collapsed_oracle(&at_rest, at_rest.x0, NULL, collapsed);
    for (uint32_t a = 0; a < at_rest.vertex_count; a++) {
        uint32_t star;
        cscd_mesh_vertex_triangles(mesh, a, &star);
        for (uint32_t b = 0; star > 0 && b < at_rest.triangle_count; b++) {
            const uint32_t *c = at_rest.triangles + (size_t)b * 3;
            expect_next(found, &next, CSCD_CONTACT_VF, (uint32_t[2]){a, b},
                        (uint32_t[4]){a, c[0], c[1], c[2]});
        }
    }
    for (uint32_t a = 0; a < cscd_mesh_edge_count(mesh); a++) {
        for (uint32_t b = a + 1; b < cscd_mesh_edge_count(mesh); b++) {
            uint32_t v[4];
            cscd_mesh_edge(mesh, a, v);
            cscd_mesh_edge(mesh, b, v + 2);
            expect_next(found, &next, CSCD_CONTACT_EE, (uint32_t[2]){a, b}, v);
        }
    }
    assert_int_equal(next, found->count);
}

static size_t compare_step(cscd_method method) {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_contacts found;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    const cscd_object_desc desc =
        cscd_object_of_triangles(at_rest.vertex_count, at_rest.triangle_count, at_rest.triangles);
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    assert_int_equal(cscd_detector_create(context, mesh, NULL, &options, &detector), CSCD_OK);
    assert_int_equal(step_packed(detector, at_rest.x0, at_rest.x1, &found), CSCD_OK);
    expect_all(mesh, &found);
    size_t count = found.count;
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
    return count;
}

/* Small integer coordinates: faces and edges that touch, cross, lie in one plane, coincide and have collapsed. */
TEST(steps_at_rest_agree_with_integers) {
    size_t contacts = 0;
    for (uint64_t seed = 0; seed < SCENES_AT_REST; seed++) {
        scene_make(SCENE_GRID, seed, &at_rest);
        memcpy(at_rest.x1, at_rest.x0, sizeof at_rest.x1);
        contacts += compare_step(CSCD_METHOD_NONE);
        contacts += compare_step(CSCD_METHOD_SINGLE);
    }
    print_message("%zu contacts\n", contacts);
    assert_true(contacts > 5 * SCENES_AT_REST);
}
