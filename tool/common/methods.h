/* What the commands need to know of each method, from what the library says about it. */
#pragma once

#include "tool/io/io_error.h"

#include <cscd/cscd.h>

typedef struct method_facts {
    bool by_regions;  /* culls by the orientation of triangles, for which it needs regions */
    bool by_contours; /* culls by the contours of patches */
    bool
        makes_plan; /* `cscd preprocess` makes plans by it, and a step by it takes no other plan unless it insists */
    bool by_charge;       /* these plans have the charge of each triangle */
    bool insists_on_plan; /* takes a plan of any method, but does not go without one */
    bool loses_contacts;  /* culls as published */
} method_facts;

/* All false: the library has no such method. */
method_facts method_facts_of(cscd_method method);

/* Read a list of steps of the published method that are done as charge does them, such as "charge,ranks", into a uint64_t: a sum
 * of the CSCD_OURS_ constants of plans, or of all. */
bool read_ours_of_plans(const char *text, void *place);
bool read_ours(const char *text, void *place);

/* Those of plans alone. */
uint64_t ours_of_plans(uint64_t ours);

/* Do these steps count with this method, and with each other? The error names the word that does not. */
bool ours_agrees(cscd_method method, uint64_t ours, io_error *error);
