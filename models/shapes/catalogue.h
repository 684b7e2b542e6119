/* Bodies by name, with any possible number of triangles. */
#pragma once

#include "models/shapes/body.h"
#include "tool/io/io.h"

/* z is up; lengths are in the unit of the models, about a metre:
 *   pawn       3 high, 2 wide, stands on z = 0: foot, waist, collar, head
 *   dumbbell   4.1 long along z: two balls on a rod
 *   figure     1.9 high, stands on z = 0, faces -y: a person, arms half raised, legs apart
 *   sphere     radius 1
 *   ellipsoid  half axes 1.5, 1, 0.7
 *   cube       edge 2
 *   torus      radii 1 and 0.35, about z
 *   genus2     two rings side by side that grew together
 *   capsule    radius 0.5, 3 long along z
 *   coil       a spring of five turns along z, round ends
 *   slab       a flat box folded twice, like a letter
 *   chain      five linked tori along x, five components
 *   letter-t, letter-u, letter-v, letter-w
 *              2 high, 2, 1.8, 2.2 and 3.2 wide, 0.5 deep, upright on z = 0, to be read from -y
 * Each component is closed, manifold, consistently oriented and embedded; positions are exact in single
 * precision; triangles are about equal. Everything is repeatable. */
typedef enum body_kind {
    BODY_PAWN,
    BODY_DUMBBELL,
    BODY_FIGURE,
    BODY_SPHERE,
    BODY_ELLIPSOID,
    BODY_CUBE,
    BODY_TORUS,
    BODY_GENUS2,
    BODY_CAPSULE,
    BODY_COIL,
    BODY_SLAB,
    BODY_CHAIN,
    BODY_HAND,
    BODY_OCTOPUS,
    BODY_LETTER_T,
    BODY_LETTER_U,
    BODY_LETTER_V,
    BODY_LETTER_W,
    BODY_KIND_COUNT
} body_kind;

enum { BODY_TRIANGLES_MAX = 4000000 };

const char *body_kind_name(body_kind kind);

/* Returns one line that describes the body. */
const char *body_kind_description(body_kind kind);

/* Leaves *out untouched when it returns false. */
bool body_kind_from_name(const char *name, body_kind *out);

uint32_t body_default_count(body_kind kind);
uint32_t body_least_count(body_kind kind);

/* Returns the possible number of triangles that is nearest to this one. */
uint32_t body_nearest_count(body_kind kind, uint32_t triangle_count);

/* Makes a body of exactly triangle_count triangles, or of its default number when that is 0. When it
 * returns false, *out is unchanged and *error says which numbers are possible. */
bool body_make(body_kind kind, uint32_t triangle_count, body *out, io_error *error);
