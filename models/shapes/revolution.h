/* Bodies that are an outline revolved, bent, or linked. */
#pragma once

#include "models/shapes/body.h"

/* Each adds exactly triangle_count triangles, an even number; sizes and places: catalogue.h. */
void add_pawn(body *b, uint32_t triangle_count);
void add_dumbbell(body *b, uint32_t triangle_count);
void add_sphere(body *b, uint32_t triangle_count);
void add_capsule(body *b, uint32_t triangle_count);
void add_torus(body *b, uint32_t triangle_count);
void add_coil(body *b, uint32_t triangle_count);

/* The count must be 2 CHAIN_LINKS or more, as an even number for each. */
enum { CHAIN_LINKS = 5 };
void add_chain(body *b, uint32_t triangle_count);
