/* How far a call has come, and whether the host wants it to end. */
#pragma once

#include "cscd/cscd.h"

#include <pthread.h>
#include <stdatomic.h>

/* The call at hand of a context. */
typedef struct progress {
    cscd_progress host; /* report NULL: nobody is told, and nothing is cancelled */
    double interval_ms; /* the host is asked no more often */
    pthread_t caller;   /* the thread that made the call, the only one to ask the host */
    double asked_ms;    /* when it did so last, or the call began */
    const char *stage;
    double part_begin, part_end; /* of the call, what is at work */
    double begin, end;           /* of that part, the stage */
    double reported;             /* never falls */
    atomic_bool cancelled;
} progress;

progress progress_of(cscd_progress host);

bool progress_wanted(const cscd_context *context);

/* A call begins that asks the host now and then. Any that can end with CSCD_CANCELLED does so first: what was
 * cancelled before is over. */
void progress_begin(cscd_context *context);

/* What follows takes the part from begin to end of the call, by estimate; the whole until this is called. */
void progress_part(cscd_context *context, double begin, double end);

/* A stage begins, named in static storage, which takes what lies between begin and end of the part. These two
 * are not for tasks. */
void progress_stage(cscd_context *context, const char *stage, double begin, double end);

/* So much of the stage is done, from 0 to 1: the host is asked when it is time. False: the call is cancelled,
 * and whoever gets this returns as soon as it can; what it leaves behind unfinished must not be used. Any
 * thread may ask, in a task too, but only the one that made the call reaches the host; on the others, and
 * where no host wants to know, this is one look at a flag. */
bool progress_go_on(cscd_context *context, double share);

/* OK, or CANCELLED with its sentence. What tasks did counts only after this has said OK. */
cscd_status progress_status(cscd_context *context);
