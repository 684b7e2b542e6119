/* The response to self-contacts: pairs that cscd reports are kept on their sides, gently. */
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
    held_pair *pairs; /* after self_contacts_add sorted by (kind, a, b), each once */
    size_t count, capacity;
    double near;     /* pairs nearer than this at rest: the lattice keeps them apart, or nothing can */
    double gap;      /* pairs are pushed apart to this distance */
    double depth;    /* pairs that have got deeper than this are given up */
    double healing;  /* how far pairs are pushed apart in one small step */
    double friction; /* Coulomb's coefficient */
} self_contacts;

/* Without pairs; the limits follow from near. The mesh is closed and manifold, at rest in `rest`. */
self_contacts self_contacts_make(const cscd_mesh *mesh, const double *rest, double near);
void self_contacts_free(self_contacts *s);

/* Takes up what a step of the detector found, as far as the pairs run into each other and not out, and come
 * from parts of the body that were apart at rest. */
void self_contacts_add(self_contacts *s, const cscd_contacts *found, const double *start, const double *end);

/* One pass in order: pushes the pairs in hold apart, follows vertices that slide from triangle to triangle,
 * and lets go of what has parted. */
void self_contacts_solve(self_contacts *s, soft_body *soft);
