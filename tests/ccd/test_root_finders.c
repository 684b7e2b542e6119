/* The guesses of roots decide how long an elementary test takes, and not one bit of its answer: our own guesses, those of
 * GSL, wrong ones and none at all give the same contacts, times included. */
#include "tests/support/ccd/elementary_cases.h"
#include "tests/support/ccd/elementary_generator.h"
#include "tests/support/rig.h"
#include "tests/support/test.h"
#include "tests/support/workload.h"

#include <gsl/gsl_poly.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the root finders ---- */

/* The linker puts the chosen one in the place of the library's (--wrap). */
int __real_cubic_guess_roots(const double c[4], double roots[3]);
int __wrap_cubic_guess_roots(const double c[4], double roots[3]);

/* GSL wants a monic cubic: a leading coefficient that is next to nothing would only spoil the other roots. */
static int guess_with_gsl(const double c[4], double roots[3]) {
    const double size = fmax(fmax(fabs(c[0]), fabs(c[1])), fabs(c[2]));
    if (fabs(c[3]) > 0x1p-40 * size)
        return gsl_poly_solve_cubic(c[2] / c[3], c[1] / c[3], c[0] / c[3], &roots[0], &roots[1], &roots[2]);
    return gsl_poly_solve_quadratic(c[2], c[1], c[0], &roots[0], &roots[1]);
}

/* Loses the first root, and is off by more than a cell at the others. */
static int guess_badly(const double c[4], double roots[3]) {
    double all[3];
    int count = __real_cubic_guess_roots(c, all);
    for (int i = 1; i < count; i++) roots[i - 1] = all[i] + 1e-7;
    return count > 0 ? count - 1 : 0;
}

/* As far off as the polishing of roots can mend: what is left differs in the last bits. */
static int guess_roughly(const double c[4], double roots[3]) {
    int count = __real_cubic_guess_roots(c, roots);
    for (int i = 0; i < count; i++) roots[i] *= 1.0 + 1e-8;
    return count;
}

static int guess_nothing(const double c[4], double roots[3]) {
    (void)c;
    (void)roots;
    return 0;
}

typedef struct root_finder {
    const char *name;
    int (*guess)(const double c[4], double roots[3]);
} root_finder;

static const root_finder finders[] = {
    {"our own", __real_cubic_guess_roots},
    {"GSL", guess_with_gsl},
    {"roughly", guess_roughly},
    {"badly", guess_badly},
    {"nothing", guess_nothing},
};

enum { FINDERS = sizeof finders / sizeof *finders, RIGHT_FINDERS = FINDERS - 2 };

static const root_finder *finder; /* NULL: the library's */
static uint64_t guessed;

int __wrap_cubic_guess_roots(const double c[4], double roots[3]) {
    if (finder == NULL) return __real_cubic_guess_roots(c, roots);
    guessed++;
    return finder->guess(c, roots);
}

/* ---- queries of every degeneracy ---- */

enum { QUERIES = PACED(400 * FAMILY_COUNT, 100 * FAMILY_COUNT) };

static elementary_query queries[QUERIES];
static query_answer expected_answers[QUERIES], answers[QUERIES];

/* Returns how many queries level two decided. */
static uint64_t answer_with(int k, cscd_contact_kind kind, query_answer *out) {
    finder = &finders[k];
    guessed = 0;
    pair_test_all(kind, queries, QUERIES, out);
    const uint64_t *decided = pair_test_decided();
    printf("%-8s %8llu guesses, %7llu decided at roots, %7llu exactly\n", finder->name,
           (unsigned long long)guessed, (unsigned long long)decided[ELEMENTARY_ROOTS],
           (unsigned long long)decided[ELEMENTARY_EXACT]);
    return decided[ELEMENTARY_ROOTS];
}

static void compare_queries(cscd_contact_kind kind) {
    random_stream random = stream_start(91 + kind);
    for (int i = 0; i < QUERIES; i++)
        queries[i] = generate_query(&random, kind, (query_family)(i % FAMILY_COUNT));
    uint64_t by_roots = answer_with(0, kind, expected_answers);
    assert_true(guessed >= QUERIES / 10);
    for (int k = 1; k < FINDERS; k++) {
        uint64_t others = answer_with(k, kind, answers);
        for (int i = 0; i < QUERIES; i++) {
            const query_answer *a = &answers[i], *b = &expected_answers[i];
            if (a->touching != b->touching || memcmp(&a->hit, &b->hit, sizeof a->hit) != 0)
                fail_msg("%s, query %d: %d %a, not %d %a", finder->name, i, a->touching, a->hit.toi,
                         b->touching, b->hit.toi);
        }
        if (finders[k].guess == guess_nothing)
            assert_true(others < by_roots); /* guesses are good for something */
    }
}

TEST(same_answers_vf) {
    compare_queries(CSCD_CONTACT_VF);
}

TEST(same_answers_ee) {
    compare_queries(CSCD_CONTACT_EE);
}

/* ---- scenes ---- */

enum { SEEDS = 8, CONTACTS_MAX = 100000 };

static scene s; /* large; one test at a time */

TEST(same_contacts_of_scenes) {
    static cscd_contact expected[CONTACTS_MAX];
    size_t total = 0;
    for (int family = 0; family < SCENE_FAMILY_COUNT; family++) {
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            size_t count = 0;
            scene_make((scene_family)family, seed, &s);
            for (int k = 0; k < FINDERS; k++) {
                finder = &finders[k];
                rig r = rig_create(&s, 1, NULL);
                cscd_contacts found = rig_step(&r, &s);
                if (k == 0) {
                    count = found.count;
                    assert_true(count <= CONTACTS_MAX);
                    if (count > 0) memcpy(expected, found.items, count * sizeof *expected);
                }
                assert_int_equal(found.count, count);
                if (count > 0) assert_memory_equal(found.items, expected, count * sizeof *expected);
                rig_destroy(&r);
            }
            total += count;
        }
    }
    printf("%zu contacts\n", total);
    assert_true(total > 4000);
}

/* Steps, longest steps and line searches of a tube that comes down on itself; counters are the same, too. */
TEST(same_calls_of_a_solver) {
    sequence *tube = calloc(1, sizeof *tube);
    workload w = {.sequence = tube, .options = cscd_detector_defaults()};
    workload_result *expected = calloc(1, sizeof *expected), *found = calloc(1, sizeof *found);
    assert_true(tube != NULL && expected != NULL && found != NULL);
    w.options.method = CSCD_METHOD_NONE;
    workload_tube(tube, 24, 16, 6);
    for (int k = 0; k < RIGHT_FINDERS; k++) {
        cscd_context *context = NULL;
        finder = &finders[k];
        assert_int_equal(cscd_context_create(NULL, &context), CSCD_OK);
        *(k == 0 ? expected : found) = workload_run(context, &w);
        cscd_context_destroy(context);
        if (k > 0) assert_memory_equal(found, expected, sizeof *found);
    }
    assert_true(!expected->failed && expected->contacts > 100);
    free(found);
    free(expected);
    free(tube);
}
