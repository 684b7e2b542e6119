/* Vertices that very many triangles share. The volumes of these triangles all overlap there, so what tells them apart is in
 * which directions they lie as seen from the vertex; or, where they share two such vertices, as the pages of a book, as seen from the
 * edge between these. */
#pragma once

#include "runtime/bvh/bvh.h"

enum { NO_HUB = UINT32_MAX };

/* Where the triangles below a child lie, as seen from a vertex that all of them share. */
typedef struct hub_volume {
    uint32_t hub;   /* the vertex; NO_HUB: they share none, or nothing is known of their directions */
    uint32_t other; /* NO_HUB, or another one, of a greater number */
    double low[3],
        high[3]; /* a box around all unit vectors towards them during the interval; with two hubs around their unit
                             * normals, the vectors from hub to other and from hub to the third corner being a right-handed pair */
    float reach;           /* the sides opposite the hub come no nearer to it; not scaled, as what follows */
    double place[2][3];    /* of the hub, at both ends */
    double sides[2][2][3]; /* at both ends, the least and the greatest coordinates of the sides opposite it */
} hub_volume;

/* Are features of the triangles of a farther than the distance from those of b, throughout the interval? Features with a
 * common vertex aside. */
bool hub_volumes_apart(const hub_volume *a, const hub_volume *b, double distance);

/* Makes room for hub volumes, as a step of bvh_build; where the mesh has no hub, none is needed. False: no memory. */
bool bvh_allocate_hubs(bvh *hierarchy);

/* Frees them, as a step of bvh_free. */
void bvh_free_hubs(bvh *hierarchy);

/* Finds the volumes for the interval from x0 to x1, as a step of bvh_refit. */
void bvh_refit_hubs(bvh *hierarchy, const double *x0, const double *x1);
