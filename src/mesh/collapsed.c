/* Which components have no surface at a moment, because all of their triangles have no area. */
#include "src/mesh/collapsed.h"

#include "src/core/context.h"
#include "src/mesh/predicates.h"

#include <string.h>

/* Of a component: one of its triangles has an area; one has three vertices of different names. */
enum { SEEN_AREA = 1, SEEN_SURFACE = 2 };

static array_list list_arrays(collapsed_components *c) {
    size_t components = c->mesh->component_count;
    return (array_list){{ARRAY(c->witnesses, components), ARRAY(c->seen, components),
                         ARRAY(c->marks, components), ARRAY(c->list, components)}};
}

/* The first witness of each component is its first triangle. */
cscd_status collapsed_create(const cscd_mesh *mesh, collapsed_components *out) {
    collapsed_components c = {.mesh = mesh};
    if (!context_allocate_all(mesh->context, list_arrays(&c))) return CSCD_OUT_OF_MEMORY;
    for (uint32_t t = mesh->triangle_count; t-- > 0;) c.witnesses[mesh->triangle_components[t]] = t;
    *out = c;
    return CSCD_OK;
}

void collapsed_free(collapsed_components *c) {
    if (c->mesh == NULL) return;
    context_free_all(c->mesh->context, list_arrays(c));
    *c = (collapsed_components){.mesh = NULL};
}

void collapsed_begin(collapsed_components *c) {
    if (c->count > 0) memset(c->marks, false, c->mesh->component_count * sizeof *c->marks);
    c->count = 0;
}

static bool has_area(const cscd_mesh *mesh, uint32_t triangle, const double *positions) {
    const double *corners[3];
    for (int i = 0; i < 3; i++) corners[i] = positions + (size_t)mesh->triangles[triangle][i] * 3;
    return !collinear(corners[0], corners[1], corners[2]);
}

static bool has_three_names(const uint32_t corners[3], const uint32_t *names) {
    if (names == NULL) return true;
    uint32_t a = names[corners[0]], b = names[corners[1]], c = names[corners[2]];
    return a != b && b != c && c != a;
}

/* Looks for an area, and for a triangle of three names, in the components whose witness has no area. */
static void look_everywhere(collapsed_components *c, const double *positions, const uint32_t *names) {
    const cscd_mesh *mesh = c->mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t component = mesh->triangle_components[t];
        if ((c->seen[component] & SEEN_AREA) != 0) continue;
        if (has_area(mesh, t, positions)) {
            c->seen[component] |= SEEN_AREA;
            c->witnesses[component] = t;
        } else if (has_three_names(mesh->triangles[t], names)) {
            c->seen[component] |= SEEN_SURFACE;
        }
    }
}

void collapsed_add(collapsed_components *c, const double *positions, const uint32_t *names) {
    uint32_t open = 0;
    for (uint32_t i = 0; i < c->mesh->component_count; i++) {
        c->seen[i] = has_area(c->mesh, c->witnesses[i], positions) ? SEEN_AREA : 0;
        open += c->seen[i] == 0;
    }
    if (open == 0) return;
    look_everywhere(c, positions, names);
    for (uint32_t i = 0; i < c->mesh->component_count; i++) {
        if (c->seen[i] != SEEN_SURFACE || c->marks[i]) continue;
        c->marks[i] = true;
        c->count++;
    }
}

const uint32_t *collapsed_list(collapsed_components *c) {
    uint32_t next = 0;
    for (uint32_t i = 0; next < c->count; i++) {
        c->list[next] = i;
        next += c->marks[i];
    }
    return c->count > 0 ? c->list : NULL;
}
