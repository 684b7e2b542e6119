/* Brute force over features, which every method must equal; which components are collapsed, and when they first
 * touch themselves. */
#pragma once

#include "cscd/cscd.h"
#include "runtime/ccd/ccd.h"
#include "tests/support/scenes.h"

/* A contact as a triple that can be sorted and compared. */
typedef struct oracle_contact {
    cscd_contact_kind kind;
    uint32_t a, b;
    double toi;
} oracle_contact;

typedef struct oracle_list {
    oracle_contact *items;
    size_t count, capacity;
} oracle_list;

/* Gives all VF and EE pairs without a common vertex whose motions have boxes that meet, but those of two components that are collapsed
 * at an end, to the feature queue, in random order and on every instruction set, without trees or stars. The list is sorted by
 * (toi, kind, a, b). Edges are numbered as the public API says, but by separate code. */
void oracle_find(const scene *s, oracle_list *out);

/* Finds the same with the test of minimum separation. */
void oracle_find_within(const scene *s, const separation *limit, oracle_list *out);

/* Which objects are looked at with which, and how far apart they have to stay. */
typedef struct oracle_rules {
    const uint32_t *vertex_objects;
    uint32_t object_count;
    const double
        *distances; /* object_count rows: 0 for touching, below 0 for objects that are not looked at */
} oracle_rules;

/* Finds contacts and what comes within the distance of its objects, with a tolerance of 1e-6 of it. */
void oracle_find_by_rules(const scene *s, const oracle_rules *rules, oracle_list *out);

/* Fails the test unless a step has found just these. */
void oracle_expect(const oracle_list *truth, const cscd_contacts *found);

void oracle_free(oracle_list *list);

/* ---- collapsed components ------------------------------------------------------------------------------ */

/* Marks, per vertex of the scene, those of components whose triangles all have no area at the positions; false for vertices
 * without a triangle. names: per vertex, for wires; NULL: there are none. */
void collapsed_oracle(const scene *s, const double *positions, const uint32_t *names, bool *vertices);

/* The same of both ends of the scene's interval together. */
void collapsed_oracle_at_ends(const scene *s, const uint32_t *names, bool *vertices);

/* ---- first contacts ------------------------------------------------------------------------------------ */

/* A scene has at most this many components. */
enum { COMPONENTS_MAX = SCENE_TRIANGLES_MAX };

/* A time of impact may be early by less than this. */
#define TOI_EARLY 1e-9

/* Returns the component whose contact with itself this is, or UINT32_MAX for a contact between two
 * components. */
uint32_t self_component(const cscd_mesh *mesh, const scene *s, const cscd_contact *c);

/* Fills in the time of each component's first contact with itself in a list; INFINITY means none. */
void find_first_times(const cscd_mesh *mesh, const scene *s, const cscd_contacts *list,
                      double times[COMPONENTS_MAX]);
