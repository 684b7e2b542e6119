/* The division of a mesh into objects, parts and cells, in which particles walk. */
#pragma once

#include "cscd/sensors.h"
#include "src/mesh/mesh.h"
#include "src/mesh/plan.h"

enum { PARTITION_NONE = UINT32_MAX };

/* Objects, parts and the mesh never change; cells do when parts are renewed, and generation then grows.
 * Arrays of cells have room for one per vertex, so that renewing never moves them. */
typedef struct sensor_partition {
    cscd_context *context;
    cscd_mesh seen;        /* the mesh, which the partition holds, in this context */
    const cscd_mesh *mesh; /* &seen */
    const cscd_sensor_options *options;

    uint32_t object_count, part_count, cell_count;
    bool *object_obstacles;  /* per object */
    cscd_sensor_part *parts; /* without a vertex of its own, a part has no cell */

    uint32_t *triangle_parts;                      /* the plan's regions, or the components */
    uint32_t *vertex_parts;                        /* PARTITION_NONE without a triangle */
    uint32_t *part_vertex_offsets, *part_vertices; /* vertices of part p, ascending */

    /* Vertices of cell c: cell_vertices[cell_offsets[c] .. cell_offsets[c + 1]), ascending. */
    uint32_t *vertex_cells; /* PARTITION_NONE without a triangle */
    uint32_t *cell_parts, *cell_offsets, *cell_vertices;

    /* Neighbours of x along edges, in its cell: neighbours[offsets[x] .. offsets[x + 1]), ascending. */
    uint32_t *neighbour_offsets, *neighbours;

    uint64_t generation;        /* 1, and one more with every renewal */
    uint64_t *part_generations; /* the generation in which a part's cells were made; those of other parts
                                 * keep their vertices, but not their numbers */
} sensor_partition;

/* Begins a partition, which holds the mesh until partition_end and keeps the address of the options. */
void partition_begin(sensor_partition *partition, cscd_context *context, const cscd_mesh *mesh,
                     const cscd_sensor_options *options);
void partition_end(sensor_partition *partition);

/* Makes parts and their cells, once. A vertex belongs to the part with most of its triangles, and of equal ones to that with
 * the smaller number. plan: NULL, or a plan of the mesh. */
cscd_status partition_divide(sensor_partition *partition, const cscd_plan *plan, const double *positions);

/* Makes new cells for a part, or for all if part is UINT32_MAX; or none, if it fails. */
cscd_status partition_renew(sensor_partition *partition, const double *positions, uint32_t part);

/* Returns the first fault of a partition as a sentence, or NULL. See live_objects_add. */
const char *partition_validate(const sensor_partition *partition);

/* Sensors watch parts of different objects unless both are obstacles, and with the option `within` also different parts of one
 * object that is no obstacle. */
static inline bool partition_watches(const sensor_partition *partition, uint32_t part_a, uint32_t part_b) {
    uint32_t a = partition->parts[part_a].object, b = partition->parts[part_b].object;
    bool obstacles = partition->object_obstacles[a] && partition->object_obstacles[b];
    return part_a != part_b && !obstacles && (a != b || partition->options->within);
}
