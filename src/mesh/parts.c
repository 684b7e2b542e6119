/* Parts of a scene: the labels of triangles, the bodies that parts make of components, and the parts of contacts. */
#include "src/mesh/parts.h"

#include "src/core/sort.h"
#include "src/mesh/plan.h"

#include <string.h>

/* ---- bodies ------------------------------------------------------------------------------------------------ */

static array_list body_arrays(const cscd_mesh *mesh, surface_bodies *b) {
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
    if (!context_copy_all(mesh->context, body_arrays(mesh, &copy))) return false;
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
    if (!context_reserve_all(mesh->context, body_arrays(mesh, &b))) return false;
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

/* ---- the labels of a detector ---------------------------------------------------------------------------- */

static array_list label_arrays(const cscd_mesh *mesh, part_labels *p) {
    return (array_list){
        {ARRAY(p->triangles, mesh->triangle_count), ARRAY(p->sizes, (size_t)p->part_count + 1)}};
}

static uint32_t *size_of(const part_labels *p, uint32_t label) {
    return &p->sizes[label < p->part_count ? label : p->part_count];
}

static void count_sizes(const cscd_mesh *mesh, part_labels *p) {
    memset(p->sizes, 0, ((size_t)p->part_count + 1) * sizeof *p->sizes);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) ++*size_of(p, p->triangles[t]);
}

/* Finds what follows from the labels. False: no memory, and nothing is left. */
static bool finish_labels(const cscd_mesh *mesh, part_labels *p) {
    count_sizes(mesh, p);
    if (bodies_find(mesh, p->triangles, p->part_count, &p->bodies)) return true;
    part_labels_free(mesh->context, p);
    return false;
}

cscd_status part_labels_check(const cscd_mesh *mesh, const uint32_t *labels, uint32_t part_count,
                              const char *name) {
    if ((labels == NULL) != (part_count == 0))
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT,
                            "%s: %s: give labels and the number of parts, or NULL and 0", name,
                            labels == NULL ? "labels is NULL" : "part_count is 0");
    for (uint32_t t = 0; labels != NULL && t < mesh->triangle_count; t++) {
        if (labels[t] < part_count || labels[t] == UINT32_MAX) continue;
        return context_fail(mesh->context, CSCD_INVALID_ARGUMENT,
                            "triangle %u has the label %u, but there are %u parts: a label is below that, or "
                            "UINT32_MAX for none",
                            t, labels[t], part_count);
    }
    return CSCD_OK;
}

cscd_status part_labels_set(const cscd_mesh *mesh, const uint32_t *labels, uint32_t part_count,
                            part_labels *p) {
    part_labels fresh = {.triangles = NULL};
    if (labels != NULL) {
        fresh.part_count = part_count;
        if (!context_reserve_all(mesh->context, label_arrays(mesh, &fresh))) return CSCD_OUT_OF_MEMORY;
        memcpy(fresh.triangles, labels, mesh->triangle_count * sizeof *labels);
        if (!finish_labels(mesh, &fresh)) return CSCD_OUT_OF_MEMORY;
    }
    part_labels_free(mesh->context, p);
    *p = fresh;
    return CSCD_OK;
}

cscd_status part_labels_copy(const part_labels *p, const cscd_mesh *mesh, part_labels *out) {
    part_labels copy = *p;
    if (!bodies_copy(&p->bodies, mesh, &copy.bodies)) return CSCD_OUT_OF_MEMORY;
    if (!context_copy_all(mesh->context, label_arrays(mesh, &copy))) {
        bodies_free(mesh->context, &copy.bodies);
        return CSCD_OUT_OF_MEMORY;
    }
    *out = copy;
    return CSCD_OK;
}

cscd_status part_labels_move(const part_labels *p, const cscd_mesh *mesh, const cscd_mesh_change *change,
                             part_labels *out) {
    part_labels moved = {.part_count = p->part_count};
    if (p->triangles != NULL) {
        if (!context_reserve_all(mesh->context, label_arrays(mesh, &moved))) return CSCD_OUT_OF_MEMORY;
        mesh_change_make_whole(change, &change->triangles);
        for (uint32_t t = 0; t < mesh->triangle_count; t++) {
            uint32_t origin = change->triangles.to_old[t];
            moved.triangles[t] = origin != UINT32_MAX ? p->triangles[origin] : UINT32_MAX;
        }
        if (!finish_labels(mesh, &moved)) return CSCD_OUT_OF_MEMORY;
    }
    *out = moved;
    return CSCD_OK;
}

void part_labels_free(cscd_context *context, part_labels *p) {
    context_free(context, p->triangles);
    context_free(context, p->sizes);
    bodies_free(context, &p->bodies);
    *p = (part_labels){.triangles = NULL};
}

