/* What the commands need to know of each method, from what the library says about it. */
#include "src/tool/common/methods.h"

#include <cscd/research.h>

#include <string.h>

method_facts method_facts_of(cscd_method method) {
    cscd_method_info info;
    if (!cscd_method_describe(method, &info)) return (method_facts){.by_regions = false};
    return (method_facts){
        .by_regions = info.by_orientation,
        .by_contours = info.by_contours,
        .makes_plan = info.makes_plan,
        .by_charge = info.by_charge,
        /* A published method to compare with is compared with regions. */
        .insists_on_plan = info.by_orientation && info.loses_contacts,
        .loses_contacts = info.loses_contacts,
    };
}

/* ---- steps of the published method --------------------------------------------------------------------- */

typedef struct step_word {
    const char *word;
    uint64_t bit;
} step_word;

static const step_word of_plans[] = {{"charge", CSCD_OURS_CHARGE},
                                     {"ranks", CSCD_OURS_RANKS},
                                     {"cuts", CSCD_OURS_CUTS},
                                     {"points", CSCD_OURS_POINTS}};

enum { PLAN_WORDS = sizeof of_plans / sizeof *of_plans };

static bool find_word(const char *text, size_t length, uint64_t *set) {
    for (int i = 0; i < PLAN_WORDS; i++) {
        if (strlen(of_plans[i].word) != length || memcmp(of_plans[i].word, text, length) != 0) continue;
        *set |= of_plans[i].bit;
        return true;
    }
    return false;
}

bool read_ours_of_plans(const char *text, void *place) {
    uint64_t set = 0;
    for (;;) {
        const size_t length = strcspn(text, ",");
        if (!find_word(text, length, &set)) return false;
        if (text[length] == '\0') break;
        text += length + 1;
    }
    *(uint64_t *)place = set;
    return true;
}

bool read_ours(const char *text, void *place) {
    return read_ours_of_plans(text, place);
}
