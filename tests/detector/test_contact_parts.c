/* Contacts summed up by pair of parts: against sums that look at the whole list anew for every pair of parts. */
#include "tests/support/calls.h"
#include "tests/support/intersections/body_rig.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

static body_rig rig; /* large; one test at a time */
static uint32_t labels[SCENE_TRIANGLES_MAX], part_count;
static cscd_contacts found;

/* ---- scenes ---------------------------------------------------------------------------------------------- */

/* A body that swallows its tail, and a ball that goes through it. */
static void open_scene(counting_allocator *counter, uint32_t thread_count) {
    static const double centre[3] = {0.9, 0.2, 0.1};
    body_rig_begin(&rig);
    body_rig_add_snake(&rig);
    body_rig_end_body(&rig);
    scene_add_sphere(&rig.all, centre, 0.6, 9, 14);
    body_rig_end_body(&rig);
    rig.counter = counter;
    body_rig_create(&rig, NULL, thread_count);
    memcpy(rig.all.x1, rig.all.x0, sizeof rig.all.x0);
    for (uint32_t i = 0; i < rig.all.vertex_count * 3; i++)
        rig.all.x1[i] += i < rig.bodies[1].first_vertex * 3 ? 0.03 * (i % 5) : 0.1 * (i % 3) + 0.05;
}

static void step_scene(void) {
    expect_ok(step_packed(rig.detector, rig.all.x0, rig.all.x1, &found));
}

static void draw_labels(uint32_t count, uint64_t seed) {
    random_seed(seed);
    part_count = count;
    for (uint32_t t = 0; t < rig.all.triangle_count; t++)
        labels[t] = random_integer(0, 19) == 0 ? UINT32_MAX : (uint32_t)random_integer(0, (int)count - 1);
    expect_ok(cscd_detector_set_parts(rig.detector, labels, part_count));
}

/* ---- the brute force -------------------------------------------------------------------------------------- */

/* The label of the first triangle that has these corners, so many. */
static uint32_t label_of(const uint32_t *vertices, int count) {
    for (uint32_t t = 0; t < rig.all.triangle_count; t++) {
        const uint32_t *c = rig.all.triangles + (size_t)t * 3;
        int has = 0;
        for (int i = 0; i < count; i++)
            has += c[0] == vertices[i] || c[1] == vertices[i] || c[2] == vertices[i];
        if (has == count) return labels[t];
    }
    return UINT32_MAX;
}

static bool is_between(const cscd_contact *c, uint32_t a, uint32_t b) {
    int of_a = c->kind == CSCD_CONTACT_VF ? 1 : 2;
    uint32_t p = label_of(c->vertices, of_a), q = label_of(c->vertices + of_a, 4 - of_a);
    return (p == a && q == b) || (p == b && q == a);
}

static size_t compare_with_brute_force(const cscd_contact *items, size_t count) {
    cscd_contact_part_pairs sums;
    size_t next = 0, all = 0;
    expect_ok(cscd_detector_contact_parts(rig.detector, items, count, &sums));
    for (uint32_t i = 0; i <= part_count; i++) {
        for (uint32_t k = i; k <= part_count; k++) {
            cscd_contact_part_pair expected = {i == part_count ? UINT32_MAX : i,
                                               k == part_count ? UINT32_MAX : k, 0, 0, 2.0};
            for (size_t c = 0; c < count; c++) {
                if (!is_between(&items[c], expected.a, expected.b)) continue;
                expected.count++;
                if (items[c].toi >= expected.toi) continue;
                expected.toi = items[c].toi;
                expected.earliest = c;
            }
            if (expected.count == 0) continue;
            assert_true(next < sums.count);
            assert_memory_equal(&sums.items[next++], &expected, sizeof expected);
            all += expected.count;
        }
    }
    assert_int_equal(next, sums.count);
    assert_int_equal(all, count);
    return next;
}

/* ---- sums ------------------------------------------------------------------------------------------------- */

TEST(objects_are_parts_by_default) {
    open_scene(NULL, 1);
    step_scene();
    part_count = 2;
    for (uint32_t t = 0; t < rig.all.triangle_count; t++) labels[t] = t >= rig.bodies[1].first_triangle;
    assert_int_equal(compare_with_brute_force(found.items, found.count), 2);
    assert_int_equal(compare_with_brute_force(NULL, 0), 0);
}

/* Any selection, in any order; the list of the step stays. */
TEST(parts_of_the_caller) {
    size_t pairs = 0;
    for (uint32_t threads = 1; threads <= 3; threads++) {
        open_scene(NULL, threads);
        draw_labels(1 + 6 * (threads - 1), threads);
        step_scene();
        cscd_contact *copy = malloc(found.count * sizeof *copy);
        memcpy(copy, found.items, found.count * sizeof *copy);
        pairs += compare_with_brute_force(found.items, found.count);
        assert_memory_equal(copy, found.items, found.count * sizeof *copy);
        for (size_t i = 0; i < found.count; i++) copy[i] = found.items[found.count - 1 - i];
        compare_with_brute_force(copy, found.count / 2);
        copy[1] = copy[0]; /* of several at one time the first counts */
        compare_with_brute_force(copy, 2);
        free(copy);
    }
    assert_true(pairs > 60);
}

