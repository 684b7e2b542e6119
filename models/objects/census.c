/* Finds which objects of a recording touch each other, and when, by detector steps from frame to frame. */
#include "models/common/vec3.h"
#include "models/objects/objects.h"
#include "models/shapes/body.h"

#include <stdlib.h>
#include <string.h>

cscd_status census_begin(const cscd_mesh *mesh, census *out) {
    census c = {.mesh = mesh, .object_count = cscd_mesh_component_count(mesh)};
    cscd_status status = cscd_detector_create(cscd_mesh_context(mesh), mesh, NULL, NULL, &c.detector);
    if (status != CSCD_OK) return status;
    c.last = body_allocate(cscd_mesh_vertex_count(mesh), 3 * sizeof *c.last);
    c.pairs = body_allocate((size_t)c.object_count * c.object_count, sizeof *c.pairs);
    *out = c;
    return CSCD_OK;
}

void census_free(census *c) {
    cscd_detector_destroy(c->detector);
    free(c->last);
    free(c->pairs);
    *c = (census){0};
}

static uint32_t object_of(const cscd_mesh *mesh, uint32_t vertex) {
    uint32_t count;
    return cscd_mesh_triangle_component(mesh, *cscd_mesh_vertex_triangles(mesh, vertex, &count));
}

static void count_contacts(census *c, const cscd_contacts *found) {
    bool between = false, within = false;
    for (size_t i = 0; i < found->count; i++) {
        const cscd_contact *contact = &found->items[i];
        uint32_t a[2] = {contact->a}, b[3];
        if (contact->kind == CSCD_CONTACT_VF) {
            cscd_mesh_triangle(c->mesh, contact->b, b);
        } else {
            cscd_mesh_edge(c->mesh, contact->a, a);
            cscd_mesh_edge(c->mesh, contact->b, b);
        }
        uint32_t first = object_of(c->mesh, a[0]), second = object_of(c->mesh, b[0]);
        c->pairs[first * c->object_count + second] = c->pairs[second * c->object_count + first] = true;
        between = between || first != second;
        within = within || first == second;
    }
    c->touching = between;
    c->between_intervals += between;
    c->within_intervals += within;
    c->contacts += found->count;
}

static double mean_edge(const cscd_mesh *mesh, const double *frame) {
    uint32_t count = cscd_mesh_edge_count(mesh);
    double sum = 0.0;
    for (uint32_t e = 0; e < count; e++) {
        uint32_t v[2];
        double along[3];
        cscd_mesh_edge(mesh, e, v);
        vec3_subtract(frame + (size_t)v[1] * 3, frame + (size_t)v[0] * 3, along);
        sum += vec3_norm(along);
    }
    return sum / count;
}

static cscd_status count_interval(census *c, const double *frame) {
    cscd_contacts found;
    cscd_status status =
        cscd_detector_step(c->detector, CSCD_DOUBLES(c->last, cscd_mesh_vertex_count(c->mesh)),
                           CSCD_DOUBLES(frame, cscd_mesh_vertex_count(c->mesh)), &found);
    if (status != CSCD_OK) return status;
    count_contacts(c, &found);
    for (uint32_t v = 0; v < cscd_mesh_vertex_count(c->mesh); v++) {
        double moved[3];
        vec3_subtract(frame + (size_t)v * 3, c->last + (size_t)v * 3, moved);
        c->largest_motion = fmax(c->largest_motion, vec3_norm(moved) / c->edge_length);
    }
    return CSCD_OK;
}

cscd_status census_add(census *c, const double *frame) {
    cscd_intersections intersections;
    cscd_status status = CSCD_OK;
    if (c->frame_count == 0)
        c->edge_length = mean_edge(c->mesh, frame);
    else
        status = count_interval(c, frame);
    if (status == CSCD_OK)
        status = cscd_detector_check(c->detector, CSCD_DOUBLES(frame, cscd_mesh_vertex_count(c->mesh)),
                                     &intersections);
    if (status != CSCD_OK) return status;
    c->intersecting_frames += intersections.count > 0;
    memcpy(c->last, frame, (size_t)cscd_mesh_vertex_count(c->mesh) * 3 * sizeof *frame);
    c->frame_count++;
    return CSCD_OK;
}

uint32_t census_pair_count(const census *c) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < c->object_count; i++) {
        for (uint32_t j = 0; j < i; j++) count += c->pairs[i * c->object_count + j];
    }
    return count;
}
