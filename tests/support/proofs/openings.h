/* How rows of proofs find what their calls need, what of an answer they compare, and calls that several tables make. */
#pragma once

#include "tests/support/proofs/proof.h"

/* The scene of the row's family and seed, or a large one in its place, and its moments: free of contact and of intersections at
 * the first one, on the way to what touches. TWO_SPHERES are two objects, all others one. */
void open_shape(proof *p);
void describe_objects(const proof *p, cscd_object_desc out[2], uint32_t *count);

/* Makes the moments of a scene by way of its x0, its x1 and beyond. */
void make_moments(proof *p);

/* With a mesh, and with a detector of the row's method. */
void open_mesh(proof *p);
void open_detector(proof *p);

/* With these options. */
void open_detector_with(proof *p, cscd_detector_options options);

/* With a function `ignore`, which leaves nothing out. */
void open_ignoring(proof *p);

/* The positions of a moment. */
const cscd_view *at_moment(const proof *p, int moment, cscd_view *view);

/* ---- answers ------------------------------------------------------------------------------------------- */

void read_contacts(proof *p);
void read_near(proof *p);
void read_reached(proof *p);
void read_step(proof *p);

/* cscd_detector_find_intersections with all that may be asked for beside the pairs. */
void read_pairs(proof *p);
cscd_intersection_options ask_everything(void);

/* Steps over the moments, there and back again. */
extern const proof_call step_first, step_second, step_third, step_back;
