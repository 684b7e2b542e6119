/* Culling by orientation on random intervals: mode all equals the method that culls nothing, and mode
 * earliest that without later contacts; the published rules lose some (test_published.c). */
#include "tests/support/calls.h"
#include "tests/support/oracle.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { INTERVALS_PER_FAMILY = PACED(250, 25) };

enum { IGNORING_INTERVALS_PER_FAMILY = 150 };

static scene interval; /* large; one test at a time */

/* A scene and its contacts without culling. */
typedef struct reference {
    cscd_context *context;
    cscd_mesh *mesh;
    cscd_detector *detector;
    cscd_contacts contacts;
} reference;

static reference reference_create(const scene *s) {
    reference r = {0};
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    assert_int_equal(cscd_context_create(NULL, &r.context), CSCD_OK);
    assert_int_equal(cscd_mesh_create(r.context, &desc, 1, &r.mesh), CSCD_OK);
    assert_int_equal(detector_create_here(r.mesh, NULL, NULL, &r.detector), CSCD_OK);
    assert_int_equal(step_packed(r.detector, s->x0, s->x1, &r.contacts), CSCD_OK);
    return r;
}

static void reference_free(reference *r) {
    cscd_detector_destroy(r->detector);
    cscd_mesh_destroy(r->mesh);
    cscd_context_destroy(r->context);
}

static bool same_contact(const cscd_contact *a, const cscd_contact *b) {
    return memcmp(a, b, sizeof *a) == 0;
}

static void check_complete(const cscd_contacts *found, const cscd_contacts *truth) {
    assert_int_equal(found->count, truth->count);
    for (size_t i = 0; i < found->count; i++) assert_true(same_contact(&found->items[i], &truth->items[i]));
}

/* Checks that the list is what mode earliest says: bit for bit the truth without the contacts of components with
 * themselves that are later than their first. Returns how many those are. */
static size_t check_earliest(const reference *r, const scene *s, const cscd_detector *detector,
                             const cscd_contacts *found) {
    static double first[COMPONENTS_MAX];
    size_t next = 0;
    find_first_times(r->mesh, s, &r->contacts, first);
    for (size_t i = 0; i < r->contacts.count; i++) {
        const cscd_contact *contact = &r->contacts.items[i];
        uint32_t c = self_component(r->mesh, s, contact);
        if (c == UINT32_MAX || contact->toi - TOI_EARLY <= first[c])
            assert_true(next < found->count && same_contact(&found->items[next++], contact));
    }
    assert_int_equal(next, found->count);
    for (uint32_t c = 0; c < cscd_mesh_component_count(r->mesh); c++) {
        cscd_guarantee g = cscd_detector_guarantee(detector, c);
        if (g.reason == CSCD_REASON_COLLAPSED) continue;
        assert_int_equal(g.complete, isinf(first[c]));
        if (!g.complete) assert_int_equal(g.reason, CSCD_REASON_EARLIEST);
    }
    return r->contacts.count - found->count;
}

/* ---- methods --------------------------------------------------------------------------------------- */

typedef struct culling_tally {
    uint32_t intervals, embedded, first_contacts, lost;
    size_t contacts, missing;
    uint64_t pairs, pairs_without;
} culling_tally;

typedef struct variant {
    cscd_method method;
    uint32_t k;
} variant;

static cscd_plan *make_plan(const reference *r, const scene *s, variant v, uint32_t seed) {
    cscd_plan *plan = NULL;
    cscd_plan_options options = cscd_plan_defaults();
    if (v.k == 0) return NULL;
    options.method = CSCD_METHOD_KMEANS;
    options.k = v.k;
    options.seed = seed;
    assert_int_equal(plan_create_packed(r->mesh, s->x0, &options, &plan), CSCD_OK);
    return plan;
}

static bool all_embedded(const reference *r, const cscd_detector *detector) {
    for (uint32_t c = 0; c < cscd_mesh_component_count(r->mesh); c++) {
        if (!cscd_detector_guarantee(detector, c).start_embedded) return false;
    }
    return true;
}

