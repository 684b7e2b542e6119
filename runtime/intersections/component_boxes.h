/* The box around each component at one moment. */
#pragma once

#include "src/mesh/mesh.h"

typedef struct component_box {
    double low[3], high[3];
} component_box;

/* boxes: one for each component of the mesh; positions: packed. */
void component_boxes_find(const cscd_mesh *mesh, const double *positions, component_box *boxes);

static inline bool component_box_has_point(const component_box *box, const double x[3]) {
    for (int k = 0; k < 3; k++) {
        if (x[k] < box->low[k] || x[k] > box->high[k]) return false;
    }
    return true;
}

static inline bool component_box_has_box(const component_box *box, const component_box *inner) {
    return component_box_has_point(box, inner->low) && component_box_has_point(box, inner->high);
}
