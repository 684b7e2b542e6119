/* The kernels that describe contacts: on every level the same bits as the description of one pair, whatever the pair and the
 * time, also where features are degenerate or of sizes far apart. */
#include "runtime/ccd/ccd.h"
#include "tests/support/ccd/elementary_generator.h"
#include "tests/support/test.h"
#include "tests/support/variants.h"

#include <string.h>

enum { BATCHES_PER_FAMILY = 400, POINTS = 4 * LANES };

/* Eight queries as pairs of features of their own. */
typedef struct described_batch {
    elementary_query queries[LANES];
    double x0[POINTS][3], x1[POINTS][3];
    uint32_t triangles[LANES][3], edges[2 * LANES][2];
    found_pairs pairs;
} described_batch;

static double random_time(random_stream *random) {
    uint32_t kind = stream_below(random, 8);
    return kind < 2 ? (double)kind : (double)stream_below(random, 1u << 30) * 0x1p-30;
}

static void make_batch(random_stream *random, cscd_contact_kind kind, query_family family,
                       described_batch *b) {
    for (uint32_t i = 0; i < LANES; i++) {
        b->queries[i] = generate_query(random, kind, family);
        memcpy(b->x0[4 * i], b->queries[i].x0, sizeof b->queries[i].x0);
        memcpy(b->x1[4 * i], b->queries[i].x1, sizeof b->queries[i].x1);
        for (uint32_t k = 0; k < 3; k++) b->triangles[i][k] = 4 * i + 1 + k;
        for (uint32_t k = 0; k < 4; k++) b->edges[2 * i + k / 2][k % 2] = 4 * i + k;
        b->pairs.a[i] = kind == CSCD_CONTACT_VF ? 4 * i : 2 * i;
        b->pairs.b[i] = kind == CSCD_CONTACT_VF ? i : 2 * i + 1;
        b->pairs.begin[i] = random_time(random);
    }
}

/* Numbers are compared as bits. A result that is not a number may have any sign. */
static void check_number(double found, double expected) {
    if (expected != expected)
        assert_true(found != found);
    else
        assert_memory_equal(&found, &expected, sizeof found);
}

static void check_batch(const described_batch *b, cscd_contact_kind kind, const described_contacts *found) {
    for (uint32_t i = 0; i < LANES; i++) {
        point_vectors vectors;
        elementary_contact expected;
        point_vectors_from(&b->queries[i], kind, &vectors);
        coplanarity f = coplanarity_cubic(&vectors);
        contact_frame_describe(&b->queries[i], kind, &f, b->pairs.begin[i], &expected);
        check_number(found->toi[i], expected.toi);
        check_number(found->u[i], expected.u);
        check_number(found->v[i], expected.v);
        for (int k = 0; k < 3; k++) {
            check_number(found->point[k][i], expected.point[k]);
            check_number(found->normal[k][i], expected.normal[k]);
        }
    }
}

static void same_bits_as_one_pair(cscd_contact_kind kind) {
    static described_batch b;
    random_stream random = stream_start(71 + (uint64_t)kind);
    for (int n = 0; n < FAMILY_COUNT * BATCHES_PER_FAMILY; n++) {
        make_batch(&random, kind, (query_family)(n % FAMILY_COUNT), &b);
        const feature_source source = {b.x0[0], b.x1[0], (const uint32_t(*)[3])b.triangles,
                                       (const uint32_t(*)[2])b.edges};
        for (int level = 0; level < LEVEL_COUNT; level++) {
            described_contacts found;
            if (contexts[level] == NULL) continue;
            const ccd_kernels *table = ccd_kernels_of(contexts[level]);
            (kind == CSCD_CONTACT_VF ? table->describe_vf : table->describe_ee)(&source, &b.pairs, &found);
            check_batch(&b, kind, &found);
        }
    }
}

TEST(vertex_and_face) {
    same_bits_as_one_pair(CSCD_CONTACT_VF);
}

TEST(two_edges) {
    same_bits_as_one_pair(CSCD_CONTACT_EE);
}

AROUND_ALL(open_levels, close_levels)
