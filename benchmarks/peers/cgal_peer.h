/* CGAL's check of one moment: which pairs of triangles of a Surface_mesh meet beyond what they share. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct cgal_pairs {
    double setup_ms, find_ms; /* setup: making the Surface_mesh */
    size_t count;
    uint32_t (*items)[2]; /* sorted, the smaller number first; from malloc, to be freed */
    uint32_t left_out;    /* triangles for which a Surface_mesh has no place; then nothing is looked for */
} cgal_pairs;

/* Returns NULL, or what CGAL says of its failure, which lives until the next call. */
const char *cgal_peer_check(const double *positions, uint32_t vertex_count, const uint32_t *triangles,
                            uint32_t triangle_count, cgal_pairs *out);

/* "5.5.1" */
extern const char cgal_peer_version[];

#ifdef __cplusplus
}
#endif
