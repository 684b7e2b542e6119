/* A response to contacts: a shift of the vertices that a motion must not bring together. First every contact stops the
 * approach of its points; what is left then moves together, in impact zones. */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"

/* Limits how far the two points of a contact may approach along its normal, from the start to the end of a motion. Vertices
 * are named by their seams. */
typedef struct contact_stop {
    uint32_t vertices[4];
    uint32_t seen;        /* the shifts until this one are known to it */
    uint32_t next_pushed; /* the next stop on which an impulse acts */
    double weights[4];    /* as in cscd_stencil */
    double normal[3];
    double motion[3];     /* of the first point relative to the second, without any shift */
    double allowed, goal; /* an approach that is small enough, and the smaller one that a pass aims at */
    double mobility;      /* the relative motion along the normal that an impulse of 1 brings */
    double friction;      /* Coulomb's coefficient */
    double pushed;        /* the impulse along the normal so far, 0 or more */
    double rubbed[3];     /* that across it */
} contact_stop;

/* A set of vertices that move together. Its smallest vertex names it. */
typedef struct impact_zone {
    double momentum[3], mass; /* sums over its vertices */
    double told[3], tellers;  /* sum and number of the motions of obstacles in contact with it */
    double share;             /* what this round leaves of motions that differ from the common one */
} impact_zone;

/* One motion, and the shift of its end. The arrays are the detector's. */
typedef struct contact_response {
    const cscd_mesh *mesh;
    const uint32_t
        *names; /* of seams, whose vertices have one shift, that of their name; NULL: each its own */
    const double *x0;
    const double *wanted;        /* the end before any response */
    double *mobilities;          /* per name: the inverse of its mass; 0: it goes where it wants */
    const double *friction;      /* per object; NULL: 0 */
    double rounding;             /* bounds how far storing the end moves two points relative to each other */
    const swept_interval *rules; /* by which pairs keep a distance */
    double *shift;               /* per name, 3 each */
    uint32_t *shifted;           /* per name: its last shift, numbered by the clock; 1: none yet */
    uint32_t clock;

    contact_stop *stops; /* of all rounds */
    size_t stop_count;
    size_t zone_begin; /* the stops from here on are of zones */

    uint32_t *parents; /* per name: a forest of zones */
    impact_zone *zones;
} contact_response;

static inline uint32_t response_name(const contact_response *r, uint32_t vertex) {
    return r->names != NULL ? r->names[vertex] : vertex;
}

/* Takes over contacts, for which there is room among the stops. */
void response_take(contact_response *r, const cscd_contact *contacts, size_t count);

/* The number of contacts on which an impulse acts. */
size_t response_count_pushed(const contact_response *r);

/* Shifts vertices until no pair approaches by more than it may, or as near to that as some passes come: projected
 * Gauss-Seidel on accumulated impulses, so that momentum is kept, with Coulomb friction. The result does not depend on threads. */
void response_stop(contact_response *r);

/* Begins impact zones: every vertex is one of its own, and stops that are taken from now on join them. */
void response_begin_zones(contact_response *r);

/* Brings the vertices of the contacts, which have been taken, nearer to the common motion of their zone: that of the obstacles
 * in it, or else that of its centre of mass, which keeps momentum (Harmon et al. 2008). */
void response_join(contact_response *r, const cscd_contact *contacts, size_t count);

/* True if the vertex moves with an impact zone. */
bool response_in_zone(const contact_response *r, uint32_t vertex);