static void run_variant(const reference *r, const scene *s, variant v, cscd_mode mode, uint32_t seed,
                        culling_tally *sum) {
    cscd_plan *plan = make_plan(r, s, v, seed);
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *detector = NULL;
    cscd_contacts found;
    options.method = v.method;
    options.mode = mode;
    assert_int_equal(detector_create_here(r->mesh, plan, &options, &detector), CSCD_OK);
    assert_int_equal(step_packed(detector, s->x0, s->x1, &found), CSCD_OK);
    if (mode == CSCD_MODE_ALL)
        check_complete(&found, &r->contacts);
    else
        sum->missing += check_earliest(r, s, detector, &found);
    sum->intervals++;
    sum->embedded += all_embedded(r, detector);
    sum->first_contacts += all_embedded(r, detector) && r->contacts.count > 0;
    sum->contacts += r->contacts.count;
    sum->pairs += cscd_detector_counters(detector).pcp;
    sum->pairs_without += cscd_detector_counters(r->detector).pcp;
    cscd_detector_destroy(detector);
    cscd_plan_destroy(plan);
}

static void print_tally(const char *name, const culling_tally *t) {
    print_message(
        "  %-15s %5u intervals, %4u embedded, %4u of these with contact; %7zu contacts, %6zu not in "
        "earliest; pairs %5.1f %%\n",
        name, t->intervals, t->embedded, t->first_contacts, t->contacts, t->missing,
        100.0 * (double)t->pairs / (double)t->pairs_without);
}

/* Runs a family of scenes in alternating modes; each interval sees two of the variants in both modes. */
static void run_family(scene_family family, culling_tally *sum) {
    static const variant variants[3] = {
        {CSCD_METHOD_SINGLE, 0}, {CSCD_METHOD_KMEANS, 2}, {CSCD_METHOD_KMEANS, 5}};
    static const variant none = {CSCD_METHOD_NONE, 0};
    culling_tally own = {0};
    for (uint32_t seed = 0; seed < INTERVALS_PER_FAMILY; seed++) {
        scene_make(family, seed + 1000, &interval);
        reference r = reference_create(&interval);
        variant second = variants[1 + seed % 2];
        run_variant(&r, &interval, variants[0], CSCD_MODE_EARLIEST, seed, &own);
        run_variant(&r, &interval, second, CSCD_MODE_EARLIEST, seed, &own);
        if (seed % 8 == 0) run_variant(&r, &interval, none, CSCD_MODE_EARLIEST, seed, &own);
        run_variant(&r, &interval, seed % 4 < 2 ? variants[0] : second, CSCD_MODE_ALL, seed, &own);
        reference_free(&r);
    }
    print_tally(scene_family_name(family), &own);
    sum->intervals += own.intervals;
    sum->embedded += own.embedded;
    sum->first_contacts += own.first_contacts;
    sum->contacts += own.contacts;
    sum->missing += own.missing;
    sum->pairs += own.pairs;
    sum->pairs_without += own.pairs_without;
}

TEST(culling_loses_no_first_contact) {
    culling_tally sum = {0};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) run_family((scene_family)family, &sum);
    print_tally("all", &sum);
    assert_true(sum.embedded * 4 >= sum.intervals && sum.first_contacts * 10 >= sum.intervals);
    assert_true(sum.missing > 0);
}

/* ---- ignored pairs ----------------------------------------------------------------------------------- */

static bool ignore_some(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    (void)user;
    (void)kind;
    return (a * 2654435761u ^ b * 40503u) % 16 == 0;
}

/* An ignored first contact must not hide a later one: mode earliest continues past it. */
TEST(ignored_contacts_hide_none) {
    static const scene_family families[3] = {SCENE_BENT_CAPSULE, SCENE_SQUASHED_TORUS, SCENE_SPIKE};
    size_t kept = 0;
    for (uint32_t seed = 0; seed < 3 * IGNORING_INTERVALS_PER_FAMILY; seed++) {
        scene_make(families[seed % 3], seed + 5000, &interval);
        reference r = reference_create(&interval);
        cscd_detector_options options = cscd_detector_defaults();
        cscd_detector *detectors[2] = {NULL, NULL};
        cscd_contacts found[2];
        options.ignore = ignore_some;
        for (int i = 0; i < 2; i++) {
            options.method = i == 0 ? CSCD_METHOD_NONE : CSCD_METHOD_SINGLE;
            options.mode = i == 0 ? CSCD_MODE_ALL : CSCD_MODE_EARLIEST;
            assert_int_equal(detector_create_here(r.mesh, NULL, &options, &detectors[i]), CSCD_OK);
            assert_int_equal(step_packed(detectors[i], interval.x0, interval.x1, &found[i]), CSCD_OK);
        }
        check_complete(&found[1], &found[0]);
        kept += found[0].count;
        cscd_detector_destroy(detectors[0]);
        cscd_detector_destroy(detectors[1]);
        reference_free(&r);
    }
    assert_true(kept > 0);
}
