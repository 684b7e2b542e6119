/* Which part of a scene each triangle is in: objects, or what the caller says. */
#include "src/mesh/part_labels.h"

#include "src/mesh/plan.h"

#include <string.h>

/* ---- the labels of a detector ---------------------------------------------------------------------------- */

static array_list list_arrays(const cscd_mesh *mesh, part_labels *p) {
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
        if (!context_reserve_all(mesh->context, list_arrays(mesh, &fresh))) return CSCD_OUT_OF_MEMORY;
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
    if (!context_copy_all(mesh->context, list_arrays(mesh, &copy))) {
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
        if (!context_reserve_all(mesh->context, list_arrays(mesh, &moved))) return CSCD_OUT_OF_MEMORY;
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
