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

uint64_t parts_of_contact(const part_labels *labels, const cscd_mesh *mesh, const cscd_contact *c) {
    bool edge_a = c->kind == CSCD_CONTACT_EE || c->kind == CSCD_CONTACT_EV;
    uint32_t a = edge_a ? part_of_edge(labels, mesh, c->a) : part_of_vertex(labels, mesh, c->a), b;
    if (c->kind == CSCD_CONTACT_VF)
        b = part_of_triangle(labels, mesh, c->b);
    else if (c->kind == CSCD_CONTACT_EE)
        b = part_of_edge(labels, mesh, c->b);
    else if (c->kind == CSCD_CONTACT_VH)
        b = labels->triangles == NULL ? c->b : UINT32_MAX;
    else
        b = part_of_vertex(labels, mesh, c->b);
    return key_of_parts(a, b);
}
