/* Contacts that exist exactly, by integer construction, where floating point has the least to hold on to. */
#include "tests/support/ccd/elementary_cases.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <math.h>

enum { CASES = PACED(2000, 400) };

static double integer_between(random_stream *random, double extent) {
    return floor(stream_between(random, -extent, extent + 1.0));
}

static void integer_vector(random_stream *random, double extent, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = integer_between(random, extent);
}

/* Point i is at place at t = 1/3 and moves by -3 motion in all: x0 = place + motion, x1 = place - 2 motion.
 */
static void pass_through(elementary_query *query, int i, const double place[3], const double motion[3]) {
    for (int k = 0; k < 3; k++) {
        query->x0[i][k] = place[k] + motion[k];
        query->x1[i][k] = place[k] - 2.0 * motion[k];
    }
}

static void assert_touches(elementary_verdict verdict, const elementary_contact *hit) {
    assert_true(verdict.touching);
    assert_true(hit->toi <= 1.0 / 3.0);
}

/* Edges that cross at inner points; the angle between them is about 1 / ratio. */
static void edges_cross(double ratio) {
    random_stream random = stream_start((uint64_t)ratio);
    for (int n = 0; n < CASES; n++) {
        double centre[3], along[3], other[3], motion[3], rest[3] = {0, 0, 0}, ends[4][3];
        elementary_query query;
        elementary_contact hit;
        integer_vector(&random, 1e3, centre);
        integer_vector(&random, 10.0 * ratio, along);
        integer_vector(&random, 10.0, other);
        integer_vector(&random, 10.0 * ratio, motion);
        for (int k = 0; k < 3; k++) {
            ends[0][k] = centre[k] - along[k];
            ends[1][k] = centre[k] + 2.0 * along[k];
            ends[2][k] = centre[k] - along[k] - other[k];
            ends[3][k] = centre[k] + along[k] + other[k];
        }
        for (int i = 0; i < 4; i++) pass_through(&query, i, ends[i], i < 2 ? rest : motion);
        assert_touches(pair_test(CSCD_CONTACT_EE, &query, &hit), &hit);
    }
}

TEST(nearly_parallel_edges) {
    for (double ratio = 1.0; ratio <= 1e8; ratio *= 10.0) edges_cross(ratio);
}

/* A vertex meets a face, whose width is about 1 / ratio of its length, at an inner point. */
static void vertex_meets(double ratio) {
    random_stream random = stream_start((uint64_t)ratio + 7);
    for (int n = 0; n < CASES; n++) {
        double centre[3], along[3], across[3], motion[3], rest[3] = {0, 0, 0}, corners[3][3];
        elementary_query query;
        elementary_contact hit;
        integer_vector(&random, 1e3, centre);
        integer_vector(&random, 10.0 * ratio, along);
        integer_vector(&random, 10.0, across);
        integer_vector(&random, 10.0 * ratio, motion);
        for (int k = 0; k < 3; k++) { /* the centre is their mean */
            corners[0][k] = centre[k] - along[k] - across[k];
            corners[1][k] = centre[k] + 2.0 * along[k];
            corners[2][k] = centre[k] - along[k] + across[k];
        }
        pass_through(&query, 0, centre, motion);
        for (int i = 0; i < 3; i++) pass_through(&query, i + 1, corners[i], rest);
        assert_touches(pair_test(CSCD_CONTACT_VF, &query, &hit), &hit);
    }
}

TEST(thin_faces) {
    for (double ratio = 1.0; ratio <= 1e8; ratio *= 10.0) vertex_meets(ratio);
}

/* All four points pass through one place at t = 1/3, a triple root of the cubic. */
TEST(everything_through_one_point) {
    random_stream random = stream_start(3);
    for (int n = 0; n < 10 * CASES; n++) {
        double place[3], motion[3];
        elementary_query query;
        elementary_contact hit;
        integer_vector(&random, n % 2 == 0 ? 0.0 : 1e6, place);
        for (int i = 0; i < 4; i++) {
            integer_vector(&random, 1e4, motion);
            pass_through(&query, i, place, motion);
        }
        assert_touches(pair_test(CSCD_CONTACT_VF, &query, &hit), &hit);
        assert_touches(pair_test(CSCD_CONTACT_EE, &query, &hit), &hit);
    }
}

/* Everything stays in one plane, tilted so that its coordinates are not flat. */
TEST(in_one_plane) {
    random_stream random = stream_start(4);
    for (int n = 0; n < 10 * CASES; n++) {
        double p[3], q[3], corners[4][3], motion[3];
        elementary_query query;
        elementary_contact hit;
        integer_vector(&random, 100.0, p);
        integer_vector(&random, 100.0, q);
        for (int i = 0; i < 4; i++) {
            double s = integer_between(&random, 50.0), t = integer_between(&random, 50.0);
            for (int k = 0; k < 3; k++) {
                corners[i][k] = s * p[k] + t * q[k];
                if (i == 3) corners[i][k] = 3.0 * corners[0][k] - corners[1][k] - corners[2][k];
            }
        }
        for (int i = 0; i < 4; i++) { /* the vertex is the face's centroid at t = 1/3 */
            double s = integer_between(&random, 50.0), t = integer_between(&random, 50.0);
            for (int k = 0; k < 3; k++) motion[k] = s * p[k] + t * q[k];
            pass_through(&query, i, corners[i], motion);
        }
        assert_touches(pair_test(CSCD_CONTACT_VF, &query, &hit), &hit);
    }
}
