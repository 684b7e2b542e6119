/* The table at the end of a replay: the thesis' columns, mean and maximum per frame. */
#include "src/tool/common/summary.h"

#include <stdio.h>
#include <string.h>

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
    add(&t->contour, r->timings.contour_ms);
    add(&t->traversal, r->timings.traversal_ms);
    add(&t->contact, r->timings.contact_ms);
    add(&t->proof, r->timings.proof_ms);
    add(&t->check, r->timings.check_ms);
    add(&t->total, r->timings.total_ms);
    add(&t->pcp, (double)r->counters.pcp);
    add(&t->tests, (double)r->counters.tests);
    add(&t->plus, (double)r->counters.plus);
    add(&t->minus, (double)r->counters.minus);
    add(&t->clean, (double)r->counters.clean);
    add(&t->passes, (double)r->counters.passes);
}

static double mean(const column *c, uint32_t count) {
    return count > 0 ? c->sum / count : 0.0;
}

enum { STAGES = 6 };

/* Of the columns up to the proof, which the method has; X stands for the others. */
static void find_stages(cscd_method method, bool present[STAGES]) {
    bool contours = method == CSCD_METHOD_ICCD || method == CSCD_METHOD_ICCD_PUBLISHED;
    bool oriented = method != CSCD_METHOD_NONE && method != CSCD_METHOD_BRUTE && !contours;
    const bool stages[STAGES] = {true, oriented, contours, true, true, oriented};
    memcpy(present, stages, sizeof stages);
}

static void print_row(const char *method, const bool present[STAGES], const double row[STAGES + 3],
                      const char *what) {
    printf("%-14s", method);
    for (int i = 0; i < STAGES; i++) {
        if (present[i])
            printf(" %9.3f ms", row[i]);
        else
            printf(" %12s", "X");
    }
    printf(" %12.0f %9.3f ms %9.3f ms  %s\n", row[STAGES], row[STAGES + 1], row[STAGES + 2], what);
}

void totals_print_table(const totals *t, cscd_method method) {
    static const char *const names[STAGES + 3] = {
        "BVH update", "orientation", "contour", "traversal", "contact", "proof", "#PCPs", "total", "check"};
    const column *columns[STAGES + 3] = {&t->update, &t->orientation, &t->contour, &t->traversal, &t->contact,
                                         &t->proof,  &t->pcp,         &t->total,   &t->check};
    double means[STAGES + 3], maxima[STAGES + 3];
    bool present[STAGES];
    find_stages(method, present);
    printf("\n%-14s", "method");
    for (int i = 0; i < STAGES + 3; i++) {
        means[i] = mean(columns[i], t->intervals);
        maxima[i] = columns[i]->max;
        printf(" %12s", names[i]);
    }
    putchar('\n');
    print_row(cscd_method_name(method), present, means, "mean per frame");
    print_row("", present, maxima, "maximum");
    printf("X: not part of this method. The check is not part of the total.\n");
}
