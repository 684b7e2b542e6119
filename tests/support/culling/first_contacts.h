/* When each component of a scene first touches itself. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/scenes.h"

/* A scene has at most this many components. */
enum { COMPONENTS_MAX = SCENE_TRIANGLES_MAX };

/* A time of impact may be early by less than this. */
#define TOI_EARLY 1e-9

/* Returns the component whose contact with itself this is, or UINT32_MAX for a contact between two
 * components. */
uint32_t self_component(const cscd_mesh *mesh, const scene *s, const cscd_contact *c);

/* Fills in the time of each component's first contact with itself in a list; INFINITY means none. */
void find_first_times(const cscd_mesh *mesh, const scene *s, const cscd_contacts *list,
                      double times[COMPONENTS_MAX]);
