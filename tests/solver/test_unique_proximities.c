/* Proximities without repetitions: merged as brute force over the list of pairs merges them, with the same energy. */
#include "cscd/cscd.h"
#include "src/mesh/mesh.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/solver/solver_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene at_rest, moment; /* large; one test at a time */

/* The scenes are a few units large, and their edges some tenths. */
static const double distances[] = {1e-3, 0.03, 0.25};
enum { DISTANCE_COUNT = sizeof distances / sizeof *distances };

/* ---- brute force over the list of pairs ------------------------------------------------------------------ */

/* The vertices on each side that a nearest point lies on, sorted; all four, in the pair's order, where two edges are
 * nearly parallel. */
typedef struct parts {
    uint32_t side[2][3];
    int size[2];
    uint32_t vf, ee;
    double weight;
} parts;

static int vertices_of_first(const cscd_proximity *p) {
    return p->kind == CSCD_CONTACT_VF || p->kind == CSCD_CONTACT_VV ? 1 : 2;
}

static int compare_numbers(const void *left, const void *right) {
    uint32_t l = *(const uint32_t *)left, r = *(const uint32_t *)right;
    return (l > r) - (l < r);
}

static int compare_sides(const uint32_t *l, int l_size, const uint32_t *r, int r_size) {
    if (l_size != r_size) return l_size - r_size;
    for (int i = 0; i < l_size; i++) {
        if (l[i] != r[i]) return l[i] < r[i] ? -1 : 1;
    }
    return 0;
}

static int compare_parts(const void *left, const void *right) {
    const parts *l = left, *r = right;
    for (int s = 0; s < 2; s++) {
        int order = compare_sides(l->side[s], l->size[s], r->side[s], r->size[s]);
        if (order != 0) return order;
    }
    return 0;
}

/* The smaller side comes first, and a side of one vertex for two features. whole: all vertices count. */
static parts parts_of(const cscd_proximity *p, bool whole) {
    parts of = {.vf = p->vf_count, .ee = p->ee_count, .weight = p->weight};
    for (int i = 0; i < 4; i++) {
        int s = i < vertices_of_first(p) ? 0 : 1;
        if (whole || p->weights[i] != 0.0) of.side[s][of.size[s]++] = p->vertices[i];
    }
    for (int s = 0; s < 2; s++) qsort(of.side[s], (size_t)of.size[s], sizeof(uint32_t), compare_numbers);
    if (compare_sides(of.side[0], of.size[0], of.side[1], of.size[1]) > 0) {
        parts turned = of;
        for (int s = 0; s < 2; s++) {
            memcpy(turned.side[s], of.side[1 - s], sizeof turned.side[s]);
            turned.size[s] = of.size[1 - s];
        }
        return turned;
    }
    return of;
}

/* Merges equal neighbours of a sorted array. */
static size_t merge_parts(parts *all, size_t count) {
    size_t kept = 0;
    if (count > 0) qsort(all, count, sizeof *all, compare_parts);
    for (size_t i = 0; i < count; i++) {
        if (kept > 0 && compare_parts(&all[kept - 1], &all[i]) == 0) {
            all[kept - 1].vf += all[i].vf;
            all[kept - 1].ee += all[i].ee;
            all[kept - 1].weight += all[i].weight;
        } else {
            all[kept++] = all[i];
        }
    }
    return kept;
}

static parts *list_parts(const item_list *list, const double *x) {
    parts *all = calloc(list->count + 1, sizeof *all);
    assert_non_null(all);
    for (size_t i = 0; i < list->count; i++) {
        const cscd_proximity *p = &list->items[i];
        all[i] = parts_of(p, mollifier_of(p, x) < 1.0);
    }
    return all;
}

static void compare_with_merged_pairs(const item_list *pairs, const item_list *items, const double *x) {
    parts *expected = list_parts(pairs, x), *found = list_parts(items, x);
    size_t count = merge_parts(expected, pairs->count);
    assert_int_equal(items->count, count);
    if (count > 0) qsort(found, count, sizeof *found, compare_parts);
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(compare_parts(&found[i], &expected[i]), 0);
        assert_int_equal(found[i].vf, expected[i].vf);
        assert_int_equal(found[i].ee, expected[i].ee);
        assert_true(fabs(found[i].weight - expected[i].weight) <= 1e-14 * expected[i].weight);
    }
    free(expected);
    free(found);
}

