/* Closed bodies with necks and limbs: pawn-like, dumbbell-like, human-like. */
#ifndef CSCD_TEST_BODY_SHAPES_H
#define CSCD_TEST_BODY_SHAPES_H

#include <stdint.h>

/* Grows from {0}; body_free takes it back. One closed manifold, oriented, embedded surface, z up. */
typedef struct body {
    uint32_t vertex_count, triangle_count;
    uint32_t vertex_capacity, triangle_capacity;
    double *positions;   /* vertex_count * 3 */
    uint32_t *triangles; /* triangle_count * 3, counter-clockwise from outside */
} body;

typedef enum body_kind { BODY_PAWN, BODY_DUMBBELL, BODY_HUMAN, BODY_BALL, BODY_KIND_COUNT } body_kind;

const char *body_kind_name(body_kind kind);

/* Edges are about edge_length long, triangles far from slivers. The pawn is 3.1 high and 2 wide, the
 * dumbbell 4.6 long, the human 1.8 high, the ball 2 wide. */
body body_make(body_kind kind, double edge_length);

/* About triangle_count triangles, 1500 or more, to a tenth. */
body body_make_sized(body_kind kind, uint32_t triangle_count);

void body_free(body *b);

/* Building blocks. */
uint32_t body_add_vertex(body *b, double x, double y, double z);
void body_add_triangle(body *b, uint32_t v0, uint32_t v1, uint32_t v2);

/* Adds the zero set of distance, which is negative inside and lies well within the box, by surface nets on a
 * grid of that spacing or a slightly smaller one, evened out. */
void body_add_implicit(body *b, double (*distance)(const double point[3]), const double low[3],
                       const double high[3], double spacing);

#endif
