/* What every call of the library promises, proven by one driver for all rows of a table. A row names some calls, one after the
 * other, and how they find what they need; the driver makes them in many worlds and compares the answers byte for byte:
 *   memory     each allocation fails in turn: OUT_OF_MEMORY with its sentence, outputs untouched, and nothing leaks
 *   cancelled  at each progress report, and by cscd_context_cancel() in each callback: CANCELLED, outputs untouched
 *   skipped    a call that has failed is not repeated: those behind it answer as if it had not been made
 *   threads    1, 2 and 7 threads, and a loop of the host that runs the tasks backwards
 *   levels     each set of vector instructions that this processor has
 *   repeated   in a new world, and again and again in the same one, each call by itself and all in turns, where the last times
 *              allocate nothing
 * In all but `skipped` a call that has failed is repeated at once, and must then succeed. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/calls.h"
#include "tests/support/scenes.h"

#include <pthread.h>
#include <stdatomic.h>

enum { PROOF_CALLS_MAX = 24, PROOF_MOMENTS = 4, PROOF_PAIRS_MAX = 1024 };

/* Where a world interferes with a call. */
typedef enum proof_source {
    PROOF_UNHARMED,
    PROOF_ALLOCATION_FAILS,
    PROOF_REPORT_REFUSES,
    PROOF_REPORT_CANCELS,
    PROOF_ALLOCATION_CANCELS,
    PROOF_TASK_CANCELS,
    PROOF_IGNORE_CANCELS,
    PROOF_SOURCE_COUNT
} proof_source;

/* One world in which a row's calls are made. */
typedef struct proof {
    const struct proof_row *row;
    cscd_context_options options; /* of its context */
    cscd_context *context;
    counting_allocator counter;
    size_t empty; /* bytes that the context holds by itself */
    pthread_t thread;

    /* What interferes: the call of this number, counted from 0, of this source is the one that fails or cancels. */
    proof_source source;
    atomic_size_t seen;
    size_t at;
    atomic_bool struck;
    bool armed;    /* a call is being made */
    int only, out; /* the one call that is harmed, and one that is left out; -1: all, none */
    bool skips;    /* a call that has failed is not repeated */
    int again;     /* so many times more are calls made that ask */

    bool
        unwatched; /* without a progress function, so that a call that fails need not restore all that is known */
    bool large; /* the calls should have work for several threads */
    uint32_t wide_loops;
    double fraction; /* of the last report */

    /* What the calls work on: made by the row's `open`, or by calls before. The driver destroys what is not NULL. */
    scene shape;
    double x[PROOF_MOMENTS][SCENE_VERTICES_MAX * 3]; /* one moment after the other */
    cscd_mesh *mesh;
    cscd_mesh_change *change;
    cscd_plan *plan;
    cscd_detector *detector, *clone;
    cscd_line_search *line;
    cscd_event_tracker *tracker, *later;
    cscd_energy *energy;
    void *own; /* of the row, which frees it in `close` */

    /* What the call at hand writes. A call that fails must leave all of it as it was. */
    union {
        cscd_context *context;
        cscd_mesh *mesh;
        cscd_mesh_change *change;
        cscd_plan *plan;
        cscd_detector *detector;
        cscd_line_search *line;
        cscd_event_tracker *tracker;
        cscd_energy *energy;
        cscd_energy_pattern pattern;
        cscd_energy_sum energy_sum;
        cscd_contacts contacts;
        cscd_intersections pairs;
        cscd_measures measures;
        cscd_candidates candidates;
        cscd_tet_surface *tet_surface;
        cscd_proximities near;
        cscd_free_step step;
        cscd_displacement_bounds bounds;
        cscd_truncation truncation;
        cscd_safe_motion safe;
        cscd_untangled untangled;
        cscd_lenses lenses;
        cscd_contact_part_pairs part_pairs;
        cscd_events events;
        void *words[8]; /* of a row whose types are not known here */
        struct {
            const uint8_t *items;
            size_t count;
        } bytes;
        cscd_pair_contact pair_contacts[PROOF_PAIRS_MAX];
        cscd_pair_distance pair_distances[PROOF_PAIRS_MAX];
    } answer;
    double reached[SCENE_VERTICES_MAX * 3];

    /* A digest of each call's answer, and of the detector's counters and what it knows of components afterwards. */
    struct {
        uint64_t answer, counters;
    } digests[PROOF_CALLS_MAX];
    int at_call;
    size_t items; /* in all lists that were read */
    uint32_t failures, cancellations;
    const char *allocates; /* this call does, also when it is asked the same again and again */
} proof;

/* What a call is to the proofs. */
typedef enum proof_kind {
    PROOF_ASKS,    /* asked again, it answers the same */
    PROOF_CREATES, /* makes an object: a failure leaves no byte behind. Asked once */
    PROOF_CHANGES, /* changes an object. Asked once */
    PROOF_BEGINS,  /* what calls behind it need. Asked once */
} proof_kind;

/* A call: its function without `cscd_`, how it is made, and what of its answer is compared. `read` may be NULL, and is
 * called when the call has succeeded. */
typedef struct proof_call {
    const char *function;
    proof_kind kind;
    cscd_status (*make)(proof *p);
    void (*read)(proof *p);
} proof_call;

/* A row. Where one of the promises does not hold for its calls, the sentence says why, and the driver sees that it is so. */
typedef struct proof_row {
    const char *name;
    const proof_call *calls[PROOF_CALLS_MAX];
    void (*open)(proof *p);  /* makes what the calls need; NULL: nothing */
    void (*close)(proof *p); /* frees p->own */
    bool without_context;    /* a call creates it */
    scene_family family;     /* what the row's `open` reads */
    uint64_t seed;
    cscd_method method;
    const char *no_allocation; /* nothing is allocated, so nothing can fail */
    const char *no_report;     /* progress is not reported: these calls are over soon */
    const char *one_thread;    /* no work is shared */
    const char *allocates;     /* also when nothing has changed */
} proof_row;

/* The tests of a file: one for each row and promise, called ROW_PROMISE. */
int proofs_run(const char *name, const proof_row *rows, size_t row_count);
#define PROOFS(rows)                                                                                         \
    static int run_proofs(void) {                                                                            \
        return proofs_run(TEST_FILE, rows, sizeof rows / sizeof *rows);                                      \
    }                                                                                                        \
    FILE_MAIN(run_proofs)

/* Adds bytes of the answer to the digest; a list with its count. Each row must find some items. */
void proof_add(proof *p, const void *bytes, size_t size);
void proof_add_items(proof *p, const void *items, size_t count, size_t size);

/* `ignore` of a detector, which leaves nothing out; user is the proof. */
bool proof_ignore(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b);

/* A call has made the context. */
void proof_take_context(proof *p, cscd_context *context);

/* The status in an `open` must be OK. */
void proof_need(proof *p, cscd_status status);

/* ---- worlds -------------------------------------------------------------------------------------------- */

/* A world of so many threads in which the call number `at` of a source fails or cancels. */
proof proof_world(const proof_row *row, uint32_t thread_count, proof_source source, size_t at);

/* Tasks are run by the host, on one thread and the last ones first. */
void proof_host_loop(proof *p);

/* Makes the calls, and destroys everything; any promise that is not kept fails the test. */
void proof_live(proof *p);
