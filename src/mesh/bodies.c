/* Bodies: the groups of components that winding numbers count as one. */
#include "src/mesh/bodies.h"

#include "src/core/sort.h"

#include <string.h>

static array_list list_arrays(const cscd_mesh *mesh, surface_bodies *b) {
    return (array_list){{ARRAY(b->components, mesh->component_count),
                         ARRAY(b->objects, (size_t)mesh->component_count + mesh->object_count)}};
}

void bodies_free(cscd_context *context, surface_bodies *b) {
    context_free(context, b->components);
    context_free(context, b->objects);
    *b = (surface_bodies){.components = NULL};
}

bool bodies_copy(const surface_bodies *from, const cscd_mesh *mesh, surface_bodies *out) {
    surface_bodies copy = *from;
    if (!context_copy_all(mesh->context, list_arrays(mesh, &copy))) return false;
    *out = copy;
    return true;
}

/* The first component of a part in the object that was looked at last. */
typedef struct part_owner {
    uint32_t object, component;
} part_owner;

/* Unites the components that parts join. */
static void join_components(const cscd_mesh *mesh, const uint32_t *labels, uint32_t part_count,
                            part_owner *owners, uint32_t *parents) {
    sets_begin(parents, mesh->component_count);
    for (uint32_t p = 0; p < part_count; p++) owners[p] = (part_owner){UINT32_MAX, 0};
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (labels[t] >= part_count) continue; /* in no part */
        part_owner *owner = &owners[labels[t]];
        uint32_t object = cscd_mesh_vertex_object(mesh, mesh->triangles[t][0]);
        uint32_t component = mesh->triangle_components[t];
        if (owner->object == object)
            set_unite(parents, owner->component, component);
        else
            *owner = (part_owner){object, component};
    }
}

/* An object without triangles is one body, too. */
static void pass_empty_objects(const cscd_mesh *mesh, uint32_t *next, uint32_t end, surface_bodies *b) {
    for (; *next < end; ++*next) {
        if (mesh->objects[*next].triangle_count == 0) b->objects[b->count++] = *next;
    }
}

/* Each root gets the next number. It comes before all others of its set, and components come in the order of their first
 * triangles, and so of their objects. */
static void number_bodies(const cscd_mesh *mesh, surface_bodies *b) {
    uint32_t component = 0, next_object = 0;
    b->count = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (mesh->triangle_components[t] < component) continue;
        uint32_t object = cscd_mesh_vertex_object(mesh, mesh->triangles[t][0]),
                 root = b->components[component];
        pass_empty_objects(mesh, &next_object, object, b);
        b->components[component] = root == component ? b->count : b->components[root];
        if (root == component) b->objects[b->count++] = object;
        component++;
    }
    pass_empty_objects(mesh, &next_object, mesh->object_count, b);
}

bool bodies_find(const cscd_mesh *mesh, const uint32_t *labels, uint32_t part_count, surface_bodies *out) {
    surface_bodies b = {.components = NULL};
    if (!context_reserve_all(mesh->context, list_arrays(mesh, &b))) return false;
    part_owner *owners = context_allocate(mesh->context, part_count, sizeof *owners);
    if (owners == NULL) {
        bodies_free(mesh->context, &b);
        return false;
    }
    join_components(mesh, labels, part_count, owners, b.components);
    for (uint32_t i = 0; i < mesh->component_count; i++) b.components[i] = set_root(b.components, i);
    number_bodies(mesh, &b);
    context_free(mesh->context, owners);
    *out = b;
    return true;
}
