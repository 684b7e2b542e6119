/* Parts without a surface, frame by frame. */
#include "tool/answers/collapsed_parts.h"

#include "tool/io/growable.h"

#include <stdlib.h>
#include <string.h>

collapsed_parts collapsed_parts_of(const recording *r, const part_names *names) {
    return (collapsed_parts){.recording = r, .names = names};
}

void collapsed_parts_free(collapsed_parts *c) {
    for (uint32_t i = 0; c->parts != NULL && i < c->names->count; i++) {
        frame_list_free(&c->parts[i].whole);
        frame_list_free(&c->parts[i].partly);
    }
    free(c->parts);
    free(c->sizes);
    free(c->without);
    free(c->components);
    *c = (collapsed_parts){.recording = NULL};
}

/* Most recordings have none, and need nothing of this. */
static bool make_room(collapsed_parts *c) {
    const cscd_mesh *mesh = c->recording->mesh;
    const size_t parts = c->names->count;
    if (c->parts != NULL) return true;
    if (c->sizes == NULL) c->sizes = io_zeroed(parts * sizeof *c->sizes);
    if (c->without == NULL) c->without = io_zeroed(parts * sizeof *c->without);
    if (c->components == NULL)
        c->components = io_zeroed(cscd_mesh_component_count(mesh) * sizeof *c->components);
    if (c->sizes == NULL || c->without == NULL || c->components == NULL) return false;
    c->parts = io_zeroed(parts * sizeof *c->parts);
    for (uint32_t t = 0; c->parts != NULL && t < cscd_mesh_triangle_count(mesh); t++) {
        if (c->names->labels[t] != NO_PART) c->sizes[c->names->labels[t]]++;
    }
    return c->parts != NULL;
}

static void count_without(collapsed_parts *c, const cscd_intersection_pairs *found) {
    const cscd_mesh *mesh = c->recording->mesh;
    memset(c->without, 0, c->names->count * sizeof *c->without);
    memset(c->components, 0, cscd_mesh_component_count(mesh) * sizeof *c->components);
    for (uint32_t i = 0; i < found->collapsed; i++) c->components[found->collapsed_components[i]] = true;
    for (uint32_t t = 0; t < cscd_mesh_triangle_count(mesh); t++) {
        const uint32_t part = c->names->labels[t];
        if (part != NO_PART) c->without[part] += c->components[cscd_mesh_triangle_component(mesh, t)];
    }
}

bool collapsed_parts_add(collapsed_parts *c, uint32_t frame, const cscd_intersection_pairs *found) {
    if (found->collapsed == 0) return true;
    if (!make_room(c)) return false;
    count_without(c, found);
    for (uint32_t i = 0; i < c->names->count; i++) {
        if (c->without[i] == 0) continue;
        collapsed_part *part = &c->parts[i];
        if (!frame_list_add(c->without[i] == c->sizes[i] ? &part->whole : &part->partly, frame)) return false;
    }
    return true;
}

const collapsed_part *collapsed_parts_at(const collapsed_parts *c, uint32_t part) {
    if (c->parts == NULL) return NULL;
    const collapsed_part *at = &c->parts[part];
    return at->whole.count + at->partly.count > 0 ? at : NULL;
}
