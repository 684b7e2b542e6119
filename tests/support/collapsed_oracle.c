/* Which vertices belong to a component that is collapsed at a moment: labels spread over triangles until nothing changes. */
#include "tests/support/collapsed_oracle.h"

#include "src/mesh/predicates.h"

#include <string.h>

/* Gives all corners of each triangle the least label of one. */
static void label_components(const scene *s, uint32_t *labels) {
    for (uint32_t v = 0; v < s->vertex_count; v++) labels[v] = v;
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t t = 0; t < s->triangle_count; t++) {
            const uint32_t *c = s->triangles + (size_t)t * 3;
            uint32_t least = labels[c[0]];
            for (int i = 1; i < 3; i++) least = labels[c[i]] < least ? labels[c[i]] : least;
            for (int i = 0; i < 3; i++) {
                changed |= labels[c[i]] != least;
                labels[c[i]] = least;
            }
        }
    }
}

void collapsed_oracle(const scene *s, const double *positions, const uint32_t *names, bool *vertices) {
    static uint32_t labels[SCENE_VERTICES_MAX];
    static bool has_area[SCENE_VERTICES_MAX], has_surface[SCENE_VERTICES_MAX];
    memset(has_area, false, sizeof has_area);
    memset(has_surface, false, sizeof has_surface);
    label_components(s, labels);
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        const uint32_t *c = s->triangles + (size_t)t * 3;
        uint32_t label = labels[c[0]];
        has_area[label] |= !collinear(positions + (size_t)c[0] * 3, positions + (size_t)c[1] * 3,
                                      positions + (size_t)c[2] * 3);
        has_surface[label] |= names == NULL || (names[c[0]] != names[c[1]] && names[c[1]] != names[c[2]] &&
                                                names[c[2]] != names[c[0]]);
    }
    for (uint32_t v = 0; v < s->vertex_count; v++)
        vertices[v] = has_surface[labels[v]] && !has_area[labels[v]];
}

void collapsed_oracle_at_ends(const scene *s, const uint32_t *names, bool *vertices) {
    static bool at_end[SCENE_VERTICES_MAX];
    collapsed_oracle(s, s->x0, names, vertices);
    collapsed_oracle(s, s->x1, names, at_end);
    for (uint32_t v = 0; v < s->vertex_count; v++) vertices[v] |= at_end[v];
}
