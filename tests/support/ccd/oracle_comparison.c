/* An elementary test's answer beside the oracle's. */
#include "tests/support/ccd/oracle_comparison.h"

#include <stdio.h>
#include <stdlib.h>

#define EARLY 1e-9

static comparison judge_answer(const compared *c) {
    if (c->touching != c->oracle.touching) return c->oracle.touching ? COMPARISON_MISSED : COMPARISON_FALSE;
    if (!c->oracle.touching) return COMPARISON_AGREES;
    if (!(c->hit.toi <= c->oracle.toi_high)) return COMPARISON_TOO_LATE;
    return c->hit.toi >= c->oracle.toi_low - EARLY ? COMPARISON_AGREES : COMPARISON_TOO_EARLY;
}

void compare_all_with_oracle(cscd_contact_kind kind, const elementary_query *queries, size_t count,
                             compared *out) {
    query_answer *answers = malloc((count + 1) * sizeof *answers);
    if (answers == NULL) abort();
    pair_test_all(kind, queries, count, answers);
    for (size_t i = 0; i < count; i++) {
        out[i] = (compared){.oracle = algebraic_oracle(kind, &queries[i]), .touching = answers[i].touching};
        out[i].hit = answers[i].hit;
        if (!answers[i].touching) out[i].hit.toi = 2.0;
        out[i].result = judge_answer(&out[i]);
    }
    free(answers);
}

compared compare_with_oracle(cscd_contact_kind kind, const elementary_query *query) {
    compared c;
    compare_all_with_oracle(kind, query, 1, &c);
    return c;
}

static void print_points(const double x[4][3]) {
    for (int i = 0; i < 4; i++) printf("%s{%a, %a, %a}", i == 0 ? "{" : ",\n  ", x[i][0], x[i][1], x[i][2]);
}

void print_compared(cscd_contact_kind kind, const elementary_query *query, const compared *c) {
    static const char *const words[] = {"agrees", "missed contact", "false contact", "toi too late",
                                        "toi too early"};
    elementary_contact unused;
    printf("/* %s, %s: toi %a (2: never), exactly %a .. %a, level %d */\n",
           kind == CSCD_CONTACT_VF ? "vf" : "ee", words[c->result], c->hit.toi, c->oracle.toi_low,
           c->oracle.toi_high, (int)pair_test(kind, query, &unused).level);
    printf("{");
    print_points(query->x0);
    printf("},\n ");
    print_points(query->x1);
    printf("}},\n");
}
