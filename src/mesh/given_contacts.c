/* Lists of contacts that a caller gives back, and the parts that they are of. */
#include "src/mesh/given_contacts.h"

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
