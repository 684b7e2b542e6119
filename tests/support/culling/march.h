/* Slow motions that end in contact: of two bodies that come together, or of one in itself. */
#pragma once

#include "cscd/cscd.h"
#include "tests/support/models/bodies.h"

enum { MARCH_OBJECTS_MAX = 2 };

typedef enum march_kind {
    MARCH_APPROACH, /* two bodies come together as they are */
    MARCH_LAND,     /* the same; the second one is an obstacle */
    MARCH_TURN,     /* the same, and the first one turns */
    MARCH_JAWS,     /* the arms of one body close */
    MARCH_FOLD,     /* one vertex is drawn under an edge, and out through the triangle behind it */
    MARCH_KINDS
} march_kind;

typedef struct march {
    march_kind kind;
    body bodies[MARCH_OBJECTS_MAX];
    cscd_object_desc objects[MARCH_OBJECTS_MAX];
    uint32_t object_count, vertex_count, triangle_count;
    double edge, low[3], high[3]; /* of the first body */
    double gap;                   /* of the two, along x, in edges */
    double closed;                /* so far the jaws have closed at s = 0, in edges */
    uint32_t drawn;               /* the vertex that is */
    double path[3][3];            /* its places at s = 0, 0.5 and 1 */
    double shake;                 /* in edges */
} march;

march march_make(march_kind kind);
void march_free(march *m);

/* Writes positions at s, a way in edges: two bodies are half an edge apart at s = 0, and touch from about 0.5 on. */
void march_place(const march *m, double s, double *out);
