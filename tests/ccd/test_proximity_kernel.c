/* The kernel that decides by the start of a motion which features are near and which stay apart: never
 * against the test of one pair, whose verdicts it anticipates; the same bits on every level. */
#include "cscd/solver.h"
#include "runtime/ccd/ccd.h"
#include "tests/support/calls.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <math.h>
#include <string.h>

enum { BATCHES = 4000, POINTS = 4 * LANES };

/* Eight pairs of features of their own. */
typedef struct proximity_batch {
    double x0[POINTS][3], x1[POINTS][3];
    uint32_t triangles[LANES][3], edges[2 * LANES][2];
    uint32_t vf_a[LANES], faces[LANES], ee_a[LANES], ee_b[LANES];
} proximity_batch;

/* Small integers, at times the same ones again; or any numbers, at times far away, or moved far. */
static void make_batch(proximity_batch *b, bool integers) {
    double far = random_integer(0, 3) == 0 ? 1e6 : 0.0, speed = pow(10.0, random_integer(-9, 2));
    for (uint32_t i = 0; i < POINTS; i++) {
        for (int k = 0; k < 3; k++) {
            b->x0[i][k] = integers ? random_integer(-2, 2) : far + random_unit();
            b->x1[i][k] = integers ? random_integer(-2, 2) : b->x0[i][k] + speed * random_unit();
        }
        if (random_integer(0, 3) == 0) memcpy(b->x1[i], b->x0[i], sizeof b->x1[i]);
    }
    for (uint32_t i = 0; i < LANES; i++) {
        for (uint32_t k = 0; k < 3; k++) b->triangles[i][k] = 4 * i + 1 + k;
        for (uint32_t k = 0; k < 4; k++) b->edges[2 * i + k / 2][k % 2] = 4 * i + k;
        b->vf_a[i] = 4 * i;
        b->faces[i] = i;
        b->ee_a[i] = 2 * i;
        b->ee_b[i] = 2 * i + 1;
    }
}

/* With points 0 to 3 of the lane in order, either kind of pair is a query. */
static elementary_query query_of(const proximity_batch *b, uint32_t lane) {
    elementary_query query;
    memcpy(query.x0, b->x0[4 * lane], sizeof query.x0);
    memcpy(query.x1, b->x1[4 * lane], sizeof query.x1);
    return query;
}

typedef struct proximity_tally {
    size_t hits, misses, open;
} proximity_tally;

static void compare_with_pair_test(const proximity_batch *b, const separation *limit, bool vf,
                                   const proximity_outcomes *found, proximity_tally *sum) {
    for (uint32_t i = 0; i < LANES; i++) {
        elementary_query query = query_of(b, i);
        elementary_contact hit;
        bool bounded, hits = (found->within >> i & 1) != 0, misses = (found->apart >> i & 1) != 0;
        assert_false(hits && misses);
        sum->hits += hits;
        sum->misses += misses;
        sum->open += !hits && !misses;
        if (!hits && !misses) continue;
        bool near = (vf ? separation_vf : separation_ee)(&query, limit, &hit, &bounded);
        assert_true(near == hits);
        if (!hits) continue;
        assert_true(hit.toi == 0.0 && found->distance[i] <= limit->distance);
        for (int k = 0; k < 3; k++)
            assert_true(fabs(found->offset[k][i] / found->distance[i] - hit.normal[k]) < 1e-5);
    }
}

