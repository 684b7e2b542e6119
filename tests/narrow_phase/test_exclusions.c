/* Pairs to leave out: a list does what the callback does, and seams make a split surface whole again. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

enum { SEEDS = 3, LIST_MAX = 4000 };

static scene whole, split; /* large; one test at a time */

/* ---- lists --------------------------------------------------------------------------------------------- */

/* Some pairs of triangles, each way round, some of them twice. */
typedef struct ignored_pairs {
    uint32_t pairs[2 * LIST_MAX];
    size_t count;
} ignored_pairs;

static bool ignored_by_rule(void *user, uint32_t a, uint32_t b) {
    assert_true(a < b);
    return (a + b + *(const uint32_t *)user) % 3 == 0;
}

static void list_by_rule(uint32_t rule, const cscd_contacts *contacts, const cscd_mesh *mesh,
                         ignored_pairs *out) {
    out->count = 0;
    for (size_t i = 0; i < contacts->count && out->count < LIST_MAX; i++) {
        const cscd_contact *c = &contacts->items[i];
        cscd_stencil s = cscd_mesh_stencil(mesh, c->kind, c->a, c->b, c->u, c->v);
        uint32_t count = cscd_mesh_triangle_count(mesh);
        for (uint32_t a = 0; a < count; a++) {
            uint32_t v[3];
            cscd_mesh_triangle(mesh, a, v);
            if (v[0] != s.vertices[0] && v[1] != s.vertices[0] && v[2] != s.vertices[0]) continue;
            for (uint32_t b = 0; b < count && out->count < LIST_MAX; b++) {
                uint32_t w[3];
                cscd_mesh_triangle(mesh, b, w);
                if (w[0] != s.vertices[3] && w[1] != s.vertices[3] && w[2] != s.vertices[3]) continue;
                if (a == b || !ignored_by_rule(&rule, a < b ? a : b, a < b ? b : a)) continue;
                out->pairs[2 * out->count] = a;
                out->pairs[2 * out->count++ + 1] = b;
            }
        }
    }
}

/* Names the larger triangle of each pair first, so that none is named the other way round besides. */
static void turn_round(ignored_pairs *list) {
    for (size_t i = 0; i < list->count; i++) {
        uint32_t *pair = &list->pairs[2 * i], a = pair[0], b = pair[1];
        pair[0] = a < b ? b : a;
        pair[1] = a < b ? a : b;
    }
}

static bool is_in_list(const ignored_pairs *list, uint32_t a, uint32_t b) {
    for (size_t i = 0; i < list->count; i++) {
        uint32_t x = list->pairs[2 * i], y = list->pairs[2 * i + 1];
        if ((x == a && y == b) || (x == b && y == a)) return true;
    }
    return false;
}

/* What the callback sees: features of the mesh, and the list of triangles. */
typedef struct feature_filter {
    const ignored_pairs *list;
    const cscd_mesh *mesh;
    size_t calls[3]; /* by kind */
} feature_filter;

static bool ignore_features(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    feature_filter *filter = user;
    uint32_t count_a = 1, count_b = 1;
    const uint32_t *star_a = &a, *star_b = &b;
    filter->calls[kind]++;
    if (kind == CSCD_CONTACT_VF) star_a = cscd_mesh_vertex_triangles(filter->mesh, a, &count_a);
    if (kind == CSCD_CONTACT_EE) {
        assert_true(a < b);
        star_a = cscd_mesh_edge_triangles(filter->mesh, a, &count_a);
        star_b = cscd_mesh_edge_triangles(filter->mesh, b, &count_b);
    }
    if (kind == CSCD_CONTACT_TT) assert_true(a < b);
    for (uint32_t i = 0; i < count_a * count_b; i++) {
        uint32_t s = star_a[i / count_b], t = star_b[i % count_b];
        if (s != t && is_in_list(filter->list, s, t)) return true;
    }
    return false;
}

