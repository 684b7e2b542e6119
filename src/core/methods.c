/* Facts about each method that are known without running it. */
#include "src/core/methods.h"

#include <string.h>

static const method_traits traits[] = {
    {CSCD_METHOD_AUTO, .name = "auto", .by_orientation = true},
    {CSCD_METHOD_NONE, .name = "none"},
    {CSCD_METHOD_BRUTE, .name = "brute"},
    {CSCD_METHOD_SINGLE, .name = "single", .makes_plan = true, .by_orientation = true},
    {CSCD_METHOD_KMEANS, .name = "kmeans", .makes_plan = true, .needs_plan = true, .by_orientation = true},
    {CSCD_METHOD_CHARGE, .name = "charge", .makes_plan = true, .by_charge = true, .needs_plan = true,
     .by_orientation = true},
    {CSCD_METHOD_PUBLISHED, .name = "published", .makes_plan = true, .by_charge = true,
     .loses_contacts = true, .by_orientation = true},
    {CSCD_METHOD_ICCD, .name = "iccd", .by_contours = true},
    {CSCD_METHOD_ICCD_PUBLISHED, .name = "iccd-published", .loses_contacts = true, .by_contours = true},
    {CSCD_METHOD_CONES, .name = "cones", .by_contours = true},
};

enum { METHOD_COUNT = sizeof traits / sizeof *traits };

const method_traits *method_traits_of(cscd_method method) {
    for (int i = 0; i < METHOD_COUNT; i++) {
        if (traits[i].method == method) return &traits[i];
    }
    return NULL;
}

const method_traits *method_traits_named(const char *name) {
    for (int i = 0; i < METHOD_COUNT; i++) {
        if (strcmp(traits[i].name, name) == 0) return &traits[i];
    }
    return NULL;
}
