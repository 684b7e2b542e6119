/* A response to contacts: a shift of the vertices that a motion must not bring together. First every contact stops the
 * approach of its points. The features of a pair that then comes into contact elsewhere stay on their sides of a plane. */
#pragma once

#include "runtime/narrow_phase/narrow_phase.h"

/* Limits how far two points may approach along a normal, from the start to the end of a motion: the points of a contact, or one
 * vertex on each side of a plane. Vertices are named by their seams. */
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
} contact_response;

static inline uint32_t response_name(const contact_response *r, uint32_t vertex) {
    return r->names != NULL ? r->names[vertex] : vertex;
}

/* Returns the distance beyond which the pair of a contact is surely out of contact. */
static inline double response_separation(const swept_interval *rules, const cscd_contact *c) {
    const separation s = pair_separation(rules, c->kind, c->a, c->b);
    return s.distance + 2.0 * s.tolerance;
}

/* Takes over contacts, for each of which there is room among the stops: their points stop. */
void response_take(contact_response *r, const cscd_contact *contacts, size_t count);

/* The most stops that one contact needs. */
enum { STOPS_PER_CONTACT = 4 };

/* Takes over contacts, for each of which there is that much room: vertices of their features stop before the plane between these at
 * x0. No contact of the pair is possible on a motion that all of its stops allow. */
void response_take_sides(contact_response *r, const cscd_contact *contacts, size_t count);

/* The number of stops on which an impulse acts. */
size_t response_count_pushed(const contact_response *r);

/* Shifts vertices until no pair approaches by more than it may, or as near to that as so many passes come: projected
 * Gauss-Seidel on accumulated impulses, so that momentum is kept, with Coulomb friction. The result does not depend on threads. */
void response_stop(contact_response *r, int passes);
