/* The table at the end of a replay: the thesis' columns, mean and maximum per frame. */
#include "src/cli/summary.h"

#include <stdio.h>

static void add(column *c, double value) {
    c->sum += value;
    c->max = value > c->max ? value : c->max;
}

static bool all_complete(const cscd_detector *detector, const cscd_mesh *mesh) {
    for (uint32_t i = 0; i < cscd_mesh_component_count(mesh); i++) {
        if (!cscd_detector_guarantee(detector, i).complete) return false;
    }
    return true;
}

void totals_add(totals *t, const interval_result *r, const cscd_mesh *mesh) {
    if (r->contact_count > 0 && t->intervals_with_contact++ == 0) t->first_contact_frame = r->frame;
    t->intervals++;
    t->states[r->state]++;
    t->vf += r->counters.vf;
    t->ee += r->counters.ee;
    t->bounded += r->counters.bounded;
    t->static_checks += r->counters.static_checks;
    t->intervals_complete += all_complete(r->detector, mesh);
    add(&t->update, r->timings.update_ms);
    add(&t->orientation, r->timings.orientation_ms);
    add(&t->traversal, r->timings.traversal_ms);
    add(&t->contact, r->timings.contact_ms);
    add(&t->proof, r->timings.proof_ms);
    add(&t->check, r->timings.check_ms);
    add(&t->total, r->timings.total_ms);
    add(&t->pcp, (double)r->counters.pcp);
    add(&t->tests, (double)r->counters.tests);
    add(&t->plus, (double)r->counters.plus);
    add(&t->minus, (double)r->counters.minus);
}

static double mean(const column *c, uint32_t count) {
    return count > 0 ? c->sum / count : 0.0;
}

/* A stage of a method that may not have it. */
static void print_stage(bool present, double ms) {
    if (present)
        printf(" %9.3f ms", ms);
    else
        printf(" %12s", "X");
}

static void print_row(const char *method, bool oriented, const double row[8], const char *what) {
    printf("%-9s %9.3f ms", method, row[0]);
    print_stage(oriented, row[1]);
    printf(" %9.3f ms %9.3f ms", row[2], row[3]);
    print_stage(oriented, row[4]);
    printf(" %12.0f %9.3f ms %9.3f ms  %s\n", row[5], row[6], row[7], what);
}

void totals_print_table(const totals *t, const char *method, bool oriented) {
    const column *columns[8] = {&t->update, &t->orientation, &t->traversal, &t->contact,
                                &t->proof,  &t->pcp,         &t->total,     &t->check};
    double means[8], maxima[8];
    for (int i = 0; i < 8; i++) {
        means[i] = mean(columns[i], t->intervals);
        maxima[i] = columns[i]->max;
    }
    printf("\n%-9s %12s %12s %12s %12s %12s %12s %12s %12s\n", "method", "BVH update", "orientation",
           "traversal", "contact", "proof", "#PCPs", "total", "check");
    print_row(method, oriented, means, "mean per frame");
    print_row("", oriented, maxima, "maximum");
    printf(oriented ? "" : "X: not part of this method. ");
    printf("The check is not part of the total.\n");
}
