/* The places at which particles begin: one in every cell, also when cells are renewed; or some on every
 * object, at random. */
#include "sensors/placement.h"

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

/* ---- at random ----------------------------------------------------------------------------------------- */

/* Lists vertices by object, in the order of their parts. */
static void list_objects(const sensor_partition *partition, random_particles *r) {
    for (uint32_t p = 0; p < partition->part_count; p++) {
        uint32_t count = partition->part_vertex_offsets[p + 1] - partition->part_vertex_offsets[p];
        r->object_offsets[partition->parts[p].object + 1] += count;
    }
    for (uint32_t o = 0; o < r->object_count; o++) r->object_offsets[o + 1] += r->object_offsets[o];
    for (uint32_t p = partition->part_count; p-- > 0;) { /* fills from the end: ends go down to beginnings, */
        uint32_t *end = &r->object_offsets[partition->parts[p].object + 1];
        uint32_t i = partition->part_vertex_offsets[p + 1];
        while (i > partition->part_vertex_offsets[p])
            r->object_vertices[--*end] = partition->part_vertices[--i];
    }
    uint32_t total = partition->part_vertex_offsets[partition->part_count];
    for (uint32_t o = 0; o < r->object_count; o++) r->object_offsets[o] = r->object_offsets[o + 1];
    r->object_offsets[r->object_count] = total; /* which are in their places now */
}

/* Edges are sorted, so neighbours come in order. */
static void list_neighbours(const cscd_mesh *mesh, random_particles *r) {
    uint32_t *offsets = r->neighbour_offsets;
    for (uint32_t e = 0; e < mesh->edge_count; e++)
        for (int k = 0; k < 2; k++) offsets[mesh->edges[e][k] + 1]++;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) offsets[v + 1] += offsets[v];
    for (uint32_t e = mesh->edge_count; e-- > 0;)
        for (int k = 1; k >= 0; k--) r->neighbours[--offsets[mesh->edges[e][k] + 1]] = mesh->edges[e][1 - k];
    for (uint32_t v = 0; v < mesh->vertex_count; v++) offsets[v] = offsets[v + 1];
    offsets[mesh->vertex_count] = 2 * mesh->edge_count;
}

static array_list list_arrays(random_particles *r) {
    return (array_list){
        {ARRAY(r->object_offsets, (size_t)r->object_count + 1), ARRAY(r->object_vertices, r->vertex_count),
         ARRAY(r->neighbour_offsets, (size_t)r->vertex_count + 1), ARRAY(r->neighbours, r->neighbour_count)}};
}

cscd_status random_particles_create(const sensor_partition *partition, random_particles *out) {
    const cscd_mesh *mesh = partition->mesh;
    out->object_count = partition->object_count;
    out->neighbour_count = (size_t)mesh->edge_count * 2;
    out->vertex_count = mesh->vertex_count;
    if (!context_allocate_all(partition->context, list_arrays(out))) return CSCD_OUT_OF_MEMORY;
    list_objects(partition, out);
    list_neighbours(mesh, out);
    return CSCD_OK;
}

void random_particles_free(cscd_context *context, random_particles *r) {
    context_free_all(context, list_arrays(r));
}

/* A number below count, from SplitMix64 (Steele et al. 2014). */
static uint32_t draw_below(uint64_t *state, uint32_t count) {
    uint64_t z = *state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ z >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ z >> 27) * UINT64_C(0x94D049BB133111EB);
    return (uint32_t)((((z ^ z >> 31) >> 32) * count) >> 32);
}

static uint32_t particles_of(const random_particles *r, uint32_t object, uint32_t per_object) {
    uint32_t count = r->object_offsets[object + 1] - r->object_offsets[object];
    return per_object < count ? per_object : count;
}

cscd_status random_particles_place(const random_particles *r, const sensor_partition *partition,
                                   uint32_t per_object, uint32_t seed, particles *p) {
    uint32_t count = 0;
    for (uint32_t o = 0; o < r->object_count; o++) count += particles_of(r, o, per_object);
    cscd_status status = particles_reserve(p, count);
    if (status != CSCD_OK) return status;
    uint64_t state = seed;
    for (uint32_t o = 0; o < r->object_count; o++) {
        uint32_t *vertices = r->object_vertices + r->object_offsets[o];
        uint32_t left = r->object_offsets[o + 1] - r->object_offsets[o];
        for (uint32_t i = particles_of(r, o, per_object); i-- > 0;) {
            uint32_t k = draw_below(&state, left--), drawn = vertices[k];
            vertices[k] = vertices[left];
            vertices[left] = drawn; /* behind those that can still be drawn */
            p->vertices[p->count] = drawn;
            p->objects[p->count] = o;
            p->groups[p->count++] = particle_group(partition, partition->vertex_parts[drawn], false);
        }
    }
    return CSCD_OK;
}