/* ---- wires, points, half-spaces ---------------------------------------------------------------------------- */

enum { LOOSE_VERTICES = 3 + 2 + 2 + 1 };

/* A triangle, a wire and two drops fall through each other and the ground. */
TEST(loose_objects_have_parts) {
    static const uint32_t triangle[3] = {0, 1, 2}, wire[2] = {0, 1};
    static const double up[3] = {0, 0, 1};
    static const double x0[LOOSE_VERTICES * 3] = {0, 0, 1, 4, 0, 1, 0, 4, 1, 1, 1, 2,
                                                  1, 1, 3, 1, 2, 2, 3, 3, 2, 9, 9, 0};
    double x1[LOOSE_VERTICES * 3];
    const cscd_object_desc objects[4] = {cscd_object_of_triangles(3, 1, triangle),
                                         cscd_object_of_wires(2, 1, wire), cscd_object_of_points(2),
                                         cscd_object_half_space(up)};
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_detector *detector = NULL;
    cscd_contact_part_pairs sums;
    memcpy(x1, x0, sizeof x0);
    for (int v = 3; v < 7; v++) x1[v * 3 + 2] -= 5.0; /* all but the triangle and the ground */
    expect_ok(cscd_context_create(NULL, &context));
    expect_ok(cscd_mesh_create(context, objects, 4, &mesh));
    expect_ok(cscd_detector_create(context, mesh, NULL, NULL, &detector));
    expect_ok(step_packed(detector, x0, x1, &found));
    expect_ok(cscd_detector_contact_parts(detector, found.items, found.count, &sums));
    /* The wire's ends and one drop meet the triangle (the other drop passes it by), and all four the ground. */
    static const uint32_t expected[4][3] = {{0, 1, 2}, {0, 2, 1}, {1, 3, 2}, {2, 3, 2}};
    assert_int_equal(sums.count, 4);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(sums.items[i].a, expected[i][0]);
        assert_int_equal(sums.items[i].b, expected[i][1]);
        assert_int_equal(sums.items[i].count, expected[i][2]);
    }
    const uint32_t label = 0;
    expect_ok(cscd_detector_set_parts(detector, &label, 1));
    expect_ok(cscd_detector_contact_parts(detector, found.items, found.count, &sums));
    assert_int_equal(sums.count, 2);
    assert_true(sums.items[0].a == 0 && sums.items[0].b == UINT32_MAX && sums.items[0].count == 3);
    assert_true(sums.items[1].a == UINT32_MAX && sums.items[1].b == UINT32_MAX && sums.items[1].count == 4);
    cscd_contact edges = {.kind = CSCD_CONTACT_EE};
    for (uint32_t e = 0; e < cscd_mesh_edge_count(mesh); e++) {
        uint32_t ends[2];
        cscd_mesh_edge(mesh, e, ends);
        if (ends[0] == 3) edges.a = e; /* the wire */
    }
    expect_ok(cscd_detector_contact_parts(detector, &edges, 1, &sums));
    assert_true(edges.a > 0 && sums.items[0].a == 0 && sums.items[0].b == UINT32_MAX);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

/* ---- calls ------------------------------------------------------------------------------------------------ */

TEST(what_is_refused) {
    cscd_contact_part_pairs sums;
    open_scene(NULL, 1);
    step_scene();
    assert_int_equal(cscd_detector_contact_parts(NULL, found.items, found.count, &sums), CSCD_NULL_OBJECT);
    assert_int_equal(cscd_detector_contact_parts(rig.detector, NULL, 1, &sums), CSCD_INVALID_ARGUMENT);
    assert_int_equal(cscd_detector_contact_parts(rig.detector, NULL, 0, NULL), CSCD_INVALID_ARGUMENT);
    const uint32_t vertices = rig.all.vertex_count, edges = cscd_mesh_edge_count(rig.mesh),
                   triangles = rig.all.triangle_count;
    const cscd_contact wrong[] = {
        {.kind = CSCD_CONTACT_VF, .a = vertices},
        {.kind = CSCD_CONTACT_VF, .b = triangles},
        {.kind = CSCD_CONTACT_EE, .a = edges},
        {.kind = CSCD_CONTACT_EE, .b = edges},
        {.kind = CSCD_CONTACT_VV, .b = vertices},
        {.kind = CSCD_CONTACT_EV, .a = edges},
        {.kind = CSCD_CONTACT_EV, .b = vertices},
        {.kind = CSCD_CONTACT_VH, .b = 2},
        {.kind = CSCD_CONTACT_TT},
        {.kind = (cscd_contact_kind)77},
        {.kind = CSCD_CONTACT_VH, .a = vertices, .b = 0},
        {.kind = CSCD_CONTACT_VV, .a = vertices},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const cscd_contact both[2] = {found.items[0], wrong[i]};
        expect_invalid(rig.context, cscd_detector_contact_parts(rig.detector, both, 2, &sums),
                       "contact 1 (kind ");
    }
}

AROUND_EACH(NULL, body_rigs_free)
