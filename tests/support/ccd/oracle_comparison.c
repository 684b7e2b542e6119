/* An elementary test's answer beside the oracle's. */
#include "tests/support/ccd/oracle_comparison.h"

#include <stdio.h>

#define EARLY 1e-9

static comparison judge(const compared *c) {
    if (c->verdict.touching != c->oracle.touching)
        return c->oracle.touching ? COMPARISON_MISSED : COMPARISON_FALSE;
    if (!c->oracle.touching) return COMPARISON_AGREES;
    if (!(c->hit.toi <= c->oracle.toi_high)) return COMPARISON_TOO_LATE;
    return c->hit.toi >= c->oracle.toi_low - EARLY ? COMPARISON_AGREES : COMPARISON_TOO_EARLY;
}

compared compare_with_oracle(cscd_contact_kind kind, const elementary_query *query) {
    compared c = {.hit = {.toi = 2.0}};
    c.oracle = algebraic_oracle(kind, query);
    c.verdict = pair_test(kind, query, &c.hit);
    c.result = judge(&c);
    return c;
}

static void print_points(const double x[4][3]) {
    for (int i = 0; i < 4; i++) printf("%s{%a, %a, %a}", i == 0 ? "{" : ",\n  ", x[i][0], x[i][1], x[i][2]);
}

void print_compared(cscd_contact_kind kind, const elementary_query *query, const compared *c) {
    static const char *const words[] = {"agrees", "missed contact", "false contact", "toi too late",
                                        "toi too early"};
    printf("/* %s, %s: toi %a (2: never), exactly %a .. %a, level %d */\n",
           kind == CSCD_CONTACT_VF ? "vf" : "ee", words[c->result], c->hit.toi, c->oracle.toi_low,
           c->oracle.toi_high, (int)c->verdict.level);
    printf("{");
    print_points(query->x0);
    printf("},\n ");
    print_points(query->x1);
    printf("}},\n");
}