/* Limits about the pairs' own distances, from which verdicts change. */
TEST(never_against_the_test_of_one_pair) {
    static proximity_batch b;
    proximity_tally sum = {0};
    random_seed(7);
    for (int n = 0; n < BATCHES; n++) {
        bool vf = n % 2 == 0;
        make_batch(&b, n % 4 < 2);
        feature_source source = {b.x0[0], b.x1[0], b.triangles, b.edges};
        separation limit = {pow(10.0, random_between(-4.0, 0.3)), 0.0};
        for (int round = 0; round < 4; round++) {
            limit.tolerance = (round % 2 == 0 ? 1e-6 : 0.5) * limit.distance;
            for (int level = 0; level < LEVEL_COUNT; level++) {
                if (contexts[level] == NULL) continue;
                const ccd_kernels *table = ccd_kernels_of(contexts[level]);
                proximity_outcomes found;
                separations_x8 limits;
                for (int i = 0; i < LANES; i++) {
                    limits.distance[i] = limit.distance;
                    limits.tolerance[i] = limit.tolerance;
                }
                (vf ? table->proximity_vf : table->proximity_ee)(&source, vf ? b.vf_a : b.ee_a,
                                                                 vf ? b.faces : b.ee_b, &limits, &found);
                compare_with_pair_test(&b, &limit, vf, &found, &sum);
                double own = found.distance[random_integer(0, LANES - 1)];
                if (level == 0 && own > 1e-9 && own < 1e9)
                    limit.distance = own * (1.0 + random_integer(-2, 2) * 0x1p-46);
                limit.tolerance = (round % 2 == 0 ? 1e-6 : 0.5) * limit.distance;
            }
        }
    }
    print_message("  %zu near, %zu apart, %zu left open\n", sum.hits, sum.misses, sum.open);
    assert_true(sum.hits > 10000 && sum.misses > 10000 && sum.open < sum.hits + sum.misses);
}

/* ---- one moment ---------------------------------------------------------------------------------------- */

static void test_eight(const ccd_kernels *table, const proximity_batch *b, const feature_source *source,
                       bool vf, double limit, proximity_outcomes *out) {
    separations_x8 limits;
    for (int i = 0; i < LANES; i++) {
        limits.distance[i] = limit;
        limits.tolerance[i] = 1e-6 * limit;
    }
    memset(out, 0, sizeof *out);
    (vf ? table->proximity_vf : table->proximity_ee)(source, vf ? b->vf_a : b->ee_a, vf ? b->faces : b->ee_b,
                                                     &limits, out);
}

/* Where both ends are one array, the second is not looked at, and every bit is the same. */
TEST(one_moment_as_a_motion_that_rests) {
    static proximity_batch b;
    size_t within = 0, apart = 0;
    random_seed(8);
    for (int n = 0; n < BATCHES; n++) {
        make_batch(&b, n % 4 < 2);
        memcpy(b.x1, b.x0, sizeof b.x0);
        const feature_source moment = {b.x0[0], b.x0[0], b.triangles, b.edges},
                             motion = {b.x0[0], b.x1[0], b.triangles, b.edges};
        const double limit = pow(10.0, random_between(-4.0, 0.3));
        for (int level = 0; level < LEVEL_COUNT; level++) {
            if (contexts[level] == NULL) continue;
            proximity_outcomes one, two;
            test_eight(ccd_kernels_of(contexts[level]), &b, &moment, n % 2 == 0, limit, &one);
            test_eight(ccd_kernels_of(contexts[level]), &b, &motion, n % 2 == 0, limit, &two);
            assert_memory_equal(&one, &two, sizeof one);
            within += (size_t)__builtin_popcount(one.within);
            apart += (size_t)__builtin_popcount(one.apart);
        }
    }
    assert_true(within > 1000 && apart > 1000);
}

/* The parameters are those of the verdict, the normal is that of its offset, and the distance that between the points which the
 * weights name. */
static void compare_nearest(const proximity_batch *b, bool vf, uint32_t i, const proximity_outcomes *found,
                            const nearest_points_x8 *near) {
    const cscd_contact_kind kind = vf ? CSCD_CONTACT_VF : CSCD_CONTACT_EE;
    const double *x[4];
    double weights[4], apart[3];
    for (uint32_t k = 0; k < 4; k++) x[k] = b->x0[4 * i + k];
    cscd_stencil_weights(kind, found->u[i], found->v[i], weights);
    connection_between(x, weights, points_of_first(kind), apart);
    assert_true(near->u[i] == found->u[i] && near->v[i] == found->v[i]);
    assert_true(near->distance[i] == connection_length(apart));
    for (int k = 0; k < 3; k++) {
        assert_true(apart[k] == found->offset[k][i]);
        assert_true(near->normal[k][i] == found->offset[k][i] / found->distance[i]);
    }
}

