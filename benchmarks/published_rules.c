/* What each rule of the published culling loses, one rule at a time. */
#include "benchmarks/lib/contest.h"
#include "cscd/research.h"

#include <stdio.h>

static const double toi_early = 1e-9;

typedef struct rule_set {
    const char *name;
    uint64_t rules; /* that are as published, by the bits of CSCD_OURS_ that they are not */
} rule_set;

enum {
    ALL_RULES = CSCD_OURS_MOTION | CSCD_OURS_STARTS | CSCD_OURS_REPRESENTATIVES | CSCD_OURS_NEIGHBOURS |
                CSCD_OURS_TESTS
};

static const rule_set rule_sets[] = {
    {"none of them", 0},
    {"adjacent triangles have no contact", CSCD_OURS_NEIGHBOURS},
    {"fixed representatives", CSCD_OURS_REPRESENTATIVES},
    {"the detector point stays", CSCD_OURS_MOTION},
    {"the start is not proven", CSCD_OURS_STARTS},
    {"plain cubic roots", CSCD_OURS_TESTS},
    {"all, as published", ALL_RULES},
};

/* Losses on one recording with one component. */
typedef struct losses {
    uint32_t with_contact;     /* intervals */
    uint32_t first, none_left; /* of these: intervals whose first contact is lost; that lose all */
    size_t contacts, lost;
} losses;

static bool measure_losses(const truth *t, const rule_set *set, losses *out, io_error *error) {
    const recording_data *r = t->recording;
    cscd_detector_options options = cscd_detector_defaults();
    cscd_detector *detector = NULL;
    options.method = CSCD_METHOD_PUBLISHED;
    options.ours = ALL_RULES & ~set->rules;
    if (cscd_detector_create(r->context, r->mesh, r->charge, &options, &detector) != CSCD_OK)
        return io_fail(error, "%s: %s", r->name, cscd_context_detail(r->context));
    losses sum = {.with_contact = 0};
    cscd_status status = CSCD_OK;
    for (uint32_t i = 0; status == CSCD_OK && i + 1 < r->frame_count; i++) {
        cscd_contacts found;
        size_t count = t->offsets[i + 1] - t->offsets[i];
        status = cscd_detector_step(
            detector, CSCD_DOUBLES(recording_data_frame(r, i), cscd_mesh_vertex_count(r->mesh)),
            CSCD_DOUBLES(recording_data_frame(r, i + 1), cscd_mesh_vertex_count(r->mesh)), &found);
        if (status != CSCD_OK || count == 0) continue;
        sum.with_contact++;
        sum.contacts += count;
        sum.lost += count - found.count;
        sum.none_left += found.count == 0;
        sum.first += found.count == 0 || found.items[0].toi > t->contacts[t->offsets[i]].toi + toi_early;
    }
    cscd_detector_destroy(detector);
    *out = sum;
    return status == CSCD_OK || io_fail(error, "%s: %s", r->name, cscd_context_detail(r->context));
}

static bool measure_recording(const char *name, io_error *error) {
    recording_data r;
    truth t;
    if (!recording_data_open("build/models", name, "build/models", 1, &r, error)) return false;
    bool good = truth_find(&r, &t, error);
    for (size_t i = 0; good && i < sizeof rule_sets / sizeof *rule_sets; i++) {
        losses l = {.with_contact = 0};
        good = measure_losses(&t, &rule_sets[i], &l, error);
        if (good)
            printf("  %-16s %-34s %5zu of %5zu %13u of %3u %12u\n", name, rule_sets[i].name, l.lost,
                   l.contacts, l.first, l.with_contact, l.none_left);
    }
    if (good) truth_free(&t);
    recording_data_close(&r);
    return good;
}

int main(int argument_count, char **arguments) {
    static const char *const names[] = {"pawn-drop", "dumbbell-stairs", "figure-balls"};
    io_error error;
    if (argument_count > 1) {
        fprintf(stderr,
                "usage: published_rules\n\nWhat each rule of the published culling loses on our recordings; "
                "'%s' is no argument of it.\n",
                arguments[1]);
        return 2;
    }
    printf("  %-16s %-34s %14s %20s %12s\n", "recording", "rule", "contacts lost", "first contacts lost",
           "all lost");
    for (int i = 0; i < 3; i++) {
        if (measure_recording(names[i], &error)) continue;
        fprintf(stderr, "published_rules: %s\n", error.text);
        return 1;
    }
    return 0;
}
