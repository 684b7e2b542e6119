/* The elementary tests beside the answers that a Linux run wrote: against the exact ones as test_elementary_oracle.c does, and
 * against the product's own, bit for bit. CSCD_ANSWERS names the file. */
#include "tests/support/test.h"
#include "tests/windows/answer_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 4096 };
#define EARLY 1e-9

typedef struct answer_tally {
    size_t records, touching, wrong, late, early, other_bits;
} answer_tally;

static void judge_answer(answer_tally *t, const recorded_answer *r, const query_answer *own) {
    t->records++;
    t->touching += own->touching;
    t->wrong += own->touching != (r->exactly_touching != 0);
    if (own->touching && r->exactly_touching != 0) {
        t->late += !(own->hit.toi <= r->toi_high);
        t->early += !(own->hit.toi >= r->toi_low - EARLY);
    }
    t->other_bits += own->touching != (r->touching != 0) || memcmp(&own->hit, &r->hit, sizeof own->hit) != 0;
}

/* Records of one kind that follow each other. */
static void judge_batch(answer_tally *t, const recorded_answer *records, size_t count) {
    static elementary_query queries[BATCH];
    static query_answer answers[BATCH];
    for (size_t i = 0; i < count; i++) queries[i] = records[i].query;
    pair_test_all((cscd_contact_kind)records[0].kind, queries, count, answers);
    for (size_t i = 0; i < count; i++) judge_answer(t, &records[i], &answers[i]);
}

static void test_recorded_answers(void **state) {
    (void)state;
    static recorded_answer records[BATCH];
    char title[sizeof ANSWER_FILE_TITLE] = "";
    answer_tally t = {0};
    const char *path = getenv("CSCD_ANSWERS");
    assert_non_null(path);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fread(title, 1, sizeof title - 1, file), sizeof title - 1);
    assert_string_equal(title, ANSWER_FILE_TITLE);
    size_t count = 0;
    while (fread(&records[count], sizeof *records, 1, file) == 1) {
        const bool other = count > 0 && records[count].kind != records[0].kind;
        if (other) judge_batch(&t, records, count);
        if (other) records[0] = records[count];
        count = other ? 1 : count + 1;
        if (count == BATCH) judge_batch(&t, records, count);
        if (count == BATCH) count = 0;
    }
    if (count > 0) judge_batch(&t, records, count);
    fclose(file);
    printf("%u answers, %u touch\n", (unsigned)t.records, (unsigned)t.touching);
    assert_true(t.records >= 1000 && t.touching >= t.records / 8);
    assert_int_equal(t.wrong, 0);
    assert_int_equal(t.late, 0);
    assert_int_equal(t.early, 0);
    assert_int_equal(t.other_bits, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_recorded_answers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
