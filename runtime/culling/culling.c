/* Culling by orientation: regions, their detector points, the orientations of triangles in an interval, and the contacts that taint them. */
#include "runtime/culling/culling.h"

#include <string.h>

array_list culling_arrays(culling *c) {
    size_t triangles = c->mesh->triangle_count, regions = c->region_count;
    return (array_list){{ARRAY(c->triangle_regions, triangles), ARRAY(c->triangle_weights, triangles),
                         ARRAY(c->detector_offsets, regions), ARRAY(c->detector_points, regions),
                         ARRAY(c->facing, triangles), ARRAY(c->orientations, triangles),
                         ARRAY(c->earlier, triangles)}};
}

cscd_status culling_create(const cscd_mesh *mesh, const cscd_plan *plan, culling *out) {
    culling c = {.context = mesh->context, .mesh = mesh};
    c.region_count = plan != NULL ? plan->region_count : mesh->component_count;
    if (!context_allocate_all(c.context, culling_arrays(&c))) return CSCD_OUT_OF_MEMORY;
    const uint32_t *regions = plan != NULL ? plan->triangle_regions : mesh->triangle_components;
    memcpy(c.triangle_regions, regions, mesh->triangle_count * sizeof *regions);
    for (uint32_t t = 0; plan == NULL && t < mesh->triangle_count; t++)
        c.triangle_weights[t] = 1.0 / mesh->components[mesh->triangle_components[t]].triangle_count;
    if (plan != NULL) {
        memcpy(c.triangle_weights, plan->triangle_weights, mesh->triangle_count * sizeof(double));
        memcpy(c.detector_offsets, plan->detector_offsets, c.region_count * sizeof *c.detector_offsets);
    }
    culling_clear(&c);
    *out = c;
    return CSCD_OK;
}

void culling_destroy(culling *c) {
    context_free_all(c->context, culling_arrays(c));
    *c = (culling){0};
}

void culling_clear(culling *c) {
    memset(c->facing, ORIENTATION_ZERO, c->mesh->triangle_count);
    memset(c->orientations, ORIENTATION_ZERO, c->mesh->triangle_count);
    c->plus = c->minus = 0;
}

void culling_begin(culling *c) {
    memcpy(c->orientations, c->facing, c->mesh->triangle_count);
    uint32_t plus = 0, minus = 0;
    for (uint32_t t = 0; t < c->mesh->triangle_count; t++) {
        plus += c->facing[t] == ORIENTATION_PLUS;
        minus += c->facing[t] == ORIENTATION_MINUS;
    }
    c->plus = plus;
    c->minus = minus;
}

void culling_pass_done(culling *c) {
    memcpy(c->earlier, c->orientations, c->mesh->triangle_count);
}

/* ---- tainting ------------------------------------------------------------------------------------------ */

uint32_t tainting_triangle(const tainting *t, uint32_t triangle) {
    start_states_taint(t->starts, triangle);
    return t->closes[t->mesh->triangle_components[triangle]] && culling_taint(t->culling, triangle);
}

static uint32_t taint_star(const tainting *t, const uint32_t *star, uint32_t count) {
    uint32_t newly_kept = 0;
    for (uint32_t i = 0; i < count; i++) newly_kept += tainting_triangle(t, star[i]);
    return newly_kept;
}

static uint32_t taint_vertex(const tainting *t, uint32_t vertex) {
    const cscd_mesh *mesh = t->mesh;
    uint32_t begin = mesh->vertex_star_offsets[vertex];
    return taint_star(t, mesh->vertex_stars + begin, mesh->vertex_star_offsets[vertex + 1] - begin);
}

static uint32_t taint_edge(const tainting *t, uint32_t edge) {
    const cscd_mesh *mesh = t->mesh;
    return taint_star(t, mesh->edge_stars + mesh->edge_star_offsets[edge], edge_star_size(mesh, edge));
}

/* Does a feature belong to no triangle? */
static bool is_loose(const cscd_mesh *mesh, const cscd_contact *contact) {
    if (contact->kind == CSCD_CONTACT_VF) return vertex_has_no_triangle(mesh, contact->a);
    return contact->kind != CSCD_CONTACT_EE || edge_is_loose(mesh, contact->a) ||
           edge_is_loose(mesh, contact->b);
}

uint32_t tainting_component(const cscd_mesh *mesh, const cscd_contact *contact) {
    bool vf = contact->kind == CSCD_CONTACT_VF;
    if (is_loose(mesh, contact)) return UINT32_MAX;
    uint32_t first = vf ? mesh->vertex_stars[mesh->vertex_star_offsets[contact->a]]
                        : mesh->edge_stars[mesh->edge_star_offsets[contact->a]];
    uint32_t second = vf ? contact->b : mesh->edge_stars[mesh->edge_star_offsets[contact->b]];
    uint32_t a = mesh->triangle_components[first], b = mesh->triangle_components[second];
    return a == b ? a : UINT32_MAX;
}

void tainting_note(const cscd_mesh *mesh, const cscd_contact *contact, double *earliest) {
    uint32_t component = tainting_component(mesh, contact);
    if (component != UINT32_MAX && contact->toi < earliest[component]) earliest[component] = contact->toi;
}

uint32_t tainting_look(const tainting *t, const cscd_contact *contact) {
    uint32_t component = tainting_component(t->mesh, contact);
    if (component == UINT32_MAX) return 0;
    t->touched[component]++;
    if (contact->toi - t->within > t->earliest[component]) return 0;
    if (contact->kind == CSCD_CONTACT_VF)
        return taint_vertex(t, contact->a) + tainting_triangle(t, contact->b);
    return taint_edge(t, contact->a) + taint_edge(t, contact->b);
}

static void mark_star(const uint32_t *stars, const uint32_t *offsets, uint32_t feature, bool *triangles) {
    for (uint32_t i = offsets[feature]; i < offsets[feature + 1]; i++) triangles[stars[i]] = true;
}

void tainting_mark(const cscd_mesh *mesh, const cscd_contact *contact, bool *triangles, uint32_t *touched) {
    uint32_t component = tainting_component(mesh, contact);
    if (component == UINT32_MAX) return;
    touched[component]++;
    if (contact->kind == CSCD_CONTACT_VF) {
        mark_star(mesh->vertex_stars, mesh->vertex_star_offsets, contact->a, triangles);
        triangles[contact->b] = true;
    } else {
        mark_star(mesh->edge_stars, mesh->edge_star_offsets, contact->a, triangles);
        mark_star(mesh->edge_stars, mesh->edge_star_offsets, contact->b, triangles);
    }
}
