/* The partition: cells of vertices that particles walk in, handed from preprocessing to the runtime. */
#include "src/mesh/partition.h"

static bool allocate_cells(cscd_partition *partition) {
    cscd_context *context = partition->context;
    size_t vertices = partition->mesh->vertex_count, edges = partition->mesh->edge_count;
    partition->vertex_cells = context_allocate(context, vertices, sizeof(uint32_t));
    partition->cell_parts = context_allocate(context, vertices, sizeof(uint32_t));
    partition->cell_offsets = context_allocate(context, vertices + 1, sizeof(uint32_t));
    partition->cell_vertices = context_allocate(context, vertices, sizeof(uint32_t));
    partition->neighbour_offsets = context_allocate(context, vertices + 1, sizeof(uint32_t));
    partition->neighbours = context_allocate(context, 2 * edges, sizeof(uint32_t));
    return partition->vertex_cells != NULL && partition->cell_parts != NULL &&
           partition->cell_offsets != NULL && partition->cell_vertices != NULL &&
           partition->neighbour_offsets != NULL && partition->neighbours != NULL;
}

static bool allocate_parts(cscd_partition *partition) {
    cscd_context *context = partition->context;
    size_t vertices = partition->mesh->vertex_count, triangles = partition->mesh->triangle_count;
    size_t parts = partition->part_count;
    partition->object_obstacles = context_allocate(context, partition->object_count, sizeof(bool));
    partition->parts = context_allocate(context, parts, sizeof(cscd_part));
    partition->distortions = context_allocate(context, parts, sizeof(double));
    partition->part_generations = context_allocate(context, parts, sizeof(uint64_t));
    partition->triangle_parts = context_allocate(context, triangles, sizeof(uint32_t));
    partition->vertex_parts = context_allocate(context, vertices, sizeof(uint32_t));
    partition->part_vertex_offsets = context_allocate(context, parts + 1, sizeof(uint32_t));
    partition->part_vertices = context_allocate(context, vertices, sizeof(uint32_t));
    return partition->object_obstacles != NULL && partition->parts != NULL &&
           partition->distortions != NULL && partition->part_generations != NULL &&
           partition->triangle_parts != NULL && partition->vertex_parts != NULL &&
           partition->part_vertex_offsets != NULL && partition->part_vertices != NULL;
}

cscd_partition *partition_allocate(const cscd_mesh *mesh, uint32_t object_count, uint32_t part_count) {
    cscd_partition *partition = context_allocate(mesh->context, 1, sizeof *partition);
    if (partition == NULL) return NULL;
    partition->context = mesh->context;
    partition->mesh = mesh;
    partition->object_count = object_count;
    partition->part_count = part_count;
    if (allocate_parts(partition) && allocate_cells(partition)) return partition;
    cscd_partition_destroy(partition);
    return NULL;
}

void cscd_partition_destroy(cscd_partition *partition) {
    if (partition == NULL) return;
    cscd_context *context = partition->context;
    void *blocks[] = {partition->object_obstacles,    partition->parts,          partition->distortions,
                      partition->part_generations,    partition->triangle_parts, partition->vertex_parts,
                      partition->part_vertex_offsets, partition->part_vertices,  partition->vertex_cells,
                      partition->cell_parts,          partition->cell_offsets,   partition->cell_vertices,
                      partition->neighbour_offsets,   partition->neighbours,     partition};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) context_free(context, blocks[i]);
}

uint32_t cscd_partition_object_count(const cscd_partition *partition) {
    return partition->object_count;
}

uint32_t cscd_partition_part_count(const cscd_partition *partition) {
    return partition->part_count;
}

cscd_part cscd_partition_part(const cscd_partition *partition, uint32_t part) {
    return partition->parts[part];
}

uint32_t cscd_partition_cell_count(const cscd_partition *partition) {
    return partition->cell_count;
}

uint32_t cscd_partition_vertex_cell(const cscd_partition *partition, uint32_t vertex) {
    return partition->vertex_cells[vertex];
}

double cscd_partition_distortion(const cscd_partition *partition, uint32_t part) {
    return partition->distortions[part];
}
