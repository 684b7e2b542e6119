/* Keeps one particle in every cell of a partition, also when cells are renewed. */
#include "sensors/cell_particles.h"

#include "src/core/vec3.h"

uint32_t particle_group(const sensor_partition *partition, uint32_t part, bool by_parts) {
    uint32_t object = partition->parts[part].object;
    if (partition->object_obstacles[object]) return PARTITION_NONE;
    return by_parts ? part : object;
}

/* The mean is summed from differences to the first vertex, so that it keeps its digits far from the
 * origin. */
static uint32_t middle_of(const uint32_t *vertices, uint32_t count, const double *x) {
    const double *first = x + (size_t)vertices[0] * 3;
    double mean[3] = {0.0, 0.0, 0.0}, least = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        double d[3];
        vec3_subtract(x + (size_t)vertices[i] * 3, first, d);
        vec3_add_scaled(mean, 1.0 / count, d, mean);
    }
    uint32_t nearest = vertices[0];
    for (uint32_t i = 0; i < count; i++) {
        double d[3];
        vec3_subtract(x + (size_t)vertices[i] * 3, first, d);
        vec3_subtract(d, mean, d);
        double squared = vec3_dot(d, d);
        if (!(squared < least)) continue;
        least = squared;
        nearest = vertices[i];
    }
    return nearest;
}

static uint32_t middle_of_cell(const sensor_partition *partition, uint32_t cell, const double *x) {
    uint32_t begin = partition->cell_offsets[cell];
    return middle_of(partition->cell_vertices + begin, partition->cell_offsets[cell + 1] - begin, x);
}

cscd_status cell_particles_place(particles *p, const sensor_partition *partition, uint64_t *generation,
                                 const double *x) {
    if (*generation == partition->generation) return CSCD_OK;
    cscd_status status = particles_reserve(p, partition->cell_count);
    if (status != CSCD_OK) return status;
    uint32_t *placed = p->targets;
    for (uint32_t c = 0; c < partition->cell_count; c++) placed[c] = PARTITION_NONE;
    for (uint32_t i = 0; i < p->count; i++) {
        uint32_t vertex = p->vertices[i];
        if (partition->part_generations[partition->vertex_parts[vertex]] <= *generation)
            placed[partition->vertex_cells[vertex]] = vertex;
    }
    p->count = partition->cell_count;
    for (uint32_t c = 0; c < p->count; c++) {
        uint32_t part = partition->cell_parts[c];
        p->vertices[c] = placed[c] != PARTITION_NONE ? placed[c] : middle_of_cell(partition, c, x);
        p->objects[c] = partition->parts[part].object;
        p->groups[c] = particle_group(partition, part, partition->options->within);
    }
    *generation = partition->generation;
    return CSCD_OK;
}
