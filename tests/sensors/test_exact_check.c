/* The exact check of particle sensors: against brute force over the same areas, and against the detector. */
#include "sensors/exact_check.h"
#include "tests/support/ccd/elementary_cases.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/sensors/sensor_rig.h"
#include "tests/support/test.h"

#include <string.h>

enum { SCENES_PER_FAMILY = PACED(12, 3), SCENES_OF_TWO = PACED(60, 30) };

static scene interval; /* large; one test at a time */

/* ---- brute force --------------------------------------------------------------------------------------- */

/* One bit per side of each feature; a feature may be of both sides. */
typedef struct sides {
    uint8_t vertices[SCENE_VERTICES_MAX], edges[SCENE_TRIANGLES_MAX * 3], triangles[SCENE_TRIANGLES_MAX];
} sides;

static bool contains_cell(const uint32_t *cells, uint32_t count, uint32_t cell) {
    for (uint32_t i = 0; i < count; i++) {
        if (cells[i] == cell) return true;
    }
    return false;
}

static void mark_side(const sensor_partition *p, const uint32_t *cells, uint32_t count, uint8_t side,
                      sides *out) {
    const cscd_mesh *mesh = p->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corners = mesh->triangles[t];
        bool within = false;
        for (int k = 0; k < 3; k++)
            within = within || contains_cell(cells, count, p->vertex_cells[corners[k]]);
        if (!within) continue;
        out->triangles[t] |= side;
        for (int k = 0; k < 3; k++) {
            out->vertices[corners[k]] |= side;
            out->edges[mesh->triangle_edges[t][k]] |= side;
        }
    }
}

/* Is one of the features of the first side and the other of the second? */
static bool facing_sides(uint8_t a, uint8_t b) {
    return ((a & 1) != 0 && (b & 2) != 0) || ((a & 2) != 0 && (b & 1) != 0);
}

static void test_pair(const swept_interval *moving, cscd_contact_kind kind, uint32_t a, uint32_t b,
                      area_verdict *out) {
    const cscd_mesh *mesh = moving->mesh;
    bool vf = kind == CSCD_CONTACT_VF;
    swept_box box_a = vf ? swept_box_of(moving, &a, 1) : swept_box_of(moving, mesh->edges[a], 2);
    swept_box box_b = swept_box_of(moving, vf ? mesh->triangles[b] : mesh->edges[b], vf ? 3 : 2);
    elementary_query query;
    elementary_contact hit;
    swept_interval_load(moving, kind, a, b, &query);
    out->tests += swept_boxes_within(&box_a, &box_b, 0.0);
    if (!pair_test(kind, &query, &hit).touching) return;
    if (!out->contact || hit.toi < out->toi) out->toi = hit.toi;
    out->contact = true;
}

static area_verdict brute_force(const sensor_partition *p, const area_query *query) {
    static sides marks;
    const cscd_mesh *mesh = p->mesh;
    swept_interval moving = {.mesh = mesh, .x0 = query->start, .x1 = query->end};
    area_verdict verdict = {0};
    memset(&marks, 0, sizeof marks);
    mark_side(p, query->cells_a, query->count_a, 1, &marks);
    mark_side(p, query->cells_b, query->count_b, 2, &marks);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            if (facing_sides(marks.vertices[v], marks.triangles[t]) &&
                !triangle_contains(mesh->triangles[t], v))
                test_pair(&moving, CSCD_CONTACT_VF, v, t, &verdict);
        }
    }
    for (uint32_t a = 0; a < mesh->edge_count; a++) {
        for (uint32_t b = a + 1; b < mesh->edge_count; b++) {
            if (facing_sides(marks.edges[a], marks.edges[b]) &&
                !edges_share_vertex(mesh->edges[a], mesh->edges[b]))
                test_pair(&moving, CSCD_CONTACT_EE, a, b, &verdict);
        }
    }
    return verdict;
}

static area_verdict run_check(exact_check *exact, const sensor_partition *p, const area_query *query) {
    area_verdict verdict;
    assert_int_equal(exact_check_run(exact, p, query, &verdict), CSCD_OK);
    return verdict;
}

static void assert_same(const area_verdict *found, const area_verdict *expected) {
    assert_int_equal(found->contact, expected->contact);
    assert_memory_equal(&found->toi, &expected->toi, sizeof found->toi);
    assert_int_equal(found->tests, expected->tests);
}

/* Chooses each of a part's cells with a chance of two in three. */
static uint32_t choose_cells(const sensor_partition *p, uint32_t part, uint32_t *out) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->parts[part].cell_count; i++) {
        if (random_integer(0, 2) > 0) out[count++] = p->parts[part].first_cell + i;
    }
    return count;
}

/* Makes parts of slabs of triangles, or, in one of four scenes, of random triangles. */
static void choose_parts(const scene *s, uint32_t part_count, uint32_t *triangle_parts) {
    bool any = random_integer(0, 3) == 0;
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        double x = s->x0[(size_t)s->triangles[t * 3] * 3];
        uint32_t slab = x < -0.3 ? 0 : x < 0.3 ? 1 : 2;
        triangle_parts[t] = any ? (uint32_t)random_integer(0, (int)part_count - 1) : slab % part_count;
    }
}

