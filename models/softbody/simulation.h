/* A soft body that falls, bends and runs into obstacles and into itself: extended position-based dynamics (XPBD) in
 * small steps (Macklin et al., "Small steps in physics simulation", 2019). Everything runs in a fixed order, so the
 * same input gives the same motion, bit for bit. */
#pragma once

#include "models/softbody/obstacles.h"
#include "models/softbody/self_contact.h"
#include "models/softbody/soft_body.h"

/* Advances by `seconds` in `step_count` small steps; the vertices of the surface follow. contacts: those found
 * before, or NULL. */
void simulation_advance(soft_body *b, obstacles *o, self_contacts *contacts, double seconds,
                        uint32_t step_count);
