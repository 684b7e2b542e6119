/* What the commands need to know of each method, from what the library says about it. */
#include "tool/common/methods.h"

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

/* Those of plans come first. */
static const step_word steps[] = {{"charge", CSCD_OURS_CHARGE},
                                  {"ranks", CSCD_OURS_RANKS},
                                  {"cuts", CSCD_OURS_CUTS},
                                  {"points", CSCD_OURS_POINTS},
                                  {"motion", CSCD_OURS_MOTION},
                                  {"starts", CSCD_OURS_STARTS},
                                  {"representatives", CSCD_OURS_REPRESENTATIVES},
                                  {"neighbours", CSCD_OURS_NEIGHBOURS},
                                  {"tests", CSCD_OURS_TESTS},
                                  {"boxes", CSCD_OURS_BOXES}};

enum { ALL_STEPS = sizeof steps / sizeof *steps, PLAN_STEPS = 4 };

uint64_t ours_of_plans(uint64_t ours) {
    uint64_t all = 0;
    for (int i = 0; i < PLAN_STEPS; i++) all |= steps[i].bit;
    return ours & all;
}

static bool find_step(const char *text, size_t length, int count, uint64_t *set) {
    for (int i = 0; i < count; i++) {
        if (strlen(steps[i].word) != length || memcmp(steps[i].word, text, length) != 0) continue;
        *set |= steps[i].bit;
        return true;
    }
    return false;
}

static bool read_steps(const char *text, int count, uint64_t *out) {
    uint64_t set = 0;
    for (;;) {
        const size_t length = strcspn(text, ",");
        if (!find_step(text, length, count, &set)) return false;
        if (text[length] == '\0') break;
        text += length + 1;
    }
    *out = set;
    return true;
}

/* The first of these steps that is not among the allowed ones; NULL: there is none. */
static const char *word_beyond(uint64_t ours, uint64_t allowed) {
    for (int i = 0; i < ALL_STEPS; i++)
        if ((ours & ~allowed & steps[i].bit) != 0) return steps[i].word;
    return NULL;
}

bool ours_agrees(cscd_method method, uint64_t ours, io_error *error) {
    const uint64_t of_iccd = CSCD_OURS_NEIGHBOURS | CSCD_OURS_TESTS | CSCD_OURS_BOXES;
    if (ours == 0) return true;
    if (!method_facts_of(method).loses_contacts)
        return io_fail(error, "--ours counts with --method published or iccd-published; leave it out");
    const char *beyond = word_beyond(ours, method == CSCD_METHOD_PUBLISHED ? UINT64_MAX : of_iccd);
    if (beyond != NULL)
        return io_fail(error, "--ours %s counts with --method published; with %s: neighbours, tests, boxes",
                       beyond, cscd_method_name(method));
    if ((ours & CSCD_OURS_CUTS) != 0 && (ours & CSCD_OURS_RANKS) == 0)
        return io_fail(error, "--ours cuts needs ranks; give --ours ranks,cuts");
    if ((ours & CSCD_OURS_POINTS) != 0 && (ours & CSCD_OURS_CUTS) == 0)
        return io_fail(error, "--ours points needs cuts; give --ours ranks,cuts,points");
    return true;
}

bool read_ours_of_plans(const char *text, void *place) {
    return read_steps(text, PLAN_STEPS, place);
}

bool read_ours(const char *text, void *place) {
    return read_steps(text, ALL_STEPS, place);
}