TEST(equals_brute_force) {
    static uint32_t triangle_parts[SCENE_TRIANGLES_MAX];
    uint32_t contacts = 0, none = 0, cells_a[64], cells_b[64];
    random_seed(1);
    for (int i = 0; i < SCENE_FAMILY_COUNT * SCENES_PER_FAMILY; i++) {
        scene_make((scene_family)(i % SCENE_FAMILY_COUNT), (uint64_t)i, &interval);
        rig r = rig_create(&interval, 1, NULL);
        choose_parts(&interval, 3, triangle_parts);
        sensor_partition *p = hand_partition_create(r.mesh, interval.x0, triangle_parts, 3, 6);
        exact_check exact;
        assert_int_equal(exact_check_create(r.mesh, &exact), CSCD_OK);
        for (int k = 0; k < 3; k++) {
            area_query query = {interval.x0, interval.x1, cells_a, cells_b, 0, 0};
            query.count_a = choose_cells(p, k == 0 ? 1 : 0, cells_a);
            query.count_b = choose_cells(p, k == 2 ? 1 : 2, cells_b);
            area_verdict found = run_check(&exact, p, &query), expected = brute_force(p, &query);
            assert_same(&found, &expected);
            contacts += found.contact;
            none += found.tests > 0 && !found.contact;
        }
        exact_check_destroy(&exact);
        hand_partition_destroy(p);
        rig_destroy(&r);
    }
    assert_true(contacts > 10 && none > 10);
}

/* ---- the detector -------------------------------------------------------------------------------------- */

static const cscd_contact *first_between(const rig *r, cscd_contacts found) {
    const cscd_contact *first = NULL;
    for (size_t i = 0; i < found.count; i++) {
        const cscd_contact *c = &found.items[i];
        const uint32_t *stars = c->kind == CSCD_CONTACT_VF ? r->mesh->vertex_stars : r->mesh->edge_stars;
        const uint32_t *offsets =
            c->kind == CSCD_CONTACT_VF ? r->mesh->vertex_star_offsets : r->mesh->edge_star_offsets;
        uint32_t a = stars[offsets[c->a]], b = c->kind == CSCD_CONTACT_VF ? c->b : stars[offsets[c->b]];
        if (r->mesh->triangle_components[a] == r->mesh->triangle_components[b]) continue;
        if (first == NULL || c->toi < first->toi) first = c;
    }
    return first;
}

TEST(equals_detector) {
    const scene_family families[] = {SCENE_TWO_SPHERES, SCENE_NESTED_SPHERES, SCENE_LINKED_TORI};
    uint32_t contacts = 0, none = 0, cells[128];
    for (uint32_t i = 0; i < 128; i++) cells[i] = i;
    random_seed(2);
    for (int i = 0; i < SCENES_OF_TWO; i++) {
        scene_make(families[i % 3], 1000u + (uint64_t)i, &interval);
        rig r = rig_create(&interval, 1, NULL);
        sensor_partition *p = hand_partition_create(r.mesh, interval.x0, NULL, 2, 9);
        uint32_t count = p->parts[0].cell_count;
        area_query query = {interval.x0, interval.x1, cells, cells + count, count, p->parts[1].cell_count};
        exact_check exact;
        assert_int_equal(exact_check_create(r.mesh, &exact), CSCD_OK);
        area_verdict found = run_check(&exact, p, &query);
        const cscd_contact *first = first_between(&r, rig_step(&r, &interval));
        assert_int_equal(found.contact, first != NULL);
        if (first != NULL) assert_memory_equal(&found.toi, &first->toi, sizeof found.toi);
        contacts += found.contact;
        none += !found.contact;
        exact_check_destroy(&exact);
        hand_partition_destroy(p);
        rig_destroy(&r);
    }
    assert_true(contacts > 3 && none > 3);
}

/* ---- order, reuse, memory ------------------------------------------------------------------------------ */

TEST(order_and_reuse_do_not_matter) {
    uint32_t cells[128], reversed[128];
    random_seed(3);
    scene_make(SCENE_LINKED_TORI, 5, &interval);
    rig r = rig_create(&interval, 1, NULL);
    sensor_partition *p = hand_partition_create(r.mesh, interval.x0, NULL, 2, 9);
    uint32_t count = p->parts[0].cell_count, others = p->parts[1].cell_count;
    for (uint32_t i = 0; i < count + others; i++) cells[i] = i;
    for (uint32_t i = 0; i < count; i++) reversed[i] = count - 1 - i;
    exact_check exact;
    assert_int_equal(exact_check_create(r.mesh, &exact), CSCD_OK);
    area_query query = {interval.x0, interval.x1, cells, cells + count, count, others};
    area_query swapped = {interval.x0, interval.x1, cells + count, reversed, others, count};
    area_query empty = {interval.x0, interval.x1, cells, NULL, count, 0};
    area_verdict first = run_check(&exact, p, &query), second = run_check(&exact, p, &swapped);
    area_verdict none = run_check(&exact, p, &empty), again = run_check(&exact, p, &query);
    assert_true(first.tests > 0);
    assert_same(&second, &first);
    assert_same(&again, &first);
    assert_false(none.contact);
    assert_int_equal(none.tests, 0);
    exact_check_destroy(&exact);
    exact_check_destroy(&exact);
    hand_partition_destroy(p);
    rig_destroy(&r);
}
