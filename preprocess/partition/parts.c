/* Gives triangles and vertices to objects and their parts. */
#include "preprocess/partition/parts.h"

#include <string.h>

/* In a scene of one object, its components are the objects of the partition. */
static bool objects_are_components(const cscd_mesh *mesh) {
    return mesh->object_count == 1;
}

static void find_objects(cscd_partition *partition) {
    const cscd_mesh *mesh = partition->mesh;
    for (uint32_t object = 0; object < partition->object_count; object++)
        partition->object_obstacles[object] = objects_are_components(mesh)
                                                  ? component_is_obstacle(mesh, object)
                                                  : mesh->objects[object].obstacle;
}

static void give_triangles(cscd_partition *partition, const cscd_plan *plan) {
    const cscd_mesh *mesh = partition->mesh;
    const uint32_t *parts = plan != NULL ? plan->triangle_regions : mesh->triangle_components;
    memcpy(partition->triangle_parts, parts, mesh->triangle_count * sizeof *parts);
    uint32_t object = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        while (t >= mesh->objects[object].first_triangle + mesh->objects[object].triangle_count) object++;
        partition->parts[parts[t]].object =
            objects_are_components(mesh) ? mesh->triangle_components[t] : object;
    }
}

/* Returns the part of most triangles around a vertex. counts holds a zero per part, and does so again
 * afterwards. */
static uint32_t part_with_most(const cscd_partition *partition, uint32_t vertex, uint32_t *counts) {
    const cscd_mesh *mesh = partition->mesh;
    uint32_t begin = mesh->vertex_star_offsets[vertex], end = mesh->vertex_star_offsets[vertex + 1];
    uint32_t best = PARTITION_NONE;
    for (uint32_t i = begin; i < end; i++) counts[partition->triangle_parts[mesh->vertex_stars[i]]]++;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t part = partition->triangle_parts[mesh->vertex_stars[i]];
        if (best == PARTITION_NONE || counts[part] > counts[best] ||
            (counts[part] == counts[best] && part < best))
            best = part;
    }
    for (uint32_t i = begin; i < end; i++) counts[partition->triangle_parts[mesh->vertex_stars[i]]] = 0;
    return best;
}

static void give_vertices(cscd_partition *partition, uint32_t *counts) {
    uint32_t vertex_count = partition->mesh->vertex_count, *ends = partition->part_vertex_offsets + 1;
    for (uint32_t v = 0; v < vertex_count; v++)
        partition->vertex_parts[v] = part_with_most(partition, v, counts);
    for (uint32_t v = 0; v < vertex_count; v++) {
        if (partition->vertex_parts[v] != PARTITION_NONE) counts[partition->vertex_parts[v]]++;
    }
    for (uint32_t p = 0, begin = 0; p < partition->part_count; begin += counts[p++]) ends[p] = begin;
    for (uint32_t v = 0; v < vertex_count; v++) {
        uint32_t part = partition->vertex_parts[v];
        if (part != PARTITION_NONE) partition->part_vertices[ends[part]++] = v;
    }
}

cscd_partition *partition_of_parts(const cscd_mesh *mesh, const cscd_plan *plan) {
    uint32_t object_count = objects_are_components(mesh) ? mesh->component_count : mesh->object_count;
    uint32_t part_count = plan != NULL ? plan->region_count : mesh->component_count;
    uint32_t *counts = context_allocate(mesh->context, part_count, sizeof *counts);
    if (counts == NULL) return NULL;
    cscd_partition *partition = partition_allocate(mesh, object_count, part_count);
    if (partition != NULL) {
        find_objects(partition);
        give_triangles(partition, plan);
        give_vertices(partition, counts);
    }
    context_free(mesh->context, counts);
    return partition;
}
