/* What the contacts found so far say about triangles: those in contact with their own component are tainted. */
#pragma once

#include "runtime/culling/culling.h"
#include "runtime/culling/start_state.h"

/* What contacts taint in an interval. */
typedef struct tainting {
    const cscd_mesh *mesh;
    start_states *starts;
    culling *culling;
    const bool *wants_all_contacts; /* per component: tainted triangles lose their orientations */
    bool *touched;                  /* per component: has it a contact with itself? */
} tainting;

/* Taints the stars of both features of all contacts of a component with itself, those that the caller ignores among
 * them. Returns how many triangles have lost their orientations, so that pairs of them are newly kept. */
uint32_t tainting_look(const tainting *t, const cscd_contact *contacts, size_t count);
