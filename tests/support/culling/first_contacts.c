/* When each component of a scene first touches itself. */
#include "tests/support/culling/first_contacts.h"

#include <math.h>

/* A feature belongs to the component of any triangle that holds it. */
static uint32_t component_of(const cscd_mesh *mesh, const scene *s, cscd_contact_kind kind, uint32_t feature,
                             bool second) {
    uint32_t vertices[2] = {feature, 0};
    if (kind == CSCD_CONTACT_VF && second) return cscd_mesh_triangle_component(mesh, feature);
    if (kind == CSCD_CONTACT_EE) cscd_mesh_edge(mesh, feature, vertices);
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        for (int i = 0; i < 3; i++) {
            if (s->triangles[t * 3 + (uint32_t)i] == vertices[0])
                return cscd_mesh_triangle_component(mesh, t);
        }
    }
    return UINT32_MAX;
}

uint32_t self_component(const cscd_mesh *mesh, const scene *s, const cscd_contact *c) {
    uint32_t a = component_of(mesh, s, c->kind, c->a, false), b = component_of(mesh, s, c->kind, c->b, true);
    return a == b ? a : UINT32_MAX;
}

void find_first_times(const cscd_mesh *mesh, const scene *s, const cscd_contacts *list,
                      double times[COMPONENTS_MAX]) {
    for (uint32_t c = 0; c < cscd_mesh_component_count(mesh); c++) times[c] = INFINITY;
    for (size_t i = 0; i < list->count; i++) {
        uint32_t c = self_component(mesh, s, &list->items[i]);
        if (c != UINT32_MAX) times[c] = fmin(times[c], list->items[i].toi);
    }
}
