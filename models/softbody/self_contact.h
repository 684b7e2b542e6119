/* The response to contacts of a body with itself: each pair that cscd reports is kept on its side, gently. */
#pragma once

#include "cscd/cscd.h"
#include "models/softbody/soft_body.h"

/* A pair in contact, a on the outside of b. VF: vertex and triangle; EE: two edges. */
typedef struct held_pair {
    cscd_contact_kind kind;
    uint32_t a, b;
} held_pair;

typedef struct self_contacts {
    const cscd_mesh *mesh;
    double *rest;     /* the vertices at rest */
    held_pair *pairs; /* sorted by (kind, a, b) after self_contacts_add, without repetitions */
    size_t count, capacity;
    double near;     /* pairs that are nearer at rest are left to the lattice */
    double gap;      /* pairs are pushed apart to this distance */
    double depth;    /* deeper pairs are given up */
    double healing;  /* how far pairs are pushed apart in one small step */
    double friction; /* Coulomb's coefficient */
} self_contacts;

/* Makes a response without pairs; its limits follow from near. The mesh is closed and manifold; `rest` has
 * its vertices at rest. */
self_contacts self_contacts_make(const cscd_mesh *mesh, const double *rest, double near);
void self_contacts_free(self_contacts *s);

/* Adds the contacts of a detector step whose sides run into each other, not apart, and come from parts of
 * the body that were apart at rest. */
void self_contacts_add(self_contacts *s, const cscd_contacts *found, const double *start, const double *end);

/* Solves all pairs once, in order: pushes them apart, follows vertices that slide from triangle to
 * triangle, and drops pairs that have parted. */
void self_contacts_solve(self_contacts *s, soft_body *soft);
