/* What every call promises (tests/support/proofs/proof.h), of event trackers and of single pairs. */
#include "tests/support/events/recorded_frames.h"
#include "tests/support/proofs/openings.h"
#include "tests/support/random.h"
#include "tests/support/test.h"

#include <stdlib.h>
#include <string.h>

/* ---- event trackers ------------------------------------------------------------------------------------- */

/* A recording, whose frames go to a tracker one by one. */
typedef struct proof_recording {
    recorded_frames frames;
    uint32_t next;
} proof_recording;

static void open_recording(proof *p) {
    proof_recording *r = calloc(1, sizeof *r);
    assert_non_null(r);
    random_seed(p->row->seed);
    recorded_frames_create(&r->frames, NULL, 4);
    p->own = r;
}

static void close_recording(proof *p) {
    proof_recording *r = p->own;
    recorded_frames_free(&r->frames);
    free(r);
}

static cscd_status create_tracker(proof *p) {
    const proof_recording *r = p->own;
    return cscd_event_tracker_create(p->context, r->frames.mesh, &r->frames.options, &p->answer.tracker);
}

static void keep_tracker(proof *p) {
    p->tracker = p->answer.tracker;
}

static cscd_status add_contacts(proof *p) {
    const proof_recording *r = p->own;
    const recorded_frame *f = &r->frames.frames[r->next];
    return cscd_event_tracker_add_contacts(p->tracker, f->contacts, f->contact_count);
}

static cscd_status add_frame(proof *p) {
    const proof_recording *r = p->own;
    const recorded_frame *f = &r->frames.frames[r->next];
    return cscd_event_tracker_add_frame(p->tracker, f->number, f->looked ? &f->found : NULL);
}

static void go_on(proof *p) {
    ((proof_recording *)p->own)->next++;
}

static cscd_status take_events(proof *p) {
    return cscd_event_tracker_take(p->tracker, &p->answer.events);
}

static cscd_status finish_events(proof *p) {
    return cscd_event_tracker_finish(p->tracker, &p->answer.events);
}

static void read_events(proof *p) {
    proof_add_items(p, p->answer.events.items, p->answer.events.count, sizeof *p->answer.events.items);
    proof_add(p, &p->answer.events.open, sizeof p->answer.events.open);
}

static const proof_call tracker_made = {"event_tracker_create", PROOF_CREATES, create_tracker, keep_tracker};
static const proof_call contacts = {"event_tracker_add_contacts", PROOF_CHANGES, add_contacts, NULL};
static const proof_call frame = {"event_tracker_add_frame", PROOF_BEGINS, add_frame, go_on};
static const proof_call taken = {"event_tracker_take", PROOF_CHANGES, take_events, read_events};
static const proof_call finished = {"event_tracker_finish", PROOF_CHANGES, finish_events, read_events};

/* ---- single pairs --------------------------------------------------------------------------------------- */

/* Random points of so many pairs, as doubles and as floats. */
typedef struct proof_pairs {
    double x[2][PROOF_PAIRS_MAX * 12];
    float rounded[2][PROOF_PAIRS_MAX * 12];
} proof_pairs;

static void open_pairs(proof *p) {
    proof_pairs *r = malloc(sizeof *r);
    assert_non_null(r);
    random_seed(7);
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < PROOF_PAIRS_MAX * 12; k++) {
            r->x[i][k] = random_unit();
            r->rounded[i][k] = (float)r->x[i][k];
        }
    }
    p->own = r;
}

static void free_pairs(proof *p) {
    free(p->own);
}

static cscd_pairs pairs_of(const proof *p, cscd_contact_kind kind) {
    const uint32_t count = p->large ? PROOF_PAIRS_MAX : 50;
    return (cscd_pairs){kind, 4 * count, count, NULL};
}

static cscd_status step_pairs(proof *p) {
    const proof_pairs *r = p->own;
    const cscd_pairs pairs = pairs_of(p, CSCD_CONTACT_EE);
    return cscd_pairs_step(p->context, &pairs, CSCD_DOUBLES(r->x[0], pairs.point_count),
                           CSCD_DOUBLES(r->x[1], pairs.point_count), 0.0, 0.0, p->answer.pair_contacts);
}

static cscd_status step_rounded(proof *p) {
    const proof_pairs *r = p->own;
    const cscd_pairs pairs = pairs_of(p, CSCD_CONTACT_VF);
    return cscd_pairs_step(p->context, &pairs, CSCD_FLOATS(r->rounded[0], pairs.point_count),
                           CSCD_FLOATS(r->rounded[1], pairs.point_count), 0.01, 0.0, p->answer.pair_contacts);
}

static void read_pair_contacts(proof *p) {
    proof_add_items(p, p->answer.pair_contacts, pairs_of(p, CSCD_CONTACT_EE).pair_count,
                    sizeof *p->answer.pair_contacts);
}

static cscd_status find_near_pairs(proof *p) {
    const proof_pairs *r = p->own;
    const cscd_pairs pairs = pairs_of(p, CSCD_CONTACT_VF);
    return cscd_pairs_find_near(p->context, &pairs, CSCD_DOUBLES(r->x[0], pairs.point_count), 0.4,
                                p->answer.pair_distances);
}

static cscd_status find_near_rounded(proof *p) {
    const proof_pairs *r = p->own;
    const cscd_pairs pairs = pairs_of(p, CSCD_CONTACT_EE);
    return cscd_pairs_find_near(p->context, &pairs, CSCD_FLOATS(r->rounded[0], pairs.point_count), 0.4,
                                p->answer.pair_distances);
}

static void read_pair_distances(proof *p) {
    proof_add_items(p, p->answer.pair_distances, pairs_of(p, CSCD_CONTACT_EE).pair_count,
                    sizeof *p->answer.pair_distances);
}

static const proof_call pair_step = {"pairs_step", PROOF_ASKS, step_pairs, read_pair_contacts};
static const proof_call pair_near = {"pairs_find_near", PROOF_ASKS, find_near_pairs, read_pair_distances};
static const proof_call rounded_step = {"pairs_step", PROOF_ASKS, step_rounded, read_pair_contacts};
static const proof_call rounded_near = {"pairs_find_near", PROOF_ASKS, find_near_rounded,
                                        read_pair_distances};

/* ---- the table ------------------------------------------------------------------------------------------ */

static const char packed[] = "packed doubles are read where they are";
static const char unasked[] = "single pairs report no progress";
static const char rounded[] = "floats are made doubles, which nothing keeps";
static const char tracked[] = "a frame has few things, which one thread adds";

#define FRAMES                                                                                               \
    {                                                                                                        \
        &tracker_made, &contacts, &frame, &contacts, &frame, &taken, &contacts, &frame, &contacts, &frame,   \
            &finished                                                                                        \
    }
static const proof_row rows[] = {
    {"events", FRAMES, open_recording, close_recording, .seed = 1, .no_report = tracked,
     .one_thread = tracked},
    {"events_seams", FRAMES, open_recording, close_recording, .seed = 4, .no_report = tracked,
     .one_thread = tracked},
    {"pairs",
     {&pair_step, &pair_near},
     open_pairs,
     free_pairs,
     .no_allocation = packed,
     .no_report = unasked},
    {"pairs_of_floats",
     {&rounded_step, &rounded_near},
     open_pairs,
     free_pairs,
     .no_report = unasked,
     .allocates = rounded},
};

PROOFS(rows)
