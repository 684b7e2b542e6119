/* What of an answer the proofs compare, and calls that several tables make. */
#pragma once

#include "tests/support/proofs/proof.h"

void read_contacts(proof *p);
void read_near(proof *p);
void read_reached(proof *p);
void read_step(proof *p);

/* cscd_detector_find_intersections with all that may be asked for beside the pairs. */
void read_pairs(proof *p);
cscd_intersection_options ask_everything(void);

/* Steps over the moments, there and back again. */
extern const proof_call step_first, step_second, step_third, step_back;
