/* The contacts of method none on a recording, and how the lists of other methods differ from them. */
#pragma once

#include "benchmarks/lib/scene_files.h"

/* The contacts of method none in each interval, and which intervals begin with every component proven
 * embedded. */
typedef struct truth {
    const recording_data *recording;
    uint32_t *vertex_components;
    cscd_contact *contacts; /* interval i: contacts[offsets[i] .. offsets[i + 1]) */
    size_t *offsets;
    bool *proven;
    uint32_t proven_count;
} truth;

bool truth_find(const recording_data *r, truth *out, io_error *error);
void truth_free(truth *t);

typedef struct contact_losses {
    double lost;          /* contacts of method none that are not reported */
    double earliest_lost; /* intervals and components whose first contact is not reported in time */
    double invented;      /* contacts that method none does not report; of published methods alone */
} contact_losses;

/* Adds what the list of an interval lacks. False: it breaks the guarantee of its method. Published methods may lose and invent
 * anything; no other may add or alter a contact. */
bool truth_compare(const truth *t, uint32_t interval, const cscd_detector *detector, cscd_method method,
                   cscd_mode mode, const cscd_contacts *found, contact_losses *s);
