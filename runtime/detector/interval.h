/* The interval at hand: which components are culled in it, what contacts have done to them, and the limit of its list. */
#pragma once

#include "runtime/culling/culling.h"
#include "runtime/detector/search.h"
#include "runtime/intersections/intersections.h"

/* The contacts that taint triangles when they leave the workers: all of them, or, in a search of a moment, those that are left
 * out and may touch on the way of a motion that begins there. Where only the earliest contacts are listed, those leave the
 * workers that neither taint nor are listed. */
typedef enum cap_taint { CAP_TAINTS_ALL, CAP_TAINTS_LEFT_OUT, CAP_KEEPS_EARLIEST } cap_taint;

/* A limit on the length of lists: contacts that find no room are counted, and leave nothing behind but taint. */
typedef struct list_cap {
    size_t longest; /* of the options; 0: there is no limit */
    bool *tainted;  /* per triangle: by contacts that have left the workers; NULL: there never was a limit */
    bool any_tainted;
    size_t beside;   /* the room of a worker besides its share of the limit */
    cap_taint taint; /* which contacts that leave the workers taint, in this search */
} list_cap;

typedef struct detector_interval {
    search_space *space;          /* of the detector */
    const exclusions *exclusions; /* of its configuration */
    culling culling;
    list_cap cap;

    /* True if pairs of two collapsed components are not looked at. */
    bool leaves_collapsed;

    /* Per component: */
    bool *culled; /* its pairs are culled */
    bool *closes; /* it is culled, and closing passes find all its contacts, or all that are early enough */
    uint32_t *touched; /* the number of contacts that it has with itself */
    bool *incomplete;  /* some of its contacts may be missing */
    uint32_t *kept; /* pairs of its triangles that were not culled, where that decides (culling_choice.c) */
    uint32_t *kept_by_workers; /* the same for each worker in turn */
    double *earliest; /* the least toi of its contacts with itself, where only the earliest are wanted */

    uint32_t intervals; /* that the vertices have gone through */
    bool counts_kept;   /* pairs are counted in this one */
    bool lists_earliest;
    uint64_t passes;       /* its closing passes */
    size_t *contacts_seen; /* per worker: its first contacts that have been looked at for tainted triangles */
} detector_interval;

/* ---- what culling learns ------------------------------------------------------------------------------- */

/* Begins to count the pairs of each component with itself, by which the next intervals choose between culling it or not.
 * The start states have been counted. proves: a step proves what is not known of the start. */
void interval_begin_counting(detector_interval *iv, const culling_rules *rules, start_states *starts,
                             bool proves);

/* Ends an interval that the vertices go through, before its end becomes the next start. */
void interval_learn(detector_interval *iv, const culling_rules *rules, start_states *starts);

/* Culls every component but obstacles; nothing has touched yet. */
void interval_cull_everything(detector_interval *iv);

/* ---- only the earliest contacts ------------------------------------------------------------------------ */

/* A contact is listed if its toi exceeds the least one of its component by at most this. A toi is never late, and early by
 * less than this (docs/theory/elementary.md). */
static const double earliest_share = 1e-9;

/* Closing passes have to find every contact whose true time is at most that of the latest one that may be listed, so
 * contacts up to here taint (docs/theory/culling.md, Corollary 2). */
static const double earliest_tainting = 2e-9;

/* Begins an interval: no contact is noted. */
void earliest_begin(detector_interval *iv);

/* Notes the contacts that the workers have gained since contacts_seen. */
void earliest_note(detector_interval *iv);

/* Takes the contacts of components with themselves out of the workers whose toi exceeds the earliest one by more than
 * `within`. The earliest have been noted. */
void earliest_drop_later(detector_interval *iv, double within);

/* ---- the limit of a list ------------------------------------------------------------------------------- */

/* Sets the limit from now on; 0: none. OUT_OF_MEMORY: nothing changes. */
cscd_status list_cap_set(cscd_context *context, const cscd_mesh *mesh, list_cap *cap, size_t longest);

/* LIST_TOO_LONG, with its sentence: the list would have `count` items. */
cscd_status list_cap_fail(cscd_context *context, const list_cap *cap, size_t count);

/* Lets the search that has just begun keep no more contacts than the limit allows. */
void list_cap_begin(detector_interval *iv, interval_search *search, cap_taint taint);

/* Taints by the contacts that have left the workers since the last call. Returns how many triangles are newly kept. */
uint32_t list_cap_taint(detector_interval *iv, const tainting *t);

/* Lets static checks keep no more pairs in their workers than the longest list allows, until list_cap_end_pairs; 0: no list
 * is made of them, so workers need room for few. spill takes pairs from the workers as they fill; NULL drops them, since their
 * triangles are marked. */
void list_cap_begin_pairs(const list_cap *cap, static_check *check, size_t longest, void (*spill)(void *data),
                          void *data);
void list_cap_end_pairs(static_check *check);
