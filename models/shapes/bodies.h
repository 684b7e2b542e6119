/* The bodies of the catalogue, a function each. */
#pragma once

#include "models/shapes/body.h"

/* ---- an outline revolved, bent, or linked -------------------------------------------------------------- */

/* Each adds exactly triangle_count triangles, an even number. */
void add_pawn(body *b, uint32_t triangle_count);
void add_dumbbell(body *b, uint32_t triangle_count);
void add_sphere(body *b, uint32_t triangle_count);
void add_capsule(body *b, uint32_t triangle_count);
void add_torus(body *b, uint32_t triangle_count);
void add_coil(body *b, uint32_t triangle_count);

/* The count must be 2 CHAIN_LINKS or more, as an even number for each. */
enum { CHAIN_LINKS = 5 };
void add_chain(body *b, uint32_t triangle_count);

/* ---- equal squares, flat and folded -------------------------------------------------------------------- */

/* Adds a cube with n squares along each edge: 12 n^2 triangles. */
void add_cube(body *b, uint32_t n);

/* Adds a slab with n squares along its length, 28 or more; the other edges are divided as finely. It has
 * slab_triangles(n) triangles. */
void add_slab(body *b, uint32_t n);
uint32_t slab_triangles(uint32_t n);

/* ---- zero sets of functions ---------------------------------------------------------------------------- */

/* Each function adds exactly triangle_count triangles, or returns false and adds nothing when that is
 * impossible. */
bool add_figure(body *b, uint32_t triangle_count);
bool add_genus2(body *b, uint32_t triangle_count);
bool add_ellipsoid(body *b, uint32_t triangle_count);
bool add_hand(body *b, uint32_t triangle_count);
bool add_octopus(body *b, uint32_t triangle_count);
bool add_letter_t(body *b, uint32_t triangle_count);
bool add_letter_u(body *b, uint32_t triangle_count);
bool add_letter_v(body *b, uint32_t triangle_count);
bool add_letter_w(body *b, uint32_t triangle_count);
