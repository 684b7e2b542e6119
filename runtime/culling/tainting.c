/* What the contacts found so far say about triangles: those in contact with their component are tainted. */
#include "runtime/culling/tainting.h"

void tainting_begin(cscd_detector *d) {
    for (uint32_t c = 0; c < d->mesh->component_count; c++) d->touched[c] = false;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) d->contacts_seen[i] = 0;
}

/* Returns whether its pairs are kept from now on, and were not. */
static bool taint(cscd_detector *d, uint32_t triangle) {
    start_states_taint(&d->starts, triangle);
    return d->wants_all_contacts[d->mesh->triangle_components[triangle]] &&
           culling_taint(&d->culling, triangle);
}

static uint32_t taint_star(cscd_detector *d, const uint32_t *star, uint32_t count) {
    uint32_t fresh = 0;
    for (uint32_t i = 0; i < count; i++) fresh += taint(d, star[i]);
    return fresh;
}

static uint32_t taint_vertex(cscd_detector *d, uint32_t vertex) {
    uint32_t begin = d->mesh->vertex_star_offsets[vertex];
    return taint_star(d, d->mesh->vertex_stars + begin, d->mesh->vertex_star_offsets[vertex + 1] - begin);
}

static uint32_t taint_edge(cscd_detector *d, uint32_t edge) {
    return taint_star(d, d->mesh->edge_stars + d->mesh->edge_star_offsets[edge],
                      edge_star_size(d->mesh, edge));
}

/* The component that both features belong to; UINT32_MAX: two. */
static uint32_t common_component(const cscd_mesh *mesh, const cscd_contact *contact) {
    bool vf = contact->kind == CSCD_CONTACT_VF;
    uint32_t first = vf ? mesh->vertex_stars[mesh->vertex_star_offsets[contact->a]]
                        : mesh->edge_stars[mesh->edge_star_offsets[contact->a]];
    uint32_t second = vf ? contact->b : mesh->edge_stars[mesh->edge_star_offsets[contact->b]];
    uint32_t a = mesh->triangle_components[first], b = mesh->triangle_components[second];
    return a == b ? a : UINT32_MAX;
}

uint32_t tainting_look(cscd_detector *d) {
    uint32_t fresh = 0;
    if (!detector_culls(d)) return 0;
    for (uint32_t i = 0; i < d->traversal.lane_count; i++) {
        const contact_lane *lane = &d->contact_lanes[i];
        for (size_t j = d->contacts_seen[i]; j < lane->count; j++) {
            const cscd_contact *contact = &lane->contacts[j];
            uint32_t component = common_component(d->mesh, contact);
            if (component == UINT32_MAX) continue;
            d->touched[component] = true;
            if (contact->kind == CSCD_CONTACT_VF)
                fresh += taint_vertex(d, contact->a) + taint(d, contact->b);
            else
                fresh += taint_edge(d, contact->a) + taint_edge(d, contact->b);
        }
        d->contacts_seen[i] = lane->count;
    }
    return fresh;
}