static size_t compare_with_callback(const ignored_pairs *list, cscd_method method, cscd_mode mode) {
    cscd_detector_options by_list = cscd_detector_defaults(), by_callback;
    by_list.method = method;
    by_list.mode = mode;
    by_callback = by_list;
    by_list.ignored = list->pairs;
    by_list.ignored_count = list->count;
    feature_filter filter = {.list = list};
    by_callback.ignore = ignore_features;
    by_callback.ignore_user = &filter;
    rig l = rig_create(&whole, 1, &by_list), c = rig_create(&whole, 1, &by_callback);
    filter.mesh = c.mesh;
    cscd_intersections crossing_l, crossing_c;
    assert_int_equal(check_packed(l.detector, whole.x1, &crossing_l), CSCD_OK);
    assert_int_equal(check_packed(c.detector, whole.x1, &crossing_c), CSCD_OK);
    assert_int_equal(crossing_l.count, crossing_c.count);
    if (crossing_l.count > 0)
        assert_memory_equal(crossing_l.items, crossing_c.items, crossing_l.count * sizeof *crossing_l.items);
    cscd_contacts found_l = rig_step(&l, &whole), found_c = rig_step(&c, &whole);
    assert_int_equal(found_l.count, found_c.count);
    if (found_l.count > 0)
        assert_memory_equal(found_l.items, found_c.items, found_l.count * sizeof *found_l.items);
    size_t count = found_l.count;
    assert_true((filter.calls[CSCD_CONTACT_TT] > 0) >= (crossing_l.count > 0));
    assert_true(filter.calls[CSCD_CONTACT_VF] + filter.calls[CSCD_CONTACT_EE] >= count);
    rig_destroy(&l);
    rig_destroy(&c);
    return count;
}

TEST(a_list_does_what_the_callback_does) {
    static ignored_pairs list;
    size_t all = 0, kept = 0;
    static const scene_family closed[] = {SCENE_BENT_CAPSULE, SCENE_SPIKE, SCENE_TWO_SPHERES};
    for (uint32_t i = 0; i < sizeof closed / sizeof *closed; i++) {
        scene_make(closed[i], 2, &whole);
        rig r = rig_create(&whole, 1, NULL);
        cscd_contacts found = rig_step(&r, &whole);
        all += found.count;
        list_by_rule(i, &found, r.mesh, &list);
        rig_destroy(&r);
        kept += compare_with_callback(&list, CSCD_METHOD_NONE, CSCD_MODE_ALL);
        compare_with_callback(&list, CSCD_METHOD_SINGLE, CSCD_MODE_EARLIEST);
        turn_round(&list);
        compare_with_callback(&list, CSCD_METHOD_BRUTE, CSCD_MODE_ALL);
    }
    print_message("  %zu of %zu contacts kept\n", kept, all);
    assert_true(kept > 0 && kept < all);
}

/* ---- seams --------------------------------------------------------------------------------------------- */

static uint32_t of_whole[SCENE_VERTICES_MAX]; /* a vertex of the split surface: the one it came from */

/* Every triangle of a part of the surface gets vertices of its own; false: there are too many. */
static bool split_some(random_stream *random, ignored_pairs *seams) {
    static uint32_t last_copy[SCENE_VERTICES_MAX];
    split = whole;
    seams->count = 0;
    for (uint32_t v = 0; v < whole.vertex_count; v++) of_whole[v] = last_copy[v] = v;
    for (uint32_t k = 0; k < whole.triangle_count * 3; k++) {
        if (stream_below(random, 3) != 0) continue;
        uint32_t v = whole.triangles[k], copy = split.vertex_count++;
        if (copy == SCENE_VERTICES_MAX || seams->count == LIST_MAX) return false;
        memcpy(split.x0 + copy * 3, whole.x0 + v * 3, sizeof(double[3]));
        memcpy(split.x1 + copy * 3, whole.x1 + v * 3, sizeof(double[3]));
        split.triangles[k] = copy;
        of_whole[copy] = v;
        seams->pairs[2 * seams->count] = copy;
        seams->pairs[2 * seams->count++ + 1] = last_copy[v]; /* a chain */
        last_copy[v] = copy;
    }
    return true;
}

/* A contact by the vertices of the whole surface, comparable byte by byte. */
typedef struct named_contact {
    uint32_t kind, a[2], b[3];
} named_contact;

