/* The piece of an intersection curve that lies in two triangles, under a symbolic perturbation of the vertices. */
#pragma once

#include "runtime/intersections/component_boxes.h"
#include "src/mesh/bodies.h"
#include "src/mesh/symbolic.h"

/* Where the surface is at one moment, which vertices count as one, and which components are taken as turned around. */
typedef struct named_surface {
    const cscd_mesh *mesh;
    const double *positions; /* packed */
    const uint32_t
        *names; /* per vertex: the smallest one that it is one with, at the same place; NULL: itself */
    const bool *
        turned; /* per component: its normals are inwards, so that the side they point away from is outside; NULL:
                         * of none */
    const surface_bodies *bodies; /* NULL: the objects are the bodies */
    const bool *
        collapsed; /* per component: it has no surface, so it contains nothing and is in nothing; NULL: none is */
    const component_box *boxes; /* per component; NULL: not known */
} named_surface;

/* 1 where the normal of a triangle points outwards, -1 where its component is turned around. */
static inline int surface_sense(const named_surface *s, uint32_t triangle) {
    return s->turned != NULL && s->turned[s->mesh->triangle_components[triangle]] ? -1 : 1;
}

static inline uint32_t surface_body(const named_surface *s, uint32_t triangle) {
    return body_of_triangle(s->bodies, s->mesh, triangle);
}

static inline uint32_t surface_name(const named_surface *s, uint32_t vertex) {
    return s->names != NULL ? s->names[vertex] : vertex;
}

static inline symbolic_point surface_point(const named_surface *s, uint32_t vertex) {
    return (symbolic_point){s->positions + (size_t)vertex * 3, surface_name(s, vertex)};
}

enum { NO_EDGE = UINT32_MAX };

/* An edge passes through a triangle that has none of its vertices. Or, with NO_EDGE, the surface passes through itself
 * at a vertex, whose number then stands in place of the triangle. */
typedef struct surface_event {
    uint32_t edge, triangle;
} surface_event;

/* It leads from ends[0] to ends[1], in the direction of the normal of a times (cross product) the normal of b: unless
 * components are turned around, the inside of b is to the left of it on a, seen from outside, and the inside of a to the
 * right of it on b. At most one end is at a vertex, which then is that of a. */
typedef struct curve_piece {
    uint32_t a, b;
    surface_event ends[2];
} curve_piece;

/* Finds the piece of two different triangles, if there is one: docs/theory/curves.md. */
bool curve_piece_of_pair(const named_surface *s, uint32_t a, uint32_t b, curve_piece *out);

/* Does it happen, and is it an end of pieces? Events at vertices are not asked for. */
bool surface_event_happens(const named_surface *s, surface_event event);