/* ---- single items ---------------------------------------------------------------------------------------- */

static int compare_names(const cscd_proximity *l, const cscd_proximity *r) {
    if (l->kind != r->kind) return l->kind < r->kind ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return (l->b > r->b) - (l->b < r->b);
}

static long double extent_of(const cscd_proximity *p, const double *x) {
    long double largest = 0.0L;
    for (uint32_t i = 0; i < 12; i++)
        largest = fmaxl(
            largest, fabsl((long double)x[p->vertices[i / 3] * 3 + i % 3] - x[p->vertices[0] * 3 + i % 3]));
    return largest;
}

/* Compares distance, normal and point with the sums that vertices and weights stand for. */
static void check_item(const rig *r, const cscd_proximity *p, const double *x) {
    cscd_stencil s = stencil_of_item(r->mesh, p);
    long double rounding = 0x1p-48L * extent_of(p, x), square = 0.0L;
    assert_memory_equal(s.vertices, p->vertices, sizeof s.vertices);
    assert_memory_equal(s.weights, p->weights, sizeof s.weights);
    assert_int_equal(p->count, p->vf_count + p->ee_count);
    double u, v, point[3];
    cscd_stencil_parameters(p->kind, p->weights, &u, &v);
    cscd_proximity_point(p, x, point);
    assert_true(p->count > 0 && u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0);
    for (uint32_t k = 0; k < 3; k++) {
        long double apart = 0.0L, middle = 0.0L, largest = 0.0L, origin = x[p->vertices[0] * 3 + k];
        for (int i = 0; i < 4; i++) {
            long double coordinate = x[p->vertices[i] * 3 + k];
            apart += p->weights[i] * (coordinate - origin);
            middle += 0.5L * fabsl(p->weights[i]) * coordinate;
            largest = fmaxl(largest, fabsl(coordinate));
        }
        square += apart * apart;
        assert_true(fabsl(middle - point[k]) <= rounding + 0x1p-50L * largest);
        if (p->distance > 1e4L * rounding)
            assert_true(fabsl(apart - p->distance * p->normal[k]) <= 8.0L * rounding);
    }
    assert_true(fabsl(sqrtl(square) - p->distance) <= rounding);
}

static void check_items(const rig *r, const item_list *list, const double *x) {
    for (size_t i = 0; i < list->count; i++) {
        const cscd_proximity *p = &list->items[i];
        if (i > 0) assert_true(compare_names(p - 1, p) < 0);
        if (p->kind == CSCD_CONTACT_VV) assert_true(p->a < p->b);
        if (p->kind == CSCD_CONTACT_VF || p->kind == CSCD_CONTACT_EE) assert_int_equal(p->count, 1);
        assert_true(p->threshold == 0.0 || p->kind == CSCD_CONTACT_EE);
        check_item(r, p, x);
    }
}

typedef struct form_tally {
    size_t pairs, items, of_kind[CSCD_CONTACT_EV + 1], mollified;
} form_tally;

static void compare_forms(const rig *r, const double *x, double distance, form_tally *t) {
    item_list pairs = find_items(r, x, distance, CSCD_NEAR_PAIRS),
              items = find_items(r, x, distance, CSCD_NEAR_UNIQUE);
    check_items(r, &pairs, x);
    check_items(r, &items, x);
    compare_with_merged_pairs(&pairs, &items, x);
    double expected = sum_energies(&pairs, x, distance, false),
           found = sum_energies(&items, x, distance, true);
    assert_true(fabs(found - expected) <= 1e-12 * expected);
    t->pairs += pairs.count;
    t->items += items.count;
    for (size_t i = 0; i < items.count; i++) {
        t->of_kind[items.items[i].kind]++;
        t->mollified += mollifier_of(&items.items[i], x) < 1.0;
    }
    free(pairs.items);
    free(items.items);
}

/* ---- weights --------------------------------------------------------------------------------------------- */

