/* The partition of vertices into cells, in which particles walk: preprocessing makes it, the sensors use
 * it. */
#include "sensors/partition.h"

#include <assert.h>

static array_list list_arrays(cscd_partition *p) {
    size_t vertices = p->mesh->vertex_count, triangles = p->mesh->triangle_count, parts = p->part_count;
    return (array_list){
        {ARRAY(p->object_obstacles, p->object_count), ARRAY(p->parts, parts), ARRAY(p->distortions, parts),
         ARRAY(p->part_generations, parts), ARRAY(p->triangle_parts, triangles),
         ARRAY(p->vertex_parts, vertices), ARRAY(p->part_vertex_offsets, parts + 1),
         ARRAY(p->part_vertices, vertices), ARRAY(p->vertex_cells, vertices), ARRAY(p->cell_parts, vertices),
         ARRAY(p->cell_offsets, vertices + 1), ARRAY(p->cell_vertices, vertices),
         ARRAY(p->neighbour_offsets, vertices + 1), ARRAY(p->neighbours, 2 * (size_t)p->mesh->edge_count)}};
}

static void free_partition(reference_count *references) {
    cscd_partition *partition = (cscd_partition *)references;
    cscd_context *context = partition->context;
    cscd_mesh mesh = partition->seen;
    context_free_all(context, list_arrays(partition));
    context_free(context, partition);
    mesh_release(&mesh);
    context_release(context);
}

static const char *check_cells(const cscd_partition *p) {
    uint32_t vertices = 0;
    for (uint32_t c = 0; c < p->cell_count; c++) {
        if (p->cell_parts[c] >= p->part_count) return "a cell is of a part that there is not";
        if (p->cell_offsets[c] != vertices || p->cell_offsets[c + 1] < vertices)
            return "the cells of a partition do not follow each other";
        vertices = p->cell_offsets[c + 1];
        for (uint32_t i = p->cell_offsets[c]; i < vertices; i++) {
            uint32_t v = p->cell_vertices[i];
            if (v >= p->mesh->vertex_count || p->vertex_cells[v] != c ||
                p->vertex_parts[v] != p->cell_parts[c])
                return "a cell holds a vertex of another one";
        }
    }
    return NULL;
}

const char *partition_validate(const cscd_partition *p) {
    for (uint32_t t = 0; t < p->mesh->triangle_count; t++) {
        if (p->triangle_parts[t] >= p->part_count) return "a triangle is in a part that there is not";
    }
    for (uint32_t v = 0; v < p->mesh->vertex_count; v++) {
        if (p->vertex_cells[v] != PARTITION_NONE && p->vertex_cells[v] >= p->cell_count)
            return "a vertex is in a cell that there is not";
    }
    for (uint32_t i = 0; i < p->part_count; i++) {
        if (p->parts[i].object >= p->object_count) return "a part is of an object that there is not";
    }
    return check_cells(p);
}

cscd_partition *partition_allocate(const cscd_mesh *mesh, uint32_t object_count, uint32_t part_count) {
    cscd_partition *partition = context_allocate(mesh->context, 1, sizeof *partition);
    if (partition == NULL) return NULL;
    partition->context = mesh->context;
    partition->seen = mesh_seen_from(mesh->context, mesh);
    partition->mesh = &partition->seen;
    partition->object_count = object_count;
    partition->part_count = part_count;
    if (!context_allocate_all(partition->context, list_arrays(partition))) {
        context_free(mesh->context, partition);
        return NULL;
    }
    mesh_hold(mesh);
    context_add_object(partition->context, &partition->references, free_partition);
    return partition;
}

void partition_hold(cscd_partition *partition) {
    reference_add(&partition->references);
}

void partition_release(cscd_partition *partition) {
    context_drop_object(partition->context, &partition->references);
}

void cscd_partition_destroy(cscd_partition *partition) {
    if (partition != NULL) context_destroy_object(partition->context, &partition->references);
}

uint32_t cscd_partition_object_count(const cscd_partition *partition) {
    return partition->object_count;
}

uint32_t cscd_partition_part_count(const cscd_partition *partition) {
    return partition->part_count;
}

cscd_part cscd_partition_part(const cscd_partition *partition, uint32_t part) {
    assert(part < partition->part_count);
    return partition->parts[part];
}

uint32_t cscd_partition_cell_count(const cscd_partition *partition) {
    return partition->cell_count;
}

uint32_t cscd_partition_vertex_cell(const cscd_partition *partition, uint32_t vertex) {
    assert(vertex < partition->mesh->vertex_count);
    return partition->vertex_cells[vertex];
}

double cscd_partition_distortion(const cscd_partition *partition, uint32_t part) {
    assert(part < partition->part_count);
    return partition->distortions[part];
}
