/* Partitions made by hand: triangles may be in any part, and cells lie about random vertices. */
#include "tests/support/sensors/hand_partition.h"

#include "src/core/vec3.h"
#include "tests/support/random.h"

#include <stdlib.h>

static void *allocate_zeros(size_t count, size_t size) {
    void *block = calloc(count + 1, size);
    if (block == NULL) abort();
    return block;
}

static sensor_partition *allocate_partition(const cscd_mesh *mesh, uint32_t part_count) {
    size_t vertices = mesh->vertex_count;
    sensor_partition *p = allocate_zeros(1, sizeof *p);
    static const cscd_sensor_options none;
    *p = (sensor_partition){
        .context = mesh->context, .mesh = mesh, .options = &none, .part_count = part_count};
    p->object_count = part_count;
    p->object_obstacles = allocate_zeros(part_count, sizeof *p->object_obstacles);
    p->parts = allocate_zeros(part_count, sizeof *p->parts);
    p->triangle_parts = allocate_zeros(mesh->triangle_count, sizeof(uint32_t));
    p->vertex_parts = allocate_zeros(vertices, sizeof(uint32_t));
    p->part_vertex_offsets = allocate_zeros((size_t)part_count + 1, sizeof(uint32_t));
    p->part_vertices = allocate_zeros(vertices, sizeof(uint32_t));
    p->vertex_cells = allocate_zeros(vertices, sizeof(uint32_t));
    p->cell_parts = allocate_zeros(vertices, sizeof(uint32_t));
    p->cell_offsets = allocate_zeros(vertices + 1, sizeof(uint32_t));
    p->cell_vertices = allocate_zeros(vertices, sizeof(uint32_t));
    p->part_generations = allocate_zeros(part_count, sizeof(uint64_t));
    p->generation = 1;
    for (uint32_t i = 0; i < part_count; i++) p->part_generations[i] = 1;
    return p;
}

static void list_part_vertices(sensor_partition *p) {
    const cscd_mesh *mesh = p->mesh;
    uint32_t count = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const uint32_t *star = mesh->vertex_stars + mesh->vertex_star_offsets[v];
        bool used = mesh->vertex_star_offsets[v + 1] > mesh->vertex_star_offsets[v];
        p->vertex_parts[v] = used ? p->triangle_parts[star[0]] : PARTITION_NONE;
        p->vertex_cells[v] = PARTITION_NONE;
    }
    for (uint32_t i = 0; i < p->part_count; i++) {
        p->part_vertex_offsets[i] = count;
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            if (p->vertex_parts[v] == i) p->part_vertices[count++] = v;
        }
    }
    p->part_vertex_offsets[p->part_count] = count;
}

static double squared_distance(const double *positions, uint32_t a, uint32_t b) {
    double offset[3];
    vec3_subtract(positions + (size_t)a * 3, positions + (size_t)b * 3, offset);
    return vec3_dot(offset, offset);
}

/* Gives each vertex of the part to the nearest of the centres, or to the first of equally near ones. */
static void make_cells(sensor_partition *p, const double *positions, uint32_t part, uint32_t cells_max) {
    const uint32_t *vertices = p->part_vertices + p->part_vertex_offsets[part];
    uint32_t count = p->part_vertex_offsets[part + 1] - p->part_vertex_offsets[part], made = 0;
    uint32_t *nearest = allocate_zeros(count, sizeof *nearest), centres[64];
    p->parts[part] = (cscd_sensor_part){.object = part, .first_cell = p->cell_count};
    for (uint32_t c = 0; c < cells_max && count > 0; c++)
        centres[c] = vertices[random_integer(0, (int)count - 1)];
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t c = 1; c < cells_max; c++) {
            double to_best = squared_distance(positions, vertices[i], centres[nearest[i]]);
            if (squared_distance(positions, vertices[i], centres[c]) < to_best) nearest[i] = c;
        }
    }
    uint32_t place = p->cell_offsets[p->cell_count];
    for (uint32_t c = 0; c < cells_max; c++) {
        uint32_t cell = p->cell_count + made, begin = place;
        for (uint32_t i = 0; i < count; i++) {
            if (nearest[i] != c) continue;
            p->vertex_cells[vertices[i]] = cell;
            p->cell_vertices[place++] = vertices[i];
        }
        if (place == begin) continue;
        p->cell_parts[cell] = part;
        p->cell_offsets[cell + 1] = place;
        made++;
    }
    p->parts[part].cell_count = made;
    p->cell_count += made;
    free(nearest);
}

sensor_partition *hand_partition_create(const cscd_mesh *mesh, const double *positions,
                                        const uint32_t *triangle_parts, uint32_t part_count,
                                        uint32_t cells_max) {
    sensor_partition *p = allocate_partition(mesh, part_count);
    memcpy(p->triangle_parts, triangle_parts != NULL ? triangle_parts : mesh->triangle_components,
           mesh->triangle_count * sizeof(uint32_t));
    list_part_vertices(p);
    for (uint32_t i = 0; i < part_count; i++) make_cells(p, positions, i, cells_max);
    return p;
}

void hand_partition_destroy(sensor_partition *p) {
    free(p->object_obstacles);
    free(p->parts);
    free(p->triangle_parts);
    free(p->vertex_parts);
    free(p->part_vertex_offsets);
    free(p->part_vertices);
    free(p->vertex_cells);
    free(p->cell_parts);
    free(p->cell_offsets);
    free(p->cell_vertices);
    free(p->part_generations);
    free(p);
}

void hand_partition_particles(const sensor_partition *p, uint32_t *out) {
    for (uint32_t c = 0; c < p->cell_count; c++) {
        int begin = (int)p->cell_offsets[c], end = (int)p->cell_offsets[c + 1];
        out[c] = p->cell_vertices[random_integer(begin, end - 1)];
    }
}