const char *part_labels_validate(const part_labels *p, const cscd_mesh *mesh) {
    uint64_t sum = 0;
    if ((p->triangles != NULL) != (p->sizes != NULL)) return "labels of parts have no sizes";
    if (p->triangles == NULL) return NULL;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        if (p->triangles[t] >= p->part_count && p->triangles[t] != UINT32_MAX)
            return "a triangle is in a part that there is not";
    }
    for (size_t i = 0; i <= p->part_count; i++) sum += p->sizes[i];
    return sum == mesh->triangle_count ? NULL : "the parts have other triangles than the mesh";
}

/* ---- parts of features ------------------------------------------------------------------------------------ */

uint32_t part_size(const part_labels *p, const cscd_mesh *mesh, uint32_t part) {
    if (p->triangles != NULL) return *size_of(p, part);
    return part < mesh->object_count ? mesh->objects[part].triangle_count : 0;
}

uint32_t part_of_triangle(const part_labels *p, const cscd_mesh *mesh, uint32_t triangle) {
    if (p->triangles != NULL) return p->triangles[triangle];
    return cscd_mesh_vertex_object(mesh, mesh->triangles[triangle][0]);
}

uint32_t part_of_vertex(const part_labels *p, const cscd_mesh *mesh, uint32_t vertex) {
    if (p->triangles == NULL) return cscd_mesh_vertex_object(mesh, vertex);
    if (vertex_has_no_triangle(mesh, vertex)) return UINT32_MAX;
    return p->triangles[mesh->vertex_stars[mesh->vertex_star_offsets[vertex]]];
}

uint32_t part_of_edge(const part_labels *p, const cscd_mesh *mesh, uint32_t edge) {
    if (p->triangles == NULL) return cscd_mesh_vertex_object(mesh, mesh->edges[edge][0]);
    if (edge_is_loose(mesh, edge)) return UINT32_MAX;
    return p->triangles[mesh->edge_stars[mesh->edge_star_offsets[edge]]];
}

/* ---- contacts that a caller gives back --------------------------------------------------------------------- */

static bool has_vertex(const cscd_mesh *mesh, uint32_t vertex) {
    return vertex < mesh->vertex_count;
}

static bool has_edge(const cscd_mesh *mesh, uint32_t edge) {
    return edge < mesh->edge_count;
}

/* Are both features of the mesh? */
static bool is_of_mesh(const cscd_mesh *mesh, const cscd_contact *c) {
    switch (c->kind) {
    case CSCD_CONTACT_VF:
        return has_vertex(mesh, c->a) && c->b < mesh->triangle_count;
    case CSCD_CONTACT_EE:
        return has_edge(mesh, c->a) && has_edge(mesh, c->b);
    case CSCD_CONTACT_VV:
        return has_vertex(mesh, c->a) && has_vertex(mesh, c->b);
    case CSCD_CONTACT_EV:
        return has_edge(mesh, c->a) && has_vertex(mesh, c->b);
    case CSCD_CONTACT_VH:
        return has_vertex(mesh, c->a) && c->b < mesh->object_count;
    default:
        return false;
    }
}

cscd_status given_contacts_check(cscd_context *context, const cscd_mesh *mesh, const char *function,
                                 const cscd_contact *contacts, size_t count) {
    if (contacts == NULL && count > 0)
        return context_fail(context, CSCD_INVALID_ARGUMENT, "%s: contacts is NULL, but there are to be %zu",
                            function, count);
    for (size_t i = 0; i < count; i++) {
        if (is_of_mesh(mesh, &contacts[i])) continue;
        return context_fail(context, CSCD_INVALID_ARGUMENT,
                            "contact %zu (kind %d, features %u and %u) is not of the mesh", i,
                            (int)contacts[i].kind, contacts[i].a, contacts[i].b);
    }
    return CSCD_OK;
}

uint64_t parts_of_contact(const part_labels *labels, const cscd_mesh *mesh, cscd_contact_kind kind,
                          uint32_t a, uint32_t b) {
    const bool edge_a = kind == CSCD_CONTACT_EE || kind == CSCD_CONTACT_EV;
    const uint32_t part_a = edge_a ? part_of_edge(labels, mesh, a) : part_of_vertex(labels, mesh, a);
    uint32_t part_b;
    if (kind == CSCD_CONTACT_VF)
        part_b = part_of_triangle(labels, mesh, b);
    else if (kind == CSCD_CONTACT_EE)
        part_b = part_of_edge(labels, mesh, b);
    else if (kind == CSCD_CONTACT_VH)
        part_b = labels->triangles == NULL ? b : UINT32_MAX;
    else
        part_b = part_of_vertex(labels, mesh, b);
    return key_of_parts(part_a, part_b);
}