static void sort_two(uint32_t *x) {
    if (x[0] > x[1]) {
        uint32_t larger = x[0];
        x[0] = x[1];
        x[1] = larger;
    }
}

static named_contact name_contact(const cscd_mesh *mesh, const cscd_contact *c, const uint32_t *names) {
    cscd_stencil s = cscd_mesh_stencil(mesh, c->kind, c->a, c->b, c->u, c->v);
    named_contact n = {(uint32_t)c->kind, {names[s.vertices[0]], 0}, {0, 0, 0}};
    if (c->kind == CSCD_CONTACT_VF) {
        n.b[0] = c->b; /* triangles keep their numbers */
        return n;
    }
    uint32_t a[2] = {names[s.vertices[0]], names[s.vertices[1]]};
    uint32_t b[2] = {names[s.vertices[2]], names[s.vertices[3]]};
    sort_two(a);
    sort_two(b);
    bool swapped = a[0] > b[0] || (a[0] == b[0] && a[1] > b[1]);
    memcpy(n.a, swapped ? b : a, sizeof a);
    memcpy(n.b, swapped ? a : b, sizeof b);
    return n;
}

static int compare_named(const void *left, const void *right) {
    return memcmp(left, right, sizeof(named_contact));
}

/* Sorted, each once; the caller frees. */
static named_contact *named_contacts(const rig *r, const scene *s, const uint32_t *names, size_t *count) {
    cscd_contacts found = rig_step(r, s);
    named_contact *list = calloc(found.count + 1, sizeof *list);
    assert_non_null(list);
    for (size_t i = 0; i < found.count; i++) list[i] = name_contact(r->mesh, &found.items[i], names);
    qsort(list, found.count, sizeof *list, compare_named);
    *count = 0;
    for (size_t i = 0; i < found.count; i++) {
        if (*count == 0 || compare_named(&list[i], &list[*count - 1]) != 0) list[(*count)++] = list[i];
    }
    return list;
}

/* What a split surface with seams reports, by the names of the whole one, is what that reports; so is what
 * its static check lists. */
static size_t compare_split(cscd_method method, const ignored_pairs *seams) {
    static uint32_t same[SCENE_VERTICES_MAX];
    for (uint32_t v = 0; v < SCENE_VERTICES_MAX; v++) same[v] = v;
    cscd_detector_options options = cscd_detector_defaults();
    options.method = method;
    rig one = rig_create(&whole, 1, &options);
    options.seams = seams->pairs;
    options.seam_count = seams->count;
    rig sewn = rig_create(&split, 2, &options);
    cscd_intersections truth, listed;
    assert_int_equal(check_packed(one.detector, whole.x1, &truth), CSCD_OK);
    assert_int_equal(check_packed(sewn.detector, split.x1, &listed), CSCD_OK);
    assert_int_equal(listed.count, truth.count);
    for (size_t i = 0; i < truth.count; i++) {
        assert_int_equal(listed.items[i].a, truth.items[i].a);
        assert_int_equal(listed.items[i].b, truth.items[i].b);
    }
    size_t expected_count, found_count;
    named_contact *expected = named_contacts(&one, &whole, same, &expected_count);
    named_contact *found = named_contacts(&sewn, &split, of_whole, &found_count);
    assert_int_equal(found_count, expected_count);
    assert_memory_equal(found, expected, expected_count * sizeof *expected);
    free(expected);
    free(found);
    rig_destroy(&one);
    rig_destroy(&sewn);
    return expected_count;
}

TEST(seams_make_a_split_surface_whole) {
    static ignored_pairs seams;
    size_t contacts = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            random_stream random = stream_start(seed + 100 * (uint64_t)family);
            scene_make((scene_family)family, seed, &whole);
            if (!split_some(&random, &seams)) continue;
            contacts += compare_split(CSCD_METHOD_NONE, &seams);
            if (seed == 0) compare_split(CSCD_METHOD_BRUTE, &seams);
            compare_split(CSCD_METHOD_SINGLE, &seams);
        }
    }
    print_message("  %zu contacts\n", contacts);
    assert_true(contacts > 1000);
}

