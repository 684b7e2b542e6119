/* The energy of proximities without repetitions, along paths on which items merge and part. */
#include "cscd/cscd.h"
#include "tests/support/solver/solver_rig.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static scene moment; /* large; one test at a time */

/* A fan of eight triangles around vertex 0, folded up and down, and a small triangle above it, whose lowest corner is
 * vertex 9. */
static void make_fan(scene *s) {
    s->vertex_count = 12;
    s->triangle_count = 9;
    memset(s->x0, 0, sizeof s->x0);
    for (uint32_t i = 0; i < 8; i++) {
        double angle = 0.25 * 3.141592653589793 * i;
        const double rim[3] = {cos(angle), sin(angle), i % 2 == 0 ? 0.2 : -0.1};
        const uint32_t corners[3] = {0, 1 + i, 1 + (i + 1) % 8};
        memcpy(s->x0 + 3 + 3 * i, rim, sizeof rim);
        memcpy(s->triangles + 3 * i, corners, sizeof corners);
    }
    s->triangles[24] = 9, s->triangles[25] = 10, s->triangles[26] = 11;
    memcpy(s->x1, s->x0, sizeof s->x1);
}

/* The small triangle moves over the fan, along a circle and across the middle, and its upper edge turns. */
static void place_on_fan(scene *s, double time) {
    double angle = 6.3 * time, far = 0.7 * cos(3.0 * angle), turn = 5.0 * angle;
    const double low[3] = {far * cos(angle), far * sin(angle), 0.25};
    for (size_t k = 0; k < 3; k++) s->x0[27 + k] = s->x0[30 + k] = s->x0[33 + k] = low[k];
    s->x0[30] += 0.4 * cos(turn), s->x0[31] += 0.4 * sin(turn), s->x0[32] += 0.01;
    s->x0[33] -= 0.4 * sin(turn), s->x0[34] += 0.4 * cos(turn), s->x0[35] += 0.3;
}

typedef struct path_jumps {
    double counted, once; /* the largest change between two moments of a sum with counts, and without them */
    double total;
} path_jumps;

enum { MOMENTS = 20000 };

/* Follows the energy along the path; at every moment it is that of all pairs. */
static path_jumps follow_path(const rig *r, double reach) {
    path_jumps jumps = {0.0, 0.0, 0.0};
    double counted = 0.0, once = 0.0;
    for (int i = 0; i <= MOMENTS; i++) {
        place_on_fan(&moment, i / (double)MOMENTS);
        item_list pairs = find_items(r, moment.x0, reach, CSCD_NEAR_PAIRS),
                  items = find_items(r, moment.x0, reach, CSCD_NEAR_UNIQUE);
        double expected = sum_energies(&pairs, moment.x0, reach, false);
        double now = sum_energies(&items, moment.x0, reach, true),
               once_now = sum_energies(&items, moment.x0, reach, false);
        assert_true(fabs(now - expected) <= 1e-12 * expected);
        if (i > 0) {
            jumps.counted = fmax(jumps.counted, fabs(now - counted));
            jumps.once = fmax(jumps.once, fabs(once_now - once));
        }
        jumps.total = fmax(jumps.total, now);
        counted = now;
        once = once_now;
        free(pairs.items);
        free(items.items);
    }
    return jumps;
}

/* The vertices of the path move by less than 0.01 from moment to moment, and the energy of a pair changes by at most
 * 2.1 times its share of the reach; about twenty pairs are near. A list without counts jumps by whole energies. */
TEST(energy_does_not_jump_on_a_fan) {
    make_fan(&moment);
    for (int with_rest = 0; with_rest < 2; with_rest++) {
        rig r = near_rig(&moment, 1);
        if (with_rest == 1) {
            place_on_fan(&moment, 0.1);
            set_rest(&r, moment.x0);
        }
        path_jumps jumps = follow_path(&r, 0.35);
        print_message("  at most %.3g; jumps by %.3g, and by %.3g without counts\n", jumps.total,
                      jumps.counted, jumps.once);
        assert_true(jumps.total > 5.0 && jumps.counted < 0.1 && jumps.once > 0.5);
        rig_destroy(&r);
    }
}

/* Two edges turn through parallel, one above the other: they stay one item, whose mollifier goes to 0 and back, while
 * their nearest points jump from end to end. */
TEST(parallel_edges_stay_an_item) {
    static const uint32_t triangles[] = {0, 1, 2, 3, 4, 5};
    static const double corners[] = {-1, 0, 0, 1, 0, 0, 0, 0.1, -2, -0.9, 0, 0.1, 1.1, 0, 0.1, 0, 0.1, 2};
    double before = -1.0, largest = 0.0, least = INFINITY;
    size_t at_ends = 0;
    moment.vertex_count = 6;
    moment.triangle_count = 2;
    memcpy(moment.triangles, triangles, sizeof triangles);
    memcpy(moment.x0, corners, sizeof corners);
    rig r = near_rig(&moment, 1);
    set_rest(&r, moment.x0);
    for (int i = -2000; i <= 2000; i++) {
        double angle = 1e-4 * i;
        moment.x0[9] = -0.9 * cos(angle), moment.x0[10] = -0.9 * sin(angle) + 0.02;
        moment.x0[12] = 1.1 * cos(angle), moment.x0[13] = 1.1 * sin(angle) + 0.02;
        item_list pairs = find_items(&r, moment.x0, 0.5, CSCD_NEAR_PAIRS),
                  items = find_items(&r, moment.x0, 0.5, CSCD_NEAR_UNIQUE);
        double energy = sum_energies(&items, moment.x0, 0.5, true);
        assert_true(fabs(energy - sum_energies(&pairs, moment.x0, 0.5, false)) <= 1e-12 * energy);
        for (size_t j = 0; j < items.count; j++) {
            const cscd_proximity *p = &items.items[j];
            if (p->kind != CSCD_CONTACT_EE || p->a != 0 || p->b != 3) continue;
            double factor = mollifier_of(p, moment.x0);
            assert_true(fabs(p->threshold - 1e-3 * 4.0 * 4.0) <= 1e-15);
            least = fmin(least, factor);
            at_ends += factor < 1.0 &&
                       (p->weights[0] * p->weights[1] == 0.0 || p->weights[2] * p->weights[3] == 0.0);
        }
        if (before >= 0.0) largest = fmax(largest, fabs(energy - before));
        before = energy;
        free(pairs.items);
        free(items.items);
    }
    print_message("  jumps by %.3g; mollifier down to %.3g; %zu moments with nearest points at ends\n",
                  largest, least, at_ends);
    assert_true(largest < 0.02 && least < 1e-9 && at_ends > 10);
    rig_destroy(&r);
}
