/* What the commands need to know of each method. */
#include "src/tool/common/methods.h"

#include "cscd/research.h"
static const method_facts facts[] = {
    [CSCD_METHOD_AUTO] = {.by_regions = true},
    [CSCD_METHOD_NONE] = {.by_regions = false},
    [CSCD_METHOD_BRUTE] = {.by_regions = false},
    [CSCD_METHOD_SINGLE] = {.by_regions = true, .makes_plan = true},
    [CSCD_METHOD_KMEANS] = {.by_regions = true, .makes_plan = true},
    [CSCD_METHOD_CHARGE] = {.by_regions = true, .makes_plan = true},
    [CSCD_METHOD_PUBLISHED] = {.by_regions = true, .insists_on_plan = true, .loses_contacts = true},
    [CSCD_METHOD_ICCD] = {.by_contours = true},
    [CSCD_METHOD_ICCD_PUBLISHED] = {.by_contours = true, .loses_contacts = true},
};

const method_facts *method_facts_of(cscd_method method) {
    return &facts[method];
}
