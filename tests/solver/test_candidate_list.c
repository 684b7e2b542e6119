/* The list of a line search's candidates: sorted, each once, and with every pair that is near or in contact on the way. */
#include "tests/support/loose/loose_scene.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <string.h>

static scene interval; /* large; one test at a time */
static cscd_candidate kept[1 << 21];
static double moment[SCENE_VERTICES_MAX * 3];

static int compare_candidates(const cscd_candidate *p, const cscd_candidate *q) {
    if (p->kind != q->kind) return p->kind < q->kind ? -1 : 1;
    if (p->a != q->a) return p->a < q->a ? -1 : 1;
    return (p->b > q->b) - (p->b < q->b);
}

/* Keeps a copy of the list, since later calls end it. */
static size_t keep_list(cscd_line_search *line) {
    cscd_candidates found;
    expect_ok(cscd_line_search_candidates(line, &found));
    assert_true(found.count <= sizeof kept / sizeof *kept &&
                found.count <= cscd_line_search_candidate_count(line));
    for (size_t i = 1; i < found.count; i++)
        assert_true(compare_candidates(&found.items[i - 1], &found.items[i]) < 0);
    if (found.count > 0) memcpy(kept, found.items, found.count * sizeof *kept);
    return found.count;
}

static bool is_kept(size_t count, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    const cscd_candidate wanted = {kind, a, b};
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare_candidates(&kept[middle], &wanted) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && compare_candidates(&kept[low], &wanted) == 0;
}

/* All near pairs at some moments of the line are in the list. Pairs with half-spaces are no candidates. Returns how many
 * pairs there were. */
static size_t expect_near(cscd_line_search *line, size_t count, double reach) {
    static const double fractions[] = {0.0, 0.25, 0.5, 0.9, 1.0};
    size_t pairs = 0;
    for (size_t i = 0; i < sizeof fractions / sizeof *fractions; i++) {
        cscd_proximities near;
        expect_ok(cscd_line_search_find_near(line, fractions[i], reach, CSCD_NEAR_PAIRS, &near));
        for (size_t k = 0; k < near.count; k++) {
            if (near.items[k].kind == CSCD_CONTACT_VH) continue;
            assert_true(is_kept(count, near.items[k].kind, near.items[k].a, near.items[k].b));
            pairs++;
        }
    }
    return pairs;
}

TEST(near_pairs_are_candidates) {
    size_t pairs = 0, contacts = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        cscd_line_search *line;
        scene_make((scene_family)family, 3, &interval);
        rig r = rig_create(&interval, 1 + (uint32_t)family % 3, NULL);
        expect_ok(cscd_line_search_create(r.detector, &line));
        expect_ok(line_begin_packed(line, interval.x0, interval.x1, 0.05));
        const size_t count = keep_list(line);
        pairs += expect_near(line, count, 0.05);
        const cscd_contacts found = rig_step(&r, &interval);
        for (size_t i = 0; i < found.count; i++)
            assert_true(is_kept(count, found.items[i].kind, found.items[i].a, found.items[i].b));
        contacts += found.count;
        cscd_line_search_destroy(line);
        rig_destroy(&r);
    }
    assert_true(pairs > 1000 && contacts > 100);
}

/* Wires and points have kinds of their own. */
TEST(loose_candidates_have_their_kinds) {
    static loose_scene loose; /* large */
    const loose_recipe recipe = {.triangles = true,
                                 .wires = true,
                                 .points = true,
                                 .half_spaces = true,
                                 .thickness = true,
                                 .motion = 1.5};
    random_stream random = stream_start(500);
    cscd_line_search *line;
    size_t of_kind[CSCD_CONTACT_VH + 1] = {0};
    loose_scene_make(&loose, &recipe, &random, 1, CSCD_SIMD_AUTO);
    const cscd_detector_options options = loose_scene_options(&loose);
    cscd_detector *detector = loose_scene_detector(&loose, &options);
    expect_ok(cscd_line_search_create(detector, &line));
    expect_ok(cscd_line_search_begin(line, CSCD_DOUBLES(loose.x0, loose.vertex_count),
                                     CSCD_DOUBLES(loose.x1, loose.vertex_count), 0.5));
    const size_t count = keep_list(line);
    for (size_t i = 0; i < count; i++) of_kind[kept[i].kind]++;
    assert_true(of_kind[CSCD_CONTACT_VF] > 0 && of_kind[CSCD_CONTACT_EE] > 0 &&
                of_kind[CSCD_CONTACT_VV] > 0 && of_kind[CSCD_CONTACT_EV] > 0 &&
                of_kind[CSCD_CONTACT_TT] == 0);
    assert_true(expect_near(line, count, 0.5) > 100);
    cscd_line_search_destroy(line);
    cscd_detector_destroy(detector);
    loose_scene_free(&loose);
}

static bool ignore_all(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b) {
    (void)user;
    return kind == CSCD_CONTACT_VF || (a + b) % 2 == 0;
}

TEST(ignored_pairs_are_not_listed) {
    cscd_detector_options options = cscd_detector_defaults();
    cscd_line_search *line;
    options.ignore = ignore_all;
    scene_make(SCENE_TWO_SPHERES, 3, &interval);
    rig r = rig_create(&interval, 1, &options);
    expect_ok(cscd_line_search_create(r.detector, &line));
    expect_ok(line_begin_packed(line, interval.x0, interval.x1, 0.1));
    const size_t count = keep_list(line);
    assert_true(count > 0 && count < cscd_line_search_candidate_count(line));
    for (size_t i = 0; i < count; i++)
        assert_true(kept[i].kind == CSCD_CONTACT_EE && (kept[i].a + kept[i].b) % 2 == 1);
    cscd_line_search_destroy(line);
    rig_destroy(&r);
}

TEST(bad_calls_change_nothing) {
    cscd_line_search *line;
    cscd_candidates found = {NULL, 77};
    scene_make(SCENE_TWO_SPHERES, 3, &interval);
    rig r = rig_create(&interval, 1, NULL);
    expect_ok(cscd_line_search_create(r.detector, &line));
    assert_int_equal(cscd_line_search_candidates(NULL, &found), CSCD_NULL_OBJECT);
    expect_invalid(r.context, cscd_line_search_candidates(line, &found), "the line has no motion");
    memcpy(moment, interval.x0, sizeof moment);
    expect_ok(line_begin_packed(line, moment, moment, 0.0));
    expect_invalid(r.context, cscd_line_search_candidates(line, NULL), "out is NULL");
    assert_int_equal(found.count, 77);
    expect_ok(cscd_line_search_candidates(line, &found));
    cscd_line_search_destroy(line);
    rig_destroy(&r);
}
