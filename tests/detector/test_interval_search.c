/* The search by trees finds what brute force over all feature pairs finds, and needs the orphan pairs for
 * it. */
#include "runtime/detector/detector.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"

#include <string.h>

static scene interval; /* large; one test at a time */

typedef cscd_status search_kind(interval_search *search);

/* Adjacent triangles are skipped, so feature pairs that only they contain are not tested. */
static cscd_status search_without_orphans(interval_search *search) {
    interval_search_skip_adjacent(search, true);
    search->interval.skip_adjacent = true;
    return interval_search_traverse(search, TRAVERSAL_KEPT);
}

static size_t search_by(const rig *r, search_kind *kind, result_buffer *buffer, cscd_counters *counters) {
    cscd_detector *d = r->detector;
    cscd_contacts found;
    interval_search search = interval_search_begin(&d->space, interval.x0, interval.x1, d->config.limit);
    expect_ok(bvh_rebuild_move(&d->rebuild, &d->space.bvh, interval.x0, interval.x1, uniform_growth(0.0),
                               uniform_growth(0.0)));
    expect_ok(kind(&search));
    expect_ok(contact_list_collect(&d->space, &d->config.exclusions, buffer, &search.counters, &found));
    *counters = search.counters;
    return found.count;
}

TEST(trees_find_what_brute_force_finds) {
    size_t contacts = 0, of_orphans = 0;
    uint64_t adjacent = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 0; seed < 6; seed++) {
            result_buffer expected = {.capacity = 0}, found = {.capacity = 0};
            cscd_counters brute, trees, fewer;
            scene_make((scene_family)family, seed, &interval);
            rig r = rig_create(&interval, 1 + (uint32_t)seed % 3, NULL);
            size_t count = search_by(&r, interval_search_by_brute_force, &expected, &brute);
            assert_int_equal(search_by(&r, interval_search_everything, &found, &trees), count);
            if (count > 0) assert_memory_equal(found.items, expected.items, count * sizeof(cscd_contact));
            assert_true(trees.feature_pairs <= brute.feature_pairs);
            size_t without = search_by(&r, search_without_orphans, &found, &fewer);
            assert_true(without <= count);
            contacts += count;
            of_orphans += count - without;
            adjacent += trees.adjacent;
            result_buffer_free(r.context, &expected);
            result_buffer_free(r.context, &found);
            rig_destroy(&r);
        }
    }
    print_message("  %zu contacts, %zu of orphan pairs; %llu adjacent pairs skipped\n", contacts, of_orphans,
                  (unsigned long long)adjacent);
    assert_true(contacts > 1000 && of_orphans > 0 && adjacent > 10000);
}
