/* Facts about each method that are known without running it. */
#pragma once

#include "cscd/research.h"

typedef struct method_traits {
    cscd_method method;
    const char *name;
    bool makes_plan;     /* preprocessing makes plans by this method */
    bool by_charge;      /* ... from the charge of triangles, which they keep */
    bool needs_plan;     /* a detector needs a plan that was made by this method */
    bool loses_contacts; /* it follows published rules that lose contacts, so it certifies nothing */
    bool by_orientation; /* culls by the orientation of triangles, if it has regions */
    bool by_contours;    /* culls by the contours of patches */
} method_traits;

/* NULL: there is no such method. */
const method_traits *method_traits_of(cscd_method method);
const method_traits *method_traits_named(const char *name);
