/* What the commands need to know of each method, from what the library says about it. */
#include "src/tool/common/methods.h"

#include <cscd/research.h>

method_facts method_facts_of(cscd_method method) {
    cscd_method_info info;
    if (!cscd_method_describe(method, &info)) return (method_facts){.by_regions = false};
    return (method_facts){
        .by_regions = info.by_orientation,
        .by_contours = info.by_contours,
        .makes_plan = info.makes_plan,
        /* A published method to compare with is compared with regions. */
        .insists_on_plan = info.by_orientation && info.loses_contacts,
        .loses_contacts = info.loses_contacts,
    };
}
