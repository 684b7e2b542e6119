/* Applies the contacts found so far: taints the triangles that are in contact with their own component. */
#pragma once

#include "runtime/culling/culling.h"
#include "runtime/culling/start_state.h"

/* The state that the contacts of an interval change. */
typedef struct tainting {
    const cscd_mesh *mesh;
    start_states *starts;
    culling *culling;
    const bool *closes; /* per component: tainted triangles lose their orientations */
    uint32_t *touched;  /* per component: how many contacts it has with itself */
    double *earliest;   /* per component: the least toi of a contact with itself that was noted */
    double within;      /* contacts that are later than the earliest by more than this taint nothing */
} tainting;

/* Returns the component that both features of a contact belong to; UINT32_MAX if they do not belong to one. */
uint32_t tainting_component(const cscd_mesh *mesh, const cscd_contact *contact);

/* Notes the time of a contact of a component with itself, if it is the earliest so far. */
void tainting_note(const cscd_mesh *mesh, const cscd_contact *contact, double *earliest);

/* Taints the stars of both features of a contact of a component with itself, also of one that the caller ignores. Returns how
 * many triangles have lost their orientations, so that pairs of them are newly kept. */
uint32_t tainting_look(const tainting *t, const cscd_contact *contact);

/* The same in two parts, for a contact that is not kept: first the triangles that it taints are marked, and its
 * component as touched once more; later each is tainted, which returns 1 if its pairs are newly kept, else 0. */
void tainting_mark(const cscd_mesh *mesh, const cscd_contact *contact, bool *triangles, uint32_t *touched);
uint32_t tainting_triangle(const tainting *t, uint32_t triangle);
