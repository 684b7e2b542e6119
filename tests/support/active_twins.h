/* Two detectors of one mesh: one that has active vertices, and one that looks at everything and leaves out, by its function
 * `ignore`, what has none of them. All that they say is the same, bit for bit. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

enum { TWIN_VERTICES_MAX = 2 * SCENE_VERTICES_MAX };

typedef struct active_twins {
    const cscd_mesh *mesh;
    cscd_detector *ours, *theirs;
    uint32_t vertex_count;
    bool set;                       /* else all vertices are active */
    bool active[TWIN_VERTICES_MAX]; /* where there is a set */

    /* How much was compared. */
    size_t contacts, intersections, near, blocked, held, limited, waiting;
    size_t left_out; /* contacts of features that are not active, as far as anybody has asked */
} active_twins;

/* Creates theirs, whose options are those given, with `ignore`, method NONE or BRUTE, and mode ALL. ours: the detector
 * that has the set; it stays the caller's. */
void active_twins_begin(active_twins *t, cscd_detector *ours, const cscd_detector_options *options,
                        bool brute_force);

/* The same for a second detector that the caller has made with active_twins_ignore and t. */
void active_twins_join(active_twins *t, cscd_detector *ours, cscd_detector *theirs);
bool active_twins_ignore(void *user, cscd_contact_kind kind, uint32_t a, uint32_t b);
void active_twins_end(active_twins *t);

/* Takes another set: a part of space, single vertices, none, all, or what comes as an object; at times NULL. */
void active_twins_choose(active_twins *t, const double *x, random_stream *random);

/* Gives ours the set as it is. */
void active_twins_tell(active_twins *t);

/* Puts the vertices that are not active back to where they start. */
void active_twins_hold(const active_twins *t, const double *x0, double *x1);

/* Is one of two features active, as in cscd_contact? */
bool active_twins_look_at(const active_twins *t, cscd_contact_kind kind, uint32_t a, uint32_t b);

/* Each compares the answers of both. What motions reach is written to x1, or what they began with. */
void active_twins_step(active_twins *t, const double *x0, const double *x1);
void active_twins_check(active_twins *t, const double *x);
void active_twins_near(active_twins *t, const double *x, double distance);
void active_twins_max_step(active_twins *t, const double *x0, double *x1);
void active_twins_bounds(active_twins *t, const double *x0, double radius);
void active_twins_truncate(active_twins *t, const double *x0, double *x1, double radius);
void active_twins_line(active_twins *t, const double *x0, double *x1, double reach);