/* A third of the areas at rest of the triangles that have this vertex, or, with another one, this edge. */
static long double area_around(const rig *r, uint32_t vertex, uint32_t other) {
    long double sum = 0.0L;
    for (uint32_t t = 0; t < r->mesh->triangle_count; t++) {
        const uint32_t *corners = r->mesh->triangles[t];
        long double u[3], v[3], squares = 0.0L;
        int found = 0;
        for (int i = 0; i < 3; i++) found += corners[i] == vertex || corners[i] == other;
        if (found != (vertex == other ? 1 : 2)) continue;
        for (uint32_t k = 0; k < 3; k++) {
            u[k] = (long double)at_rest.x0[corners[1] * 3 + k] - at_rest.x0[corners[0] * 3 + k];
            v[k] = (long double)at_rest.x0[corners[2] * 3 + k] - at_rest.x0[corners[0] * 3 + k];
        }
        for (int k = 0; k < 3; k++) {
            long double across = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
            squares += across * across;
        }
        sum += 0.5L * sqrtl(squares) / 3.0L;
    }
    return sum;
}

static double weight_of(const rig *r, const cscd_proximity *p) {
    if (p->kind == CSCD_CONTACT_VF) return (double)(0.25L * area_around(r, p->a, p->a));
    const uint32_t *v = p->vertices;
    return (double)(0.25L * (area_around(r, v[0], v[1]) + area_around(r, v[2], v[3])));
}

/* Every pair has the weight of its features, and both forms have the same sum of weight times energy. */
static void compare_weights(const rig *r, double distance) {
    item_list pairs = find_items(r, at_rest.x1, distance, CSCD_NEAR_PAIRS),
              items = find_items(r, at_rest.x1, distance, CSCD_NEAR_UNIQUE);
    double expected = 0.0, found = 0.0;
    for (size_t i = 0; i < pairs.count; i++) {
        const cscd_proximity *p = &pairs.items[i];
        double weight = weight_of(r, p);
        assert_true(fabs(p->weight - weight) <= 1e-12 * weight + 1e-15 && p->separation == 0.0);
        expected += p->weight * mollifier_of(p, at_rest.x1) * exp(-p->distance);
    }
    for (size_t i = 0; i < items.count; i++) {
        const cscd_proximity *p = &items.items[i];
        found += p->weight * mollifier_of(p, at_rest.x1) * exp(-p->distance);
    }
    assert_true(fabs(found - expected) <= 1e-12 * expected);
    free(pairs.items);
    free(items.items);
}

/* ---- all of it ------------------------------------------------------------------------------------------- */

TEST(items_stand_for_all_pairs) {
    form_tally t = {0};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 0; seed < 6; seed++) {
            double distance = distances[((uint64_t)family + seed) % DISTANCE_COUNT];
            scene_make((scene_family)family, seed, &at_rest);
            rig r = near_rig(&at_rest, 1 + (uint32_t)seed % 3);
            compare_forms(&r, at_rest.x1, distance, &t);
            set_rest(&r, at_rest.x0);
            compare_forms(&r, at_rest.x1, distance, &t);
            compare_weights(&r, distance);
            rig_destroy(&r);
        }
    }
    print_message("  %zu pairs, %zu items: %zu VF, %zu EE (%zu mollified), %zu VV, %zu EV\n", t.pairs,
                  t.items, t.of_kind[CSCD_CONTACT_VF], t.of_kind[CSCD_CONTACT_EE], t.mollified,
                  t.of_kind[CSCD_CONTACT_VV], t.of_kind[CSCD_CONTACT_EV]);
    assert_true(t.items < t.pairs && t.mollified > 100);
    for (int kind = 0; kind <= CSCD_CONTACT_EV; kind++)
        assert_true(kind == CSCD_CONTACT_TT || t.of_kind[kind] > 100);
}

/* ---- the same in other ways -------------------------------------------------------------------------------- */

static void expect_same_items(const item_list *list, const item_list *other) {
    assert_int_equal(list->count, other->count);
    if (list->count > 0) assert_memory_equal(list->items, other->items, list->count * sizeof *list->items);
}

