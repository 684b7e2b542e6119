/* Lists of proximities in both forms, and their energies. */
#include "tests/support/solver/near_items.h"

#include "tests/support/calls.h"
#include "tests/support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

rig near_rig(const scene *s, uint32_t threads) {
    cscd_detector_options options = cscd_detector_defaults();
    options.method = CSCD_METHOD_NONE;
    return rig_create(s, threads, &options);
}

void set_rest(const rig *r, const double *rest) {
    expect_ok(set_rest_packed(r->detector, rest));
}

item_list find_items(const rig *r, const double *x, double distance, cscd_near_form form) {
    cscd_proximities found = {.count = 4711};
    expect_ok(
        (form == CSCD_NEAR_UNIQUE ? find_unique_packed : find_near_packed)(r->detector, x, distance, &found));
    item_list list = {calloc(found.count + 1, sizeof *list.items), found.count};
    assert_non_null(list.items);
    if (found.count > 0) memcpy(list.items, found.items, found.count * sizeof *list.items);
    return list;
}

double mollifier_of(const cscd_proximity *p, const double *x) {
    double a[3], b[3], c[3], square = 0.0;
    if (p->threshold == 0.0) return 1.0;
    for (uint32_t k = 0; k < 3; k++) {
        a[k] = x[p->vertices[1] * 3 + k] - x[p->vertices[0] * 3 + k];
        b[k] = x[p->vertices[3] * 3 + k] - x[p->vertices[2] * 3 + k];
    }
    for (int k = 0; k < 3; k++) {
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        square += c[k] * c[k];
    }
    double share = square / p->threshold;
    return share < 1.0 ? share * (2.0 - share) : 1.0;
}

/* A barrier without its pole, so that scenes with contacts have an energy, too. */
static double energy_of(double distance, double reach) {
    double beyond = 1.0 - distance / reach;
    return beyond > 0.0 ? beyond * beyond * (2.0 + distance / reach) : 0.0;
}

double sum_energies(const item_list *list, const double *x, double reach, bool counted) {
    double sum = 0.0;
    for (size_t i = 0; i < list->count; i++) {
        const cscd_proximity *p = &list->items[i];
        sum += (counted ? p->count : 1) * mollifier_of(p, x) * energy_of(p->distance, reach);
    }
    return sum;
}
