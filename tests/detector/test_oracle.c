/* Every method in mode all equals brute force over features, on hundreds of random intervals. */
#include "cscd/cscd.h"
#include "cscd/research.h"
#include "tests/support/calls.h"
#include "tests/support/oracle.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"

#include <stdio.h>
#include <string.h>

enum { INTERVALS_PER_FAMILY = 50 };

static scene interval; /* large; one test at a time */

typedef struct method_tally {
    uint32_t intervals, with_contact;
    size_t contacts;
} method_tally;

static cscd_detector *make_detector(cscd_context *context, const scene *s, cscd_method method,
                                    cscd_mesh **mesh) {
    cscd_object_desc desc = cscd_object_of_triangles(s->vertex_count, s->triangle_count, s->triangles);
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *detector = NULL;
    options.method = method;
    expect_ok(cscd_mesh_create(context, &desc, 1, mesh));
    expect_ok(detector_create_here(*mesh, NULL, &options, &detector));
    return detector;
}

static void compare_with_oracle(const scene *s, const oracle_list *truth, cscd_method method,
                                scene_family family, uint64_t seed) {
    cscd_context *context = NULL;
    cscd_mesh *mesh = NULL;
    cscd_contacts found;
    expect_ok(cscd_context_create(NULL, &context));
    cscd_detector *detector = make_detector(context, s, method, &mesh);
    expect_ok(step_packed(detector, s->x0, s->x1, &found));
    if (found.count != truth->count)
        print_error("%s, seed %u, method %s: %zu contacts, brute force has %zu\n", scene_family_name(family),
                    (unsigned)seed, cscd_method_name(method), found.count, truth->count);
    oracle_expect(truth, &found);
    for (size_t i = 0; i < found.count; i++)
        assert_true(found.items[i].toi >= 0.0 && found.items[i].toi <= 1.0);
    cscd_detector_destroy(detector);
    cscd_mesh_destroy(mesh);
    cscd_context_destroy(context);
}

static void run_family(scene_family family, method_tally *sum) {
    oracle_list truth = {0};
    method_tally own = {0};
    for (uint64_t seed = 0; seed < INTERVALS_PER_FAMILY; seed++) {
        scene_make(family, seed, &interval);
        oracle_find(&interval, &truth);
        compare_with_oracle(&interval, &truth, CSCD_METHOD_NONE, family, seed);
        compare_with_oracle(&interval, &truth, CSCD_METHOD_BRUTE, family, seed);
        own.intervals++;
        own.with_contact += truth.count > 0;
        own.contacts += truth.count;
    }
    print_message("  %-15s %3u intervals, %3u with contact, %6zu contacts\n", scene_family_name(family),
                  own.intervals, own.with_contact, own.contacts);
    assert_true(own.with_contact > 0 && own.with_contact < own.intervals);
    sum->intervals += own.intervals;
    sum->with_contact += own.with_contact;
    sum->contacts += own.contacts;
    oracle_free(&truth);
}

TEST(mode_all_equals_brute_force) {
    method_tally sum = {0};
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) run_family((scene_family)family, &sum);
    print_message("  %-15s %3u intervals, %3u with contact, %6zu contacts\n", "all", sum.intervals,
                  sum.with_contact, sum.contacts);
    assert_true(sum.intervals >= 500);
    assert_true(sum.with_contact * 3 >= sum.intervals);
    assert_true((sum.intervals - sum.with_contact) * 3 >= sum.intervals);
}