TEST(same_from_a_line_search) {
    static double x[SCENE_VERTICES_MAX * 3];
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        cscd_line_search *line;
        cscd_proximities found;
        scene_make((scene_family)family, 6, &at_rest);
        rig r = near_rig(&at_rest, 2);
        set_rest(&r, at_rest.x0);
        expect_ok(cscd_line_search_create(r.detector, &line));
        expect_ok(line_begin_packed(line, at_rest.x0, at_rest.x1, 0.2));
        expect_ok(line_positions_packed(line, 0.3, x));
        item_list expected = find_items(&r, x, 0.2, CSCD_NEAR_UNIQUE);
        expect_ok(cscd_line_search_find_near(line, 0.3, 0.2, CSCD_NEAR_UNIQUE, &found));
        item_list list = {(cscd_proximity *)found.items, found.count};
        expect_same_items(&list, &expected);
        free(expected.items);
        cscd_line_search_destroy(line);
        rig_destroy(&r);
    }
}

TEST(same_when_scaled) {
    static const int exponents[] = {-240, -140, 100, 240};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        int exponent = exponents[family % 4];
        scene_make((scene_family)family, 11, &at_rest);
        moment = at_rest;
        for (uint32_t i = 0; i < moment.vertex_count * 3; i++) {
            moment.x0[i] = ldexp(moment.x0[i], exponent);
            moment.x1[i] = ldexp(moment.x1[i], exponent);
        }
        rig plain = near_rig(&at_rest, 1), scaled = near_rig(&moment, 1);
        set_rest(&plain, at_rest.x0);
        set_rest(&scaled, moment.x0);
        item_list expected = find_items(&plain, at_rest.x1, 0.1, CSCD_NEAR_UNIQUE),
                  found = find_items(&scaled, moment.x1, ldexp(0.1, exponent), CSCD_NEAR_UNIQUE);
        assert_int_equal(found.count, expected.count);
        for (size_t i = 0; i < found.count; i++) {
            const cscd_proximity *p = &found.items[i], *t = &expected.items[i];
            assert_int_equal(compare_names(p, t), 0);
            assert_memory_equal(p->weights, t->weights, sizeof p->weights);
            assert_true(p->vf_count == t->vf_count && p->ee_count == t->ee_count &&
                        p->distance == ldexp(t->distance, exponent));
            assert_true(p->threshold == ldexp(t->threshold, 4 * exponent));
            assert_true(p->weight == ldexp(t->weight, 2 * exponent));
        }
        free(expected.items);
        free(found.items);
        rig_destroy(&scaled);
        rig_destroy(&plain);
    }
}

/* ---- arguments ----------------------------------------------------------------------------------------- */

static size_t count_mollified(const rig *r) {
    item_list items = find_items(r, at_rest.x0, 0.25, CSCD_NEAR_UNIQUE);
    size_t count = 0;
    for (size_t i = 0; i < items.count; i++) count += items.items[i].threshold > 0.0;
    free(items.items);
    return count;
}

TEST(arguments_are_checked) {
    cscd_proximities out = {.count = 4711};
    scene_make(SCENE_SPIKE, 1, &at_rest);
    moment = at_rest;
    rig r = near_rig(&at_rest, 1);
    expect_invalid(r.context,
                   cscd_detector_find_near(r.detector, CSCD_DOUBLES(at_rest.x0, at_rest.vertex_count), 0.1,
                                           (cscd_near_form)4, &out),
                   "form 4");
    assert_true(out.items == NULL && out.count == 4711);
    assert_int_equal(set_rest_packed(NULL, at_rest.x0), CSCD_NULL_OBJECT);
    assert_int_equal(count_mollified(&r), 0);
    set_rest(&r, at_rest.x0);
    size_t known = count_mollified(&r);
    assert_true(known > 0);
    moment.x0[0] = 0x1p280;
    expect_invalid(r.context, set_rest_packed(r.detector, moment.x0), "long at rest");
    moment.x0[0] = NAN;
    expect_invalid(r.context, set_rest_packed(r.detector, moment.x0), "rest: vertex 0 has x");
    assert_int_equal(count_mollified(&r), known);
    set_rest(&r, NULL);
    assert_int_equal(count_mollified(&r), 0);
    rig_destroy(&r);
}
