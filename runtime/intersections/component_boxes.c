/* Boxes around components, from their triangles. */
#include "runtime/intersections/component_boxes.h"

#include "src/core/floating.h"
#include "src/mesh/surface.h"

static component_box empty_component_box(void) {
    const double most = (double)INFINITY;
    return (component_box){{most, most, most}, {-most, -most, -most}};
}

void component_boxes_find(const cscd_mesh *mesh, const double *positions, component_box *boxes) {
    for (uint32_t c = 0; c < mesh->component_count; c++) boxes[c] = empty_component_box();
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        component_box *box = &boxes[mesh->triangle_components[t]];
        for (uint32_t i = 0; i < 3; i++) {
            const double *x = surface_corner(mesh, positions, t, i);
            for (int k = 0; k < 3; k++) {
                box->low[k] = min_of(box->low[k], x[k]);
                box->high[k] = max_of(box->high[k], x[k]);
            }
        }
    }
}
