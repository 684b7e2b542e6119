/* The progress of a call, and the host's wish to end it. */
#pragma once

#include "src/core/entry.h"

#include <pthread.h>
#include <stdatomic.h>

/* The call that a context's caller waits for. */
typedef struct progress {
    cscd_progress host; /* report NULL: nobody is told, and nothing is cancelled */
    entry_state *entry; /* of the context */
    double interval_ms; /* the shortest time between two calls of report */
    pthread_t caller;   /* the thread that made the call, the only one to ask the host */
    double asked_ms;    /* when the host was asked last, or the call began */
    const char *stage;
    double part_begin, part_end; /* the share of the call that the present part takes */
    double begin, end;           /* the share of that part that the stage takes */
    double reported;             /* never falls */
    const char *held; /* the stage of a call that makes others, which say nothing; NULL: there is none */
    double held_share;
    atomic_bool cancelled;
    bool by_report; /* report has cancelled the call, and not cscd_context_cancel */
} progress;

progress progress_of(cscd_progress host, entry_state *entry);

bool progress_wanted(const progress *p);

/* Has the host cancelled the call? */
bool progress_cancelled(const progress *p);

/* Cancels the call; on any thread. */
void progress_cancel(progress *p);

/* Begins any call: forgets that an earlier one was cancelled. */
void progress_begin_call(progress *p);

/* Begins a call that asks the host now and then, as every call that can end with CSCD_CANCELLED. */
void progress_begin(progress *p);

/* A call that makes other calls of the library says where it stands itself: until it lets go, their stages and parts count for nothing,
 * and their beginnings begin nothing. The share is that of the whole call. */
void progress_hold(progress *p, const char *stage, double share);
void progress_let_go(progress *p);

/* The following stages take the call from begin to end, by estimate; without this, the whole call. */
void progress_part(progress *p, double begin, double end);

/* Begins a stage, whose name lies in static storage and which takes the part from begin to end. Tasks call
 * neither this nor progress_part. */
void progress_stage(progress *p, const char *stage, double begin, double end);

/* Work in the middle of a stage that has a name of its own: the fraction that is reported stands still meanwhile. */
typedef struct progress_outer {
    const char *stage;
    double begin, end;
} progress_outer;

/* Returns the stage that progress_leave goes back to. Tasks call neither. */
progress_outer progress_enter(progress *p, const char *stage);
void progress_leave(progress *p, progress_outer outer);

/* Says which share of the stage is done, from 0 to 1, and calls the host when it is time. Returns false when
 * the call is cancelled: the caller then returns as soon as it can, and unfinished results must not be used.
 * Any thread may ask, in a task too, but only the one that made the call reaches the host; on the others, and
 * where no host wants to know, this only reads flags. */
bool progress_go_on(progress *p, double share);