/* At any scale between the least and the greatest length. */
TEST(nearest_points_are_those_of_the_verdict) {
    static proximity_batch b;
    size_t compared = 0;
    random_seed(9);
    for (int n = 0; n < BATCHES; n++) {
        const bool vf = n % 2 == 0;
        const double scale = ldexp(1.0, n % 3 == 0 ? random_integer(-290, 290) : 0);
        make_batch(&b, n % 4 < 2);
        for (int i = 0; i < POINTS * 3; i++) b.x0[i / 3][i % 3] *= scale;
        const feature_source source = {b.x0[0], b.x0[0], b.triangles, b.edges};
        for (int level = 0; level < LEVEL_COUNT; level++) {
            if (contexts[level] == NULL) continue;
            const ccd_kernels *table = ccd_kernels_of(contexts[level]);
            proximity_outcomes found;
            nearest_points_x8 near;
            test_eight(table, &b, &source, vf, 1.5 * scale, &found);
            (vf ? table->nearest_vf : table->nearest_ee)(&source, vf ? b.vf_a : b.ee_a, vf ? b.faces : b.ee_b,
                                                         &near);
            for (uint32_t i = 0; i < LANES; i++) {
                if ((found.within >> i & 1) == 0) continue;
                compare_nearest(&b, vf, i, &found, &near);
                compared++;
            }
        }
    }
    print_message("  %zu pairs\n", compared);
    assert_true(compared > 10000);
}

/* ---- levels -------------------------------------------------------------------------------------------- */

static scene interval; /* large; one test at a time */

TEST(same_bits_on_every_level) {
    cscd_detector_options options = cscd_detector_defaults();
    options.min_separation = 0.05;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        static cscd_contact expected[1 << 17];
        static cscd_proximity expected_near[1 << 17];
        size_t count = SIZE_MAX, near_count = 0;
        scene_make((scene_family)family, 3, &interval);
        for (int level = 0; level < LEVEL_COUNT; level++) {
            if (contexts[level] == NULL) continue;
            const cscd_object_desc desc =
                cscd_object_of_triangles(interval.vertex_count, interval.triangle_count, interval.triangles);
            cscd_mesh *mesh;
            cscd_detector *detector;
            cscd_contacts found;
            cscd_proximities near;
            assert_int_equal(cscd_mesh_create(contexts[level], &desc, 1, &mesh), CSCD_OK);
            assert_int_equal(detector_create_here(mesh, NULL, &options, &detector), CSCD_OK);
            assert_int_equal(step_packed(detector, interval.x0, interval.x1, &found), CSCD_OK);
            assert_true(found.count <= 1 << 17);
            if (count == SIZE_MAX && found.count > 0)
                memcpy(expected, found.items, found.count * sizeof *expected);
            if (count == SIZE_MAX) count = found.count;
            assert_int_equal(found.count, count);
            if (count > 0) assert_memory_equal(found.items, expected, count * sizeof *expected);
            assert_int_equal(find_near_packed(detector, interval.x1, 0.05, &near), CSCD_OK);
            if (near_count == 0 && near.count > 0)
                memcpy(expected_near, near.items, near.count * sizeof *expected_near);
            if (near_count == 0) near_count = near.count;
            assert_int_equal(near.count, near_count);
            if (near_count > 0)
                assert_memory_equal(near.items, expected_near, near_count * sizeof *expected_near);
            cscd_detector_destroy(detector);
            cscd_mesh_destroy(mesh);
        }
    }
}

AROUND_ALL(open_levels, close_levels)
