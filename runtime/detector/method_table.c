/* Says how each method goes through the pipeline. Baselines are in runtime/baselines: without that folder and the
 * lines between the marks here, the detector has all other methods. */
#include "runtime/detector/config.h"

/* baselines: begin */
#include "runtime/baselines/baselines.h"
/* baselines: end */

static const culling_rules tests_every_pair = {.by_orientation = false};
static const culling_rules culls_by_orientation = {.by_orientation = true};
/* baselines: begin */
static const culling_rules assumes_clean = {.by_orientation = true, .assumes_clean = true};
/* baselines: end */
static const culling_rules culls_where_it_pays = {.by_orientation = true, .where_it_pays = true};

static const method_stages stages[] = {
    {CSCD_METHOD_AUTO, .rules = &culls_where_it_pays},
    {CSCD_METHOD_NONE, .rules = &tests_every_pair},
    {CSCD_METHOD_BRUTE, .rules = &tests_every_pair, .brute_force = true},
    {CSCD_METHOD_SINGLE, .rules = &culls_by_orientation},
    {CSCD_METHOD_KMEANS, .rules = &culls_by_orientation},
    {CSCD_METHOD_CHARGE, .rules = &culls_by_orientation},
    /* baselines: begin */
    {CSCD_METHOD_PUBLISHED, .rules = &assumes_clean, .search = &detector_based_search,
     .ours = CSCD_OURS_MOTION | CSCD_OURS_STARTS | CSCD_OURS_REPRESENTATIVES | CSCD_OURS_NEIGHBOURS |
             CSCD_OURS_TESTS | CSCD_OURS_BOXES},
    {CSCD_METHOD_ICCD, .rules = &tests_every_pair, .hider = &iccd_hider},
    {CSCD_METHOD_ICCD_PUBLISHED, .rules = &tests_every_pair, .search = &iccd_search,
     .ours = CSCD_OURS_NEIGHBOURS | CSCD_OURS_TESTS | CSCD_OURS_BOXES},
    {CSCD_METHOD_CONES, .rules = &tests_every_pair, .hider = &cones_hider},
    /* baselines: end */
};

static const method_stages absent;

const method_stages *method_stages_of(cscd_method method) {
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++) {
        if (stages[i].method == method) return &stages[i];
    }
    return &absent;
}

bool cscd_method_describe(cscd_method method, cscd_method_info *out) {
    const method_traits *found = method_traits_of(method);
    if (found == NULL) return false;
    cscd_method_info info = {.name = found->name,
                             .makes_plan = found->makes_plan,
                             .needs_plan = found->needs_plan,
                             .loses_contacts = found->loses_contacts,
                             .by_orientation = found->by_orientation,
                             .by_contours = found->by_contours,
                             .by_charge = found->by_charge,
                             .available = method_stages_of(method)->rules != NULL};
    *out = info;
    return true;
}