/* Two sheets sewn together along an edge, a little apart: near each other at the seam only there. */
TEST(a_seam_may_gape) {
    const uint32_t triangles[] = {0, 1, 2, 3, 4, 5}, seams[] = {0, 3, 1, 4};
    const cscd_object_desc desc = cscd_object_of_triangles(6, 2, triangles);
    const double x[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.01, 1, 0, 0.01, 0, -1, 0};
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_detector_options options = cscd_detector_defaults();
    cscd_proximities near;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    assert_int_equal(detector_create_here(mesh, NULL, &options, &detector), CSCD_OK);
    assert_int_equal(find_near_packed(detector, x, 0.05, &near), CSCD_OK);
    assert_true(near.count > 0);
    cscd_detector_destroy(detector);
    options.seams = seams;
    options.seam_count = 2;
    assert_int_equal(detector_create_here(mesh, NULL, &options, &detector), CSCD_OK);
    assert_int_equal(find_near_packed(detector, x, 0.05, &near), CSCD_OK);
    assert_int_equal(near.count, 0);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

/* Two triangles that pierce each other are ignored, also when a change has numbered them the other way round. */
TEST(ignored_triangles_may_change_places) {
    const uint32_t triangles[] = {0, 1, 2, 3, 4, 5}, turned[] = {3, 4, 5, 0, 1, 2}, origins[] = {1, 0},
                   pair[] = {0, 1};
    const cscd_object_desc before = cscd_object_of_triangles(6, 2, triangles),
                           after = cscd_object_of_triangles(6, 2, turned);
    const cscd_object_change change = {.object = 0, .desc = &after, .triangle_origins = origins};
    const double x[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0, 0, 0, -1, 0, 0, 1, 0, 3, 0};
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_mesh_change *turn;
    cscd_contacts found;
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &before, 1, &mesh), CSCD_OK);
    assert_int_equal(cscd_mesh_change_create(context, mesh, &change, 1, &turn), CSCD_OK);
    for (uint32_t ignored = 0; ignored < 2; ignored++) {
        cscd_detector *detector;
        cscd_detector_options options = cscd_detector_defaults();
        options.ignored = pair;
        options.ignored_count = ignored;
        assert_int_equal(detector_create_here(mesh, NULL, &options, &detector), CSCD_OK);
        for (int changed = 0; changed < 2; changed++) {
            if (changed) assert_int_equal(cscd_detector_change_mesh(detector, turn), CSCD_OK);
            assert_int_equal(step_packed(detector, x, x, &found), CSCD_OK);
            assert_true((found.count > 0) == (ignored == 0));
        }
        cscd_detector_destroy(detector);
    }
    cscd_mesh_change_destroy(turn);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

TEST(mistakes_are_named) {
    const uint32_t triangles[] = {0, 1, 2}, pairs[] = {0, 0, 0, 3};
    const cscd_object_desc desc = cscd_object_of_triangles(3, 1, triangles);
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector = NULL;
    cscd_detector_options options = cscd_detector_defaults();
    assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(context, &desc, 1, &mesh), CSCD_OK);
    options.ignored = pairs;
    options.ignored_count = 2;
    assert_int_equal(detector_create_here(mesh, NULL, &options, &detector), CSCD_INVALID_ARGUMENT);
    assert_string_equal(cscd_context_detail(context), "pair 1 of ignored names triangle 3, but there are 1");
    options.ignored_count = 0;
    options.seams = pairs;
    options.seam_count = 2;
    assert_int_equal(detector_create_here(mesh, NULL, &options, &detector), CSCD_INVALID_ARGUMENT);
    assert_string_equal(cscd_context_detail(context), "pair 1 of seams names vertex 3, but there are 3");
    options.seams = NULL;
    assert_int_equal(detector_create_here(mesh, NULL, &options, &detector), CSCD_INVALID_ARGUMENT);
    assert_string_equal(cscd_context_detail(context), "seams is NULL, but there are to be 2 pairs");
    assert_null(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}
