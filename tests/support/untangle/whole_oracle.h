/* Do triangles with doubles as coordinates intersect? Decided by definitions in whole numbers of any length, without code of the
 * library: all coordinates are multiples of one power of two. */
#pragma once

#include <gmp.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct whole_vector {
    mpz_t at[3];
} whole_vector;

/* A mesh at one moment. */
typedef struct whole_oracle {
    uint32_t vertex_count, triangle_count, vertex_room, triangle_room;
    const uint32_t (*triangles)[3];
    const uint32_t *names; /* per vertex: vertices with one name are one */
    const double *x;
    whole_vector *points, *normals; /* normals per triangle: null where it has no area */
} whole_oracle;

void whole_oracle_begin(whole_oracle *o);
void whole_oracle_end(whole_oracle *o);

/* Arrays are read as long as pairs are asked for; coordinates are finite. */
void whole_oracle_take(whole_oracle *o, uint32_t vertex_count, uint32_t triangle_count,
                       const uint32_t (*triangles)[3], const uint32_t *names, const double *x);

bool whole_oracle_has_area(const whole_oracle *o, uint32_t triangle);

/* Has a vertex or an edge of one triangle a point in common with the face of the other, or an edge with an edge, without a common name;
 * or have both the same three vertices, each at one place? */
bool whole_oracle_counts(const whole_oracle *o, uint32_t a, uint32_t b);
